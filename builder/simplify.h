// Mesh simplification behind our own interface (meshoptimizer at present).
#ifndef PROM_BUILDER_SIMPLIFY_H
#define PROM_BUILDER_SIMPLIFY_H

#include "metaobj/mesh.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"

#include <stdbool.h>

typedef struct prom_simplify_options {
    uint32_t target_triangles;
    float max_error;  // object units; 0: no limit
    bool lock_border; // open borders stay exactly
    bool sloppy;      // clusters vertices regardless of topology; not with lock_border
} prom_simplify_options;

// Simplifies submesh by submesh in proportion (never below 1 triangle where there was one,
// except that sloppy may drop specks), removes unused vertices and optimises for the vertex
// cache. *error gets the greatest object-space deviation (absolute; quadric based, an
// estimate). Returns false and leaves *out empty when the result would not be smaller.
bool prom_simplify(const prom_mesh *mesh, const prom_simplify_options *options, prom_mesh *out,
                   float *error);

// Levels of a leaf: level 0 is the mesh itself; each next has half of the triangles, while that
// works and is at least min_triangles; one last sloppy level unless lock_border. Errors are to
// the original, monotone over the levels. levels: up to max_levels meshes to be freed by the
// caller; returns the count.
uint32_t prom_simplify_levels(const prom_mesh *mesh, bool lock_border, uint32_t min_triangles,
                              uint32_t max_levels, prom_mesh *levels, float *errors);

// Welds vertices that are equal in all attributes, and with position_tolerance > 0 also snaps
// positions within it; drops degenerate triangles and unused vertices; optimises for the vertex
// cache and overdraw.
void prom_mesh_weld(prom_mesh *mesh, float position_tolerance);

#endif
