// Cost features: what a frame asks of the device, and timed samples of it. Plain data between the
// renderer, which measures, and the cost model, which fits and predicts.
#ifndef PROM_METAOBJ_COST_FEATURES_H
#define PROM_METAOBJ_COST_FEATURES_H

#include "metaobj/base/alloc.h"
#include "metaobj/model.h"

typedef struct prom_cost_features {
    double fixed;                     // 1 for a whole frame (clear, resolve, call overhead)
    double draws, vertices, triangles;
    double pixels[PROM_SHADE_COUNT];  // shaded pixels by kind
} prom_cost_features;

typedef struct prom_cost_sample {
    prom_cost_features features;
    double ms;
} prom_cost_sample;

typedef PROM_ARRAY(prom_cost_sample) prom_cost_samples;

#endif
