// The weights of nodes in a view: the curves of benefit/weights.h at the nodes' places.
#ifndef PROM_TRAVERSE_WEIGHTING_H
#define PROM_TRAVERSE_WEIGHTING_H

#include "benefit/weights.h"
#include "traverse/view.h"

// {0}: every pixel counts alike.
typedef struct prom_weighting {
    unsigned use;            // prom_weight_kind flags
    const float *semantics;  // of prom_weights_gather; NULL: all 1
    const prom_view *before; // of the last frame; NULL: nothing has moved
    double dt_s;             // since then
} prom_weighting;

// Whether any node's weight may be other than 1.
bool prom_weighting_is_on(const prom_weighting *weighting);
// What a pixel of a node is worth. Focus counts from the line of sight to the node's nearest
// part; the speed is that of its centre across the picture. What holds the eye is taken at its
// place straight ahead.
float prom_weight_in_view(const prom_weighting *weighting, const prom_view *view,
                          const prom_model *model, uint32_t node);

#endif
