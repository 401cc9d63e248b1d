// Meshes on the device: one vertex and one index buffer, meshes as offsets. Private to render/.
#ifndef PROM_RENDER_MESH_STORE_H
#define PROM_RENDER_MESH_STORE_H

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"
#include "render/gpu_buffer.h"

typedef struct stored_mesh {
    uint32_t first_vertex, vertex_count;
    uint32_t first_index, index_count;
    uint32_t first_submesh, submesh_count;
} stored_mesh;

typedef struct mesh_store {
    gpu_buffer vertices, indices;
    uint32_t vertex_count, index_count; // in use
    PROM_ARRAY(stored_mesh) meshes;
    PROM_ARRAY(prom_submesh) submeshes; // first_index counts from the start of the buffer
} mesh_store;                           // {0} is an empty store

void mesh_store_finish(mesh_store *store);
// Room for so many more vertices and indices; false when the device has no memory left.
bool mesh_store_reserve(mesh_store *store, uint64_t vertices, uint64_t indices);
// The new mesh's id, or PROM_NONE when the device has no memory left.
uint32_t mesh_store_add(mesh_store *store, const prom_mesh *mesh);
void mesh_store_truncate(mesh_store *store, uint32_t count);
uint64_t mesh_store_bytes(const mesh_store *store);

#endif
