// Private to simplification: edge collapse and vertex clustering over a work's triangles.
#ifndef PROM_SIMPLIFY_COLLAPSE_H
#define PROM_SIMPLIFY_COLLAPSE_H

#include "builder/simplify/work.h"

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

// One run in one reading (see prom_read_vertices): appends the remaining triangles to `out`,
// still made of representatives, which prom_choose_corners has to replace; *error is raised.
void prom_work_collapse_run(const prom_work *work, const uint32_t *faces, size_t count,
                            const prom_collapse_options *options,
                            const uint32_t *representative, prom_index_array *out,
                            float *error);

// Vertex clustering, owner by owner in proportion; may leave nothing of specks.
void prom_work_sloppy(const prom_work *work, const prom_index_array *faces, uint32_t target,
                      float max_error, prom_index_array *out, float *error);

#endif
