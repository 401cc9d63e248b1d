// The hall: its gallery floor on columns, the flight up to it, and the roof's trusses.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f
#define COLUMN_INSET 0.28f // of the columns behind the gallery's edge

// ---- columns

static void fluted(const void *context, float u, float v, float p[3])
{
    const float *c = context; // radius below, above, y0, y1, flutes, depth
    float a = 2 * PI * u, swell = 1 - (1 - c[1] / c[0]) * v * v;
    float ends = fminf(1, 20 * fminf(v, 1 - v));
    float r = c[0] * swell - c[5] * ends * fabsf(sinf(0.5f * c[4] * a));
    p[0] = r * cosf(a);
    p[1] = c[2] + (c[3] - c[2]) * v;
    p[2] = -r * sinf(a);
}

// A scroll of the capital: a spiral band on each front.
static void build_volute(prom_gallery *g, prom_solid *s, float x, float y, float z, float size)
{
    float points[96][3], radii[96];
    int n = prom_gallery_steps(g, 96);
    n = n < 96 ? n : 95;
    for (int i = 0; i <= n; i++) {
        float t = (float)i / (float)n, a = 4.5f * PI * t, r = size * (1 - 0.85f * t);
        points[i][0] = x + (x < 0 ? -1 : 1) * r * sinf(a);
        points[i][1] = y + r * cosf(a);
        points[i][2] = z;
        radii[i] = 0.16f * size * (1.1f - 0.5f * t);
    }
    prom_solid_tube(s, (const float(*)[3])points, radii, n + 1, prom_gallery_sides(g, 32));
    prom_gallery_ball(s, x, y, z, 0.22f * size, 0.22f * size, 0.16f * size,
                      prom_gallery_sides(g, 32), 0);
}

void prom_gallery_make_column(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *random)
{
    (void)v;
    (void)random;
    float top = PROM_GALLERY_UPPER - PROM_GALLERY_SLAB, r = 0.26f;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xf2e9da, 1.2f));
    prom_solid_box(s, -0.38f, 0, -0.38f, 0.38f, 0.16f, 0.38f,
                   PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    const float base[][2] = {{0.36f, 0.16f}, {0.37f, 0.20f}, {0.37f, 0.25f},
                             {0.33f, 0.28f}, {0.30f, 0.31f}, {0.31f, 0.34f},
                             {0.33f, 0.37f}, {0.31f, 0.41f}, {r, 0.44f}};
    prom_solid_lathe(s, base, 9, prom_gallery_sides(g, 96), true);
    const float shaft[6] = {r,           0.85f * r, 0.44f,
                            top - 0.42f, 20,        g->options.detail > 1 ? 0.022f : 0};
    prom_gallery_surface(s, fluted, shaft, prom_gallery_sides(g, 320) / 2,
                         prom_gallery_steps(g, 64), 2, 4, PROM_GALLERY_CLOSED_U);
    float y = top - 0.42f;
    const float head[][2] = {{0.22f, y},         {0.25f, y + 0.02f}, {0.25f, y + 0.05f},
                             {0.23f, y + 0.07f}, {0.24f, y + 0.14f}, {0.31f, y + 0.26f},
                             {0.31f, y + 0.30f}};
    prom_solid_lathe(s, head, 7, prom_gallery_sides(g, 96), true);
    prom_solid_box(s, -0.36f, y + 0.30f, -0.36f, 0.36f, top, 0.36f,
                   PROM_FACE_ALL & ~PROM_FACE_TOP);
    for (int k = 0; k < 4 && g->options.detail > 1; k++)
        build_volute(g, s, k & 1 ? 0.27f : -0.27f, y + 0.17f, k & 2 ? 0.27f : -0.27f, 0.12f);
}

// Along one edge, the middle left free for doors, the flight and the axis.
static const float long_side[] = {0.0f, 0.178f, 0.298f, 0.413f, 0.587f, 0.702f, 0.822f, 1.0f};
static const float short_side[] = {0.29f, 0.71f};

static void place_columns(prom_gallery *g, const prom_gallery_room *r, uint32_t parent)
{
    float inset = PROM_GALLERY_BALCONY - COLUMN_INSET;
    float x0 = r->x0 + inset, x1 = r->x1 - inset, z0 = r->z0 + inset, z1 = r->z1 - inset;
    for (size_t i = 0; i < sizeof long_side / sizeof *long_side; i++)
        for (int k = 0; k < 2; k++)
            prom_gallery_place(g, parent, PROM_GALLERY_COLUMN, 0,
                               (float[]){k ? x1 : x0, 0, z0 + (z1 - z0) * long_side[i]}, 0, 1);
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 2; k++)
            prom_gallery_place(g, parent, PROM_GALLERY_COLUMN, 0,
                               (float[]){x0 + (x1 - x0) * short_side[i], 0, k ? z1 : z0}, 0, 1);
}

// ---- the gallery floor

static void build_edge(prom_solid *s, float x, float z, float yaw, float length)
{
    float y = PROM_GALLERY_UPPER, low = y - PROM_GALLERY_SLAB;
    const float profile[][2] = {
        {low, 0},           {low + 0.12f, 0.02f}, {low + 0.13f, 0.05f}, {y - 0.22f, 0.05f},
        {y - 0.16f, 0.10f}, {y - 0.06f, 0.13f},   {y, 0.13f},           {y, 0}};
    prom_solid_frame old = prom_solid_enter(s, x, 0, z, yaw);
    prom_solid_moulding(s, profile, 8, -0.13f, length + 0.13f);
    prom_solid_leave(s, old);
}

static void build_gallery(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    float b = PROM_GALLERY_BALCONY, y = PROM_GALLERY_UPPER;
    prom_gallery_hole h = {r->x0 + b, r->z0 + b, r->x1 - b, r->z1 - b};
    float width = h.u1 - h.u0, depth = h.v1 - h.v0;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_SLABS, 0xffffff, 2.4f));
    prom_gallery_slab(s, r->x0, r->z0, r->x1, r->z1, y, &h, 1, true);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xffffff, 2.0f));
    prom_gallery_slab(s, r->x0, r->z0, r->x1, r->z1, y - PROM_GALLERY_SLAB, &h, 1, false);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xfbf6ea, 2.0f));
    build_edge(s, h.u0, h.v0, 0, width);
    build_edge(s, h.u1, h.v1, PI, width);
    build_edge(s, h.u0, h.v1, PI / 2, depth);
    build_edge(s, h.u1, h.v0, -PI / 2, depth);
}

static void build_rails(prom_gallery *g, const prom_gallery_room *r,
                        const prom_gallery_flight *f, prom_solid *s)
{
    float b = PROM_GALLERY_BALCONY - 0.06f, y = PROM_GALLERY_UPPER;
    float x0 = r->x0 + b, x1 = r->x1 - b, z0 = r->z0 + b, z1 = r->z1 - b;
    float left = f->x - f->width / 2 + 0.12f, right = f->x + f->width / 2 - 0.12f;
    prom_gallery_balustrade(g, s, (float[]){x0, y, z0}, (float[]){left, y, z0});
    prom_gallery_balustrade(g, s, (float[]){right, y, z0}, (float[]){x1, y, z0});
    prom_gallery_balustrade(g, s, (float[]){x0, y, z1}, (float[]){x1, y, z1});
    prom_gallery_balustrade(g, s, (float[]){x0, y, z0}, (float[]){x0, y, z1});
    prom_gallery_balustrade(g, s, (float[]){x1, y, z0}, (float[]){x1, y, z1});
    for (int k = -1; k <= 1; k += 2) {
        float x = k < 0 ? left : right, rise = f->y1 / (float)f->steps;
        prom_gallery_balustrade(g, s, (float[]){x, 0.5f * rise, f->z0},
                                (float[]){x, f->y1, f->z1 + 0.10f});
    }
}

// Tie beams under the glass, with hangers.
static void build_trusses(prom_gallery *g, const prom_gallery_room *r, prom_solid *s)
{
    float y = PROM_GALLERY_ROOF + 0.2f, x0 = r->x0 + 1.7f, x1 = r->x1 - 1.7f;
    float cx = 0.5f * (x0 + x1), rise = 0.22f * (x1 - x0);
    int n = (int)((r->z1 - r->z0) / 3.4f), sides = prom_gallery_sides(g, 32);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0x8d9a98, 1.0f));
    for (int i = 0; i < n; i++) {
        float z = r->z0 + 1.7f + (r->z1 - r->z0 - 3.4f) * ((float)i + 0.5f) / (float)n;
        const float tie[2][3] = {{x0, y, z}, {x1, y, z}};
        prom_solid_tube(s, tie, (const float[]){0.05f, 0.05f}, 2, sides);
        for (int k = -2; k <= 2; k++) {
            float x = cx + (float)k * (x1 - x0) / 6, top = y + rise * (1 - fabsf((float)k) / 3);
            const float hanger[2][3] = {{x, y, z}, {x, top, z}};
            prom_solid_tube(s, hanger, (const float[]){0.025f, 0.025f}, 2, sides);
            if (!k) continue;
            const float brace[2][3] = {
                {x, y, z}, {x - (k < 0 ? -1 : 1) * (x1 - x0) / 6, top + rise / 3, z}};
            prom_solid_tube(s, brace, (const float[]){0.025f, 0.025f}, 2, sides);
        }
    }
}

void prom_gallery_build_hall(prom_gallery *g, uint32_t id, uint32_t parent)
{
    const prom_gallery_room *room = &g->plan.rooms.data[id];
    prom_gallery_flight f[3];
    prom_solid gallery, steps, rails, trusses;
    prom_gallery_flights(&g->plan, f);
    prom_solid_init(&gallery);
    prom_solid_init(&steps);
    prom_solid_init(&rails);
    prom_solid_init(&trusses);
    build_gallery(g, room, &gallery);
    prom_gallery_flight_of(g, &steps, &f[0]);
    build_rails(g, room, &f[0], &rails);
    if (!g->options.roofless) build_trusses(g, room, &trusses);
    prom_gallery_add(g, parent, "gallery", &gallery);
    prom_gallery_add(g, parent, "stairs", &steps);
    prom_gallery_add(g, parent, "balustrades", &rails);
    prom_gallery_add(g, parent, "trusses", &trusses);
    place_columns(g, room, parent);
}
