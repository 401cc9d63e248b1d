// A binary heap of nodes by falling key; equal keys come by rising node, so that the order
// never depends on how the heap was filled.
#ifndef PROM_TRAVERSE_HEAP_H
#define PROM_TRAVERSE_HEAP_H

#include <stdbool.h>
#include <stdint.h>

typedef struct prom_heap_entry {
    double key;
    uint32_t node;
} prom_heap_entry;

typedef struct prom_heap {
    prom_heap_entry *entries; // room for every node that can be in it at once
    uint32_t count;
    uint32_t *place; // per node: its entry's index + 1, or 0; NULL: keys are not changed
} prom_heap;

void prom_heap_push(prom_heap *heap, double key, uint32_t node);
// Takes the first entry; the heap must not be empty.
prom_heap_entry prom_heap_pop(prom_heap *heap);
// Gives the first entry's node a smaller or equal key.
void prom_heap_lower_first(prom_heap *heap, double key);

// Of heaps with places: puts a node in, or gives it another key.
void prom_heap_set(prom_heap *heap, double key, uint32_t node);
void prom_heap_remove(prom_heap *heap, uint32_t node); // may be absent
void prom_heap_clear(prom_heap *heap);

#endif
