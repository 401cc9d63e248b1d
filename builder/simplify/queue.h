// Private to simplification: the candidates, the cheapest first to a 32nd of their keys: floats
// that agree in all but their last 18 bits share a bucket, where the last one in is the first
// out. Every step takes constant time, and buckets are runs of memory, where a heap jumps
// about; that candidates of nearly the same cost change places does no harm.
#ifndef PROM_SIMPLIFY_QUEUE_H
#define PROM_SIMPLIFY_QUEUE_H

#include "metaobj/base/alloc.h"

#include <stdbool.h>

typedef struct prom_candidate {
    float key;         // >= 0
    uint32_t from, to; // points
    uint32_t stamp;    // how often both had changed when it was made
} prom_candidate;

enum { PROM_QUEUE_BLOCK = 15 };

typedef struct prom_queue_block {
    prom_candidate items[PROM_QUEUE_BLOCK];
    uint32_t count, next; // next block of the bucket: a full one
    uint32_t unused[2];
} prom_queue_block;

typedef struct prom_queue {
    PROM_ARRAY(prom_queue_block) blocks;
    uint32_t *buckets; // the first block of each
    uint32_t lowest;   // no bucket before it has any
    size_t count;      // of candidates
    uint32_t free;     // the first block that is not in use
} prom_queue;

void prom_queue_init(prom_queue *queue);
void prom_queue_finish(prom_queue *queue);
void prom_queue_clear(prom_queue *queue);
void prom_queue_push(prom_queue *queue, const prom_candidate *candidate);
bool prom_queue_pop(prom_queue *queue, prom_candidate *out); // false: it is empty
// Takes out all that `stale` says.
void prom_queue_filter(prom_queue *queue,
                       bool (*stale)(const void *user, const prom_candidate *),
                       const void *user);
size_t prom_queue_bytes(const prom_queue *queue);

#endif
