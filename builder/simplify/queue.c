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
    prom_array_finish(&queue->blocks);
    prom_free(queue->buckets);
    memset(queue, 0, sizeof *queue);
}

void prom_queue_clear(prom_queue *queue)
{
    memset(queue->buckets, 0xff, BUCKETS * sizeof *queue->buckets);
    queue->blocks.count = queue->count = 0;
    queue->lowest = BUCKETS;
    queue->free = NOTHING;
}

static uint32_t take_block(prom_queue *queue)
{
    uint32_t block = queue->free;
    if (block == NOTHING) {
        prom_array_reserve(&queue->blocks, queue->blocks.count + 1);
        return (uint32_t)queue->blocks.count++;
    }
    queue->free = queue->blocks.data[block].next;
    return block;
}

static void give_block(prom_queue *queue, uint32_t block)
{
    queue->blocks.data[block].next = queue->free;
    queue->free = block;
}

void prom_queue_push(prom_queue *queue, const prom_candidate *candidate)
{
    const uint32_t bucket = bucket_of(candidate->key);
    uint32_t first = queue->buckets[bucket];
    if (first == NOTHING || queue->blocks.data[first].count == PROM_QUEUE_BLOCK) {
        const uint32_t block = take_block(queue);
        queue->blocks.data[block].count = 0;
        queue->blocks.data[block].next = first;
        first = queue->buckets[bucket] = block;
    }
    prom_queue_block *block = &queue->blocks.data[first];
    block->items[block->count++] = *candidate;
    queue->count++;
    if (bucket < queue->lowest) queue->lowest = bucket;
}

bool prom_queue_pop(prom_queue *queue, prom_candidate *out)
{
    if (!queue->count) return false;
    while (queue->buckets[queue->lowest] == NOTHING) queue->lowest++;
    const uint32_t first = queue->buckets[queue->lowest];
    prom_queue_block *block = &queue->blocks.data[first];
    *out = block->items[--block->count];
    queue->count--;
    if (!block->count) {
        queue->buckets[queue->lowest] = block->next;
        give_block(queue, first);
    }
    return true;
}

void prom_queue_filter(prom_queue *queue,
                       bool (*stale)(const void *user, const prom_candidate *),
                       const void *user)
{
    // What stays is pushed again; blocks are given back before, so that no more are taken.
    for (uint32_t bucket = 0; bucket < BUCKETS; bucket++) {
        uint32_t block = queue->buckets[bucket];
        queue->buckets[bucket] = NOTHING;
        while (block != NOTHING) {
            const prom_queue_block copy = queue->blocks.data[block];
            give_block(queue, block);
            block = copy.next;
            queue->count -= copy.count;
            for (uint32_t i = 0; i < copy.count; i++)
                if (!stale(user, &copy.items[i])) prom_queue_push(queue, &copy.items[i]);
        }
    }
}

size_t prom_queue_bytes(const prom_queue *queue)
{
    return queue->blocks.capacity * sizeof *queue->blocks.data +
           BUCKETS * sizeof *queue->buckets;
}
