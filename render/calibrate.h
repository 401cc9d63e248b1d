// Calibration draws: synthetic scenes that vary draws, vertices, triangles, pixels by kind,
// what is hidden, changes of state and uploads, each timed for at least 5 ms, as samples for
// the cost model's fit (traverse/cost.h).
#ifndef PROM_RENDER_CALIBRATE_H
#define PROM_RENDER_CALIBRATE_H

#include "metaobj/cost_features.h"
#include "render/renderer.h"
#include "render/timer.h"

// Fills *samples (grown as needed) with timed draws at the given frame size.
// noise: how far the 95th percentile of repeated frames lies above their median, 0.2 = 20 %.
// effort: 1 is a few seconds, 3 up to 40 s. Everything it uploads is freed again.
prom_status prom_calibrate_run(prom_renderer *renderer, prom_timer *timer, uint32_t width,
                               uint32_t height, int effort, prom_cost_samples *samples,
                               double *noise, prom_error *error);

#endif
