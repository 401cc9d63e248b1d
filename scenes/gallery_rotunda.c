// The rotunda: a round wall with four passages, half columns, a coffered dome with an eye.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f
#define PASSAGE 0.95f // half width
#define HEAD 3.15f    // height of the passages
#define EYE 0.86f     // elevation at which the dome opens, of the quarter circle

typedef struct drum {
    float x, z, radius, top;
} drum;

static void round_point(const drum *d, float radius, float angle, float y, float p[3])
{
    p[0] = d->x + radius * cosf(angle);
    p[1] = y;
    p[2] = d->z - radius * sinf(angle);
}

// ---- the wall, seen from inside

static void build_band(prom_solid *s, const drum *d, float a0, float a1, float y0, float y1,
                       int steps)
{
    for (int i = 0; i < steps; i++) {
        float angles[2], p[4][3], n[3] = {0};
        for (int k = 0; k < 2; k++)
            angles[k] = a1 + (a0 - a1) * (float)(i + k) / (float)steps; // to the right, inside
        uint32_t first = 0;
        for (int k = 0; k < 4; k++) {
            float angle = angles[k == 1 || k == 2], y = k < 2 ? y0 : y1;
            round_point(d, d->radius, angle, y, p[k]);
            n[0] = -cosf(angle);
            n[2] = sinf(angle);
            uint32_t id =
                prom_solid_vertex(s, p[k], n, -angle * d->radius / s->repeat, -y / s->repeat);
            if (!k) first = id;
        }
        prom_solid_triangle(s, first, first + 1, first + 2);
        prom_solid_triangle(s, first, first + 2, first + 3);
    }
}

// The passage from the round wall to the room's rectangle, towards +x of its frame.
static void build_passage(prom_solid *s, float radius, float to)
{
    float from = sqrtf(radius * radius - PASSAGE * PASSAGE), h = HEAD, w = PASSAGE;
    prom_solid_quad(s, (float[]){from, 0, -w}, (float[]){to, 0, -w}, (float[]){to, h, -w},
                    (float[]){from, h, -w});
    prom_solid_quad(s, (float[]){to, 0, w}, (float[]){from, 0, w}, (float[]){from, h, w},
                    (float[]){to, h, w});
    prom_solid_quad(s, (float[]){from, h, -w}, (float[]){to, h, -w}, (float[]){to, h, w},
                    (float[]){from, h, w});
}

// Between the passage's end and the door in the room's wall, which is smaller.
static void build_stop(prom_gallery *g, prom_solid *s, float to, const prom_gallery_opening *o)
{
    prom_paint paint = prom_gallery_paint(g, PROM_GALLERY_ASHLAR, 0xfff8ea, 2.4f);
    float half = o ? o->width / 2 : 0, top = o ? o->y1 : 0;
    prom_gallery_hole hole = {PASSAGE - half, -1, PASSAGE + half, top};
    prom_solid_frame old = prom_solid_enter(s, to, 0, -PASSAGE, -PI / 2);
    prom_gallery_wall(s, 2 * PASSAGE, 0, HEAD, &hole, o ? 1 : 0, NULL, 0, &paint);
    prom_solid_leave(s, old);
}

static const prom_gallery_opening *door_at(const prom_gallery *g, uint32_t room,
                                           prom_gallery_side side)
{
    float along;
    for (size_t i = 0; i < g->plan.openings.count; i++)
        if (prom_gallery_in_face(&g->plan, &g->plan.openings.data[i], room, side, &along))
            return &g->plan.openings.data[i];
    return NULL;
}

static void build_walls(prom_gallery *g, const prom_gallery_room *r, uint32_t id, const drum *d,
                        prom_solid *s)
{
    float gap = asinf(PASSAGE / d->radius);
    int steps = prom_gallery_steps(g, 64), over = prom_gallery_steps(g, 16);
    prom_paint stone = prom_gallery_paint(g, PROM_GALLERY_ASHLAR, 0xfff8ea, 2.4f);
    prom_paint plaster = prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xf4dcb4, 2.0f);
    static const prom_gallery_side sides[4] = {PROM_GALLERY_EAST, PROM_GALLERY_NORTH,
                                               PROM_GALLERY_WEST, PROM_GALLERY_SOUTH};
    for (int k = 0; k < 4; k++) {
        float a = PI / 2 * (float)k,
              reach = k % 2 ? 0.5f * (r->z1 - r->z0) : 0.5f * (r->x1 - r->x0);
        prom_solid_use(s, stone);
        build_band(s, d, a + gap, a + PI / 2 - gap, 0, HEAD, steps);
        prom_solid_use(s, plaster);
        build_band(s, d, a + gap, a + PI / 2 - gap, HEAD, d->top, steps);
        build_band(s, d, a - gap, a + gap, HEAD, d->top, over);
        prom_solid_use(s, stone);
        prom_solid_frame old = prom_solid_enter(s, d->x, 0, d->z, a);
        build_passage(s, d->radius, reach);
        build_stop(g, s, reach, door_at(g, id, sides[k]));
        prom_solid_leave(s, old);
    }
}

// Rings around the wall: (inset from it, height) from bottom to top, bulging inwards.
static void build_ring(prom_gallery *g, prom_solid *s, const drum *d, const float (*profile)[2],
                       int points, float a0, float a1)
{
    int steps = prom_gallery_steps(g, a1 - a0 > 3 ? 256 : 64);
    for (int j = 0; j + 1 < points; j++) {
        const float *lo = profile[j], *hi = profile[j + 1];
        for (int i = 0; i < steps; i++) {
            float b0 = a1 + (a0 - a1) * (float)i / (float)steps;
            float b1 = a1 + (a0 - a1) * (float)(i + 1) / (float)steps, p[4][3];
            round_point(d, d->radius - lo[0], b0, lo[1], p[0]);
            round_point(d, d->radius - lo[0], b1, lo[1], p[1]);
            round_point(d, d->radius - hi[0], b1, hi[1], p[2]);
            round_point(d, d->radius - hi[0], b0, hi[1], p[3]);
            prom_solid_quad(s, p[0], p[1], p[2], p[3]);
        }
    }
}

static void build_pilasters(prom_gallery *g, prom_solid *s, const drum *d)
{
    float y = d->top - 1.0f;
    const float shaft[][2] = {{0.27f, 0},         {0.27f, 0.25f},     {0.22f, 0.32f},
                              {0.24f, 0.40f},     {0.20f, 0.46f},     {0.17f, y - 0.35f},
                              {0.20f, y - 0.30f}, {0.18f, y - 0.25f}, {0.27f, y - 0.05f},
                              {0.27f, y}};
    for (int k = 0; k < 4; k++)
        for (int side = -1; side <= 1; side += 2) {
            float a = PI / 4 + PI / 2 * (float)k + (float)side * 0.40f, p[3];
            round_point(d, d->radius - 0.02f, a, 0, p);
            prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xd9b49a, 0.9f));
            prom_solid_frame old = prom_solid_enter(s, p[0], 0, p[2], a);
            prom_solid_lathe(s, shaft, 10, prom_gallery_sides(g, 96), true);
            prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xfbf6ea, 2.0f));
            prom_solid_box(s, -0.26f, y, -0.26f, 0.26f, y + 0.10f, 0.26f, PROM_FACE_ALL);
            prom_solid_leave(s, old);
        }
}

// ---- the dome

static void dome_point(const drum *d, float radius, float around, float up, float p[3])
{
    round_point(d, radius * cosf(up), around, d->top + radius * sinf(up), p);
}

// A cell of the dome: a rim and steps into the recess. box: angle0, up0, angle1, up1.
static void build_cell(prom_gallery *g, prom_solid *s, const drum *d, const float box[4])
{
    float b[4] = {box[0], box[1], box[2], box[3]}, radius = d->radius;
    int levels = 1 + (int)g->options.detail / 2;
    float wa = 0.14f * (b[2] - b[0]), wu = 0.14f * (b[3] - b[1]);
    for (int k = 0; k <= levels; k++) {
        float c[4] = {b[0] + wa, b[1] + wu, b[2] - wa, b[3] - wu}, o[4][3], in[4][3],
              deep[4][3];
        float next = radius + 0.22f / (float)levels;
        // Corners as seen from inside: lower left, lower right, upper right, upper left.
        static const int corner[4][2] = {{2, 1}, {0, 1}, {0, 3}, {2, 3}};
        for (int i = 0; i < 4; i++) {
            dome_point(d, radius, b[corner[i][0]], b[corner[i][1]], o[i]);
            dome_point(d, radius, c[corner[i][0]], c[corner[i][1]], in[i]);
            dome_point(d, next, c[corner[i][0]], c[corner[i][1]], deep[i]);
        }
        if (k == levels) {
            prom_solid_quad(s, o[0], o[1], o[2], o[3]);
            return;
        }
        for (int i = 0; i < 4; i++) {
            int j = (i + 1) % 4;
            prom_solid_quad(s, o[i], o[j], in[j], in[i]);
            prom_solid_quad(s, in[i], in[j], deep[j], deep[i]);
        }
        for (int i = 0; i < 4; i++) b[i] = c[i];
        radius = next;
        wa *= 0.6f;
        wu *= 0.6f;
    }
}

static void build_dome(prom_gallery *g, prom_solid *s, const drum *d)
{
    const int around = 24, rows = 6;
    float base = 0.10f, top = PI / 2 * EYE;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xffffff, 2.0f));
    for (int j = 0; j < rows; j++) {
        // Cells keep their shape towards the top.
        float a = 1 - powf(0.80f, (float)j), b = 1 - powf(0.80f, (float)(j + 1));
        float full = 1 - powf(0.80f, (float)rows);
        for (int i = 0; i < around; i++)
            build_cell(g, s, d,
                       (float[]){2 * PI * (float)i / (float)around,
                                 base + (top - base) * a / full,
                                 2 * PI * (float)(i + 1) / (float)around,
                                 base + (top - base) * b / full});
    }
    // The plain foot of the dome and the rim of its eye.
    float foot = d->radius * sinf(base), eye = d->radius * cosf(top),
          y = d->top + d->radius * sinf(top);
    const float plain[][2] = {{0, d->top}, {d->radius * (1 - cosf(base)), d->top + foot}};
    build_ring(g, s, d, plain, 2, 0, 2 * PI);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0xe6b95c, 0.5f));
    float in = d->radius - eye;
    const float rim[][2] = {
        {in, y}, {in + 0.05f, y - 0.04f}, {in + 0.10f, y}, {in + 0.10f, y + 0.5f}};
    build_ring(g, s, d, rim, 4, 0, 2 * PI);
    // Glass over the eye, and the dome from outside.
    prom_solid_use(s, prom_gallery_glass(g));
    prom_solid_frame old = prom_solid_enter(s, d->x, y + 0.4f, d->z, 0);
    const float cap[][2] = {{eye, 0}, {0.8f * eye, 0.16f}, {0.4f * eye, 0.28f}, {0, 0.32f}};
    prom_solid_lathe(s, cap, 4, prom_gallery_sides(g, 96), true);
    prom_solid_leave(s, old);
}

static void build_outer(prom_gallery *g, prom_solid *s, const drum *d)
{
    float profile[12][2];
    int n = 0;
    profile[n][0] = d->radius + 0.5f;
    profile[n++][1] = d->top;
    for (int i = 0; i <= 8; i++) {
        float up = PI / 2 * (0.08f + 0.79f * (float)i / 8), r = d->radius + 0.45f;
        profile[n][0] = r * cosf(up);
        profile[n++][1] = d->top + 0.35f + r * sinf(up);
    }
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0x9fb8a8, 1.0f));
    prom_solid_frame old = prom_solid_enter(s, d->x, 0, d->z, 0);
    prom_solid_lathe(s, (const float(*)[2])profile, n, prom_gallery_sides(g, 128), true);
    prom_solid_leave(s, old);
}

void prom_gallery_build_rotunda(prom_gallery *g, uint32_t id, uint32_t parent)
{
    const prom_gallery_room *r = &g->plan.rooms.data[id];
    drum d = {0.5f * (r->x0 + r->x1), 0.5f * (r->z0 + r->z1),
              0.5f * fminf(r->x1 - r->x0, r->z1 - r->z0) - 0.15f, r->y1};
    prom_solid walls, trim, dome;
    prom_solid_init(&walls);
    prom_solid_init(&trim);
    prom_solid_init(&dome);
    build_walls(g, r, id, &d, &walls);
    build_pilasters(g, &trim, &d);
    prom_solid_use(&trim, prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xfbf6ea, 2.0f));
    float y = d.top - 0.9f;
    const float entablature[][2] = {{0, y},
                                    {0.30f, y + 0.01f},
                                    {0.30f, y + 0.30f},
                                    {0.34f, y + 0.34f},
                                    {0.34f, y + 0.62f},
                                    {0.46f, y + 0.74f},
                                    {0.58f, y + 0.80f},
                                    {0.60f, y + 0.90f},
                                    {0, y + 0.91f}};
    build_ring(g, &trim, &d, entablature, 9, 0, 2 * PI);
    float gap = asinf((PASSAGE + 0.14f) / d.radius);
    const float skirting[][2] = {{0.04f, 0}, {0.04f, 0.26f}, {0.02f, 0.30f}, {0, 0.30f}};
    for (int k = 0; k < 4; k++) {
        prom_solid_use(&trim, prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xa8a29a, 1.0f));
        build_ring(g, &trim, &d, skirting, 4, PI / 2 * (float)k + gap,
                   PI / 2 * (float)(k + 1) - gap);
    }
    if (!g->options.roofless) {
        build_dome(g, &dome, &d);
        build_outer(g, &dome, &d);
    }
    prom_gallery_add(g, parent, "round_wall", &walls);
    prom_gallery_add(g, parent, "orders", &trim);
    prom_gallery_add(g, parent, "dome", &dome);
}
