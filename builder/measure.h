// Accuracy tables: pictures of a representation against pictures of the true object, per view
// bin, over two backgrounds (DESIGN: benefit).
//
// Smaller sizes are area averages of the largest: a table says what a well-filtered picture of
// that size would show, not which of its samples happened to hit.
#ifndef PROM_BUILDER_MEASURE_H
#define PROM_BUILDER_MEASURE_H

#include "builder/bake.h"
#include "metaobj/model.h"

// Diameter in pixels at which gaps are counted.
#define PROM_GAP_PX 64

// In place of a metric (benefit/metric.h): nothing is compared, everything but the object
// itself is taken for half right. For experiments.
#define PROM_METRIC_CONSTANT "constant"
#define PROM_MEASURE_METRIC "edge-blur"
// Pixels per degree of the views: those of 1280 pixels over the whole width of the screen of
// benefit/flip.h.
#define PROM_MEASURE_PPD 22.3402f

typedef struct prom_measure_options {
    const char
        *metric; // in benefit/metric.h, or PROM_METRIC_CONSTANT; NULL: PROM_MEASURE_METRIC
    float ppd;   // of the views; 0: PROM_MEASURE_PPD
} prom_measure_options;

typedef struct prom_measure prom_measure;

// A representation under measurement, and what came of it.
typedef struct prom_comparison {
    const prom_views *views;
    prom_accuracy_row accuracy;
    uint32_t gaps[PROM_DIRS]; // pixels, at PROM_GAP_PX, that the object covers whole and the
                              // representation not at all: through them the background shows
} prom_comparison;

// mean_luminance: linear, of the scene; the first background. The second one contrasts with it.
prom_measure *prom_measure_create(const prom_measure_options *options, float mean_luminance);
void prom_measure_destroy(prom_measure *measure);
// How it measures, for the model.
void prom_measure_tell(const prom_measure *measure, prom_measured *measured);
// A hash of all of that which has an influence on the results.
uint64_t prom_measure_key(const prom_measure *measure);

// Measures representations in one direction bin; different directions may be measured by
// several threads at a time (`thread` below prom_thread_count()). Accuracy is 1 - error summed
// over the padded window / area covered in either picture, mean of both backgrounds, rounded
// down; 0 where too many pixels of that area are too wrong (prom_measured). *coverage gets the
// truth's covered share of the bounding sphere's disc, 65535 = 1.
void prom_measure_direction(prom_measure *measure, unsigned thread, uint32_t dir,
                            const prom_views *truth, uint16_t *coverage,
                            prom_comparison *const *others, size_t count);

// Each item's share of the visible pixels in a direction: shares[item][dir], summing to 65535
// over the items up to rounding where anything is visible. Items are views->ids < item_count.
void prom_measure_shares(const prom_views *views, uint32_t dir, uint32_t item_count,
                         uint16_t (*shares)[PROM_DIRS]);

#endif
