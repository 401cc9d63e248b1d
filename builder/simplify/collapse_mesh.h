// A mesh that edges can be collapsed in: triangles over vertices over points, in flat arrays of
// 32-bit numbers.
#ifndef PROM_SIMPLIFY_COLLAPSE_MESH_H
#define PROM_SIMPLIFY_COLLAPSE_MESH_H

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"

typedef struct prom_collapse_mesh {
    PROM_ARRAY(prom_vertex) vertices; // the original's, then those that collapses made
    PROM_ARRAY(uint32_t) point;       // per vertex: its point
    PROM_ARRAY(uint32_t)
    group;                   // per vertex: vertices of two groups are never one (submeshes,
                             // sheets with a back side); a border between groups is a
                             // seam
    uint32_t *corners;       // 3 per triangle: vertices; PROM_NONE in all: gone
    uint32_t *next_corner;   // per corner: the next of its point, PROM_NONE at the end
    uint32_t *first_corner;  // per point
    uint32_t triangle_slots; // of the original
    uint32_t triangles;      // left
    uint32_t points, points_left;
    uint32_t base_vertices; // of the original
} prom_collapse_mesh;

// Points are vertices at exactly equal positions. groups: per vertex, NULL: all 0. Triangles
// without area, with corners at one point, not finite, or repeated (same points, same winding)
// are left out; indices must be in range. NULL or empty arrays give an empty mesh.
void prom_collapse_mesh_init(prom_collapse_mesh *mesh, const prom_vertex *vertices,
                             uint32_t vertex_count, const uint32_t *groups,
                             const uint32_t *indices, size_t index_count);
void prom_collapse_mesh_finish(prom_collapse_mesh *mesh);

// The vertices' positions are floats of the original; those of a point agree.
static inline uint32_t prom_corner_point(const prom_collapse_mesh *mesh, uint32_t corner)
{
    return mesh->point.data[mesh->corners[corner]];
}

static inline uint32_t prom_corner_of_triangle(uint32_t triangle, uint32_t k)
{
    return 3 * triangle + k;
}

#endif
