// Private to simplification: the candidates, the cheapest first to a 32nd of their keys: floats
// that agree in all but their last 18 bits share a bucket, where the last one in is the first
// out. Every step takes constant time and stays in the cache better than a heap does; that
// candidates of nearly the same cost change places does no harm (measured: nothing in distances).
#ifndef PROM_SIMPLIFY_QUEUE_H
#define PROM_SIMPLIFY_QUEUE_H

#include "metaobj/base/alloc.h"

#include <stdbool.h>

typedef struct prom_candidate {
    float key;         // >= 0
    uint32_t from, to; // points
    uint32_t stamp;    // how often both had changed when it was made
    uint32_t next;     // the queue's
} prom_candidate;

typedef struct prom_queue {
    PROM_ARRAY(prom_candidate) items;
    uint32_t *buckets; // the first item of each
    uint32_t lowest;   // no bucket before it has any
    uint32_t unused;   // the first item of those that were taken out
} prom_queue;

void prom_queue_init(prom_queue *queue);
void prom_queue_finish(prom_queue *queue);
void prom_queue_clear(prom_queue *queue);
bool prom_queue_is_full(const prom_queue *queue); // pushing takes more memory
void prom_queue_push(prom_queue *queue, const prom_candidate *candidate);
bool prom_queue_pop(prom_queue *queue, prom_candidate *out); // false: it is empty
// Takes out all that `stale` says, and returns how many are left.
size_t prom_queue_filter(prom_queue *queue,
                         bool (*stale)(const void *user, const prom_candidate *),
                         const void *user);
size_t prom_queue_bytes(const prom_queue *queue);

#endif
