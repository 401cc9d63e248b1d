#include "traverse/heap.h"

#include <assert.h>

static bool before(const prom_heap_entry *a, const prom_heap_entry *b)
{
    return a->key != b->key ? a->key > b->key : a->node < b->node;
}

void prom_heap_push(prom_heap *heap, double key, uint32_t node)
{
    const prom_heap_entry entry = {key, node};
    uint32_t i = heap->count++;
    while (i > 0) {
        uint32_t parent = (i - 1) / 2;
        if (!before(&entry, &heap->entries[parent])) break;
        heap->entries[i] = heap->entries[parent];
        i = parent;
    }
    heap->entries[i] = entry;
}

// Puts an entry in at the top and lets it sink to its place.
static void sink(prom_heap *heap, prom_heap_entry entry)
{
    uint32_t i = 0;
    for (uint32_t child; (child = 2 * i + 1) < heap->count; i = child) {
        if (child + 1 < heap->count && before(&heap->entries[child + 1], &heap->entries[child]))
            child++;
        if (!before(&heap->entries[child], &entry)) break;
        heap->entries[i] = heap->entries[child];
    }
    heap->entries[i] = entry;
}

prom_heap_entry prom_heap_pop(prom_heap *heap)
{
    assert(heap->count > 0);
    prom_heap_entry first = heap->entries[0];
    prom_heap_entry last = heap->entries[--heap->count];
    if (heap->count) sink(heap, last);
    return first;
}

void prom_heap_lower_first(prom_heap *heap, double key)
{
    assert(heap->count > 0);
    sink(heap, (prom_heap_entry){key, heap->entries[0].node});
}
