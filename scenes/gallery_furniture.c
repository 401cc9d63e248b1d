// Furniture.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f
#define NO_BOTTOM (PROM_FACE_ALL & ~PROM_FACE_BOTTOM)

static prom_paint wood(prom_gallery *g, uint32_t v)
{
    static const uint32_t tints[] = {0x9c6f48, 0x6f4a32, 0xb88a5c, 0x5a3c2c};
    return prom_gallery_paint(g, PROM_GALLERY_WOOD, tints[v % 4], 1.0f);
}

static prom_paint cloth(prom_gallery *g, uint32_t v)
{
    static const uint32_t tints[] = {0xa24a44, 0x5f7f6a, 0x55708a, 0xc8a860, 0x8a6a7a};
    return prom_gallery_paint(g, PROM_GALLERY_FABRIC, tints[v % 5], 0.3f);
}

static prom_paint brass(prom_gallery *g)
{
    return prom_gallery_paint(g, PROM_GALLERY_METAL, 0xd0a850, 0.4f);
}

// A turned leg at (x, z), up to `top`.
static void build_leg(prom_gallery *g, prom_solid *s, float x, float z, float top, float r)
{
    const float leg[][2] = {{0.6f * r, 0},           {0.9f * r, 0.08f * top},
                            {0.6f * r, 0.16f * top}, {1.0f * r, 0.45f * top},
                            {0.7f * r, 0.70f * top}, {1.1f * r, 0.80f * top},
                            {1.1f * r, top}};
    prom_solid_frame old = prom_solid_enter(s, x, 0, z, 0);
    if (g->options.detail == 1)
        prom_solid_box(s, -0.8f * r, 0, -0.8f * r, 0.8f * r, top, 0.8f * r, PROM_FACE_SIDES);
    else
        prom_solid_lathe(s, leg, 7, prom_gallery_sides(g, 48), true);
    prom_solid_leave(s, old);
}

typedef struct cushion {
    float x, y, z, hx, hy, hz;
} cushion;

// A box with round edges: a superellipsoid.
static void cushion_point(const void *context, float u, float v, float p[3])
{
    const cushion *c = context;
    float a = 2 * PI * u, e = PI * (v - 0.5f);
    float ca = cosf(a), sa = -sinf(a), ce = v <= 0 || v >= 1 ? 0 : cosf(e), se = sinf(e);
    float flat = powf(fabsf(ce), 0.35f);
    p[0] = c->x + c->hx * flat * copysignf(powf(fabsf(ca), 0.30f), ca);
    p[1] = c->y + c->hy * copysignf(powf(fabsf(se), 0.6f), se);
    p[2] = c->z + c->hz * flat * copysignf(powf(fabsf(sa), 0.30f), sa);
}

static void build_cushion(prom_gallery *g, prom_solid *s, float x, float y, float z, float hx,
                          float hy, float hz)
{
    cushion c = {x, y, z, hx, hy, hz};
    prom_gallery_surface(s, cushion_point, &c, prom_gallery_sides(g, 96),
                         prom_gallery_steps(g, 40), 4 * hx / 0.3f, 1, PROM_GALLERY_CLOSED_U);
}

// ---- seats

void prom_gallery_make_bench(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    prom_solid_use(s, wood(g, v));
    for (int k = 0; k < 6; k++)
        build_leg(g, s, 0.70f * (float)(k % 3 - 1), k < 3 ? -0.18f : 0.18f, 0.34f, 0.035f);
    prom_solid_box(s, -0.78f, 0.32f, -0.25f, 0.78f, 0.38f, 0.25f, PROM_FACE_ALL);
    if (v % 2) { // slats
        for (int k = 0; k < 6; k++)
            prom_solid_box(s, -0.80f, 0.38f, -0.245f + 0.083f * (float)k, 0.80f, 0.42f,
                           -0.18f + 0.083f * (float)k, NO_BOTTOM);
        return;
    }
    prom_solid_use(s, cloth(g, v / 2));
    for (int k = -1; k <= 1; k++)
        build_cushion(g, s, 0.52f * (float)k, 0.43f, 0, 0.26f, 0.06f, 0.25f);
}

void prom_gallery_make_chair(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    prom_solid_use(s, wood(g, v));
    for (int k = 0; k < 4; k++)
        build_leg(g, s, k & 1 ? 0.19f : -0.19f, k & 2 ? 0.19f : -0.17f, 0.43f, 0.022f);
    prom_solid_box(s, -0.22f, 0.41f, -0.20f, 0.22f, 0.45f, 0.22f, PROM_FACE_ALL);
    for (int k = -1; k <= 1; k += 2) { // posts of the back
        const float post[3][3] = {{0.19f * (float)k, 0.44f, -0.18f},
                                  {0.19f * (float)k, 0.72f, -0.20f},
                                  {0.18f * (float)k, 0.98f, -0.25f}};
        prom_solid_tube(s, post, (const float[]){0.020f, 0.018f, 0.014f}, 3,
                        prom_gallery_sides(g, 32));
    }
    for (int k = 0; k < 3; k++) {
        float y = 0.58f + 0.16f * (float)k, z = -0.19f - 0.022f * (float)(k * k) * 0.6f;
        prom_solid_box(s, -0.19f, y, z - 0.012f, 0.19f, y + 0.06f, z + 0.012f, PROM_FACE_ALL);
    }
    prom_solid_use(s, cloth(g, v));
    build_cushion(g, s, 0, 0.465f, 0.01f, 0.20f, 0.03f, 0.19f);
}

void prom_gallery_make_armchair(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    prom_solid_use(s, wood(g, v + 1));
    for (int k = 0; k < 4; k++)
        build_leg(g, s, k & 1 ? 0.30f : -0.30f, k & 2 ? 0.28f : -0.26f, 0.22f, 0.03f);
    prom_solid_use(s, cloth(g, v + 2));
    build_cushion(g, s, 0, 0.28f, 0, 0.36f, 0.10f, 0.34f);
    build_cushion(g, s, 0, 0.42f, 0.05f, 0.25f, 0.07f, 0.28f);
    build_cushion(g, s, 0, 0.68f, -0.28f, 0.34f, 0.38f, 0.09f);
    for (int k = -1; k <= 1; k += 2)
        build_cushion(g, s, 0.33f * (float)k, 0.48f, 0.02f, 0.075f, 0.16f, 0.32f);
}

// ---- tables

void prom_gallery_make_desk(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    prom_solid_use(s, wood(g, v));
    for (int k = 0; k < 4; k++)
        build_leg(g, s, k & 1 ? 0.68f : -0.68f, k & 2 ? 0.30f : -0.30f, 0.60f, 0.035f);
    prom_solid_box(s, -0.74f, 0.60f, -0.36f, 0.74f, 0.73f, 0.36f, PROM_FACE_ALL);
    prom_solid_box(s, -0.80f, 0.73f, -0.42f, 0.80f, 0.765f, 0.42f, PROM_FACE_ALL);
    for (int k = -1; k <= 1; k++) {
        float x = 0.49f * (float)k;
        prom_solid_box(s, x - 0.22f, 0.62f, 0.36f, x + 0.22f, 0.71f, 0.372f, PROM_FACE_NO_BACK);
    }
    prom_solid_use(s, brass(g));
    for (int k = -1; k <= 1; k++)
        prom_gallery_ball(s, 0.49f * (float)k, 0.665f, 0.385f, 0.014f, 0.014f, 0.014f,
                          prom_gallery_sides(g, 32), 0);
    // A blotter, books, papers and a lamp.
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_FABRIC, 0x4f6a52, 0.3f));
    prom_solid_box(s, -0.35f, 0.765f, -0.15f, 0.35f, 0.770f, 0.34f, NO_BOTTOM);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_LABEL, 0xffffff, 0.21f));
    prom_solid_box(s, -0.12f, 0.770f, 0.0f, 0.09f, 0.774f, 0.29f, NO_BOTTOM);
    float y = 0.765f;
    for (int k = 0; k < 4; k++) {
        float h = prom_random_between(r, 0.025f, 0.05f);
        prom_solid_frame old =
            prom_solid_enter(s, -0.58f, y, -0.12f, prom_random_between(r, -0.3f, 0.3f));
        prom_solid_use(s, cloth(g, (uint32_t)k + v));
        prom_solid_box(s, -0.11f, 0, -0.15f, 0.11f, h, 0.15f, NO_BOTTOM);
        prom_solid_leave(s, old);
        y += h;
    }
    const float lamp[][2] = {
        {0.09f, 0}, {0.09f, 0.015f}, {0.02f, 0.03f}, {0.014f, 0.30f}, {0.012f, 0.40f}};
    prom_solid_frame old = prom_solid_enter(s, 0.56f, 0.765f, -0.20f, 0);
    prom_solid_use(s, brass(g));
    prom_solid_lathe(s, lamp, 5, prom_gallery_sides(g, 64), true);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_CERAMIC, 0x5f9a72, 0.5f));
    const float shade[][2] = {{0.13f, 0.32f}, {0.11f, 0.40f}, {0.05f, 0.45f}, {0.01f, 0.46f}};
    prom_solid_lathe(s, shade, 4, prom_gallery_sides(g, 64), true);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLAIN, 0xfff2c8, 1));
    prom_gallery_ball(s, 0, 0.35f, 0, 0.10f, 0.03f, 0.10f, prom_gallery_sides(g, 32),
                      PROM_GALLERY_LIT);
    prom_solid_leave(s, old);
}

void prom_gallery_make_table(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    const float foot[][2] = {{0.06f, 0.12f}, {0.05f, 0.20f}, {0.09f, 0.34f},
                             {0.05f, 0.50f}, {0.07f, 0.62f}, {0.20f, 0.68f}};
    const float top[][2] = {
        {0.50f, 0.68f}, {0.55f, 0.70f}, {0.55f, 0.72f}, {0.53f, 0.735f}, {0, 0.735f}};
    prom_solid_use(s, wood(g, v));
    prom_solid_lathe(s, foot, 6, prom_gallery_sides(g, 64), true);
    prom_solid_lathe(s, top, 5, prom_gallery_sides(g, 128), false);
    for (int k = 0; k < 3; k++) {
        float a = 2 * PI * (float)k / 3;
        const float leg[4][3] = {{0.03f * cosf(a), 0.20f, 0.03f * sinf(a)},
                                 {0.20f * cosf(a), 0.16f, 0.20f * sinf(a)},
                                 {0.32f * cosf(a), 0.05f, 0.32f * sinf(a)},
                                 {0.38f * cosf(a), 0.02f, 0.38f * sinf(a)}};
        prom_solid_tube(s, leg, (const float[]){0.04f, 0.035f, 0.028f, 0.02f}, 4,
                        prom_gallery_sides(g, 32));
    }
}

void prom_gallery_make_console(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    prom_solid_use(s, v % 2 ? brass(g) : wood(g, v));
    for (int k = -1; k <= 1; k += 2) {
        float x = 0.48f * (float)k;
        const float leg[5][3] = {{x, 0.80f, 0.34f},
                                 {x, 0.60f, 0.36f},
                                 {x, 0.36f, 0.24f},
                                 {x, 0.14f, 0.12f},
                                 {x, 0, 0.16f}};
        prom_solid_tube(s, leg, (const float[]){0.04f, 0.045f, 0.035f, 0.028f, 0.03f}, 5,
                        prom_gallery_sides(g, 32));
    }
    prom_solid_box(s, -0.54f, 0.74f, 0, 0.54f, 0.83f, 0.38f, PROM_FACE_ALL);
    prom_solid_box(s, -0.46f, 0.10f, 0.02f, 0.46f, 0.13f, 0.20f, PROM_FACE_ALL);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xd8b8a0, 0.7f));
    prom_solid_box(s, -0.58f, 0.83f, 0, 0.58f, 0.87f, 0.42f, PROM_FACE_ALL);
}

// ---- books

static void build_books(prom_gallery *g, prom_solid *s, float x0, float x1, float y, float high,
                        prom_random *r)
{
    static const uint32_t leathers[] = {0x9a4a38, 0x6f5c40, 0x4f6a58,
                                        0xa8844c, 0x5a6384, 0x84404a};
    float x = x0;
    while (x < x1 - 0.06f) {
        float thick = prom_random_between(r, 0.025f, 0.055f);
        float h = high * prom_random_between(r, 0.68f, 0.94f),
              deep = prom_random_between(r, 0.18f, 0.23f);
        if (prom_random_unit(r) < 0.04f) { // a gap
            x += 2 * thick;
            continue;
        }
        prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_FABRIC,
                                             leathers[prom_random_below(r, 6)], 0.3f));
        prom_solid_box(s, x, y, 0.03f, x + thick, y + h, 0.03f + deep,
                       PROM_FACE_TOP | PROM_FACE_FRONT | PROM_FACE_LEFT | PROM_FACE_RIGHT);
        if (g->options.detail > 2) {
            prom_solid_use(s, brass(g));
            for (int k = 0; k < 2; k++)
                prom_solid_box(s, x, y + h * (k ? 0.8f : 0.2f), 0.03f + deep, x + thick,
                               y + h * (k ? 0.83f : 0.23f), 0.032f + deep, PROM_FACE_NO_BACK);
        }
        x += thick + 0.001f;
    }
}

void prom_gallery_make_bookcase(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    const float w = 0.62f, top = 2.5f, d = 0.34f;
    prom_solid_use(s, wood(g, v % 2));
    prom_solid_box(s, -w, 0, 0, -w + 0.04f, top, d, PROM_FACE_ALL);
    prom_solid_box(s, w - 0.04f, 0, 0, w, top, d, PROM_FACE_ALL);
    prom_solid_box(s, -w + 0.04f, 0.08f, 0, w - 0.04f, top, 0.015f, PROM_FACE_FRONT);
    prom_solid_box(s, -w + 0.04f, 0, 0, w - 0.04f, 0.09f, d - 0.01f,
                   PROM_FACE_FRONT | PROM_FACE_TOP);
    const float crown[][2] = {{top, d},
                              {top + 0.03f, d + 0.01f},
                              {top + 0.07f, d + 0.05f},
                              {top + 0.10f, d + 0.06f},
                              {top + 0.12f, d + 0.06f},
                              {top + 0.12f, 0}};
    prom_solid_moulding(s, crown, 6, -w - 0.05f, w + 0.05f);
    for (int k = 0; k < 6; k++) {
        float y = 0.09f + 0.40f * (float)k;
        prom_solid_use(s, wood(g, v % 2));
        if (k)
            prom_solid_box(s, -w + 0.04f, y - 0.025f, 0.01f, w - 0.04f, y, d - 0.02f,
                           PROM_FACE_ALL);
        if (g->options.detail > 1) {
            build_books(g, s, -w + 0.05f, w - 0.05f, y, 0.36f, r);
        } else {
            prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_BOOKS, 0xffffff, 1));
            prom_solid_picture(s, (float[]){-w + 0.05f, y, 0.24f},
                               (float[]){w - 0.05f, y, 0.24f},
                               (float[]){w - 0.05f, y + 0.36f, 0.24f},
                               (float[]){-w + 0.05f, y + 0.36f, 0.24f});
        }
    }
}

// ---- this and that

typedef struct leaf {
    float yaw, reach, rise, droop, width;
    float back; // 1: the underside
} leaf;

static void leaf_point(const void *context, float u, float v, float p[3])
{
    const leaf *l = context;
    float c = cosf(l->yaw), s = sinf(l->yaw);
    float half = l->width * sinf(PI * fminf(1, 0.08f + 0.92f * v)) *
                 (l->back > 0 ? 1 - 2 * u : 2 * u - 1);
    float out = l->reach * v, y = l->rise * v - l->droop * v * v * v - 0.3f * fabsf(half);
    p[0] = c * out - s * half;
    p[1] = y;
    p[2] = -s * out - c * half;
}

static void build_leaf(prom_gallery *g, prom_solid *s, float yaw, float y, float reach,
                       float rise, float droop, float width)
{
    prom_solid_frame old = prom_solid_enter(s, 0, y, 0, 0);
    for (int k = 0; k < 2; k++) {
        leaf l = {yaw, reach, rise, droop, width, (float)k};
        prom_gallery_surface(s, leaf_point, &l, 2, prom_gallery_steps(g, 48), 1, 2, 0);
    }
    prom_solid_leave(s, old);
}

void prom_gallery_make_plant(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t pots[] = {0xc87850, 0xe0d8cc, 0x5f7f9a};
    const float pot[][2] = {{0.15f, 0},     {0.19f, 0.10f}, {0.23f, 0.34f}, {0.25f, 0.36f},
                            {0.25f, 0.42f}, {0.22f, 0.42f}, {0.21f, 0.36f}, {0, 0.36f}};
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_CERAMIC, pots[v % 3], 1));
    prom_solid_lathe(s, pot, 8, prom_gallery_sides(g, 96), false);
    prom_solid_use(
        s, prom_gallery_paint(g, PROM_GALLERY_LEAVES, v % 2 ? 0xe8f4d8 : 0xc8e8c0, 0.5f));
    int leaves = prom_gallery_steps(g, 104);
    for (int i = 0; i < leaves; i++) {
        float t = (float)i / (float)leaves;
        build_leaf(g, s, 2.4f * (float)i, 0.36f + 0.5f * t * t,
                   prom_random_between(r, 0.35f, 0.62f) * (1.1f - 0.5f * t),
                   prom_random_between(r, 0.55f, 1.0f),
                   prom_random_between(r, 0.2f, 0.7f) * (1 - 0.5f * t),
                   prom_random_between(r, 0.04f, 0.07f));
    }
    if (v % 2) return;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_WOOD, 0x8a6a48, 0.5f));
    const float stem[2][3] = {{0, 0.3f, 0}, {0, 0.9f, 0}};
    prom_solid_tube(s, stem, (const float[]){0.03f, 0.02f}, 2, prom_gallery_sides(g, 32));
}

void prom_gallery_make_ropes(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const float corner[4][2] = {
        {-1.2f, -1.2f}, {1.2f, -1.2f}, {1.2f, 1.2f}, {-1.2f, 1.2f}};
    const float post[][2] = {{0.15f, 0},      {0.15f, 0.015f}, {0.05f, 0.045f}, {0.022f, 0.07f},
                             {0.022f, 0.90f}, {0.034f, 0.91f}, {0.034f, 0.94f}, {0.02f, 0.95f},
                             {0.032f, 0.98f}, {0, 1.01f}};
    (void)v;
    (void)r;
    for (int k = 0; k < 4; k++) {
        const float *a = corner[k], *b = corner[(k + 1) % 4];
        prom_solid_frame old = prom_solid_enter(s, a[0], 0, a[1], 0);
        prom_solid_use(s, brass(g));
        prom_solid_lathe(s, post, 10, prom_gallery_sides(g, 64), true);
        prom_solid_leave(s, old);
        prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_FABRIC, 0xa83a3a, 0.1f));
        float points[33][3], radii[33];
        int n = prom_gallery_steps(g, 48) < 32 ? prom_gallery_steps(g, 48) : 32;
        for (int i = 0; i <= n; i++) {
            float t = (float)i / (float)n;
            points[i][0] = a[0] + (b[0] - a[0]) * t;
            points[i][1] = 0.86f - 0.9f * t * (1 - t);
            points[i][2] = a[1] + (b[1] - a[1]) * t;
            radii[i] = 0.018f;
        }
        prom_solid_tube(s, (const float(*)[3])points, radii, n + 1, prom_gallery_sides(g, 32));
    }
}

void prom_gallery_make_radiator(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)v;
    (void)r;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLAIN, 0xf0ece2, 1));
    for (int i = 0; i < 11; i++) {
        float x = -0.50f + 0.10f * (float)i;
        if (g->options.detail == 1) {
            prom_solid_box(s, x - 0.035f, 0.10f, 0.09f, x + 0.035f, 0.69f, 0.17f,
                           PROM_FACE_ALL & ~(PROM_FACE_BOTTOM | PROM_FACE_BACK));
            continue;
        }
        const float rib[4][3] = {
            {x, 0.10f, 0.13f}, {x, 0.17f, 0.13f}, {x, 0.62f, 0.13f}, {x, 0.69f, 0.13f}};
        prom_solid_tube(s, rib, (const float[]){0.012f, 0.045f, 0.045f, 0.012f}, 4,
                        prom_gallery_sides(g, 32));
    }
    for (int k = 0; k < 4; k++)
        prom_solid_box(s, k & 1 ? 0.48f : -0.54f, 0, k & 2 ? 0.15f : 0.07f,
                       k & 1 ? 0.54f : -0.48f, 0.12f, k & 2 ? 0.19f : 0.11f, NO_BOTTOM);
    for (int k = 0; k < 2; k++)
        prom_solid_box(s, -0.54f, k ? 0.62f : 0.14f, 0.08f, 0.54f, k ? 0.66f : 0.18f, 0.18f,
                       PROM_FACE_ALL);
}

void prom_gallery_make_rug(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t tints[] = {0xffffff, 0xe8f0d8, 0xd8e0ff};
    const float x = 1.5f, z = 1.0f, y = 0.014f;
    (void)r;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_CARPET, tints[v % 3], 1));
    prom_solid_picture(s, (float[]){-x, y, z}, (float[]){x, y, z}, (float[]){x, y, -z},
                       (float[]){-x, y, -z});
    prom_solid_box(s, -x, 0, -z, x, y, z, PROM_FACE_SIDES);
}

void prom_gallery_make_globe(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    prom_solid_use(s, wood(g, v));
    for (int k = 0; k < 3; k++) {
        float a = 2 * PI * (float)k / 3;
        const float leg[3][3] = {{0.36f * cosf(a), 0, 0.36f * sinf(a)},
                                 {0.22f * cosf(a), 0.25f, 0.22f * sinf(a)},
                                 {0.36f * cosf(a), 0.72f, 0.36f * sinf(a)}};
        prom_solid_tube(s, leg, (const float[]){0.025f, 0.02f, 0.025f}, 3,
                        prom_gallery_sides(g, 32));
    }
    const float ring[][2] = {
        {0.36f, 0.70f}, {0.42f, 0.70f}, {0.42f, 0.74f}, {0.36f, 0.74f}, {0.36f, 0.70f}};
    prom_solid_lathe(s, ring, 5, prom_gallery_sides(g, 128), false);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_TERRAZZO, 0x9fc0d0, 1));
    prom_gallery_ball(s, 0, 0.74f, 0, 0.34f, 0.34f, 0.34f, prom_gallery_sides(g, 128), 0);
}
