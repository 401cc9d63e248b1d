// Steadiness: of what a new cut would change in the picture, no more than a number of switches,
// those that gain most; the rest stays as it was drawn in the last cut.
//
// Where the two cuts differ they do so in regions of the tree that do not touch, and each can
// be kept by itself, if what was drawn is still valid; what has come into view meanwhile is
// added in the cheapest way. The new cut is taken where the old one could not be kept, and
// where that is what keeps the whole within the budget: such switches are made even above the
// number. A region that alone has more switches than the number (a cluster that opens) is
// switched in a frame of its own, or it would never be.
#ifndef PROM_TRAVERSE_STEADY_H
#define PROM_TRAVERSE_STEADY_H

#include "traverse/evaluate.h"

typedef struct prom_steady_region {
    uint32_t root;
    uint32_t switches;    // to the new cut
    double cost, benefit; // new less old
    bool keeps, may_keep;
} prom_steady_region;

typedef struct prom_steady {
    prom_last_cut wanted; // the new cut, by node
    PROM_ARRAY(prom_steady_region) regions;
    bool *keep; // per node: a region that stays as it was
    uint32_t *stack;
} prom_steady;

void prom_steady_init(prom_steady *steady, const prom_model *model);
void prom_steady_finish(prom_steady *steady);

// Changes a finished cut of the evaluation so that it heeds the selection's max_switches
// against its `last`; does nothing where either is not given, and for cuts over the budget.
void prom_steady_keep(prom_steady *steady, const prom_eval *eval, prom_cut *cut);

#endif
