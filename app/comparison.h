// Comparison of a cut with full detail, as pictures: where full detail shows the scene and the
// cut the background (holes), and how much alike the whole frames look (accuracy). One drawing
// of full detail serves both.
#ifndef PROM_APP_COMPARISON_H
#define PROM_APP_COMPARISON_H

#include "app/session.h"

typedef struct prom_comparison {
    prom_selector *full;
    prom_cut cut;
    uint8_t *truth, *shown; // RGBA pictures
    // With accuracy only: a grey picture, then the error of each pixel; features of both
    // pictures; scratch of the metric.
    float *grey, *truth_features, *shown_features, *scratch;
} prom_comparison;

typedef struct prom_difference {
    double holes;    // share of the pixels covered by full detail that the cut does not cover
    double accuracy; // 1 - mean error of `edge-blur` over the frame; 0 without accuracy
} prom_difference;

prom_status prom_comparison_init(prom_comparison *comparison, const prom_session *session,
                                 bool with_accuracy, prom_error *error);
void prom_comparison_finish(prom_comparison *comparison); // {0} is allowed
// Draws the cut and full detail from this camera, and compares.
prom_difference prom_comparison_run(prom_comparison *comparison, prom_session *session,
                                    const prom_camera *camera, const prom_cut *cut);

#endif
