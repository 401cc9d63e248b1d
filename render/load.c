// Everything of a model from its container to the device.
#include "render/renderer_private.h"

static prom_status reserve_for(prom_renderer *r, const prom_model *model, prom_error *error)
{
    uint64_t vertices = 0, indices = 0;
    for (uint32_t i = 0; i < model->mesh_count; i++) {
        vertices += model->meshes[i].vertex_count;
        indices += model->meshes[i].index_count;
    }
    if (!mesh_store_reserve(&r->meshes, vertices, indices) ||
        !texture_store_reserve(&r->textures, model->textures, model->texture_count))
        return renderer_out_of_memory(error);
    return PROM_OK;
}

static prom_status load_meshes(prom_renderer *r, prom_container *container,
                               const prom_model *model, prom_error *error)
{
    for (uint32_t i = 0; i < model->mesh_count; i++) {
        prom_mesh mesh = {0};
        prom_status status = prom_container_read_mesh(container, model, i, &mesh, error);
        if (status) return status;
        uint32_t id = prom_renderer_add_mesh(r, &mesh);
        prom_mesh_finish(&mesh);
        if (id == PROM_NONE) return renderer_out_of_memory(error);
    }
    return PROM_OK;
}

static prom_status load_textures(prom_renderer *r, prom_container *container,
                                 const prom_model *model, prom_error *error)
{
    for (uint32_t i = 0; i < model->texture_count; i++) {
        prom_texture texture = {0};
        prom_status status = prom_container_read_texture(container, model, i, &texture, error);
        if (status) return status;
        uint32_t id = prom_renderer_add_texture(r, &texture);
        prom_texture_finish(&texture);
        if (id == PROM_NONE) return renderer_out_of_memory(error);
    }
    return PROM_OK;
}

prom_status prom_renderer_load(prom_renderer *renderer, prom_container *container,
                               const prom_model *model, prom_error *error)
{
    prom_renderer_truncate(renderer, 0, 0);
    prom_status status = reserve_for(renderer, model, error);
    if (!status) status = load_meshes(renderer, container, model, error);
    if (!status) status = load_textures(renderer, container, model, error);
    if (status) {
        prom_renderer_truncate(renderer, 0, 0);
        return status;
    }
    prom_renderer_set_materials(renderer, model->materials, model->material_count);
    return PROM_OK;
}
