// The steps of an evaluation (prom_eval_run) that have files of their own.
#ifndef PROM_TRAVERSE_EVALUATE_PRIVATE_H
#define PROM_TRAVERSE_EVALUATE_PRIVATE_H

#include "traverse/evaluate.h"

// Of the options of a node, leaves those that the selection's priors leave.
void prom_eval_heed_priors(prom_eval *eval, uint32_t node);
// Costs and cmin of all visited nodes.
void prom_eval_find_costs(prom_eval *eval);
// What one of a node's representations costs in this view, added to terms.
void prom_eval_add_terms(const prom_eval *eval, uint32_t node, uint32_t rep,
                         double terms[PROM_TERMS]);
// Values of all options, where they are not the benefits.
void prom_eval_find_values(prom_eval *eval);

#endif
