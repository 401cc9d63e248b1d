// Private to simplification: a mesh taken apart for it.
//
// Every welded vertex has one owner: its submesh, and whether its triangles have a back side
// (the same triangle once more with the opposite winding) and whether that has the front's
// normals. Since no vertex has two owners, the
// whole index buffer can be simplified at once: borders between submeshes are then attribute
// seams that move together and never crack, and an owner tells each remaining triangle's
// material. Back sides are left out while simplifying (a folded sheet has no border that could
// be kept) and come back when the result is put together.
//
// Index lists below are front faces over the work's vertices.
#ifndef PROM_SIMPLIFY_WORK_H
#define PROM_SIMPLIFY_WORK_H

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"

#include <stdbool.h>

typedef PROM_ARRAY(prom_vertex) prom_vertex_array;
typedef PROM_ARRAY(uint32_t) prom_index_array;

enum {
    PROM_OWNER_BACK = 1, // has a back side
    PROM_OWNER_LIKE = 2, // whose normals are the front's, not their opposites
    PROM_OWNERS = 4,     // owners per submesh
};

static inline uint32_t prom_owner_submesh(uint32_t owner)
{
    return owner / PROM_OWNERS;
}

typedef struct prom_work {
    prom_vertex_array vertices; // the first base_count are the mesh's; made ones follow
    prom_index_array owners;    // per vertex: submesh * PROM_OWNERS + bits
    prom_index_array place;     // per vertex: the first vertex of this position and submesh
    prom_index_array indices;   // the mesh's front faces
    uint32_t base_count;
    uint32_t submesh_count;
    uint32_t *materials; // per submesh
    uint32_t triangles;  // with back sides
    float diagonal;      // of the bounds
} prom_work;

// Welds vertices equal in all attributes and drops triangles that are degenerate, not finite or
// repeated.
void prom_work_init(prom_work *work, const prom_mesh *mesh);
void prom_work_finish(prom_work *work);
// Adds a vertex and returns its number; prom_work_find_places has to follow the last.
uint32_t prom_work_append(prom_work *work, const prom_vertex *vertex, uint32_t owner);
void prom_work_find_places(prom_work *work);
// Forgets the appended vertices.
void prom_work_reset(prom_work *work);
// Triangles of a list counted with their back sides.
uint32_t prom_work_count(const prom_work *work, const prom_index_array *faces);
// Puts a mesh together: submeshes in their order (empty ones left out), back sides, only used
// vertices, caches optimised.
void prom_work_emit(const prom_work *work, const prom_index_array *faces, prom_mesh *out);

// Groups equal items of `size` bytes (a multiple of 4): first[i] is the first equal item.
void prom_first_equal(const void *items, uint32_t count, size_t size, uint32_t *first);
// Orders triangles for the vertex cache and against overdraw, and vertices for fetching; drops
// unused vertices.
void prom_mesh_optimize(prom_mesh *mesh);
// Twice the area's vector of a triangle.
void prom_triangle_cross(const float a[3], const float b[3], const float c[3], float cross[3]);

#endif
