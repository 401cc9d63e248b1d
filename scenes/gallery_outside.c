// What is seen through the windows: facades, roofs, the garden, hills and the sky.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f
#define PARAPET 0.7f
#define GROUND -0.12f
#define LAWN 70.0f // beyond the walls

// ---- facades

static prom_paint stone(prom_gallery *g)
{
    return prom_gallery_paint(g, PROM_GALLERY_ASHLAR, 0xf6e8cc, 2.4f);
}

static void build_surround(prom_solid *s, const prom_gallery_hole *h)
{
    float b = 0.16f, d = 0.06f;
    prom_solid_box(s, h->u0 - b, h->v0 - b, 0, h->u0, h->v1 + b, d, PROM_FACE_NO_BACK);
    prom_solid_box(s, h->u1, h->v0 - b, 0, h->u1 + b, h->v1 + b, d, PROM_FACE_NO_BACK);
    prom_solid_box(s, h->u0, h->v1, 0, h->u1, h->v1 + b, d, PROM_FACE_NO_BACK);
    prom_solid_box(s, h->u0 - b, h->v0 - b, 0, h->u1 + b, h->v0, 0.14f, PROM_FACE_NO_BACK);
    prom_solid_box(s, h->u0 - 0.3f, h->v1 + b, 0, h->u1 + 0.3f, h->v1 + b + 0.12f, 0.2f,
                   PROM_FACE_NO_BACK);
}

// A stretch of facade between two middle lines of walls, in its frame; `from` is where it
// starts along x or z.
static void build_facade(prom_gallery *g, prom_solid *s, prom_gallery_side side, float low,
                         float high, float plane)
{
    prom_gallery_hole holes[8];
    int n = 0;
    bool along_x = side == PROM_GALLERY_WEST || side == PROM_GALLERY_EAST;
    bool mirrored = side == PROM_GALLERY_NORTH || side == PROM_GALLERY_EAST;
    for (size_t i = 0; i < g->plan.openings.count && n < 8; i++) {
        const prom_gallery_opening *o = &g->plan.openings.data[i];
        float face = side == PROM_GALLERY_WEST || side == PROM_GALLERY_NORTH ? o->from : o->to;
        if (!o->window || o->along_x != along_x || fabsf(face - plane) > 1e-3f ||
            o->middle < low || o->middle > high)
            continue;
        float u = mirrored ? high - o->middle : o->middle - low, half = o->width / 2;
        holes[n++] = (prom_gallery_hole){u - half, o->y0, u + half, o->y1};
    }
    static const float yaws[4] = {PI, 0, -PI / 2, PI / 2};
    float x = along_x ? plane : mirrored ? high : low;
    float z = along_x ? (mirrored ? high : low) : plane;
    prom_paint paint = stone(g);
    prom_solid_frame old = prom_solid_enter(s, x, 0, z, yaws[side]);
    float length = high - low, top = PROM_GALLERY_ROOF + PARAPET;
    prom_gallery_wall(s, length, GROUND, top, holes, n, NULL, 0, &paint);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xfbf3e2, 2.0f));
    for (int i = 0; i < n; i++) build_surround(s, &holes[i]);
    const float cornice[][2] = {{11.6f, 0},     {11.7f, 0.10f},  {11.9f, 0.14f},
                                {12.0f, 0.34f}, {12.15f, 0.40f}, {12.16f, 0}};
    const float belt[][2] = {{5.6f, 0}, {5.64f, 0.08f}, {5.9f, 0.10f}, {5.95f, 0}};
    prom_solid_moulding(s, cornice, 6, 0, length);
    float from = 0; // the belt stops at windows that reach over it
    for (int i = 0; i < n; i++) {
        if (holes[i].v0 > 5.6f || holes[i].v1 < 5.95f) continue;
        prom_solid_moulding(s, belt, 4, from, holes[i].u0 - 0.16f);
        from = holes[i].u1 + 0.16f;
    }
    prom_solid_moulding(s, belt, 4, from, length);
    prom_solid_leave(s, old);
}

static void cell_span(const float spans[][2], uint32_t count, uint32_t i, float out[2])
{
    out[0] = i ? spans[i][0] - PROM_GALLERY_WALL / 2 : spans[i][0] - PROM_GALLERY_WALL;
    out[1] =
        i + 1 < count ? spans[i][1] + PROM_GALLERY_WALL / 2 : spans[i][1] + PROM_GALLERY_WALL;
}

static void build_facades(prom_gallery *g, prom_solid *s)
{
    const prom_gallery_plan *p = &g->plan;
    float north = -PROM_GALLERY_WALL, south = p->row_z[p->rows - 1][1] + PROM_GALLERY_WALL;
    float west = north, east = p->column_x[p->columns - 1][1] + PROM_GALLERY_WALL, span[2];
    for (uint32_t i = 0; i < p->columns; i++) {
        cell_span(p->column_x, p->columns, i, span);
        build_facade(g, s, PROM_GALLERY_NORTH, span[0], span[1], north);
        build_facade(g, s, PROM_GALLERY_SOUTH, span[0], span[1], south);
    }
    for (uint32_t j = 0; j < p->rows; j++) {
        cell_span(p->row_z, p->rows, j, span);
        build_facade(g, s, PROM_GALLERY_WEST, span[0], span[1], west);
        build_facade(g, s, PROM_GALLERY_EAST, span[0], span[1], east);
    }
}

// ---- roofs

static void build_roof(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    float x[2], z[2], first[2], last[2];
    prom_gallery_hole hole = {0};
    cell_span(g->plan.column_x, g->plan.columns, r->column, x);
    cell_span(g->plan.row_z, g->plan.rows, r->row, first);
    cell_span(g->plan.row_z, g->plan.rows, r->row + r->rows - 1, last);
    z[0] = first[0];
    z[1] = last[1];
    float mx = 0.26f * (r->x1 - r->x0), mz = 0.26f * (r->z1 - r->z0), y = PROM_GALLERY_ROOF;
    if (r->kind == PROM_GALLERY_HALL) mx = mz = 1.7f;
    if (r->kind == PROM_GALLERY_COURT) mx = mz = 0;
    if (r->kind == PROM_GALLERY_ROTUNDA) {
        mx = 0.5f * (r->x1 - r->x0) - 2.0f;
        mz = 0.5f * (r->z1 - r->z0) - 2.0f;
    }
    bool open = r->ceiling == PROM_GALLERY_SKYLIGHT || r->kind == PROM_GALLERY_COURT ||
                r->kind == PROM_GALLERY_ROTUNDA;
    if (open) hole = (prom_gallery_hole){r->x0 + mx, r->z0 + mz, r->x1 - mx, r->z1 - mz};
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0xa8b4b0, 1.5f));
    prom_gallery_slab(s, x[0], z[0], x[1], z[1], y, &hole, open ? 1 : 0, true);
    if (r->ceiling == PROM_GALLERY_SKYLIGHT) // the curb of the lantern
        for (int k = 0; k < 4; k++) {
            bool across = k < 2;
            float a =
                k & 1 ? (across ? hole.v1 : hole.u1) : (across ? hole.v0 : hole.u0) - 0.1f;
            float b = a + 0.1f;
            prom_solid_box(s, across ? hole.u0 - 0.1f : a, y, across ? a : hole.v0,
                           across ? hole.u1 + 0.1f : b, y + 0.25f, across ? b : hole.v1,
                           PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
        }
}

// ---- the garden

static void frame_strips(prom_solid *s, const float in[4], const float out[4], float cell)
{
    prom_solid_floor(s, out[0], out[1], out[2], in[1], GROUND, cell);
    prom_solid_floor(s, out[0], in[3], out[2], out[3], GROUND, cell);
    prom_solid_floor(s, out[0], in[1], in[0], in[3], GROUND, cell);
    prom_solid_floor(s, in[2], in[1], out[2], in[3], GROUND, cell);
}

static void build_ground(prom_gallery *g, prom_solid *s, const float house[4])
{
    float terrace[4], lawn[4];
    for (int k = 0; k < 4; k++) {
        float sign = k < 2 ? -1 : 1;
        terrace[k] = house[k] + sign * 6;
        lawn[k] = house[k] + sign * LAWN;
    }
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_GRAVEL, 0xffffff, 2.0f));
    frame_strips(s, house, terrace, 8);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_GRASS, 0xffffff, 3.0f));
    frame_strips(s, terrace, lawn, 12);
}

static void plant_garden(prom_gallery *g, uint32_t parent, const float house[4])
{
    prom_random r = prom_random_stream(g->options.seed, 20, 0);
    float length = 2 * (house[2] - house[0] + house[3] - house[1]);
    int trees = (int)(length / 4);
    for (int i = 0; i < trees; i++) {
        float out = prom_random_between(&r, 12, 40), t = prom_random_unit(&r);
        uint32_t side = prom_random_below(&r, 4);
        float a = house[side & 1 ? 1 : 0] - out, b = house[side & 1 ? 3 : 2] + out;
        float along = a + (b - a) * t;
        float across = side & 2 ? house[side & 1 ? 2 : 3] + out : house[side & 1 ? 0 : 1] - out;
        float at[3] = {side & 1 ? across : along, GROUND, side & 1 ? along : across};
        prom_gallery_place(g, parent, PROM_GALLERY_TREE, (uint32_t)i, at,
                           2 * PI * prom_random_unit(&r), prom_random_between(&r, 0.8f, 1.3f));
    }
    for (int side = 0; side < 4; side++) { // hedges along the terrace, with gaps
        float low = side & 1 ? house[1] : house[0], high = side & 1 ? house[3] : house[2];
        float edge = side == 0   ? house[1] - 7
                     : side == 1 ? house[0] - 7
                     : side == 2 ? house[3] + 7
                                 : house[2] + 7;
        int n = (int)((high - low) / 5);
        for (int i = 0; i < n; i++) {
            if (i % 4 == 1) continue;
            float u = low + (high - low) * ((float)i + 0.5f) / (float)n;
            float at[3] = {side & 1 ? edge : u, GROUND, side & 1 ? u : edge};
            prom_gallery_place(g, parent, PROM_GALLERY_HEDGE, (uint32_t)i, at,
                               side & 1 ? PI / 2 : 0, 1);
        }
    }
    for (int k = 0; k < 2; k++)
        prom_gallery_place(
            g, parent, PROM_GALLERY_FOUNTAIN, 0,
            (float[]){0.5f * (house[0] + house[2]), GROUND, k ? house[3] + 18 : house[1] - 18},
            0, 1);
}

// ---- far away: hills and the sky, a backdrop

static void sky_point(const void *context, float u, float v, float p[3])
{
    const float *c = context; // x, z, radius
    float a = -2 * PI * u, e = PI / 2 * (v * 1.04f - 0.04f), r = v >= 1 ? 0 : cosf(e);
    p[0] = c[0] + c[2] * r * cosf(a);
    p[1] = c[2] * sinf(e) - 2;
    p[2] = c[1] - c[2] * r * sinf(a);
}

static void hill_point(const void *context, float u, float v, float p[3])
{
    const float *c = context;
    float a = -2 * PI * u, near = 0.5f + 0.45f * v;
    float h =
        v * v * c[2] * (0.015f + 0.10f * fmaxf(0, 0.4f + prom_noise_rough(u, 0.5f, 7, 8)));
    p[0] = c[0] + c[2] * near * cosf(a);
    p[1] = -0.004f * c[2] + h;
    p[2] = c[1] - c[2] * near * sinf(a);
}

static void plain_point(const void *context, float u, float v, float p[3])
{
    const float *c = context;
    float a = -2 * PI * u, r = 0.03f + 0.5f * v;
    p[0] = c[0] + c[2] * r * cosf(a);
    p[1] = -0.004f * c[2] * fminf(1, 1.2f * v) - 1.0f;
    p[2] = c[1] - c[2] * r * sinf(a);
}

static void build_far(prom_gallery *g, prom_solid *s, const float house[4])
{
    float size = hypotf(house[2] - house[0], house[3] - house[1]) + 2 * LAWN;
    const float c[3] = {0.5f * (house[0] + house[2]), 0.5f * (house[1] + house[3]), 5 * size};
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_SKY, 0xffffff, 1));
    prom_gallery_surface(s, sky_point, c, 48, 16, 2, 1,
                         PROM_GALLERY_CLOSED_U | PROM_GALLERY_LIT);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0x9db8a4, 1));
    prom_gallery_surface(s, hill_point, c, 96, 6, 40, 4, PROM_GALLERY_CLOSED_U);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_GRASS, 0xf4f8ee, 1));
    prom_gallery_surface(s, plain_point, c, 48, 6, 200, 60, PROM_GALLERY_CLOSED_U);
}

void prom_gallery_build_outside(prom_gallery *g, uint32_t parent)
{
    const prom_gallery_plan *p = &g->plan;
    const float house[4] = {-PROM_GALLERY_WALL, -PROM_GALLERY_WALL,
                            p->column_x[p->columns - 1][1] + PROM_GALLERY_WALL,
                            p->row_z[p->rows - 1][1] + PROM_GALLERY_WALL};
    prom_solid facades, roofs, ground, far;
    prom_solid_init(&facades);
    prom_solid_init(&roofs);
    prom_solid_init(&ground);
    prom_solid_init(&far);
    build_facades(g, &facades);
    for (size_t i = 0; i < p->rooms.count && !g->options.roofless; i++) {
        const prom_gallery_room *r = &p->rooms.data[i];
        if (r->storey || r->kind >= PROM_GALLERY_HALL) build_roof(g, r, &roofs);
    }
    build_ground(g, &ground, house);
    build_far(g, &far, house);
    prom_gallery_add(g, parent, "facades", &facades);
    prom_gallery_add(g, parent, "roofs", &roofs);
    prom_gallery_add(g, parent, "ground", &ground);
    prom_gallery_add(g, parent, "sky", &far);
    plant_garden(g, parent, house);
}

// ---- plants and the fountain

typedef struct crown {
    float c[3], r[3];
    uint32_t seed;
} crown;

static void crown_point(const void *context, float u, float v, float p[3])
{
    const crown *b = context;
    float a = 2 * PI * u, e = PI * (v - 0.5f), w = v <= 0 || v >= 1 ? 0 : cosf(e);
    float d[3] = {w * cosf(a), sinf(e), -w * sinf(a)};
    float r = 1 + 0.45f * prom_noise_space(2.5f * d[0], 2.5f * d[1], 2.5f * d[2], b->seed) +
              0.25f * prom_noise_space(9 * d[0], 9 * d[1], 9 * d[2], b->seed + 4);
    for (int k = 0; k < 3; k++) p[k] = b->c[k] + b->r[k] * r * d[k];
}

void prom_gallery_make_tree(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t greens[] = {0xffffff, 0xe8f8d0, 0xd8e8d8, 0xf8f0c0};
    const float trunk[4][3] = {
        {0, 0, 0}, {0.05f, 0.8f, 0.02f}, {0, 1.8f, 0.05f}, {0.05f, 3.2f, 0}};
    int steps = prom_gallery_steps(g, 80);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_WOOD, 0x8a7058, 0.6f));
    prom_solid_tube(s, trunk, (const float[]){0.28f, 0.20f, 0.16f, 0.08f}, 4,
                    prom_gallery_sides(g, 32));
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_LEAVES, greens[v % 4], 1));
    bool slim = v % 3 == 2; // a cypress
    for (int i = 0; i < (slim ? 1 : 5); i++) {
        float a = 2.4f * (float)i, out = i ? 0.9f : 0;
        crown b = {.c = {out * cosf(a), slim ? 4.2f : 3.3f + 0.35f * (float)i, out * sinf(a)},
                   .seed = (uint32_t)prom_random_next(r)};
        float size = slim ? 0.95f : prom_random_between(r, 1.2f, 1.7f);
        b.r[0] = b.r[2] = size;
        b.r[1] = slim ? 3.6f : 0.85f * size;
        prom_gallery_surface(s, crown_point, &b, steps, slim ? steps : steps / 2, 6,
                             slim ? 8 : 4, PROM_GALLERY_CLOSED_U);
    }
}

void prom_gallery_make_hedge(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)v;
    (void)r;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_LEAVES, 0xe0f0d0, 0.9f));
    prom_solid_box(s, -2.5f, 0, -0.4f, 2.5f, 1.1f, 0.4f, PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    for (int k = -1; k <= 1; k += 2)
        prom_gallery_ball(s, 2.3f * (float)k, 1.3f, 0, 0.5f, 0.5f, 0.5f,
                          prom_gallery_sides(g, 64), 0);
}

void prom_gallery_make_fountain(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    const float basin[][2] = {{1.9f, 0},     {1.9f, 0.35f},  {2.0f, 0.42f},
                              {2.0f, 0.50f}, {1.75f, 0.50f}, {1.75f, 0.30f}};
    const float stem[][2] = {{0.35f, 0.30f}, {0.22f, 0.60f}, {0.16f, 1.10f}, {0.25f, 1.30f},
                             {0.80f, 1.45f}, {0.85f, 1.52f}, {0.75f, 1.50f}, {0.20f, 1.46f},
                             {0.12f, 1.90f}, {0.30f, 2.00f}, {0, 2.05f}};
    (void)v;
    (void)r;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xe8ddca, 1.0f));
    prom_solid_lathe(s, basin, 6, prom_gallery_sides(g, 128), false);
    prom_solid_lathe(s, stem, 11, prom_gallery_sides(g, 96), true);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_CERAMIC, 0x8ab8c8, 1.0f));
    const float water[][2] = {{1.75f, 0.40f}, {0, 0.40f}};
    prom_solid_lathe(s, water, 2, prom_gallery_sides(g, 128), false);
}
