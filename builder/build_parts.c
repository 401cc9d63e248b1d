// What several stages share: adding meshes, textures and representations to the model.
#include "builder/build.h"

#include "benefit/accuracy.h"

prom_status prom_build_add_mesh(prom_build_state *b, const prom_mesh *mesh, uint32_t *id,
                                prom_error *error)
{
    prom_status status = prom_writer_add_mesh(b->writer, mesh, id, error);
    if (status) return status;
    uint32_t device_id = prom_renderer_add_mesh(b->renderer, mesh);
    if (device_id != *id)
        return prom_fail(error, PROM_ERR_UNSUPPORTED, "mesh %u got id %u on the device", *id,
                         device_id);
    prom_array_push(&b->mesh_infos, (prom_mesh_info){mesh->vertex_count, mesh->index_count,
                                                     mesh->submesh_count});
    return PROM_OK;
}

prom_status prom_build_add_texture(prom_build_state *b, const prom_texture *texture,
                                   uint32_t *id, prom_error *error)
{
    prom_status status = prom_writer_add_texture(b->writer, texture, id, error);
    if (status) return status;
    uint32_t device_id = prom_renderer_add_texture(b->renderer, texture);
    if (device_id != *id)
        return prom_fail(error, PROM_ERR_UNSUPPORTED, "texture %u got id %u on the device", *id,
                         device_id);
    prom_array_push(&b->texture_infos,
                    (prom_texture_info){texture->kind, texture->width, texture->height,
                                        texture->layers, texture->levels});
    return PROM_OK;
}

uint32_t prom_build_add_rep(prom_build_state *b, uint32_t p, const prom_representation *rep)
{
    prom_prototype *prototype = &b->prototypes[p];
    if (prototype->rep_count == 0) prototype->first_rep = (uint32_t)b->reps.count;
    prototype->rep_count++;
    prom_array_push(&b->reps, *rep);
    memset(prom_array_extend(&b->accuracy, 1), 255, sizeof *b->accuracy.data);
    return (uint32_t)b->reps.count - 1;
}

// The shading of most of a mesh's triangles.
static uint32_t main_shading(const prom_build_state *b, const prom_mesh *mesh)
{
    uint64_t triangles[PROM_SHADE_COUNT] = {0};
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        uint32_t shading = PROM_SHADE_PLAIN, m = mesh->submeshes[s].material;
        if (m != PROM_NONE) {
            const prom_material *material = &b->source.materials.data[m];
            if (material->alpha_mode == PROM_ALPHA_BLEND)
                shading = PROM_SHADE_BLENDED;
            else if (material->texture != PROM_NONE)
                shading = material->alpha_mode == PROM_ALPHA_MASK ? PROM_SHADE_MASKED
                                                                  : PROM_SHADE_TEXTURED;
        }
        triangles[shading] += mesh->submeshes[s].index_count / 3;
    }
    uint32_t most = 0;
    for (uint32_t k = 1; k < PROM_SHADE_COUNT; k++)
        if (triangles[k] > triangles[most]) most = k;
    return most;
}

prom_representation prom_build_mesh_rep(const prom_build_state *b, const prom_mesh *mesh,
                                        uint32_t mesh_id, uint32_t level, float error)
{
    return (prom_representation){
        .kind = PROM_REP_MESH,
        .mesh = mesh_id,
        .texture = PROM_NONE,
        .shading = main_shading(b, mesh),
        .level = level,
        .error = error,
        .max_size_px = INFINITY,
        .draws = mesh->submesh_count,
        .vertices = mesh->vertex_count,
        .triangles = mesh->index_count / 3,
    };
}

void prom_build_measure_rep(prom_build_state *b, uint32_t rep, float radius)
{
    prom_representation *r = &b->reps.data[rep];
    uint8_t(*rows)[PROM_SIZES] = b->accuracy.data[rep].a;
    prom_baker_take_views(b->baker, radius, &b->views);
    prom_measure_compare(b->measure, &b->views, rows);
    if (r->kind != PROM_REP_MESH || !(r->error > 0)) return;
    float e_px[PROM_SIZES], mean[PROM_SIZES];
    for (uint32_t s = 0; s < PROM_SIZES; s++) {
        uint32_t sum = 0;
        for (uint32_t d = 0; d < PROM_DIRS; d++) sum += rows[d][s];
        e_px[s] = r->error * prom_size_of_bin(s) / (2.0f * radius);
        mean[s] = (float)sum / (255.0f * PROM_DIRS);
    }
    r->near_k = prom_accuracy_fit_near(e_px, mean, PROM_SIZES);
}
