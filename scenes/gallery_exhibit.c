// Exhibits, their vitrines and stands.
#include "scenes/gallery_parts.h"

#include <cglm/cglm.h>
#include <math.h>

#define PI 3.14159265f

// ---- vessels

typedef struct vessel {
    float radius[6]; // along the wall, from the foot to the lip
    float height, wall;
} vessel;

static float wall_radius(const vessel *b, float t)
{
    float x = t * 5;
    int i = (int)x < 5 ? (int)x : 4;
    float f = x - (float)i;
    f = f * f * (3 - 2 * f);
    return b->radius[i] + (b->radius[i + 1] - b->radius[i]) * f;
}

// Up outside, over the lip, down inside.
static void vessel_point(const void *context, float u, float v, float p[3])
{
    const vessel *b = context;
    float a = 2 * PI * u, t, r;
    if (v < 0.72f) {
        t = v / 0.72f;
        r = wall_radius(b, t);
    } else {
        float in = (v - 0.72f) / 0.28f;
        t = 1 - in * 0.85f;
        r = fmaxf(wall_radius(b, t) - b->wall * fminf(1, 8 * in), 0);
    }
    if (v <= 0) r *= 0.96f;
    p[0] = r * cosf(a);
    p[1] = b->height * t;
    p[2] = -r * sinf(a);
}

static prom_paint glaze(prom_gallery *g, prom_random *r)
{
    static const uint32_t tints[] = {0x8fb8a8, 0xb5603a, 0x5a7fa8,
                                     0xd8c9a4, 0x6f8a4a, 0xa85a6a};
    switch (prom_random_below(r, 5)) {
    case 0:
        return prom_gallery_paint(g, PROM_GALLERY_BLUE_WHITE, 0xffffff, 1);
    case 1:
        return prom_gallery_paint(g, PROM_GALLERY_RED_FIGURE, 0xffffff, 1);
    case 2:
        return prom_gallery_paint(g, PROM_GALLERY_METAL, 0xd2a85a, 1);
    default:
        return prom_gallery_paint(g, PROM_GALLERY_CERAMIC, tints[prom_random_below(r, 6)], 1);
    }
}

static void build_handle(prom_gallery *g, prom_solid *s, const vessel *b, float side)
{
    float points[17][3], radii[17];
    int n = prom_gallery_steps(g, 48) < 16 ? prom_gallery_steps(g, 48) : 16;
    for (int i = 0; i <= n; i++) {
        float t = (float)i / (float)n, at = 0.52f + 0.40f * t;
        float out = wall_radius(b, at) - 0.004f + 0.05f * sinf(PI * t);
        points[i][0] = side * out;
        points[i][1] = b->height * at;
        points[i][2] = 0;
        radii[i] = 0.007f;
    }
    prom_solid_tube(s, (const float(*)[3])points, radii, n + 1, prom_gallery_sides(g, 32));
}

void prom_gallery_make_vase(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    vessel b = {.radius = {0.045f, prom_random_between(r, 0.05f, 0.11f),
                           prom_random_between(r, 0.08f, 0.12f),
                           prom_random_between(r, 0.05f, 0.10f),
                           prom_random_between(r, 0.025f, 0.05f),
                           prom_random_between(r, 0.035f, 0.07f)},
                .height = prom_random_between(r, 0.22f, 0.34f),
                .wall = 0.006f};
    prom_solid_use(s, glaze(g, r));
    prom_gallery_surface(s, vessel_point, &b, prom_gallery_sides(g, 128),
                         prom_gallery_steps(g, 112), 2, 1, PROM_GALLERY_CLOSED_U);
    for (int k = -1; k <= 1 && v % 3 == 1; k += 2) build_handle(g, s, &b, (float)k);
}

void prom_gallery_make_bowl(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    (void)v;
    float wide = prom_random_between(r, 0.09f, 0.15f);
    vessel b = {.radius = {0.045f, 0.05f, 0.55f * wide, 0.8f * wide, 0.95f * wide, wide},
                .height = prom_random_between(r, 0.06f, 0.12f),
                .wall = 0.006f};
    prom_solid_use(s, glaze(g, r));
    prom_gallery_surface(s, vessel_point, &b, prom_gallery_sides(g, 128),
                         prom_gallery_steps(g, 80), 2, 1, PROM_GALLERY_CLOSED_U);
}

// ---- nature

// A six-sided prism with a point, from `foot` along `axis`.
static void build_prism(prom_solid *s, const float foot[3], const float axis[3], float radius,
                        float length)
{
    vec3 side, over, ring[2][6], tip;
    glm_vec3_cross(fabsf(axis[0]) < 0.9f ? (vec3){1, 0, 0} : (vec3){0, 0, 1}, (float *)axis,
                   side);
    glm_vec3_normalize(side);
    glm_vec3_cross((float *)axis, side, over);
    for (int i = 0; i < 6; i++) {
        float a = PI / 3 * (float)i;
        for (int k = 0; k < 3; k++) {
            float round = radius * (side[k] * cosf(a) + over[k] * sinf(a));
            ring[0][i][k] = foot[k] + round;
            ring[1][i][k] = foot[k] + round + 0.8f * length * axis[k];
        }
    }
    for (int k = 0; k < 3; k++) tip[k] = foot[k] + length * axis[k];
    for (int i = 0; i < 6; i++) {
        int j = (i + 1) % 6;
        prom_solid_quad(s, ring[0][i], ring[0][j], ring[1][j], ring[1][i]);
        prom_solid_flat_triangle(s, ring[1][i], ring[1][j], tip);
    }
}

void prom_gallery_make_crystal(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t tints[] = {0xb48ad0, 0x9fd0c8, 0xf0eaf4, 0xe8b870, 0x8ab0e0};
    int count = prom_gallery_steps(g, 96);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_TERRAZZO, 0x8a8478, 0.3f));
    prom_gallery_ball(s, 0, 0.015f, 0, 0.10f, 0.03f, 0.085f, prom_gallery_sides(g, 64), 0);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_CERAMIC, tints[v % 5], 0.2f));
    for (int i = 0; i < count; i++) {
        float a = 2 * PI * prom_random_unit(r), out = sqrtf(prom_random_unit(r));
        vec3 axis = {0.55f * out * cosf(a), 1, 0.55f * out * sinf(a)};
        float foot[3] = {0.075f * out * cosf(a), 0.02f, 0.06f * out * sinf(a)};
        glm_vec3_normalize(axis);
        build_prism(s, foot, axis, prom_random_between(r, 0.007f, 0.020f),
                    prom_random_between(r, 0.05f, 0.17f) * (1.15f - 0.6f * out));
    }
}

typedef struct shell {
    float turns, tall, ribs;
} shell;

// A tube that winds up and narrows.
static void shell_point(const void *context, float u, float v, float p[3])
{
    const shell *h = context;
    float w = expf(-0.42f * h->turns * v), a = 2 * PI * h->turns * v, b = -2 * PI * u;
    float rib = 1 + 0.05f * sinf(h->ribs * a), r = 0.055f * w * rib;
    float out = 0.062f * w + r * cosf(b);
    p[0] = out * cosf(a);
    p[1] = h->tall * (1 - w) + r * sinf(b) + 0.057f;
    p[2] = -out * sinf(a);
}

void prom_gallery_make_shell(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t tints[] = {0xf2dcc4, 0xe8b89a, 0xf4efe6, 0xd0a890};
    shell h = {.turns = prom_random_between(r, 3.5f, 5.5f),
               .tall = prom_random_between(r, 0.06f, 0.22f),
               .ribs = 6 + (float)prom_random_below(r, 10)};
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_STRIPES, tints[v % 4], 1));
    prom_gallery_surface(s, shell_point, &h, prom_gallery_sides(g, 64),
                         prom_gallery_steps(g, 448), 1, 6, PROM_GALLERY_CLOSED_U);
}

void prom_gallery_make_coins(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t metals[] = {0xe0b860, 0xc8ccd0, 0xb87f4a};
    const float coin[][2] = {
        {0.015f, 0}, {0.016f, 0.002f}, {0.0145f, 0.0035f}, {0.0125f, 0.0028f}, {0, 0.0032f}};
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_FABRIC, 0x7d2f3a, 0.1f));
    prom_solid_box(s, -0.14f, 0, -0.10f, 0.14f, 0.012f, 0.10f,
                   PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    for (int i = 0; i < 24; i++) {
        prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL,
                                             metals[(v + prom_random_below(r, 2)) % 3], 0.1f));
        prom_solid_frame old = prom_solid_enter(s, -0.11f + 0.044f * (float)(i % 6), 0.012f,
                                                -0.07f + 0.046f * (float)(i / 6), 0);
        prom_solid_lathe(s, coin, 5, prom_gallery_sides(g, 64), false);
        prom_solid_leave(s, old);
    }
}

// A face in relief, on a rod.
static void mask_point(const void *context, float u, float v, float p[3])
{
    const float *m = context;
    float x = 2 * u - 1, y = 2 * v - 1;
    // The square's rim is drawn into a round one.
    float px = x * sqrtf(1 - 0.5f * y * y), py = y * sqrtf(1 - 0.5f * x * x);
    float ax = fabsf(px), bulge = sqrtf(fmaxf(0, 1 - 0.85f * (px * px + py * py)));
    float eye = expf(-90 * ((ax - 0.36f) * (ax - 0.36f) + 2 * (py - 0.15f) * (py - 0.15f)));
    float nose = expf(-60 * px * px - 9 * (py + 0.02f) * (py + 0.02f));
    float mouth = expf(-14 * px * px - 220 * (py + 0.45f) * (py + 0.45f));
    float brow = expf(-20 * (ax - 0.36f) * (ax - 0.36f) - 160 * (py - 0.34f) * (py - 0.34f));
    p[0] = 0.085f * px * (1 + 0.12f * py);
    p[1] = 0.20f + 0.11f * py;
    p[2] =
        0.075f * bulge + m[0] * (0.028f * nose - 0.018f * eye + 0.012f * brow - 0.015f * mouth);
}

void prom_gallery_make_mask(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t tints[] = {0xe6bf62, 0x7fa890, 0xb07a4e, 0x5a4638};
    const float depth = prom_random_between(r, 0.8f, 1.4f);
    int steps = prom_gallery_steps(g, 144);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, tints[v % 4], 0.4f));
    prom_gallery_surface(s, mask_point, &depth, steps, steps, 1, 1, 0);
    // Its hollow back, so that it may be seen from behind.
    prom_gallery_ball(s, 0, 0.20f, 0.012f, 0.084f, 0.108f, 0.012f, prom_gallery_sides(g, 64),
                      0);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0x6a6660, 0.4f));
    prom_solid_box(s, -0.005f, 0.01f, 0.005f, 0.005f, 0.12f, 0.015f, PROM_FACE_SIDES);
    prom_solid_box(s, -0.05f, 0, -0.04f, 0.05f, 0.012f, 0.05f,
                   PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
}

// ---- stands

static void build_stand(prom_gallery *g, prom_solid *s, float half, float height)
{
    float foot = half + 0.05f;
    int sides = PROM_FACE_ALL & ~PROM_FACE_BOTTOM;
    prom_solid_box(s, -foot, 0, -foot, foot, 0.10f, foot, sides);
    prom_solid_box(s, -half, 0.10f, -half, half, height - 0.08f, half, PROM_FACE_SIDES);
    prom_solid_box(s, -foot, height - 0.08f, -foot, foot, height, foot, PROM_FACE_ALL);
    for (int k = 0; k < 4 && g->options.detail > 1;
         k++) { // a moulding under the top, a field on each face
        prom_solid_frame old = prom_solid_enter(s, 0, 0, 0, PI / 2 * (float)k);
        const float profile[][2] = {{height - 0.16f, half},
                                    {height - 0.14f, half + 0.015f},
                                    {height - 0.10f, half + 0.03f},
                                    {height - 0.08f, half + 0.03f}};
        prom_solid_moulding(s, profile, 4, -half, half);
        prom_solid_box(s, -half + 0.06f, 0.20f, half, half - 0.06f, height - 0.26f,
                       half + 0.012f, PROM_FACE_NO_BACK);
        prom_solid_leave(s, old);
    }
}

void prom_gallery_make_pedestal(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t tints[] = {0xe8ddca, 0x9a9088, 0xc8b49a, 0xf4f0e8};
    (void)r;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_MARBLE, tints[v % 4], 0.8f));
    build_stand(g, s, 0.20f, 1.0f);
}

void prom_gallery_make_plinth(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t tints[] = {0xe8ddca, 0x8f8a86, 0xc8b49a};
    (void)r;
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_MARBLE, tints[v % 3], 1.0f));
    build_stand(g, s, 0.42f, 0.5f);
}

// ---- vitrines

static void build_edges(prom_solid *s, float x, float z, float y0, float y1, float b)
{
    for (int k = 0; k < 4; k++) {
        float cx = k & 1 ? x - b : -x, cz = k & 2 ? z - b : -z;
        prom_solid_box(s, cx, y0, cz, cx + b, y1, cz + b, PROM_FACE_SIDES);
    }
    for (int k = 0; k < 2; k++) {
        float a = k ? z - b : -z, c = k ? x - b : -x;
        prom_solid_box(s, -x, y1 - b, a, x, y1, a + b, PROM_FACE_ALL);
        prom_solid_box(s, c, y1 - b, -z + b, c + b, y1, z - b, PROM_FACE_ALL);
    }
}

static void build_glass(prom_gallery *g, prom_solid *s, float x, float z, float y0, float y1)
{
    prom_solid_use(s, prom_gallery_glass(g));
    x -= 0.006f;
    z -= 0.006f;
    prom_solid_box(s, -x, y0, -z, x, y1 - 0.004f, z, PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
}

void prom_gallery_make_table_vitrine(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    static const uint32_t cloths[] = {0xd8d0c0, 0x9a4a48, 0x55707a, 0xe6e0d2};
    float x = 0.65f, z = 0.35f, top = PROM_GALLERY_TABLE_TOP;
    (void)r;
    prom_solid_use(s,
                   prom_gallery_paint(g, PROM_GALLERY_WOOD, v % 2 ? 0x9c6f48 : 0x7a5238, 1.0f));
    for (int k = 0; k < 4; k++) {
        const float leg[][2] = {
            {0.022f, 0}, {0.03f, 0.10f}, {0.024f, 0.16f}, {0.034f, 0.55f}, {0.04f, 0.66f}};
        prom_solid_frame old = prom_solid_enter(s, k & 1 ? x - 0.06f : 0.06f - x, 0,
                                                k & 2 ? z - 0.06f : 0.06f - z, 0);
        prom_solid_lathe(s, leg, 5, prom_gallery_sides(g, 48), true);
        prom_solid_leave(s, old);
    }
    prom_solid_box(s, -x, top - 0.20f, -z, x, top - 0.005f, z, PROM_FACE_ALL);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_FABRIC, cloths[v % 4], 0.2f));
    prom_solid_box(s, -x + 0.02f, top - 0.01f, -z + 0.02f, x - 0.02f, top, z - 0.02f,
                   PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0xc9a24e, 0.4f));
    build_edges(s, x, z, top, top + 0.42f, 0.014f);
    build_glass(g, s, x, z, top, top + 0.42f);
}

void prom_gallery_make_tall_vitrine(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r)
{
    float x = 0.46f, z = 0.32f, top = PROM_GALLERY_TALL_TOP, high = 1.95f,
          shelf = PROM_GALLERY_TALL_SHELF;
    (void)r;
    prom_solid_use(s, v % 2 ? prom_gallery_paint(g, PROM_GALLERY_WOOD, 0x7a5238, 1.0f)
                            : prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xe8e4dc, 1.0f));
    prom_solid_box(s, -x, 0, -z, x, top - 0.01f, z, PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    prom_solid_box(s, -x, high, -z, x, high + 0.12f, z, PROM_FACE_ALL);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_FABRIC, 0xd8d0c0, 0.2f));
    prom_solid_box(s, -x + 0.02f, top - 0.015f, -z + 0.02f, x - 0.02f, top, z - 0.02f,
                   PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_METAL, 0xc9a24e, 0.4f));
    build_edges(s, x, z, top, high, 0.016f);
    for (int k = 0; k < 2; k++) // what the shelf lies on
        prom_solid_box(s, k ? x - 0.03f : 0.016f - x, shelf - 0.02f, -z + 0.02f,
                       k ? x - 0.016f : 0.03f - x, shelf - 0.008f, z - 0.02f, PROM_FACE_ALL);
    prom_solid_use(s, prom_gallery_glass(g));
    prom_solid_box(s, -x + 0.02f, shelf - 0.008f, -z + 0.02f, x - 0.02f, shelf, z - 0.02f,
                   PROM_FACE_TOP | PROM_FACE_FRONT | PROM_FACE_BACK);
    build_glass(g, s, x, z, top, high);
}
