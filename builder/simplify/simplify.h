// Levels of detail of a mesh, by the engine (engine.h) and by thinning leaf cards.
#ifndef PROM_SIMPLIFY_SIMPLIFY_H
#define PROM_SIMPLIFY_SIMPLIFY_H

#include "metaobj/mesh.h"

#include <stdbool.h>

// Levels of a leaf, by error: level 0 is the mesh itself, welded; of the others, each costs
// about 2.25 times the error of the one before, that is about a step that can be seen, or less
// where that would leave less than 0.4 of its triangles, and has at most 0.7 of these. The
// first costs a quarter of a pixel where the mesh is a thousand pixels wide, the last at most
// one pixel where it is six pixels wide, and none comes after one of min_triangles or fewer.
//
// All submeshes are collapsed together, so that borders between them do not crack, and each
// keeps a triangle; leaf cards are thinned and grow so that the foliage's area stays; sheets
// with two sides keep both. lock_border: every open edge stays as it is.
//
// errors: deviations from the original in object units, monotone, measured both ways between
// the surfaces at vertices and centroids (all of them up to about 10,000 triangles; beyond, of
// a sample); between samples the true distance may be greater. levels: up to max_levels meshes
// to be freed by the caller; returns the count, 0 of an empty mesh.
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
