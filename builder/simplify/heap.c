#include "builder/simplify/heap.h"

static bool before(const prom_candidate *a, const prom_candidate *b)
{
    if (a->key != b->key) return a->key < b->key;
    return a->from != b->from ? a->from < b->from : a->to < b->to;
}

static void sink(prom_candidate *items, size_t count, size_t at, prom_candidate item)
{
    for (size_t child; (child = 4 * at + 1) < count;) {
        const size_t end = child + 4 < count ? child + 4 : count;
        size_t best = child;
        for (size_t i = child + 1; i < end; i++)
            if (before(&items[i], &items[best])) best = i;
        if (!before(&items[best], &item)) break;
        items[at] = items[best];
        at = best;
    }
    items[at] = item;
}

void prom_heap_push(prom_heap *heap, prom_candidate candidate)
{
    prom_array_push(&heap->items, candidate);
    prom_candidate *items = heap->items.data;
    size_t at = heap->items.count - 1;
    for (; at && before(&candidate, &items[(at - 1) / 4]); at = (at - 1) / 4)
        items[at] = items[(at - 1) / 4];
    items[at] = candidate;
}

prom_candidate prom_heap_pop(prom_heap *heap)
{
    const prom_candidate first = heap->items.data[0];
    const size_t left = --heap->items.count;
    if (left) sink(heap->items.data, left, 0, heap->items.data[left]);
    return first;
}

void prom_heap_restore(prom_heap *heap)
{
    const size_t n = heap->items.count;
    for (size_t at = n / 4 + 1; at-- > 0;)
        if (at < n) sink(heap->items.data, n, at, heap->items.data[at]);
}
