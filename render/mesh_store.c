#include "render/mesh_store.h"

#include <assert.h>

#define MAX_ELEMENTS INT32_MAX // base vertices are signed

void mesh_store_finish(mesh_store *store)
{
    gpu_buffer_finish(&store->vertices);
    gpu_buffer_finish(&store->indices);
    prom_array_finish(&store->meshes);
    prom_array_finish(&store->submeshes);
    *store = (mesh_store){0};
}

bool mesh_store_reserve(mesh_store *store, uint64_t vertices, uint64_t indices)
{
    if (vertices > MAX_ELEMENTS - store->vertex_count ||
        indices > MAX_ELEMENTS - store->index_count)
        return false;
    return gpu_buffer_reserve_exact(&store->vertices, store->vertex_count * sizeof(prom_vertex),
                                    (store->vertex_count + vertices) * sizeof(prom_vertex)) &&
           gpu_buffer_reserve_exact(&store->indices, store->index_count * sizeof(uint32_t),
                                    (store->index_count + indices) * sizeof(uint32_t));
}

// Appends `count` elements; false when there is no room.
static bool append(gpu_buffer *buffer, uint32_t *used, const void *data, uint32_t count,
                   size_t size)
{
    if (count > MAX_ELEMENTS - *used) return false;
    size_t start = *used * size;
    if (!gpu_buffer_reserve(buffer, start, start + count * size)) return false;
    if (count)
        glNamedBufferSubData(buffer->name, (GLintptr)start, (GLsizeiptr)(count * size), data);
    *used += count;
    return true;
}

uint32_t mesh_store_add(mesh_store *store, const prom_mesh *mesh)
{
    stored_mesh m = {
        .first_vertex = store->vertex_count,
        .vertex_count = mesh->vertex_count,
        .first_index = store->index_count,
        .index_count = mesh->index_count,
        .first_submesh = (uint32_t)store->submeshes.count,
        .submesh_count = mesh->submesh_count,
    };
    if (!append(&store->vertices, &store->vertex_count, mesh->vertices, mesh->vertex_count,
                sizeof *mesh->vertices))
        return PROM_NONE;
    if (!append(&store->indices, &store->index_count, mesh->indices, mesh->index_count,
                sizeof *mesh->indices)) {
        store->vertex_count = m.first_vertex;
        return PROM_NONE;
    }
    for (uint32_t i = 0; i < mesh->submesh_count; i++) {
        prom_submesh s = mesh->submeshes[i];
        assert(s.first_index <= mesh->index_count &&
               s.index_count <= mesh->index_count - s.first_index);
        s.first_index += m.first_index;
        prom_array_push(&store->submeshes, s);
    }
    prom_array_push(&store->meshes, m);
    return (uint32_t)store->meshes.count - 1;
}

void mesh_store_truncate(mesh_store *store, uint32_t count)
{
    if (count >= store->meshes.count) return;
    const stored_mesh *first = &store->meshes.data[count];
    store->vertex_count = first->first_vertex;
    store->index_count = first->first_index;
    store->submeshes.count = first->first_submesh;
    store->meshes.count = count;
}

uint64_t mesh_store_bytes(const mesh_store *store)
{
    return store->vertices.capacity + store->indices.capacity;
}
