// Private to simplification: a reduction of a work's triangles that goes on from step to step,
// leaf cards apart from the rest: the engine collapses edges, cards are thinned.
#ifndef PROM_SIMPLIFY_REDUCE_H
#define PROM_SIMPLIFY_REDUCE_H

#include "builder/simplify/work.h"

typedef struct prom_reduce_options {
    bool lock_border;    // open borders stay exactly; cards have nothing else and stay too
    bool keep_cards;     // do not thin
    bool merged;         // of many objects: all cards are thinned, not only foliage, and
                         // submeshes may vanish
    bool loose;          // see prom_collapse_options
    float pair_distance; // the same
} prom_reduce_options;

typedef struct prom_reduction prom_reduction;

// The work must outlive the reduction.
prom_reduction *prom_reduction_create(prom_work *work, const prom_reduce_options *options);
void prom_reduction_destroy(prom_reduction *reduction); // NULL is allowed
// Goes on until at most `target` triangles (with back sides) are left, or whatever is left
// would cost more than max_error (object units, INFINITY: no limit), by the estimates of the
// metric; a card may grow by so much on each side. `out` gets the remaining front faces; their
// new vertices are appended to the work.
void prom_reduction_run(prom_reduction *reduction, uint32_t target, float max_error,
                        prom_index_array *out);

#endif
