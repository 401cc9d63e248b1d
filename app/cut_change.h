// Small changes that keep a cut valid: another option for an entry, its children in its place,
// or its ancestor. The evaluation is of the cut's view, down to the leaves. The order of the
// entries changes; of the cut's sums only predicted_ms is kept.
#ifndef PROM_APP_CUT_CHANGE_H
#define PROM_APP_CUT_CHANGE_H

#include "traverse/evaluate.h"

void prom_cut_copy(const prom_cut *from, prom_cut *to);
// Draws entry `index` by another option of its node (an index into eval->options).
void prom_cut_take_option(const prom_eval *eval, prom_cut *cut, size_t index, uint32_t option);
// The option of a node that is most accurate, or cheapest; PROM_NONE: it has none.
uint32_t prom_cut_best_option(const prom_eval *eval, uint32_t node);
uint32_t prom_cut_cheapest_option(const prom_eval *eval, uint32_t node);
// Puts the children in the place of a cluster's entry, each drawn by what `choose` says, or
// opened in its turn where it has no option. False, and nothing is changed, where the node
// cannot be opened.
bool prom_cut_open(const prom_eval *eval, prom_cut *cut, size_t index,
                   uint32_t (*choose)(const prom_eval *eval, uint32_t node));
// Puts a node with options in the place of all entries below it.
void prom_cut_close(const prom_eval *eval, prom_cut *cut, uint32_t node, uint32_t option);

#endif
