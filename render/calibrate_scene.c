#include "render/calibrate_scene.h"

#include <math.h>

// Sides of the textures, in texels: large enough that they are shrunk on nearly all items, as
// textures in scenes are; enlarged ones cost less.
#define MATERIAL_SIZE 1024u
#define PICTURE_SIZE 256u
#define MAX_TRIANGLES 400000u
#define MAX_ITEMS 2000.0
#define MAX_LAYERS 6u
#define MAX_SMALL_ITEMS 512.0 // between which state is changed
#define MAX_SENT_BYTES 8e6    // with a change of the picture; more would be spread over frames
// State i is plain where i is a multiple of this, else textured from the pool at the remainder.
// From STATE_CYCLE on it is mirrored.
#define STATE_CYCLE (SCENE_STATES / 2)

// Stacks and slices of the balls: triangles = 2 * slices * (stacks - 1).
static const struct {
    uint32_t stacks, slices;
} details[SCENE_DETAILS] = {{3, 3}, {5, 6}, {11, 10}, {26, 20}, {51, 50}};

// ---- what is uploaded

static prom_vertex ball_vertex(uint32_t stack, uint32_t slice, uint32_t detail)
{
    float v = (float)stack / (float)details[detail].stacks;
    float u = (float)slice / (float)details[detail].slices;
    float polar = v * (float)M_PI, around = u * 2 * (float)M_PI;
    float p[3] = {sinf(polar) * cosf(around), cosf(polar), -sinf(polar) * sinf(around)};
    prom_vertex vertex = {
        .position = {p[0], p[1], p[2]}, .color = {230, 220, 200, 255}, .uv = {u, v}};
    prom_pack_normal(p, vertex.normal);
    return vertex;
}

static void init_ball(prom_mesh *mesh, uint32_t detail)
{
    uint32_t stacks = details[detail].stacks, slices = details[detail].slices, n = 0;
    prom_mesh_init(mesh, (stacks + 1) * (slices + 1), 6 * slices * (stacks - 1), 1);
    for (uint32_t i = 0; i <= stacks; i++)
        for (uint32_t j = 0; j <= slices; j++)
            mesh->vertices[i * (slices + 1) + j] = ball_vertex(i, j, detail);
    for (uint32_t i = 0; i < stacks; i++)
        for (uint32_t j = 0; j < slices; j++) {
            uint32_t a = i * (slices + 1) + j, b = a + slices + 1;
            const uint32_t corners[6] = {a, b, b + 1, a, b + 1, a + 1};
            // At the poles one of the two triangles is a point.
            for (uint32_t k = 0; k < 6; k++)
                if ((k < 3 && i < stacks - 1) || (k >= 3 && i > 0))
                    mesh->indices[n++] = corners[k];
        }
    mesh->submeshes[0] = (prom_submesh){0, n, PROM_NONE};
}

static bool upload_meshes(scene_kit *kit, prom_renderer *r)
{
    bool ok = true;
    for (uint32_t d = 0; d < SCENE_DETAILS; d++) {
        prom_mesh ball;
        init_ball(&ball, d);
        kit->triangles[d] = ball.index_count / 3;
        kit->vertices[d] = ball.vertex_count;
        for (uint32_t s = 0; s < PROM_SHADE_COUNT; s++) {
            ball.submeshes[0].material = s == PROM_SHADE_PLAIN ? PROM_NONE : s;
            kit->meshes[d][s] = prom_renderer_add_mesh(r, &ball);
            ok = ok && kit->meshes[d][s] != PROM_NONE;
        }
        prom_mesh_finish(&ball);
    }
    static const float center[3] = {0, 0, 0}, half[3] = {1, 1, 1};
    prom_mesh box;
    prom_mesh_init_box(&box, center, half, NULL);
    kit->box = prom_renderer_add_mesh(r, &box);
    prom_mesh_finish(&box);
    return ok && kit->box != PROM_NONE;
}

// A blot that covers two thirds or so of the picture, with some structure.
static void paint(prom_texture *texture)
{
    for (uint32_t layer = 0; layer < texture->layers; layer++)
        for (uint32_t y = 0; y < texture->height; y++)
            for (uint32_t x = 0; x < texture->width; x++) {
                uint8_t *p = texture->pixels + prom_texture_offset(texture, 0, layer) +
                             4 * ((size_t)y * texture->width + x);
                float dx = 2 * (float)x / (float)texture->width - 1;
                float dy = 2 * (float)y / (float)texture->height - 1;
                p[0] = (uint8_t)(128 + 100 * dx);
                p[1] = (uint8_t)(128 + 100 * dy);
                p[2] = (uint8_t)(128 + ((x ^ y) & 31));
                p[3] = dx * dx + dy * dy < 0.85f ? 255 : 0;
            }
    prom_texture_make_mips(texture, 0.5f);
}

static uint32_t upload_texture(prom_renderer *r, prom_texture_kind kind, uint32_t size)
{
    prom_texture texture;
    prom_texture_init(&texture, kind, size, size);
    paint(&texture);
    uint32_t id = prom_renderer_add_texture(r, &texture);
    prom_texture_finish(&texture);
    return id;
}

static void set_materials(prom_renderer *renderer, uint32_t texture, const uint32_t *pools)
{
    // One per shading, at its number; then one per state.
    prom_material materials[PROM_SHADE_COUNT + SCENE_STATES] = {
        [PROM_SHADE_PLAIN] = {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE},
        [PROM_SHADE_TEXTURED] = {.base_color = {1, 1, 1, 1}, .texture = texture},
        [PROM_SHADE_MASKED] = {.base_color = {1, 1, 1, 1},
                               .texture = texture,
                               .alpha_mode = PROM_ALPHA_MASK,
                               .alpha_cutoff = 0.5f},
        [PROM_SHADE_BLENDED] = {.base_color = {1, 1, 1, 0.5f},
                                .texture = texture,
                                .alpha_mode = PROM_ALPHA_BLEND},
        [PROM_SHADE_IMPOSTOR] = {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE},
    };
    for (uint32_t i = 0; i < SCENE_STATES; i++)
        materials[PROM_SHADE_COUNT + i] =
            (prom_material){.base_color = {1, 1, 1, 1}, .texture = pools[i % STATE_CYCLE]};
    prom_renderer_set_materials(renderer, materials, PROM_SHADE_COUNT + SCENE_STATES);
}

// Textures of a different size each, which therefore cannot be bound together.
static bool upload_pools(prom_renderer *renderer, uint32_t pools[STATE_CYCLE])
{
    bool ok = true;
    pools[0] = PROM_NONE;
    for (uint32_t i = 1; i < STATE_CYCLE; i++) {
        pools[i] = upload_texture(renderer, PROM_TEXTURE_COLOR, 8u << i);
        ok = ok && pools[i] != PROM_NONE;
    }
    return ok;
}

static bool upload_states(scene_kit *kit, prom_renderer *renderer)
{
    bool ok = true;
    prom_mesh ball;
    init_ball(&ball, 0);
    for (uint32_t i = 0; i < SCENE_STATES; i++) {
        ball.submeshes[0].material = PROM_SHADE_COUNT + i;
        kit->states[i] = prom_renderer_add_mesh(renderer, &ball);
        ok = ok && kit->states[i] != PROM_NONE;
    }
    prom_mesh_finish(&ball);
    return ok;
}

bool scene_kit_upload(scene_kit *kit, prom_renderer *renderer)
{
    uint32_t texture = upload_texture(renderer, PROM_TEXTURE_COLOR, MATERIAL_SIZE);
    uint32_t pools[STATE_CYCLE];
    kit->pictures_unlit = upload_texture(renderer, PROM_TEXTURE_IMPOSTOR_LIT, PICTURE_SIZE);
    kit->pictures_lit = upload_texture(renderer, PROM_TEXTURE_IMPOSTOR_ALBEDO, PICTURE_SIZE);
    bool ok = upload_pools(renderer, pools) && texture != PROM_NONE &&
              kit->pictures_unlit != PROM_NONE && kit->pictures_lit != PROM_NONE;
    set_materials(renderer, texture, pools);
    ok = upload_meshes(kit, renderer) && upload_states(kit, renderer) && ok;
    kit->mesh_count = prom_renderer_mesh_count(renderer);
    kit->texture_count = prom_renderer_texture_count(renderer);
    init_ball(&kit->spare_mesh, SCENE_DETAILS - 1);
    prom_texture_init(&kit->spare_texture, PROM_TEXTURE_COLOR, PICTURE_SIZE, PICTURE_SIZE);
    paint(&kit->spare_texture);
    return ok;
}

void scene_kit_finish(scene_kit *kit)
{
    prom_mesh_finish(&kit->spare_mesh);
    prom_texture_finish(&kit->spare_texture);
}

// ---- samples

// The index-th member of the additive sequence of a step, in [0,1).
static double spread(uint32_t index, double step)
{
    double t = 0.5 + step * index;
    return t - floor(t);
}

// From low to high as t goes from 0 to 1, evenly in the logarithm.
static double log_between(double low, double high, double t)
{
    return low * pow(high / low, t);
}

static size_t spare_bytes(const scene_kit *kit, bool texture)
{
    const prom_mesh *mesh = &kit->spare_mesh;
    return texture ? prom_texture_bytes(&kit->spare_texture)
                   : mesh->vertex_count * sizeof *mesh->vertices +
                         mesh->index_count * sizeof *mesh->indices;
}

// As little as can be beside the changes of state.
static scene_plan binds_plan(uint32_t index)
{
    double items = log_between(16, MAX_SMALL_ITEMS + 1, spread(index, 0.8191725133961645));
    return (scene_plan){.series = SCENE_BINDS,
                        .items = (uint32_t)items,
                        .layers = 1,
                        .area = (float)(0.02 + 0.08 * spread(index, 0.6710436067037893)),
                        .states = 1 + index % SCENE_STATES};
}

static scene_plan uploads_plan(const scene_kit *kit, uint32_t index)
{
    scene_plan plan = {.series = SCENE_UPLOADS, .layers = 1, .textures = index % 2};
    double most = MAX_SENT_BYTES / (double)spare_bytes(kit, plan.textures);
    plan.copies = (uint32_t)log_between(1, most, spread(index, 0.8191725133961645));
    return plan;
}

static bool is_impostor(const scene_plan *plan)
{
    return plan->series == PROM_COST_IMPOSTOR_LIT || plan->series == PROM_SHADE_IMPOSTOR;
}

scene_plan scene_plan_at(const scene_kit *kit, uint32_t series, uint32_t index)
{
    if (series == SCENE_BINDS) return binds_plan(index);
    if (series == SCENE_UPLOADS) return uploads_plan(kit, index);
    // Steps 1/g, 1/g^2, 1/g^3 with g^4 = g + 1 (Roberts 2018). The shadings start apart, so
    // that together they fill the gaps.
    uint32_t offset = index + 1000 * series;
    scene_plan plan = {.series = series, .layers = 1};
    plan.items = (uint32_t)log_between(1, MAX_ITEMS + 1, spread(offset, 0.8191725133961645));
    double side = spread(offset, 0.6710436067037893);
    plan.area = (float)(0.02 + 0.98 * side * side);
    plan.detail = (uint32_t)(SCENE_DETAILS * spread(offset, 0.5497004779019703));
    if (is_impostor(&plan)) return plan;
    plan.layers = 1 + index % MAX_LAYERS;
    if (plan.items > MAX_TRIANGLES / kit->triangles[plan.detail])
        plan.items = MAX_TRIANGLES / kit->triangles[plan.detail];
    if (plan.items < plan.layers) plan.items = plan.layers;
    return plan;
}

double scene_plain_share(const scene_plan *plan)
{
    if (plan->series != SCENE_BINDS) return 0.0;
    uint32_t plain = 0;
    for (uint32_t i = 0; i < plan->items; i++) plain += i % plan->states % STATE_CYCLE == 0;
    return (double)plain / plan->items;
}

size_t scene_send(const scene_kit *kit, const scene_plan *plan, prom_renderer *renderer)
{
    prom_renderer_truncate(renderer, kit->mesh_count, kit->texture_count);
    for (uint32_t i = 0; i < plan->copies; i++)
        if (plan->textures)
            prom_renderer_add_texture(renderer, &kit->spare_texture);
        else
            prom_renderer_add_mesh(renderer, &kit->spare_mesh);
    return plan->copies * spare_bytes(kit, plan->textures);
}

bool scene_is_cut(const scene_plan *plan)
{
    return is_impostor(plan) || plan->series == PROM_SHADE_MASKED ||
           plan->series == PROM_SHADE_BLENDED;
}

// solid: of a material or without pictures, so that nothing is cut out.
static prom_draw_item make_item(const scene_kit *kit, const scene_plan *plan, uint32_t i,
                                bool solid)
{
    bool lit = plan->series == PROM_COST_IMPOSTOR_LIT;
    prom_draw_item item = {.texture = PROM_NONE};
    if (is_impostor(plan)) {
        item.mesh = kit->box;
        item.flags = lit ? 0 : PROM_REP_UNLIT;
        if (!solid) item.texture = lit ? kit->pictures_lit : kit->pictures_unlit;
    } else if (plan->series == SCENE_BINDS) {
        item.mesh = kit->states[i % plan->states];
    } else {
        uint32_t shading = solid && scene_is_cut(plan) ? PROM_SHADE_TEXTURED : plan->series;
        item.mesh = kit->meshes[plan->detail][shading];
    }
    return item;
}

typedef struct grid {
    uint32_t cells, columns;
    float width, height; // of a cell, in clip space, where x and y run from -1 to 1
} grid;

// Cells that are about square in pixels.
static grid make_grid(const scene_plan *plan, float aspect)
{
    uint32_t cells = (plan->items + plan->layers - 1) / plan->layers;
    uint32_t columns = (uint32_t)(sqrtf((float)cells * aspect) + 0.5f);
    columns = columns ? columns : 1;
    uint32_t rows = (cells + columns - 1) / columns;
    return (grid){cells, columns, 2.0f / (float)columns, 2.0f / (float)rows};
}

// Items in layers hide each other in part, are wide or tall, large or small, as in scenes.
// (What lies behind just its like costs a third less at the edges, measured.)
static void scatter(prom_draw_item *item, uint32_t i, const grid *g)
{
    item->origin[0] += g->width * (float)(spread(i, 0.8191725133961645) - 0.5);
    item->origin[1] += g->height * (float)(spread(i, 0.6710436067037893) - 0.5);
    item->basis[0] *= (float)log_between(0.4, 2.5, spread(i, 0.5497004779019703));
    item->basis[4] *= (float)log_between(0.4, 2.5, spread(i, 0.4503));
}

void scene_fill_list(const scene_kit *kit, const scene_plan *plan, float aspect, bool solid,
                     prom_draw_list *list)
{
    prom_draw_list_reset(list);
    if (!plan->items) return;
    grid g = make_grid(plan, aspect);
    float reach = 0.5f * sqrtf(plan->area); // half a cell times the side that is covered
    for (uint32_t i = 0; i < plan->items; i++) {
        prom_draw_item item = make_item(kit, plan, i, solid);
        uint32_t cell = i % g.cells, layer = i / g.cells;
        item.id = i;
        item.origin[0] = -1 + g.width * ((float)(cell % g.columns) + 0.5f);
        item.origin[1] = -1 + g.height * ((float)(cell / g.columns) + 0.5f);
        item.origin[2] = 0.1f + 0.15f * (float)layer;
        item.basis[0] = g.width * reach;
        item.basis[4] = g.height * reach;
        item.basis[8] = 0.05f;
        item.depth = 1.0f + (float)(plan->layers - layer) + (float)cell * 1e-4f;
        if (plan->layers > 1) scatter(&item, i, &g);
        if (plan->states && i % plan->states >= STATE_CYCLE) item.basis[0] *= -1;
        prom_draw_list_add(list, &item);
    }
    prom_draw_list_prepare(list);
}
