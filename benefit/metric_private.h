// What a metric provides (metric.h); each stands in the file of its name.
#ifndef PROM_BENEFIT_METRIC_PRIVATE_H
#define PROM_BENEFIT_METRIC_PRIVATE_H

#include "benefit/metric.h"

typedef struct prom_metric_kind {
    prom_metric_class class;
    uint32_t planes; // floats of its features for each pixel
    // threads: 1, or all cores work on each picture (bands.h).
    void *(*create)(double ppd, uint32_t max_side, size_t max_pixels, unsigned threads);
    void (*destroy)(void *state);
    uint32_t (*radius)(const void *state);
    void (*features)(void *state, const prom_picture *picture, float *features);
    void (*compare)(void *state, const float *features_a, const float *features_b,
                    uint32_t width, uint32_t height, float *map);
} prom_metric_kind;

// A row of a picture: width * channels values.
const void *prom_picture_row(const prom_picture *picture, uint32_t y);

extern const prom_metric_kind prom_metric_flip, prom_metric_ssim, prom_metric_rmse,
    prom_metric_sobel, prom_metric_edge_blur;

#endif
