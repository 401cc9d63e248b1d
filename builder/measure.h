// Accuracy tables: pictures of a representation against pictures of the true object, per view
// bin, over two backgrounds (DESIGN: benefit).
//
// Smaller sizes are area averages of the largest: a table says what a well-filtered picture of
// that size would show, not which of its samples happened to hit.
//
// Pictures are compared in the directions of the coarse grid, and of the fine ones in those
// whose coarse neighbours disagree; the others get what a look-up between the coarse ones would
// have given. How well that stands for comparing in all: see `everywhere`.
#ifndef PROM_BUILDER_MEASURE_H
#define PROM_BUILDER_MEASURE_H

#include "builder/views.h"
#include "metaobj/model.h"

// Diameter in pixels at which gaps are counted.
#define PROM_GAP_PX 64

// In place of a metric (benefit/metric.h): nothing is compared, everything but the object
// itself is taken for half right. For experiments.
#define PROM_METRIC_CONSTANT "constant"
#define PROM_MEASURE_METRIC "flip"
// Pixels per degree of the views: those of 1280 pixels over the whole width of the screen of
// benefit/flip.h.
#define PROM_MEASURE_PPD 22.3402f

typedef struct prom_measure_options {
    const char
        *metric;     // in benefit/metric.h, or PROM_METRIC_CONSTANT; NULL: PROM_MEASURE_METRIC
    float ppd;       // of the views; 0: PROM_MEASURE_PPD
    bool everywhere; // compare in all directions
    bool veto;       // what lacks a part has accuracy 0 of 255
} prom_measure_options;

typedef struct prom_measure prom_measure;

// mean_luminance: linear, of the scene; the first background. The second one contrasts with it.
prom_measure *prom_measure_create(const prom_measure_options *options, float mean_luminance);
void prom_measure_destroy(prom_measure *measure);
// How it measures, for the model.
void prom_measure_tell(const prom_measure *measure, prom_measured *measured);
// A hash of all of that which has an influence on the results.
uint64_t prom_measure_key(const prom_measure *measure);

// A representation under measurement, and what came of it.
typedef struct prom_comparison {
    const prom_views *views; // with large ones if it is to have accuracies for these
    prom_accuracy_row accuracy;
    bool compared[PROM_DIRS]; // else interpolated
    uint32_t gaps[PROM_DIRS]; // pixels, at PROM_GAP_PX, that the object covers whole and the
                              // representation not at all: through them the background shows
} prom_comparison;

// An object whose representations are measured. The results do not depend on what else is
// measured beside a representation.
typedef struct prom_measuring {
    const prom_views *truth; // with large views if any of the others has some
    prom_comparison *const *others;
    size_t count;
    uint32_t coarse_left; // directions to be compared first
} prom_measuring;

void prom_measuring_init(prom_measuring *measuring, const prom_views *truth,
                         prom_comparison *const *others, size_t count);
// The work in steps [0, PROM_MEASURE_STEPS), begun in this order, by any number of threads at a
// time (`thread` below prom_thread_count()): one step may wait for earlier ones. Accuracy is 1
// - error summed over the padded window / area covered in either picture, mean of both
// backgrounds, rounded down; 0 where too many pixels of that area are too wrong
// (prom_measured).
#define PROM_MEASURE_STEPS PROM_VIEWS
void prom_measure_step(prom_measure *measure, unsigned thread, prom_measuring *measuring,
                       size_t step);
// After all steps.
void prom_measure_end(prom_measuring *measuring);

#endif
