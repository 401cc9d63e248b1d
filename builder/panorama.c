#include "builder/panorama.h"

#include "traverse/view.h"

#include <math.h>

#define ERROR_PX 0.5f // that a mesh may deviate

struct prom_panorama_camera {
    prom_renderer *renderer;
    const prom_model *model;
    prom_target *target;
    prom_draw_list *lists[PROM_PANORAMA_FACES];
    prom_view views[PROM_PANORAMA_FACES];
    uint32_t size_px;
    PROM_ARRAY(uint32_t) stack; // of nodes to look at
};

void prom_panorama_init(prom_panorama *panorama, uint32_t size_px)
{
    size_t pixels = (size_t)PROM_PANORAMA_FACES * size_px * size_px;
    *panorama = (prom_panorama){.size_px = size_px,
                                .opaque = prom_alloc(pixels, sizeof *panorama->opaque),
                                .blended = prom_alloc(pixels, sizeof *panorama->blended)};
}

void prom_panorama_finish(prom_panorama *panorama)
{
    prom_free(panorama->opaque);
    prom_free(panorama->blended);
    *panorama = (prom_panorama){0};
}

prom_panorama_camera *prom_panorama_camera_create(prom_renderer *renderer,
                                                  const prom_model *model, uint32_t size_px,
                                                  prom_error *error)
{
    prom_panorama_camera *c = prom_calloc(1, sizeof *c);
    c->renderer = renderer;
    c->model = model;
    c->size_px = size_px;
    c->target = prom_target_create(size_px, PROM_PANORAMA_FACES * size_px, true, error);
    if (!c->target) {
        prom_panorama_camera_destroy(c);
        return NULL;
    }
    for (int f = 0; f < PROM_PANORAMA_FACES; f++) c->lists[f] = prom_draw_list_create(renderer);
    return c;
}

void prom_panorama_camera_destroy(prom_panorama_camera *camera)
{
    if (!camera) return;
    for (int f = 0; f < PROM_PANORAMA_FACES; f++)
        if (camera->lists[f]) prom_draw_list_destroy(camera->lists[f]);
    if (camera->target) prom_target_destroy(camera->target);
    prom_array_finish(&camera->stack);
    prom_free(camera);
}

// Ahead, to the sides, back, up and down.
static prom_camera camera_of_face(const prom_panorama_camera *c, const double eye[3], int face)
{
    const float s = sqrtf(0.5f);
    const float turns[PROM_PANORAMA_FACES][4] = {{0, 0, 0, 1},  {0, s, 0, s}, {0, 1, 0, 0},
                                                 {0, -s, 0, s}, {s, 0, 0, s}, {-s, 0, 0, s}};
    prom_camera camera = {.eye = {eye[0], eye[1], eye[2]},
                          .fov_y = (float)(M_PI / 2),
                          // As near as frames see: what they cut off must not hide anything.
                          .z_near = fminf(0.1f, c->model->radius[0] / 1000.0f),
                          .width = c->size_px,
                          .height = c->size_px};
    if (!(camera.z_near > 0)) camera.z_near = 1e-4f;
    memcpy(camera.orientation, turns[face], sizeof camera.orientation);
    return camera;
}

// Meshes stand from fine to coarse.
static uint32_t choose_mesh(const prom_model *model, uint32_t node, const prom_view *view,
                            const prom_appearance *appearance)
{
    const prom_prototype *p = &model->prototypes[model->prototype[node]];
    float scale = prom_basis_scale(model->placement[node].basis);
    uint32_t chosen = PROM_NONE;
    for (uint32_t i = p->first_rep; i < p->first_rep + p->rep_count; i++) {
        const prom_representation *rep = &model->reps[i];
        if (rep->kind != PROM_REP_MESH) continue;
        bool close = rep->error * scale * view->f_px <= ERROR_PX * appearance->nearest &&
                     appearance->size_px <= rep->max_size_px;
        if (chosen == PROM_NONE || close) chosen = i;
    }
    return chosen;
}

static void add_leaf(prom_panorama_camera *c, int face, uint32_t node)
{
    const prom_model *model = c->model;
    const prom_view *view = &c->views[face];
    prom_appearance appearance;
    prom_view_appearance(view, model, node, &appearance);
    uint32_t chosen = choose_mesh(model, node, view, &appearance);
    if (chosen == PROM_NONE) return;
    const prom_representation *rep = &model->reps[chosen];
    const prom_placement *placement = &model->placement[node];
    prom_draw_item item = {.mesh = rep->mesh,
                           .texture = rep->texture,
                           .flags = rep->flags,
                           .id = node,
                           .depth = appearance.nearest};
    for (int k = 0; k < 3; k++)
        item.origin[k] = (float)(placement->origin[k] - view->camera.eye[k]);
    memcpy(item.basis, placement->basis, sizeof item.basis);
    prom_draw_list_add(c->lists[face], &item);
}

static void fill_list(prom_panorama_camera *c, int face)
{
    const prom_model *model = c->model;
    prom_draw_list_reset(c->lists[face]);
    c->stack.count = 0;
    if (model->tree_count) prom_array_push(&c->stack, 0);
    while (c->stack.count) {
        uint32_t node = c->stack.data[--c->stack.count];
        if (prom_view_cull(&c->views[face], model->center[node], model->half[node]) ==
            PROM_OUTSIDE)
            continue;
        for (uint32_t i = 0; i < model->child_count[node]; i++)
            prom_array_push(&c->stack, model->first_child[node] + i);
        if (!model->child_count[node]) add_leaf(c, face, node);
    }
    prom_draw_list_prepare(c->lists[face]);
}

static void submit(prom_panorama_camera *c, int face, prom_ids ids)
{
    prom_pass pass = {.y = (uint32_t)face * c->size_px,
                      .width = c->size_px,
                      .height = c->size_px,
                      .output = PROM_OUTPUT_ALBEDO,
                      .ids = ids};
    prom_camera_projection(&c->views[face].camera, pass.projection);
    prom_draw_list_submit(c->lists[face], c->target, &pass);
}

static void read_face(prom_panorama_camera *c, int face, uint32_t *ids)
{
    uint32_t n = c->size_px, first = (uint32_t)face * n;
    prom_target_read_ids(c->target, 0, first, n, n, ids + (size_t)first * n);
}

// All faces are drawn before the first is read, which waits for the device. What is blended
// comes over the depths that are there then.
void prom_panorama_take(prom_panorama_camera *c, prom_panorama *panorama)
{
    prom_target_clear(c->target, prom_sky_color);
    for (int f = 0; f < PROM_PANORAMA_FACES; f++) {
        prom_camera camera = camera_of_face(c, panorama->eye, f);
        prom_view_init(&c->views[f], &camera);
        fill_list(c, f);
        panorama->has_blended[f] = prom_draw_list_has_blended(c->lists[f]);
        submit(c, f, PROM_IDS_OPAQUE);
    }
    for (int f = 0; f < PROM_PANORAMA_FACES; f++) read_face(c, f, panorama->opaque);
    for (int f = 0; f < PROM_PANORAMA_FACES; f++)
        if (panorama->has_blended[f]) submit(c, f, PROM_IDS_BLENDED);
    for (int f = 0; f < PROM_PANORAMA_FACES; f++)
        if (panorama->has_blended[f]) read_face(c, f, panorama->blended);
}
