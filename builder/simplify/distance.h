// Private to simplification: nearest points of a triangle surface, and deviation measured with
// them.
#ifndef PROM_SIMPLIFY_DISTANCE_H
#define PROM_SIMPLIFY_DISTANCE_H

#include "builder/simplify/work.h"

// A box hierarchy over triangles in spatial order.
typedef struct prom_surface {
    const prom_vertex *vertices;
    uint32_t *indices; // sorted
    uint32_t triangles;
    uint32_t leaves; // a power of two
    prom_box *boxes; // 2 * leaves, implicit binary tree, root at 1
} prom_surface;

typedef struct prom_nearest {
    float distance;       // INFINITY for an empty surface
    uint32_t slot;        // the triangle's place in the surface
    uint32_t triangle[3]; // vertices
    float weights[3];     // barycentric
} prom_nearest;

void prom_surface_init(prom_surface *surface, const prom_vertex *vertices, uint32_t count,
                       const uint32_t *indices, size_t index_count);
void prom_surface_finish(prom_surface *surface);
// The nearest point; the search may end early at any point within `enough`. hint: the slot of a
// triangle that may be near, such as the last answer's (PROM_NONE: none): it saves most of the
// search where points come in a spatial order.
prom_nearest prom_surface_nearest(const prom_surface *surface, const float point[3],
                                  float enough, uint32_t hint);

// Greatest distance, both ways, between the front faces of the work's mesh and `faces`, over
// vertices and triangle centroids, each way at most 16384 of them evenly picked: true at the
// samples for meshes of up to about 10,000 triangles, a lower bound beyond.
// INFINITY if `faces` is empty.
float prom_work_deviation(const prom_work *work, const prom_index_array *faces);

#endif
