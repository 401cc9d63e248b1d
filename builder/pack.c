#include "builder/pack.h"

void prom_pack_bytes(prom_pack *pack, const void *data, size_t bytes)
{
    if (!bytes) return;
    prom_array_reserve(pack, pack->count + bytes);
    memcpy(pack->data + pack->count, data, bytes);
    pack->count += bytes;
}

void prom_pack_mesh(prom_pack *pack, const prom_mesh *mesh)
{
    uint32_t counts[3] = {mesh->vertex_count, mesh->index_count, mesh->submesh_count};
    prom_pack_bytes(pack, counts, sizeof counts);
    prom_pack_bytes(pack, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    prom_pack_bytes(pack, mesh->indices, mesh->index_count * sizeof *mesh->indices);
    prom_pack_bytes(pack, mesh->submeshes, mesh->submesh_count * sizeof *mesh->submeshes);
}

void prom_pack_texture(prom_pack *pack, const prom_texture *texture)
{
    uint32_t shape[5] = {texture->kind, texture->width, texture->height, texture->layers,
                         texture->levels};
    prom_pack_bytes(pack, shape, sizeof shape);
    prom_pack_bytes(pack, texture->pixels, prom_texture_bytes(texture));
}

void prom_unpack_bytes(prom_unpack *unpack, void *data, size_t bytes)
{
    if (bytes > unpack->left) unpack->failed = true;
    if (unpack->failed) {
        memset(data, 0, bytes);
        return;
    }
    memcpy(data, unpack->at, bytes);
    unpack->at += bytes;
    unpack->left -= bytes;
}

uint32_t prom_unpack_u32(prom_unpack *unpack, uint32_t most)
{
    uint32_t value;
    prom_unpack_bytes(unpack, &value, sizeof value);
    if (value > most) unpack->failed = true;
    return unpack->failed ? 0 : value;
}

void prom_unpack_mesh(prom_unpack *unpack, uint32_t material_count, prom_mesh *mesh)
{
    uint32_t counts[3];
    *mesh = (prom_mesh){0};
    prom_unpack_bytes(unpack, counts, sizeof counts);
    uint64_t bytes = (uint64_t)counts[0] * sizeof *mesh->vertices +
                     (uint64_t)counts[1] * sizeof *mesh->indices +
                     (uint64_t)counts[2] * sizeof *mesh->submeshes;
    if (bytes > unpack->left) unpack->failed = true;
    if (unpack->failed || !bytes) return;
    prom_mesh_init(mesh, counts[0], counts[1], counts[2]);
    prom_unpack_bytes(unpack, mesh->vertices, counts[0] * sizeof *mesh->vertices);
    prom_unpack_bytes(unpack, mesh->indices, counts[1] * sizeof *mesh->indices);
    prom_unpack_bytes(unpack, mesh->submeshes, counts[2] * sizeof *mesh->submeshes);
    if (prom_mesh_check(mesh, material_count)) unpack->failed = true;
}

void prom_unpack_texture(prom_unpack *unpack, prom_texture *texture)
{
    uint32_t shape[5];
    *texture = (prom_texture){0};
    prom_unpack_bytes(unpack, shape, sizeof shape);
    if (unpack->failed) return;
    prom_texture sized = {.kind = shape[0],
                          .width = shape[1],
                          .height = shape[2],
                          .layers = shape[3],
                          .levels = shape[4]};
    size_t bytes = prom_texture_bytes(&sized);
    if (!bytes || bytes > unpack->left) {
        unpack->failed = true;
        return;
    }
    sized.pixels = prom_alloc(bytes, 1);
    prom_unpack_bytes(unpack, sized.pixels, bytes);
    *texture = sized;
}

bool prom_unpack_end(const prom_unpack *unpack)
{
    return !unpack->failed && !unpack->left;
}
