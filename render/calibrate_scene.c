#include "render/calibrate_scene.h"

#include <math.h>

// Sides of the textures, in texels: large enough that they are shrunk on nearly all items, as
// textures in scenes are; enlarged ones cost less.
#define MATERIAL_SIZE 1024u
#define PICTURE_SIZE 256u
#define MAX_TRIANGLES 400000u
#define MAX_ITEMS 2000.0
#define MAX_LAYERS 6u

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

bool scene_kit_upload(scene_kit *kit, prom_renderer *renderer)
{
    uint32_t texture = upload_texture(renderer, PROM_TEXTURE_COLOR, MATERIAL_SIZE);
    kit->pictures_unlit = upload_texture(renderer, PROM_TEXTURE_IMPOSTOR_LIT, PICTURE_SIZE);
    kit->pictures_lit = upload_texture(renderer, PROM_TEXTURE_IMPOSTOR_ALBEDO, PICTURE_SIZE);
    // One per shading, at its number.
    const prom_material materials[PROM_SHADE_COUNT] = {
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
    prom_renderer_set_materials(renderer, materials, PROM_SHADE_COUNT);
    return upload_meshes(kit, renderer) && texture != PROM_NONE &&
           kit->pictures_unlit != PROM_NONE && kit->pictures_lit != PROM_NONE;
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

scene_plan scene_plan_at(const scene_kit *kit, uint32_t kind, uint32_t index)
{
    // Steps 1/g, 1/g^2, 1/g^3 with g^4 = g + 1 (Roberts 2018). The shadings start apart, so
    // that together they fill the gaps.
    uint32_t offset = index + 1000 * kind;
    scene_plan plan = {.kind = kind, .layers = 1};
    plan.items = (uint32_t)log_between(1, MAX_ITEMS + 1, spread(offset, 0.8191725133961645));
    double side = spread(offset, 0.6710436067037893);
    plan.area = (float)(0.02 + 0.98 * side * side);
    plan.detail = (uint32_t)(SCENE_DETAILS * spread(offset, 0.5497004779019703));
    bool impostor = kind == PROM_SHADE_IMPOSTOR || kind == PROM_COST_IMPOSTOR_LIT;
    if (!impostor) plan.layers = 1 + index % MAX_LAYERS;
    if (!impostor && plan.items > MAX_TRIANGLES / kit->triangles[plan.detail])
        plan.items = MAX_TRIANGLES / kit->triangles[plan.detail];
    if (plan.items < plan.layers) plan.items = plan.layers;
    return plan;
}

// solid: of a material or without pictures, so that nothing is cut out.
static prom_draw_item make_item(const scene_kit *kit, const scene_plan *plan, bool solid)
{
    bool lit = plan->kind == PROM_COST_IMPOSTOR_LIT;
    prom_draw_item item = {.texture = PROM_NONE};
    if (lit || plan->kind == PROM_SHADE_IMPOSTOR) {
        item.mesh = kit->box;
        item.flags = lit ? 0 : PROM_REP_UNLIT;
        if (!solid) item.texture = lit ? kit->pictures_lit : kit->pictures_unlit;
    } else {
        bool cut = plan->kind == PROM_SHADE_MASKED || plan->kind == PROM_SHADE_BLENDED;
        item.mesh = kit->meshes[plan->detail][solid && cut ? PROM_SHADE_TEXTURED : plan->kind];
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
    grid g = make_grid(plan, aspect);
    float reach = 0.5f * sqrtf(plan->area); // half a cell times the side that is covered
    prom_draw_list_reset(list);
    for (uint32_t i = 0; i < plan->items; i++) {
        prom_draw_item item = make_item(kit, plan, solid);
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
        prom_draw_list_add(list, &item);
    }
    prom_draw_list_prepare(list);
}
