// Private to simplification: edge collapse and vertex clustering over a work's triangles.
#ifndef PROM_BUILDER_SIMPLIFY_COLLAPSE_H
#define PROM_BUILDER_SIMPLIFY_COLLAPSE_H

#include "builder/simplify_work.h"

typedef struct prom_collapse_options {
    uint32_t target; // triangles of the result (front faces)
    float max_error; // object units; INFINITY: no limit
    bool lock_border;
    bool plain; // texture coordinates mean nothing and colours are made anew afterwards
} prom_collapse_options;

// Edge collapse. Vertices that share a position but differ in attributes hold meshoptimizer
// back, so three readings are tried, from the most faithful on: all attributes, all but
// normals, positions alone; the first that reaches the target without a much greater error is
// taken, and each remaining corner gets the attributes of the vertex at its place that fit its
// face. *error: meshoptimizer's quadric estimate, object units.
void prom_work_collapse(const prom_work *work, const prom_index_array *faces,
                        const prom_collapse_options *options, prom_index_array *out,
                        float *error);

// Vertex clustering, owner by owner in proportion; may leave nothing of specks.
void prom_work_sloppy(const prom_work *work, const prom_index_array *faces, uint32_t target,
                      float max_error, prom_index_array *out, float *error);

#endif
