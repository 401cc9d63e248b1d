// Private to simplification: one reduction of a work's triangles, leaf cards apart from the
// rest.
#ifndef PROM_SIMPLIFY_REDUCE_H
#define PROM_SIMPLIFY_REDUCE_H

#include "builder/simplify/work.h"

typedef struct prom_reduce_options {
    uint32_t target;  // triangles with back sides
    float max_error;  // limit of the estimate, object units; INFINITY: none
    bool lock_border; // open borders stay exactly; cards have nothing else and stay too
    bool sloppy;      // cluster the vertices of what is no card
    bool keep_cards;  // do not thin
    bool plain;       // see prom_collapse_options; all cards are thinned, not only foliage
} prom_reduce_options;

// `out` gets the remaining front faces. Returns the greatest deviation: measured both ways (see
// prom_work_deviation), and where a mesh is too large to measure at every vertex at least
// meshoptimizer's estimate.
float prom_work_reduce(prom_work *work, const prom_reduce_options *options,
                       prom_index_array *out);

#endif
