// Cost features: what a frame asks of the device, and timed samples of it. Plain data between
// the renderer, which measures, and the cost model, which fits and predicts.
#ifndef PROM_METAOBJ_COST_FEATURES_H
#define PROM_METAOBJ_COST_FEATURES_H

#include "metaobj/base/alloc.h"
#include "metaobj/model.h"

#include <math.h>

// Kinds of pixels that cost differently: those of prom_shading, where PROM_SHADE_IMPOSTOR is an
// impostor whose pictures hold the light already, and
enum {
    PROM_COST_IMPOSTOR_LIT = PROM_SHADE_COUNT, // one that is lit when it is drawn
    PROM_COST_KINDS
};

// Pixels are those that triangles fill, whether their textures show something there or not.
typedef struct prom_cost_features {
    double fixed; // 1 for a whole frame (clear, resolve, call overhead)
    double draws, vertices, triangles;
    double pixels[PROM_COST_KINDS]; // shaded pixels by kind
    double hidden;                  // pixels drawn behind what was there already
    // Length of the triangles' edges in pixels, up to a factor: the sum over draws of
    // prom_cost_edges. Devices shade in blocks of pixels, of which an edge wastes a part.
    double edges;
    double hidden_edges; // the same of the hidden pixels
    double binds;        // changes of state (textures, programs) between draws
    double uploads;      // 1 where anything is sent to the device meanwhile
    double upload_bytes; // and how much
} prom_cost_features;

// Kinds of work whose predictions may be off by different factors.
typedef enum prom_cost_term {
    PROM_TERM_FIXED,    // what every frame takes, and the background layer
    PROM_TERM_GEOMETRY, // draws, vertices, triangles, edges
    PROM_TERM_PIXELS,   // shaded ones
    PROM_TERM_HIDDEN,   // pixels drawn behind others
    PROM_TERMS
} prom_cost_term;

typedef struct prom_cost_sample {
    prom_cost_features features;
    double ms;
} prom_cost_sample;

typedef PROM_ARRAY(prom_cost_sample) prom_cost_samples;

// Of triangles that are alike and cover `px` pixels and other_px more, the edges in the former:
// n triangles that fill A pixels have edges of about 5 sqrt(n A) in all.
static inline double prom_cost_edges(double triangles, double px, double other_px)
{
    double covered = px + other_px;
    return covered > 0 ? px * sqrt(triangles / covered) : 0;
}

#endif
