// What measuring is made of: the order of the work (measure.c), and the comparison in one view
// (measure_compare.c).
#ifndef PROM_BUILDER_MEASURE_PRIVATE_H
#define PROM_BUILDER_MEASURE_PRIVATE_H

#include "benefit/metric.h"
#include "builder/measure.h"
#include "builder/measure_picture.h"

#include <pthread.h>

typedef struct measure_scratch measure_scratch; // what a thread works in

struct prom_measure {
    prom_measured how;
    const prom_metric_class *metric; // NULL: constant
    bool everywhere;
    uint32_t pad; // pixels around a picture that the metric looks at
    prom_encoder encoder;
    measure_scratch **scratches; // of each thread
    unsigned threads;
    pthread_mutex_t lock;       // of what measurings have left,
    pthread_cond_t coarse_done; // and that one has none left
};

// The sizes that are made of a view, the largest first.
typedef struct size_range {
    uint32_t first, count;
} size_range;

static inline size_range sizes_of_view(uint32_t view)
{
    return view < PROM_DIRS ? (size_range){0, PROM_SIZES}
                            : (size_range){PROM_SIZES, PROM_SIZES_LARGE};
}

// Wants metric, how and pad set.
measure_scratch *measure_scratch_create(const prom_measure *measure);
void measure_scratch_destroy(measure_scratch *scratch);

// The true object in a view, at all sizes that are made of it, into the scratch. part: holds
// all that is covered in any of the pictures that are compared.
void measure_take_truth(const prom_measure *measure, measure_scratch *scratch,
                        const prom_views *truth, uint32_t view, prom_part part);
// Accuracies of another in the same part of the same view, one for each of the sizes.
void measure_compare(const prom_measure *measure, measure_scratch *scratch,
                     const prom_views *other, uint32_t view, prom_part part,
                     uint8_t *accuracies);

#endif
