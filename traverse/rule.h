// Selectors that follow a rule of their own: it sees each node for itself, and no budget. It
// says which clusters open, and by which option each node is drawn that stays closed.
#ifndef PROM_TRAVERSE_RULE_H
#define PROM_TRAVERSE_RULE_H

#include "traverse/evaluate.h"

// An option of a node that has some, as its index in eval->options.
typedef uint32_t prom_rule_choose(void *user, uint32_t node);

// Evaluates a view and fills the cut by the rule; `user` goes to both its functions.
void prom_rule_run(prom_eval *eval, const prom_selection *selection, prom_eval_open *open,
                   prom_rule_choose *choose, void *user, prom_cut *cut);
// The selection's rule_scale, 1 where it says nothing.
float prom_rule_scale(const prom_selection *selection);

// The state of a rule without a memory.
typedef struct prom_rule {
    prom_eval eval;
    float scale; // of this selection
} prom_rule;
void *prom_rule_create(const prom_model *model);
void prom_rule_destroy(void *rule); // NULL is allowed

#endif
