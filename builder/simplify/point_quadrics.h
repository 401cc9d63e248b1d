// Private to simplification: a quadric for each point of a mesh, of the planes of its faces,
// weighted by area, and of planes upright on its open borders and seams, weighted by the edge's
// squared length (Garland and Heckbert 1997, sections 5.1 and 6).
//
// Lengths in the quadrics are of the mesh's radius, so that floats hold very small and very
// large models alike.
#ifndef PROM_SIMPLIFY_POINT_QUADRICS_H
#define PROM_SIMPLIFY_POINT_QUADRICS_H

#include "builder/simplify/metric.h"
#include "builder/simplify/quadric.h"

typedef struct prom_point_quadrics {
    const prom_collapse_mesh *mesh;
    prom_quadric *quadrics; // per point, about its position
    float radius, inverse;  // half the bounds' diagonal and 1 / it; object units
} prom_point_quadrics;

void prom_point_quadrics_init(prom_point_quadrics *all, const prom_collapse_mesh *mesh,
                              const prom_metric_weights *weights);
void prom_point_quadrics_finish(prom_point_quadrics *all);

// From one position to another, in radii.
static inline void prom_point_quadrics_offset(const prom_point_quadrics *all, const float a[3],
                                              const float b[3], float offset[3])
{
    for (int k = 0; k < 3; k++) offset[k] = (b[k] - a[k]) * all->inverse;
}

// Of both points, about `to`.
prom_quadric prom_point_quadrics_sum(const prom_point_quadrics *all,
                                     const prom_collapse *collapse);
// The best place by a quadric about `to`, what it costs there, and the error.
void prom_point_quadrics_choose(const prom_point_quadrics *all, const prom_collapse *collapse,
                                const prom_quadric *sum, prom_collapse_result *result);
void prom_point_quadrics_merge(prom_point_quadrics *all, const prom_collapse *collapse,
                               const float place[3]);

// Of the edge from a corner to the next of its triangle.
typedef enum prom_edge_kind {
    PROM_EDGE_SMOOTH,
    PROM_EDGE_CREASE, // vertices on both sides differ in their normals
    PROM_EDGE_SEAM,   // in more than these
    PROM_EDGE_BORDER, // there is no other side
} prom_edge_kind;
prom_edge_kind prom_edge_kind_of(const prom_collapse_mesh *mesh, uint32_t corner);

#endif
