// Sculptures: draped figures, busts and abstract forms.
#include "scenes/gallery_parts.h"

#include <cglm/cglm.h>
#include <math.h>

#define PI 3.14159265f

static prom_paint sculpture_paint(prom_gallery *g, uint32_t v)
{
    switch (v % 4) {
    case 1:
        return prom_gallery_paint(g, PROM_GALLERY_METAL, 0x8f7a4e, 0.6f); // bronze
    case 3:
        return prom_gallery_paint(g, PROM_GALLERY_METAL, 0xc98a63, 0.7f); // terracotta
    default:
        return prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xfaf6ee, 0.9f);
    }
}

// Interpolates a table of `count` values over [0,1], smoothly (Catmull and Rom 1974).
static float along(const float *table, int count, float t)
{
    float x = t * (float)(count - 1);
    int i = (int)x < count - 1 ? (int)x : count - 2;
    float f = x - (float)i, p1 = table[i], p2 = table[i + 1];
    float p0 = i ? table[i - 1] : p1, p3 = i + 2 < count ? table[i + 2] : p2;
    return p1 +
           0.5f * f *
               (p2 - p0 + f * (2 * p0 - 5 * p1 + 4 * p2 - p3 + f * (3 * (p1 - p2) + p3 - p0)));
}

// ---- heads

typedef struct head {
    float x, y, z, size, turn;
    float hair, beard, nose;
    uint32_t seed;
} head;

static float bump(const float d[3], float x, float y, float z, float sharp)
{
    float n = sqrtf(x * x + y * y + z * z);
    return expf(sharp * ((d[0] * x + d[1] * y + d[2] * z) / n - 1));
}

// A ball with a face to +z, pushed in and out at places on it.
static void head_point(const void *context, float u, float v, float p[3])
{
    const head *h = context;
    float a = 2 * PI * u, e = PI * (v - 0.5f), c = v <= 0 || v >= 1 ? 0 : cosf(e);
    float d[3] = {c * cosf(a), sinf(e), -c * sinf(a)};
    float side[3] = {fabsf(d[0]), d[1], d[2]};
    float r = 1 + 0.26f * h->nose * bump(d, 0, -0.14f, 1, 70) +
              0.10f * bump(d, 0, 0.08f, 1, 60) + 0.06f * bump(side, 0.30f, 0.26f, 1, 50) -
              0.11f * bump(side, 0.36f, 0.08f, 1, 60) +
              0.05f * bump(side, 0.36f, 0.06f, 1, 200) +
              0.05f * bump(side, 0.5f, -0.2f, 0.9f, 20) + 0.05f * bump(d, 0, -0.46f, 1, 150) -
              0.03f * bump(d, 0, -0.53f, 1, 300) + 0.05f * bump(d, 0, -0.60f, 1, 150) +
              0.13f * bump(d, 0, -0.95f, 0.8f, 24) + 0.10f * bump(side, 1, -0.05f, 0.0f, 90);
    float hair = prom_noise_step(0.05f, 0.30f, d[1] * 0.8f - d[2] * 0.75f + 0.05f);
    float curl = prom_noise_space(5 * d[0] + 7, 5 * d[1], 5 * d[2], h->seed);
    float wave = 0.5f * sinf(18 * (d[1] + 0.4f * curl));
    r += hair * h->hair * (0.5f + 0.5f * curl + 0.25f * wave);
    float chin = prom_noise_step(0.2f, 0.5f, -d[1] + 0.3f * d[2] - 0.25f) *
                 prom_noise_step(-0.3f, 0.1f, d[2]);
    r += chin * h->beard * (1 + curl);
    float x = 0.76f * r * d[0], z = 0.90f * r * d[2], ct = cosf(h->turn), st = sinf(h->turn);
    p[0] = h->x + h->size * (ct * x + st * z);
    p[1] = h->y + h->size * r * d[1];
    p[2] = h->z + h->size * (ct * z - st * x);
}

static void build_head(prom_solid *s, const head *h, int steps)
{
    prom_gallery_surface(s, head_point, h, steps, steps * 3 / 4, 1, 1, PROM_GALLERY_CLOSED_U);
}

static head random_head(prom_random *r)
{
    head h = {.turn = prom_random_between(r, -0.35f, 0.35f),
              .hair = prom_random_between(r, 0.10f, 0.30f),
              .nose = prom_random_between(r, 0.8f, 1.2f),
              .seed = (uint32_t)prom_random_next(r)};
    if (prom_random_unit(r) < 0.4f) h.beard = prom_random_between(r, 0.10f, 0.22f);
    return h;
}

// ---- figures

typedef struct figure {
    float scale, folds, twist, sway, depth;
    uint32_t seed;
} figure;

static void robe_point(const void *context, float u, float v, float p[3])
{
    static const float wide[] = {0.27f,  0.225f, 0.195f, 0.180f, 0.178f, 0.185f,
                                 0.168f, 0.140f, 0.165f, 0.200f, 0.185f, 0.060f};
    static const float deep[] = {0.24f,  0.200f, 0.175f, 0.160f, 0.150f, 0.150f,
                                 0.130f, 0.112f, 0.130f, 0.135f, 0.105f, 0.058f};
    const figure *f = context;
    float a = 2 * PI * u, c = cosf(a), s = -sinf(a);
    float loose = powf(1 - v, 0.6f);
    float warp = 2.2f * prom_noise_space(2 * c, 4 * v, 2 * s, f->seed);
    float fold = sinf(f->folds * a + f->twist * v + 2 * warp);
    fold = fold > 0 ? powf(fold, 0.7f) : -powf(-fold, 1.4f);
    // A girdle and an overfold.
    float belt = 0.012f * expf(-900 * (v - 0.63f) * (v - 0.63f)) * (1 + 0.4f * sinf(30 * a));
    float over = 0.022f * prom_noise_step(0.42f, 0.44f, v + 0.02f * sinf(5 * a + f->twist)) *
                 (1 - prom_noise_step(0.60f, 0.66f, v));
    float push = f->depth * loose * fold + 0.010f * (1 - loose) * fold * (v < 0.93f) +
                 0.010f * warp + over - belt;
    float knee =
        0.05f * expf(-60 * (v - 0.34f) * (v - 0.34f)) * bump((float[]){c, 0, s}, 0.5f, 0, 1, 6);
    float x = f->sway * sinf(2.4f * v + 0.3f);
    p[0] = f->scale * (x + c * (along(wide, 12, v) + push + knee));
    p[1] = f->scale * 1.44f * v;
    p[2] = f->scale * (s * (along(deep, 12, v) + push + knee));
}

// An arm from the shoulder through the elbow to the hand, as a smooth tube.
static void build_arm(prom_solid *s, const float joints[3][3], float scale, int steps,
                      int sides)
{
    float points[66][3], radii[66];
    static const float thick[] = {0.056f, 0.052f, 0.043f, 0.044f, 0.032f, 0.030f, 0.020f};
    int n = steps < 64 ? steps : 64;
    for (int i = 0; i <= n; i++) {
        float t = (float)i / (float)n;
        for (int k = 0; k < 3; k++) {
            // A bend with a round elbow.
            const float line[5] = {joints[0][k], 0.45f * joints[0][k] + 0.55f * joints[1][k],
                                   joints[1][k], 0.5f * (joints[1][k] + joints[2][k]),
                                   joints[2][k]};
            points[i][k] = scale * along(line, 5, t);
        }
        radii[i] = scale * along(thick, 7, t);
    }
    prom_solid_tube(s, (const float(*)[3])points, radii, n + 1, sides);
    prom_gallery_ball(s, points[n][0], points[n][1], points[n][2], 0.030f * scale,
                      0.045f * scale, 0.030f * scale, sides, 0);
}

static void build_arms(prom_solid *s, const figure *f, prom_random *r, int steps, int sides)
{
    static const float poses[][2][3] = {
        {{0.29f, 1.10f, 0.02f}, {0.25f, 0.86f, 0.12f}}, // hanging
        {{0.30f, 1.12f, 0.04f}, {0.20f, 1.10f, 0.27f}}, // held forth
        {{0.27f, 1.10f, 0.05f}, {0.05f, 1.16f, 0.20f}}, // over the breast
        {{0.38f, 1.42f, 0.06f}, {0.34f, 1.72f, 0.10f}}, // raised
        {{0.33f, 1.12f, -0.05f}, {0.21f, 0.92f, 0.0f}}, // on the hip
    };
    for (int side = -1; side <= 1; side += 2) {
        const float(*pose)[3] = poses[prom_random_below(r, 5)];
        float x = f->sway * sinf(2.4f), joints[3][3] = {{0.185f, 1.33f, 0}};
        memcpy(joints[1], pose, sizeof joints[1] * 2);
        for (int k = 0; k < 3; k++) joints[k][0] = x + (float)side * joints[k][0];
        build_arm(s, (const float(*)[3])joints, f->scale, steps, sides);
    }
}

// A figure of 1.7 m times `scale` on its base; `steps` around its robe.
static void build_figure(prom_solid *s, prom_random *r, float scale, int steps)
{
    figure f = {.scale = scale,
                .folds = 7 + (float)prom_random_below(r, 7),
                .twist = prom_random_between(r, -3, 3),
                .sway = prom_random_between(r, -0.05f, 0.05f),
                .depth = prom_random_between(r, 0.016f, 0.030f),
                .seed = (uint32_t)prom_random_next(r)};
    int sides = steps / 3 / 4 * 4;
    prom_gallery_surface(s, robe_point, &f, steps, steps, 1, 2, PROM_GALLERY_CLOSED_U);
    build_arms(s, &f, r, steps / 2, sides > 6 ? sides : 6);
    head h = random_head(r);
    float x = f.sway * sinf(2.7f) * scale;
    float neck[3][3] = {{x, 1.40f * scale, 0},
                        {x, 1.46f * scale, 0.01f * scale},
                        {x, 1.54f * scale, 0.015f * scale}};
    prom_solid_tube(s, (const float(*)[3])neck,
                    (const float[]){0.064f * scale, 0.055f * scale, 0.055f * scale}, 3,
                    sides > 8 ? sides : 8);
    h.x = x;
    h.y = 1.60f * scale;
    h.z = 0.02f * scale;
    h.size = 0.112f * scale;
    build_head(s, &h, steps * 2 / 3);
}

void prom_gallery_make_statue(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    const float base[][2] = {
        {0.36f, 0}, {0.36f, 0.06f}, {0.33f, 0.09f}, {0.33f, 0.12f}, {0, 0.12f}};
    prom_solid_use(s, sculpture_paint(g, v));
    prom_solid_lathe(s, base, 5, prom_gallery_sides(g, 128), false);
    prom_solid_frame old = prom_solid_enter(s, 0, 0.11f, 0, 0);
    build_figure(s, r, prom_random_between(r, 0.98f, 1.12f), prom_gallery_steps(g, 192));
    prom_solid_leave(s, old);
}

void prom_gallery_make_model(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    const float base[][2] = {{0.055f, 0}, {0.055f, 0.015f}, {0, 0.015f}};
    prom_solid_use(s, sculpture_paint(g, v + 1));
    prom_solid_lathe(s, base, 3, prom_gallery_sides(g, 64), false);
    prom_solid_frame old = prom_solid_enter(s, 0, 0.013f, 0, 0);
    build_figure(s, r, 0.155f, prom_gallery_steps(g, 96));
    prom_solid_leave(s, old);
}

// ---- busts

typedef struct chest {
    float folds, depth;
    uint32_t seed;
} chest;

static void chest_point(const void *context, float u, float v, float p[3])
{
    static const float wide[] = {0.07f,  0.10f, 0.16f,  0.215f, 0.245f,
                                 0.235f, 0.15f, 0.068f, 0.064f};
    static const float deep[] = {0.06f,  0.09f, 0.12f,  0.140f, 0.140f,
                                 0.125f, 0.09f, 0.066f, 0.064f};
    const chest *b = context;
    float a = 2 * PI * u, c = cosf(a), s = -sinf(a);
    float cloth = v < 0.72f ? 1 : 0;
    float fold =
        cloth * b->depth *
        sinf(b->folds * (v * 3 + c) + 3 * prom_noise_space(3 * c, 5 * v, 3 * s, b->seed));
    p[0] = c * (along(wide, 9, v) + fold);
    p[1] = 0.16f + 0.34f * v;
    p[2] = s * (along(deep, 9, v) + fold);
}

void prom_gallery_make_bust(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    const float socle[][2] = {{0.12f, 0},      {0.12f, 0.03f},  {0.09f, 0.05f}, {0.06f, 0.08f},
                              {0.055f, 0.13f}, {0.075f, 0.16f}, {0, 0.17f}};
    int steps = prom_gallery_steps(g, 144);
    chest b = {.folds = prom_random_between(r, 4, 9),
               .depth = prom_random_between(r, 0.004f, 0.010f),
               .seed = (uint32_t)prom_random_next(r)};
    head h = random_head(r);
    prom_solid_use(s, sculpture_paint(g, v));
    prom_solid_lathe(s, socle, 7, prom_gallery_sides(g, 128), true);
    prom_gallery_surface(s, chest_point, &b, steps, steps, 1, 1, PROM_GALLERY_CLOSED_U);
    h.y = 0.58f;
    h.z = 0.025f;
    h.size = 0.125f;
    build_head(s, &h, steps);
}

// ---- abstract forms

typedef struct form {
    float a[8];
    uint32_t seed;
} form;

// Gielis 2003, with equal scales.
static float superformula(float angle, float m, float n1, float n2, float n3)
{
    float t = m * angle / 4;
    float sum = powf(fabsf(cosf(t)), n2) + powf(fabsf(sinf(t)), n3);
    return powf(fmaxf(sum, 1e-4f), -1 / n1);
}

static void supershape(const void *context, float u, float v, float p[3])
{
    const form *f = context;
    float a = 2 * PI * u, e = PI * (v - 0.5f);
    float r1 = superformula(a, f->a[0], f->a[1], f->a[2], f->a[3]);
    float r2 = superformula(e, f->a[4], f->a[5], f->a[6], f->a[7]);
    float c = v <= 0 || v >= 1 ? 0 : cosf(e);
    p[0] = 0.36f * r1 * r2 * c * cosf(a);
    p[1] = 0.55f + 0.5f * r2 * sinf(e);
    p[2] = -0.36f * r1 * r2 * c * sinf(a);
}

static void knot_line(const form *f, float t, float p[3])
{
    float a = 2 * PI * t, r = 0.26f + 0.12f * cosf(f->a[1] * a);
    p[0] = r * cosf(f->a[0] * a);
    p[1] = 0.50f + 0.24f * sinf(f->a[1] * a) + 0.10f * sinf(f->a[0] * a);
    p[2] = r * sinf(f->a[0] * a);
}

static void knot(const void *context, float u, float v, float p[3])
{
    const form *f = context;
    vec3 q, next, along_line, side, over;
    knot_line(f, v, q);
    knot_line(f, v + 0.002f, next);
    glm_vec3_sub(next, q, along_line);
    glm_vec3_normalize(along_line);
    glm_vec3_cross((vec3){q[0], 0.3f, q[2]}, along_line, side);
    glm_vec3_normalize(side);
    glm_vec3_cross(along_line, side, over);
    float a = 2 * PI * u, r = f->a[2];
    for (int k = 0; k < 3; k++) p[k] = q[k] + r * (side[k] * cosf(a) + over[k] * sinf(a));
}

// A column that turns and breathes.
static void twisted(const void *context, float u, float v, float p[3])
{
    const form *f = context;
    float a = 2 * PI * u, turn = f->a[0] * v;
    float r = (0.15f + 0.07f * sinf(PI * v * f->a[1])) * superformula(a, f->a[2], 6, 6, 6);
    if (v >= 1) r = 0;
    p[0] = r * cosf(a + turn) + 0.05f * sinf(3 * v * f->a[3]);
    p[1] = 1.25f * v;
    p[2] = -r * sinf(a + turn);
}

static void pebble(const void *context, float u, float v, float p[3])
{
    const form *f = context;
    float a = 2 * PI * u, e = PI * (v - 0.5f), c = v <= 0 || v >= 1 ? 0 : cosf(e);
    float d[3] = {c * cosf(a), sinf(e), -c * sinf(a)};
    float r = 1 + f->a[3] * prom_noise_space(2.2f * d[0], 2.2f * d[1], 2.2f * d[2], f->seed) +
              0.3f * f->a[3] * prom_noise_space(7 * d[0], 7 * d[1], 7 * d[2], f->seed + 5);
    p[0] = f->a[0] + f->a[1] * r * d[0];
    p[1] = f->a[2] + f->a[1] * f->a[4] * r * d[1];
    p[2] = f->a[1] * r * d[2];
}

static void build_pebbles(prom_gallery *g, prom_solid *s, prom_random *r)
{
    float y = 0;
    for (int i = 0; i < 4; i++) {
        float size = 0.33f - 0.065f * (float)i, flat = prom_random_between(r, 0.55f, 0.85f);
        form f = {.a = {prom_random_between(r, -0.06f, 0.06f), size, y + 0.94f * size * flat,
                        0.25f, flat},
                  .seed = (uint32_t)prom_random_next(r)};
        int steps = prom_gallery_steps(g, 160);
        prom_gallery_surface(s, pebble, &f, steps, steps / 2, 1, 1, PROM_GALLERY_CLOSED_U);
        y += 1.80f * size * flat;
    }
}

void prom_gallery_make_abstract(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t tints[] = {0xc9a24e, 0xb8c0c4, 0x3f5f8a,
                                     0xb5483a, 0xf4efe4, 0x4a4d50};
    int steps = prom_gallery_steps(g, 224);
    form f = {.seed = (uint32_t)prom_random_next(r)};
    prom_solid_use(s, prom_gallery_paint(g, v % 2 ? PROM_GALLERY_METAL : PROM_GALLERY_MARBLE,
                                         tints[prom_random_below(r, 6)], 0.8f));
    switch (v % 4) {
    case 0: {
        const float shape[8] = {3 + (float)prom_random_below(r, 6),
                                prom_random_between(r, 1, 4),
                                prom_random_between(r, 2, 8),
                                prom_random_between(r, 2, 8),
                                2 + (float)prom_random_below(r, 4),
                                2.5f,
                                3,
                                3};
        memcpy(f.a, shape, sizeof shape);
        prom_gallery_surface(s, supershape, &f, steps, steps, 1, 1, PROM_GALLERY_CLOSED_U);
        break;
    }
    case 1:
        f.a[0] = 2;
        f.a[1] = 3 + 2 * (float)prom_random_below(r, 2);
        f.a[2] = prom_random_between(r, 0.045f, 0.07f);
        prom_gallery_surface(s, knot, &f, prom_gallery_sides(g, 64), steps * 3, 1, 8,
                             PROM_GALLERY_CLOSED_U | PROM_GALLERY_CLOSED_V);
        break;
    case 2:
        f.a[0] = prom_random_between(r, 2, 7);
        f.a[1] = prom_random_between(r, 2, 5);
        f.a[2] = 3 + (float)prom_random_below(r, 4);
        f.a[3] = prom_random_between(r, 0.5f, 2);
        prom_gallery_surface(s, twisted, &f, steps, steps, 1, 2, PROM_GALLERY_CLOSED_U);
        break;
    default:
        build_pebbles(g, s, r);
    }
}
