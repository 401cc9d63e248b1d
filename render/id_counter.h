// Counts how many pixels of a target show each id, without stalling: of every block of
// PROM_ID_STEP x PROM_ID_STEP pixels one is looked at, another one each time; the samples
// travel through a ring of buffers and are counted when they have arrived.
#ifndef PROM_RENDER_ID_COUNTER_H
#define PROM_RENDER_ID_COUNTER_H

#include "render/context.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define PROM_ID_STEP 4
#define PROM_ID_RING 3 // countings under way at most

typedef struct prom_id_counter prom_id_counter;

// For ids below id_count; others (PROM_NONE, the background) are left out.
prom_id_counter *prom_id_counter_create(uint32_t id_count, prom_error *error);
void prom_id_counter_destroy(prom_id_counter *counter); // NULL is allowed

// Starts counting what has been drawn into a target with ids; `frame` comes back with the
// counts. False if the ring is full, or the device has no memory left: nothing is started then.
// The target may change its size from call to call. A device returns at once; llvmpipe ends the
// drawing first, so that there the call stands in place of the finish that ends the frame.
bool prom_id_counter_start(prom_id_counter *counter, prom_target *target, uint64_t frame);

typedef struct prom_id_count {
    uint32_t id;
    // Pixels of the target, estimated: PROM_ID_STEP^2 x samples. The mean over PROM_ID_STEP^2
    // calls in a row, of one picture, is exact.
    float px;
} prom_id_count;

typedef struct prom_id_counts {
    uint64_t frame;
    const prom_id_count *counts; // ids that were seen, in no order; until the next call
    size_t count;
} prom_id_counts;

// The oldest counting that has not been given yet. False if it has not arrived, or there is
// none; with `wait`, it is waited for.
bool prom_id_counter_take(prom_id_counter *counter, bool wait, prom_id_counts *counts);

#endif
