// Mesh simplification behind our own interface (meshoptimizer at present).
#ifndef PROM_SIMPLIFY_SIMPLIFY_H
#define PROM_SIMPLIFY_SIMPLIFY_H

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

// Simplifies all submeshes together, so that borders between them do not crack and each gives
// where it costs least (never below 1 triangle where there was one, except that sloppy may drop
// specks); leaf cards are thinned and grow so that the foliage's area stays; removes unused
// vertices and optimises for the vertex cache. Sheets with two sides keep both. lock_border:
// every open edge stays as it is; the target may then not be reached.
// *error gets the greatest deviation, object units: measured both ways between the surfaces at
// vertices and centroids (all of them up to about 10,000 triangles; beyond, of a sample, but at
// least meshoptimizer's quadric estimate). Between samples the true distance may be greater.
// With max_error no result deviates more. Returns false and leaves *out empty when the result
// would not be smaller.
bool prom_simplify(const prom_mesh *mesh, const prom_simplify_options *options, prom_mesh *out,
                   float *error);

// Levels of a leaf: level 0 is the mesh itself; each next has half of the triangles, while that
// works and is at least min_triangles; one last coarse level of a quarter of the last
// (vertex clustering or edge collapse, whichever deviates less) unless lock_border. A level is
// kept when it has less than 0.85 of the triangles of the one before. Level 0 is welded. Errors
// are to the original, monotone over the levels. levels: up to max_levels meshes to be freed by
// the caller; returns the count.
uint32_t prom_simplify_levels(const prom_mesh *mesh, bool lock_border, uint32_t min_triangles,
                              uint32_t max_levels, prom_mesh *levels, float *errors);

// Greatest distance between two surfaces, both ways, over at most 16384 vertices of each,
// evenly picked: a lower bound. INFINITY if one of them is empty.
float prom_mesh_deviation(const prom_mesh *a, const prom_mesh *b);
// Welds vertices that are equal in all attributes, and with position_tolerance > 0 also snaps
// positions within it; drops degenerate triangles and unused vertices; optimises for the vertex
// cache and overdraw.
void prom_mesh_weld(prom_mesh *mesh, float position_tolerance);

#endif
