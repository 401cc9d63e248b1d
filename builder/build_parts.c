// What several stages share: adding meshes, textures and representations to the model.
#include "builder/build.h"

#include "benefit/accuracy.h"

#include <assert.h>

// A mesh with gaps may be shown up to the size at which they cover this many pixels: few enough
// that all of a frame's gaps stay under half a percent of it (by taste, then seen on the
// scenes).
#define GAPS_SHOWN_PX 64.0f
// One whose gaps allow less than this is of no use.
#define LEAST_SIZE_PX 16.0f

prom_status prom_build_add_texture(prom_build_state *b, const prom_texture *texture,
                                   uint32_t *id, prom_error *error)
{
    prom_status status = prom_writer_add_texture(b->writer, texture, id, error);
    if (status) return status;
    uint32_t device_id = prom_renderer_add_texture(b->renderer, texture);
    if (device_id == PROM_NONE)
        return prom_fail(
            error, PROM_ERR_UNSUPPORTED,
            "the device has no memory for more textures; lower --max-texture-px or "
            "--texture-mb");
    assert(device_id == *id); // the stores grow together
    prom_array_push(&b->texture_infos,
                    (prom_texture_info){texture->kind, texture->width, texture->height,
                                        texture->layers, texture->levels});
    return PROM_OK;
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

// Cost features and shading of a mesh.
static void fill_features(const prom_build_state *b, const prom_mesh *mesh,
                          prom_representation *rep)
{
    rep->shading = rep->texture == PROM_NONE ? main_shading(b, mesh) : PROM_SHADE_IMPOSTOR;
    rep->max_size_px = rep->kind == PROM_REP_MESH ? INFINITY : PROM_SIZE_MAX_PX;
    if (rep->switch_distance <= 0) rep->switch_distance = INFINITY;
    rep->draws = mesh->submesh_count;
    rep->vertices = mesh->vertex_count;
    rep->triangles = mesh->index_count / 3;
}

// The near-field function through the rows of a mesh.
static float fit_near(const struct prom_accuracy_row *row, float error, float radius)
{
    float e_px[PROM_SIZES], mean[PROM_SIZES];
    for (uint32_t s = 0; s < PROM_SIZES; s++) {
        uint32_t sum = 0;
        for (uint32_t d = 0; d < PROM_DIRS; d++) sum += row->a[d][s];
        e_px[s] = error * prom_size_of_bin(s) / (2.0f * radius);
        mean[s] = (float)sum / (255.0f * PROM_DIRS);
    }
    return prom_accuracy_fit_near(e_px, mean, PROM_SIZES);
}

prom_draw_item prom_build_item_around(uint32_t mesh, const float center[3])
{
    return (prom_draw_item){.mesh = mesh,
                            .texture = PROM_NONE,
                            .origin = {-center[0], -center[1], -center[2]},
                            .basis = {1, 0, 0, 0, 1, 0, 0, 0, 1}};
}

// Fills the row and near_k; false if the representation is not admitted.
static bool measure(prom_build_state *b, uint32_t p, uint32_t device_id,
                    prom_admission admission, prom_representation *rep,
                    struct prom_accuracy_row *row)
{
    const prom_prototype *proto = &b->prototypes[p];
    memset(row, 255, sizeof *row);
    if (admission == PROM_ADMIT_UNMEASURED) return true;
    prom_draw_item item = prom_build_item_around(device_id, proto->center);
    item.texture = rep->texture;
    item.flags = rep->flags;
    prom_baker_set_subject(b->baker, &item, 1);
    if (admission == PROM_ADMIT_TRUTH) {
        prom_baker_take_views(b->baker, proto->radius, &b->truth);
        prom_measure_set_truth(b->measure, &b->truth, b->coverage[p]);
        return true;
    }
    prom_baker_take_views(b->baker, proto->radius, &b->views);
    float gaps = prom_measure_compare(b->measure, &b->views, row->a);
    if (rep->kind == PROM_REP_MESH && rep->error > 0)
        rep->near_k = fit_near(row, rep->error, proto->radius);
    if (rep->kind == PROM_REP_MESH && gaps > 0)
        rep->max_size_px = PROM_GAP_PX * sqrtf(GAPS_SHOWN_PX / gaps);
    return rep->max_size_px >= LEAST_SIZE_PX;
}

prom_status prom_build_add_rep(prom_build_state *b, uint32_t p, const prom_mesh *mesh,
                               const prom_representation *rep, prom_admission admission,
                               uint32_t *mesh_id, prom_error *error)
{
    prom_representation r = *rep;
    struct prom_accuracy_row row;
    if (mesh_id) *mesh_id = PROM_NONE;
    uint32_t device_id = prom_renderer_add_mesh(b->renderer, mesh);
    if (device_id == PROM_NONE)
        return prom_fail(error, PROM_ERR_UNSUPPORTED,
                         "the device has no memory for more meshes");
    fill_features(b, mesh, &r);
    if (!measure(b, p, device_id, admission, &r, &row)) {
        b->gap_meshes++;
        prom_renderer_truncate(b->renderer, device_id,
                               prom_renderer_texture_count(b->renderer));
        return PROM_OK;
    }
    prom_status status = prom_writer_add_mesh(b->writer, mesh, &r.mesh, error);
    if (status) return status;
    assert(r.mesh == device_id); // the stores grow together
    prom_array_push(&b->mesh_infos, (prom_mesh_info){mesh->vertex_count, mesh->index_count,
                                                     mesh->submesh_count});
    prom_prototype *proto = &b->prototypes[p];
    if (proto->rep_count == 0) proto->first_rep = (uint32_t)b->reps.count;
    proto->rep_count++;
    prom_array_push(&b->reps, r);
    prom_array_push(&b->accuracy, row);
    if (mesh_id) *mesh_id = r.mesh;
    return PROM_OK;
}
