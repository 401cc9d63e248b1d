// What a map of errors says in a few numbers.
#ifndef PROM_BENEFIT_POOL_H
#define PROM_BENEFIT_POOL_H

#include "benefit/metric.h"

typedef struct prom_pooled {
    double mean;            // for metrics that square, the root of the mean square
    double weighted_median; // the error up to which half of the sum of all errors lies
    double median, p75, p95, p99, max; // between two pixels: linear
    double differing;      // share of the pixels in which the pictures differ at all
    double differing_mean; // mean over those, of the same kind; 0 if there are none
    size_t pixels;         // pooled over; 0: all values are 0
} prom_pooled;

// Errors are 0 or more. Over the pixels whose footprint is not 0; footprint NULL: over all.
// differs: not 0 where the pictures' values differ (prom_picture_differs); NULL: where the
// error is not 0.
void prom_errors_pool(const prom_metric_class *metric, const float *map, size_t count,
                      const uint8_t *footprint, const uint8_t *differs, prom_pooled *pooled);

// 1 where a colour channel of two pictures of one size and form differs, else 0.
void prom_picture_differs(const prom_picture *a, const prom_picture *b, uint8_t *differs);

#endif
