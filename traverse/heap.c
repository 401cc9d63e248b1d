#include "traverse/heap.h"

#include <assert.h>
#include <stddef.h>

static bool before(const prom_heap_entry *a, const prom_heap_entry *b)
{
    return a->key != b->key ? a->key > b->key : a->node < b->node;
}

static void put(prom_heap *heap, uint32_t i, prom_heap_entry entry)
{
    heap->entries[i] = entry;
    if (heap->place) heap->place[entry.node] = i + 1;
}

// Puts an entry in at i and lets it rise to its place.
static void rise(prom_heap *heap, uint32_t i, prom_heap_entry entry)
{
    while (i > 0) {
        uint32_t parent = (i - 1) / 2;
        if (!before(&entry, &heap->entries[parent])) break;
        put(heap, i, heap->entries[parent]);
        i = parent;
    }
    put(heap, i, entry);
}

static void sink(prom_heap *heap, uint32_t i, prom_heap_entry entry)
{
    for (uint32_t child; (child = 2 * i + 1) < heap->count; i = child) {
        if (child + 1 < heap->count && before(&heap->entries[child + 1], &heap->entries[child]))
            child++;
        if (!before(&heap->entries[child], &entry)) break;
        put(heap, i, heap->entries[child]);
    }
    put(heap, i, entry);
}

void prom_heap_push(prom_heap *heap, double key, uint32_t node)
{
    rise(heap, heap->count++, (prom_heap_entry){key, node});
}

prom_heap_entry prom_heap_pop(prom_heap *heap)
{
    assert(heap->count > 0);
    prom_heap_entry first = heap->entries[0];
    prom_heap_entry last = heap->entries[--heap->count];
    if (heap->place) heap->place[first.node] = 0;
    if (heap->count) sink(heap, 0, last);
    return first;
}

void prom_heap_lower_first(prom_heap *heap, double key)
{
    assert(heap->count > 0);
    sink(heap, 0, (prom_heap_entry){key, heap->entries[0].node});
}

// Puts an entry in at i, which is free, and lets it move either way.
static void settle(prom_heap *heap, uint32_t i, prom_heap_entry entry)
{
    if (i > 0 && before(&entry, &heap->entries[(i - 1) / 2]))
        rise(heap, i, entry);
    else
        sink(heap, i, entry);
}

void prom_heap_set(prom_heap *heap, double key, uint32_t node)
{
    uint32_t place = heap->place[node];
    if (place)
        settle(heap, place - 1, (prom_heap_entry){key, node});
    else
        prom_heap_push(heap, key, node);
}

void prom_heap_remove(prom_heap *heap, uint32_t node)
{
    uint32_t place = heap->place[node];
    if (!place) return;
    prom_heap_entry last = heap->entries[--heap->count];
    heap->place[node] = 0;
    if (last.node != node) settle(heap, place - 1, last);
}

void prom_heap_clear(prom_heap *heap)
{
    for (uint32_t i = 0; heap->place && i < heap->count; i++)
        heap->place[heap->entries[i].node] = 0;
    heap->count = 0;
}
