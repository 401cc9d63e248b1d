// A mesh that edges can be collapsed in: triangles over vertices over points, in flat arrays of
// 32-bit numbers.
//
// A *point* is a position, a *vertex* a point with attributes (a wedge of Hoppe 1996). Vertices
// are never changed: a collapse appends new ones and rewires corners. So an old vertex still
// says where it was, while `position` says where its point is now.
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
                             // seam; those of a triangle are in one group
    uint32_t *corners;       // 3 per triangle: vertices; PROM_NONE in all: gone
    uint32_t *next_corner;   // per corner: the next of its point, PROM_NONE at the end
    uint32_t *first_corner;  // per point; PROM_NONE: it is gone
    float (*position)[3];    // per point
    uint32_t triangle_slots; // of those of the original that could be used
    uint32_t triangles;      // left
    uint32_t points, points_left;
    uint32_t base_vertices; // of the original
} prom_collapse_mesh;

// Points are vertices at exactly equal positions; of vertices that agree in everything the
// first stands for all. groups: per vertex, NULL: all 0. Triangles without area, with corners
// at one point, not finite, or repeated (same points, same winding) are left out, so slots are
// not the indices' triangles; these must be in range. NULL or empty arrays give an empty mesh.
void prom_collapse_mesh_init(prom_collapse_mesh *mesh, const prom_vertex *vertices,
                             uint32_t vertex_count, const uint32_t *groups,
                             const uint32_t *indices, size_t index_count);
void prom_collapse_mesh_finish(prom_collapse_mesh *mesh);
// The mesh as it stands: used vertices, in their order, and a submesh for each group that still
// has triangles, in ascending order; its `material` is the group's number. Owned by the caller.
void prom_collapse_mesh_emit(const prom_collapse_mesh *mesh, prom_mesh *out);
size_t prom_collapse_mesh_bytes(const prom_collapse_mesh *mesh);

static inline uint32_t prom_corner_point(const prom_collapse_mesh *mesh, uint32_t corner)
{
    return mesh->point.data[mesh->corners[corner]];
}

static inline uint32_t prom_corner_of_triangle(uint32_t triangle, uint32_t k)
{
    return 3 * triangle + k;
}

// The other two corners of a corner's triangle, in its winding.
static inline uint32_t prom_corner_after(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static inline uint32_t prom_corner_before(uint32_t corner)
{
    return corner % 3 == 0 ? corner + 2 : corner - 1;
}

#endif
