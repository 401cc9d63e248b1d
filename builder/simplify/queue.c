#include "builder/simplify/queue.h"

// Of a positive float's 31 bits the upper 13: exponent and five of the mantissa.
enum { SHIFT = 18, BUCKETS = 1 << (31 - SHIFT) };
#define NOTHING UINT32_MAX

static uint32_t bucket_of(float key)
{
    uint32_t bits;
    memcpy(&bits, &key, sizeof bits);
    return (bits & INT32_MAX) >> SHIFT;
}

void prom_queue_init(prom_queue *queue)
{
    memset(queue, 0, sizeof *queue);
    queue->buckets = prom_alloc(BUCKETS, sizeof *queue->buckets);
    prom_queue_clear(queue);
}

void prom_queue_finish(prom_queue *queue)
{
    prom_array_finish(&queue->items);
    prom_free(queue->buckets);
    memset(queue, 0, sizeof *queue);
}

void prom_queue_clear(prom_queue *queue)
{
    memset(queue->buckets, 0xff, BUCKETS * sizeof *queue->buckets);
    queue->items.count = 0;
    queue->lowest = BUCKETS;
    queue->unused = NOTHING;
}

bool prom_queue_is_full(const prom_queue *queue)
{
    return queue->unused == NOTHING && queue->items.count == queue->items.capacity;
}

void prom_queue_push(prom_queue *queue, const prom_candidate *candidate)
{
    const uint32_t bucket = bucket_of(candidate->key);
    uint32_t at = queue->unused;
    if (at == NOTHING) {
        at = (uint32_t)queue->items.count;
        prom_array_push(&queue->items, *candidate);
    } else {
        queue->unused = queue->items.data[at].next;
        queue->items.data[at] = *candidate;
    }
    queue->items.data[at].next = queue->buckets[bucket];
    queue->buckets[bucket] = at;
    if (bucket < queue->lowest) queue->lowest = bucket;
}

bool prom_queue_pop(prom_queue *queue, prom_candidate *out)
{
    while (queue->lowest < BUCKETS && queue->buckets[queue->lowest] == NOTHING) queue->lowest++;
    if (queue->lowest == BUCKETS) return false;
    const uint32_t at = queue->buckets[queue->lowest];
    *out = queue->items.data[at];
    queue->buckets[queue->lowest] = out->next;
    queue->items.data[at].next = queue->unused;
    queue->unused = at;
    return true;
}

size_t prom_queue_filter(prom_queue *queue,
                         bool (*stale)(const void *user, const prom_candidate *),
                         const void *user)
{
    size_t left = 0;
    for (uint32_t bucket = queue->lowest; bucket < BUCKETS; bucket++)
        for (uint32_t *link = &queue->buckets[bucket]; *link != NOTHING;) {
            const uint32_t at = *link;
            prom_candidate *item = &queue->items.data[at];
            if (stale(user, item)) {
                *link = item->next;
                item->next = queue->unused;
                queue->unused = at;
            } else {
                link = &item->next;
                left++;
            }
        }
    return left;
}

size_t prom_queue_bytes(const prom_queue *queue)
{
    return queue->items.capacity * sizeof *queue->items.data +
           BUCKETS * sizeof *queue->buckets;
}
