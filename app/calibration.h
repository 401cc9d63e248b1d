// The device's cost model: from a profile file, from the cache, or measured now.
#ifndef PROM_APP_CALIBRATION_H
#define PROM_APP_CALIBRATION_H

#include "metaobj/cost_features.h"
#include "render/renderer.h"
#include "traverse/cost.h"

// Draws calibration scenes and fits the cost model to their times. effort: 1 quick to 3
// thorough. samples: NULL or gets the timed draws (to be freed with prom_array_finish).
// *queries (NULL is allowed): whether the clock was the device's timer.
prom_status prom_calibration_run(prom_context *context, prom_renderer *renderer,
                                 const uint32_t size_px[2], int effort, prom_cost_model *model,
                                 prom_cost_samples *samples, bool *queries, prom_error *error);

// The cost model for this device and resolution: `profile` if given; else the cache; else
// calibrates once and stores that in the cache, saying so, or with `measure` false leaves
// *model {0}, which has no samples.
prom_status prom_calibration_get(prom_context *context, prom_renderer *renderer,
                                 const char *profile, const uint32_t size_px[2], bool measure,
                                 prom_cost_model *model, prom_error *error);

#endif
