// Image comparison metrics on one interface: how different two pictures look, pixel by pixel.
//
// A comparison has two steps, so that a reference is looked at once for many comparisons: each
// picture becomes its features, and two sets of features give the map of errors.
#ifndef PROM_BENEFIT_METRIC_H
#define PROM_BENEFIT_METRIC_H

#include "metaobj/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// A picture as it is stored, rows from the top.
typedef struct prom_picture {
    uint32_t width, height;
    uint32_t channels; // 1 (grey), 3 or 4 (the fourth is not looked at)
    bool floats;       // linear light, any finite values; else bytes, sRGB-encoded
    const void *pixels;
    size_t row_bytes; // from one row to the next; 0: rows stand close
} prom_picture;

typedef struct prom_metric_class {
    const char *name;    // as on the command line
    const char *summary; // one line
    bool uses_ppd;       // its errors depend on the pixels per degree
    bool squares;        // the mean of a map is the root of the mean square (rmse)
} prom_metric_class;

// All metrics, in the order of the help text: flip, ssim, rmse, sobel, edge-blur.
size_t prom_metric_count(void);
const prom_metric_class *prom_metric_at(size_t i);
const prom_metric_class *prom_metric_named(const char *name); // NULL: unknown

typedef struct prom_metric prom_metric;

// Working memory for pictures of up to max_pixels pixels, of up to max_side on a side. threads:
// 1, for a caller that compares on several threads itself, each with a metric of its own; 0:
// all cores work on each picture. Nothing is allocated later. `name` must be that of a metric;
// ppd: from PROM_PPD_MIN to PROM_PPD_MAX.
prom_metric *prom_metric_create(const char *name, double ppd, uint32_t max_side,
                                size_t max_pixels, unsigned threads);
void prom_metric_destroy(prom_metric *metric); // NULL is allowed
const prom_metric_class *prom_metric_class_of(const prom_metric *metric);
// Pixels around a pixel whose values can influence its error.
uint32_t prom_metric_radius(const prom_metric *metric);
// The same of the metric that prom_metric_create would make.
uint32_t prom_metric_radius_of(const char *name, double ppd);

// Floats that the features of a picture take.
size_t prom_metric_feature_floats(const prom_metric *metric, uint32_t width, uint32_t height);
void prom_metric_features(prom_metric *metric, const prom_picture *picture, float *features);
// Error of each pixel into map (width * height); 0 where nothing differs nearby. In [0,1] for
// pictures within [0,1]. Symmetric.
void prom_metric_compare(prom_metric *metric, const float *features_a, const float *features_b,
                         uint32_t width, uint32_t height, float *map);

#endif
