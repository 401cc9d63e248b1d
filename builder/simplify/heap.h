// Private to simplification: a heap of candidates, the cheapest first, four children to a node:
// those are one line of the cache. Of equal keys the one with lower points goes first, so that
// the order is that of the mesh alone.
#ifndef PROM_SIMPLIFY_HEAP_H
#define PROM_SIMPLIFY_HEAP_H

#include "metaobj/base/alloc.h"

#include <stdbool.h>

typedef struct prom_candidate {
    float key;
    uint32_t from, to; // points
    uint32_t stamp;    // how often both had changed when it was made
} prom_candidate;

typedef struct prom_heap {
    PROM_ARRAY(prom_candidate) items;
} prom_heap; // {0} is empty

void prom_heap_push(prom_heap *heap, prom_candidate candidate);
prom_candidate prom_heap_pop(prom_heap *heap); // must not be empty
// After items were put in or taken out by hand.
void prom_heap_restore(prom_heap *heap);

#endif
