// How far cuts are from full detail in one view, by FLIP. The picture of full detail is drawn
// and looked at once, then compared with those of as many cuts as are asked for.
#ifndef PROM_APP_JUDGE_H
#define PROM_APP_JUDGE_H

#include "app/session.h"
#include "benefit/metric.h"

typedef struct prom_judge {
    prom_session *session;
    prom_selector *full;
    prom_target *target;
    prom_metric *metric;
    size_t pixels;
    prom_camera camera;   // of the view
    prom_cut cut;         // of full detail
    uint32_t *px;         // per node of the tree: pixels that it shows in full detail
    float *truth, *shown; // features
    float *map;           // of the cut judged last
    uint8_t *rgba;
    uint32_t *ids;
} prom_judge;

// On failure there is still prom_judge_finish to call.
prom_status prom_judge_init(prom_judge *judge, prom_session *session, prom_error *error);
void prom_judge_finish(prom_judge *judge); // {0} is allowed
// Draws full detail from a camera, and counts what it shows of each leaf and all above it.
void prom_judge_look(prom_judge *judge, const prom_camera *camera);
// Sum of the errors of all pixels of a cut.
double prom_judge_run(prom_judge *judge, const prom_cut *cut);
// The same; each entry's node gets the sum over the pixels that show it, the others 0. What is
// see-through shows none.
double prom_judge_nodes(prom_judge *judge, const prom_cut *cut, double *error);

#endif
