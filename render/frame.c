// Frames of a model: from a cut and a camera to a draw list.
#include "render/renderer_private.h"
#include "render/target.h"

#include <assert.h>
#include <math.h>

const uint8_t prom_sky_color[4] = {172, 198, 226, 0};

void prom_camera_projection(const prom_camera *camera, mat4 projection)
{
    float focal = 1.0f / tanf(camera->fov_y * 0.5f);
    mat4 perspective = GLM_MAT4_ZERO_INIT; // infinite far, reverse z: depth = near / distance
    perspective[0][0] = focal * (float)camera->height / (float)camera->width;
    perspective[1][1] = focal;
    perspective[2][3] = -1.0f;
    perspective[3][2] = camera->z_near;
    versor to_world;
    mat4 view;
    glm_quat_copy((float *)camera->orientation, to_world);
    glm_quat_conjugate(to_world, to_world);
    glm_quat_mat4(to_world, view);
    glm_mat4_mul(perspective, view, projection);
}

// ---- false colours (chosen by taste)

static void mix_tint(const uint8_t from[3], const uint8_t to[3], float t, uint8_t tint[4])
{
    for (int i = 0; i < 3; i++)
        tint[i] = (uint8_t)((float)from[i] * (1 - t) + (float)to[i] * t + 0.5f);
    tint[3] = 255;
}

// Meshes from dark green (finest) to light, clusters blue, average boxes red, textured boxes
// orange.
static void tint_of(const prom_representation *rep, bool cluster, uint8_t tint[4])
{
    static const uint8_t dark_green[] = {0, 84, 32}, light_green[] = {200, 240, 150},
                         dark_blue[] = {24, 60, 170}, light_blue[] = {150, 200, 255},
                         red[] = {214, 40, 40}, orange[] = {255, 150, 30};
    float coarse = (float)(rep->level < 6 ? rep->level : 6) / 6.0f;
    if (rep->kind == PROM_REP_AVERAGE_BOX)
        mix_tint(red, red, 0, tint);
    else if (rep->kind == PROM_REP_TEXTURED_BOX)
        mix_tint(orange, orange, 0, tint);
    else if (cluster)
        mix_tint(dark_blue, light_blue, coarse, tint);
    else
        mix_tint(dark_green, light_green, coarse, tint);
}

// ---- the list

static void add_node(prom_draw_list *list, const prom_model *model, const prom_cut_entry *entry,
                     const prom_camera *camera, const prom_frame_options *options)
{
    uint32_t node = entry->node;
    const prom_representation *rep = &model->reps[entry->rep];
    const prom_placement *placement = &model->placement[node];
    prom_draw_item item = {
        .mesh = rep->mesh,
        .texture = rep->texture,
        .flags = rep->flags,
        .id = node,
        .depth = entry->depth,
        .background = node >= model->tree_count,
        .hidden = !(entry->visible_px > 0),
        .cost_ms = entry->cost_ms,
    };
    for (int i = 0; i < 3; i++) item.origin[i] = (float)(placement->origin[i] - camera->eye[i]);
    memcpy(item.basis, placement->basis, sizeof item.basis);
    if (options->output == PROM_OUTPUT_TINT) {
        const prom_prototype *p = &model->prototypes[model->prototype[node]];
        tint_of(rep, p->flags & PROM_PROTO_CLUSTER, item.tint);
    }
    prom_draw_list_add(list, &item);
}

static void add_background(prom_draw_list *list, const prom_model *model,
                           const prom_camera *camera, const prom_frame_options *options)
{
    for (uint32_t node = model->tree_count; node < model->node_count; node++) {
        const prom_prototype *p = &model->prototypes[model->prototype[node]];
        double square = 0;
        for (int i = 0; i < 3; i++) {
            double d = model->center[node][i] - camera->eye[i];
            square += d * d;
        }
        // Representations stand from the finest mesh on.
        for (uint32_t i = 0; i < p->rep_count; i++) {
            uint32_t rep = p->first_rep + i;
            if (model->reps[rep].kind != PROM_REP_MESH) continue;
            const prom_cut_entry entry = {
                .node = node, .rep = rep, .depth = (float)sqrt(square)};
            add_node(list, model, &entry, camera, options);
            break;
        }
    }
}

void prom_renderer_prepare_frame(prom_draw_list *list, const prom_model *model,
                                 const prom_cut *cut, const prom_camera *camera,
                                 const prom_frame_options *options)
{
    prom_draw_list_reset(list);
    for (size_t i = 0; i < cut->entries.count; i++)
        add_node(list, model, &cut->entries.data[i], camera, options);
    if (!options->no_background) add_background(list, model, camera, options);
    prom_draw_list_prepare(list);
}

void prom_renderer_submit_frame(prom_draw_list *list, prom_target *target,
                                const prom_camera *camera, const prom_frame_options *options,
                                size_t first, size_t end)
{
    const uint32_t *size = options->size_px;
    prom_pass pass = {.width = size[0] ? size[0] : camera->width,
                      .height = size[1] ? size[1] : camera->height,
                      .output = options->output,
                      .ids = options->ids,
                      .wireframe = options->wireframe,
                      .first = first,
                      .end = end};
    prom_camera_projection(camera, pass.projection);
    if (!first) target_clear(target, prom_sky_color, options->ids != PROM_IDS_NONE);
    prom_draw_list_submit(list, target, &pass);
}

void prom_renderer_draw_frame(prom_renderer *renderer, prom_draw_list *list,
                              prom_target *target, const prom_model *model, const prom_cut *cut,
                              const prom_camera *camera, const prom_frame_options *options)
{
    (void)renderer; // the list's own
    assert(list->renderer == renderer);
    static const prom_frame_options defaults = {0};
    if (!options) options = &defaults;
    prom_renderer_prepare_frame(list, model, cut, camera, options);
    prom_renderer_submit_frame(list, target, camera, options, 0, 0);
}
