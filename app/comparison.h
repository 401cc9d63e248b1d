// Comparison of a cut with full detail: where full detail shows the scene and the cut the
// background (holes), how much alike the frames look (accuracy), and what the cut makes of its
// time (quality). The cut and full detail are drawn once for all of them.
#ifndef PROM_APP_COMPARISON_H
#define PROM_APP_COMPARISON_H

#include "app/session.h"
#include "benefit/metric.h"

// What is to be found out; flags.
typedef enum prom_compare {
    PROM_COMPARE_HOLES = 1,
    PROM_COMPARE_ACCURACY = 2,
    PROM_COMPARE_QUALITY = 4,
} prom_compare;

typedef struct prom_difference {
    unsigned found;  // prom_compare flags; what was not looked for is 0
    double holes;    // share of the pixels covered by full detail that the cut does not cover
    double accuracy; // 1 - mean error of `edge-blur` over the frame
    // Quality.
    double flip;         // mean over the frame
    double loss;         // share of the visible pixels shown wrong, see app/pixel_shares.h
    double hidden_cost;  // share of the predicted cost spent on what shows no pixel
    double hidden_nodes; // share of the cut's nodes that show none
} prom_difference;

// One of two pictures: of the cut, or of full detail.
typedef struct prom_compared {
    uint8_t *rgba;
    float *features; // of the metric at work
    uint32_t *px;    // visible pixels per node, with quality only
} prom_compared;

typedef struct prom_comparison {
    prom_selector *full;
    prom_cut cut; // of full detail
    prom_target *target;
    prom_compared truth, shown;
    prom_metric *edge_blur, *flip;
    float *errors; // of each pixel
    uint32_t *ids;
    float *node_accuracy;
} prom_comparison;

// wanted: all that will be asked for; ppd: pixels per degree. On failure there is still
// prom_comparison_finish to call.
prom_status prom_comparison_init(prom_comparison *comparison, const prom_session *session,
                                 unsigned wanted, double ppd, prom_error *error);
void prom_comparison_finish(prom_comparison *comparison); // {0} is allowed
// Compares the cut's picture, which the session's target shows, with full detail from this
// camera, drawn into a target of its own.
prom_difference prom_comparison_run(prom_comparison *comparison, prom_session *session,
                                    const prom_camera *camera, const prom_cut *cut,
                                    unsigned wanted);

#endif
