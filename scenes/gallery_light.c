// Lamps, which hang from their origin, stand or hang on a wall.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f

static prom_paint brass(prom_gallery *g)
{
    return prom_gallery_paint(g, PROM_GALLERY_METAL, 0xe0b860, 0.4f);
}

static prom_paint light(prom_gallery *g)
{
    return prom_gallery_paint(g, PROM_GALLERY_PLAIN, 0xfff4d2, 1);
}

// An eight-sided drop of glass.
static void build_drop(prom_solid *s, float x, float y, float z, float size)
{
    float top[3] = {x, y, z}, low[3] = {x, y - 2.4f * size, z}, ring[4][3];
    for (int i = 0; i < 4; i++) {
        ring[i][0] = x + size * 0.6f * (i == 0 ? 1.0f : i == 2 ? -1.0f : 0);
        ring[i][1] = y - 1.5f * size;
        ring[i][2] = z + size * 0.6f * (i == 3 ? 1.0f : i == 1 ? -1.0f : 0);
    }
    for (int i = 0; i < 4; i++) {
        prom_solid_flat_triangle(s, ring[i], ring[(i + 1) % 4], top);
        prom_solid_flat_triangle(s, ring[(i + 1) % 4], ring[i], low);
    }
}

static void build_candle(prom_gallery *g, prom_solid *s, float x, float y, float z)
{
    const float cup[][2] = {{0.008f, -0.03f}, {0.05f, 0}, {0.05f, 0.012f}, {0.014f, 0.014f}};
    prom_solid_frame old = prom_solid_enter(s, x, y, z, 0);
    prom_solid_use(s, brass(g));
    prom_solid_lathe(s, cup, 4, prom_gallery_sides(g, 32), true);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLAIN, 0xf6f0e0, 1));
    const float wax[2][3] = {{0, 0, 0}, {0, 0.10f, 0}};
    prom_solid_tube(s, wax, (const float[]){0.013f, 0.012f}, 2, prom_gallery_sides(g, 32));
    prom_solid_use(s, light(g));
    prom_gallery_ball(s, 0, 0.135f, 0, 0.016f, 0.038f, 0.016f, prom_gallery_sides(g, 32),
                      PROM_GALLERY_LIT);
    prom_solid_leave(s, old);
}

static void build_ring(prom_gallery *g, prom_solid *s, int arms, float reach, float y,
                       float phase)
{
    int n = prom_gallery_steps(g, 48) < 24 ? prom_gallery_steps(g, 48) : 24;
    for (int i = 0; i < arms; i++) {
        float a = phase + 2 * PI * (float)i / (float)arms, points[25][3], radii[25];
        for (int k = 0; k <= n; k++) {
            float t = (float)k / (float)n, out = 0.05f + (reach - 0.05f) * t;
            points[k][0] = out * cosf(a);
            points[k][1] = y - 0.14f * sinf(PI * t * 1.15f) + 0.05f * t;
            points[k][2] = out * sinf(a);
            radii[k] = 0.013f - 0.004f * t;
        }
        prom_solid_use(s, brass(g));
        prom_solid_tube(s, (const float(*)[3])points, radii, n + 1, prom_gallery_sides(g, 32));
        build_candle(g, s, points[n][0], points[n][1] + 0.03f, points[n][2]);
        prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLAIN, 0xe8f2f6, 1));
        int drops = g->options.detail == 1 ? 1 : 2 << (g->options.detail - 1);
        for (int k = 0; k < drops; k++) {
            float t = (float)(k + 1) / (float)drops;
            const float *p = points[(int)(t * (float)n)];
            build_drop(s, p[0], p[1] - 0.01f, p[2], 0.022f);
        }
    }
}

void prom_gallery_make_chandelier(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    const float body[][2] = {
        {0.005f, -1.62f}, {0.05f, -1.57f}, {0.03f, -1.50f}, {0.10f, -1.40f}, {0.12f, -1.30f},
        {0.05f, -1.18f},  {0.03f, -1.05f}, {0.07f, -0.95f}, {0.03f, -0.82f}, {0.012f, -0.70f},
        {0.010f, -0.06f}, {0.09f, -0.03f}, {0.10f, 0}};
    int arms = v % 2 ? 8 : 12;
    prom_solid_use(s, brass(g));
    prom_solid_lathe(s, body, 13, prom_gallery_sides(g, 64), true);
    build_ring(g, s, arms, 0.62f, -1.25f, 0);
    if (v % 3 != 1) build_ring(g, s, arms / 2, 0.36f, -0.92f, 0.26f);
    if (g->options.detail == 1) return;
    // Strings of drops from the crown to the arms.
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_PLAIN, 0xe8f2f6, 1));
    int beads = 3 << g->options.detail;
    for (int i = 0; i < arms; i++) {
        float a = 2 * PI * ((float)i + 0.5f) / (float)arms;
        for (int k = 1; k < beads; k++) {
            float t = (float)k / (float)beads, out = 0.04f + 0.46f * t;
            build_drop(s, out * cosf(a), -0.75f - 0.55f * t - 0.10f * sinf(PI * t),
                       out * sinf(a), 0.016f);
        }
    }
}

// A ball of milk glass on a long rod.
void prom_gallery_make_pendant(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)r;
    float drop = v % 2 ? 0.9f : 1.3f;
    const float rod[2][3] = {{0, -drop, 0}, {0, 0, 0}};
    const float cap[][2] = {{0.05f, -drop - 0.04f},
                            {0.10f, -drop - 0.02f},
                            {0.04f, -drop + 0.05f},
                            {0.012f, -drop + 0.09f}};
    prom_solid_use(s, brass(g));
    prom_solid_tube(s, rod, (const float[]){0.010f, 0.010f}, 2, prom_gallery_sides(g, 32));
    prom_solid_lathe(s, cap, 4, prom_gallery_sides(g, 64), true);
    prom_solid_use(s, light(g));
    prom_gallery_ball(s, 0, -drop - 0.20f, 0, 0.19f, 0.18f, 0.19f, prom_gallery_sides(g, 96),
                      PROM_GALLERY_LIT);
}

void prom_gallery_make_sconce(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)v;
    (void)r;
    prom_solid_use(s, brass(g));
    prom_gallery_ball(s, 0, 0, 0.02f, 0.06f, 0.16f, 0.025f, prom_gallery_sides(g, 64), 0);
    for (int k = -1; k <= 1; k += 2) {
        float f = (float)k;
        const float arm[5][3] = {{0, -0.02f, 0.03f},
                                 {0.04f * f, -0.08f, 0.09f},
                                 {0.10f * f, -0.09f, 0.13f},
                                 {0.15f * f, -0.04f, 0.14f},
                                 {0.16f * f, 0.03f, 0.14f}};
        prom_solid_use(s, brass(g));
        prom_solid_tube(s, arm, (const float[]){0.012f, 0.011f, 0.010f, 0.009f, 0.009f}, 5,
                        prom_gallery_sides(g, 32));
        build_candle(g, s, 0.16f * f, 0.05f, 0.14f);
    }
}

void prom_gallery_make_lamp(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t shades[] = {0xf6e2b8, 0xf0d0b0, 0xf8f0dc};
    const float foot[][2] = {
        {0.17f, 0}, {0.17f, 0.02f}, {0.05f, 0.05f}, {0.016f, 0.10f}, {0.016f, 1.40f}};
    const float shade[][2] = {{0.26f, 1.36f}, {0.16f, 1.70f}};
    const float inside[][2] = {{0.155f, 1.70f}, {0.255f, 1.36f}};
    (void)r;
    prom_solid_use(s, brass(g));
    prom_solid_lathe(s, foot, 5, prom_gallery_sides(g, 64), true);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_FABRIC, shades[v % 3], 0.3f));
    prom_solid_lathe(s, shade, 2, prom_gallery_sides(g, 96), true);
    prom_solid_lathe(s, inside, 2, prom_gallery_sides(g, 96), true);
    prom_solid_use(s, light(g));
    prom_gallery_ball(s, 0, 1.48f, 0, 0.05f, 0.07f, 0.05f, prom_gallery_sides(g, 48),
                      PROM_GALLERY_LIT);
}
