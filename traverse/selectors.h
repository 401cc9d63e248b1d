// The selectors, one source file each.
#ifndef PROM_TRAVERSE_SELECTORS_H
#define PROM_TRAVERSE_SELECTORS_H

#include "traverse/selector.h"

extern const prom_selector_class prom_select_meta;
extern const prom_selector_class prom_select_greedy;
extern const prom_selector_class prom_select_lagrange;
extern const prom_selector_class prom_select_incremental;
extern const prom_selector_class prom_select_optimal;
extern const prom_selector_class prom_select_funkhouser;
extern const prom_selector_class prom_select_pixels;
extern const prom_selector_class prom_select_sse;
extern const prom_selector_class prom_select_feedback;
extern const prom_selector_class prom_select_distance;
extern const prom_selector_class prom_select_full;
extern const prom_selector_class prom_select_coarsest;

// Of the last selection of `greedy`: whether a step did not fit; *ms: what the cheapest cut with
// the first one and those that it presupposes is predicted at. Where that was within the budget,
// the cut has at least half of what the optimum gains over the cheapest one.
bool prom_greedy_unpaid(const void *state, double *ms);

#endif
