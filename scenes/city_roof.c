#include "scenes/city_parts.h"

#include <cglm/cglm.h>
#include <math.h>

#define THICKNESS 0.16f
#define EAVES 0.35f

// ---- the covering of a slope

// A slope from its eaves (a left, b right, seen from outside) to its upper edge (c right, d
// left; c = d for a triangle), cut into courses of tiles.
typedef struct slope {
    vec3 a, b, c, d, normal, across; // across: unit, along the eaves
    int rows, columns;
    float step, wave; // heights of the courses' edges and of the tiles' waves
} slope;

static void slope_point(const slope *s, float u, float v, float height, vec3 p)
{
    vec3 low, high;
    glm_vec3_lerp((float *)s->a, (float *)s->b, u, low);
    glm_vec3_lerp((float *)s->d, (float *)s->c, u, high);
    glm_vec3_lerp(low, high, v, p);
    glm_vec3_muladds((float *)s->normal, height, p);
}

static uint32_t slope_vertex(prom_solid *shape, const slope *s, float u, float v, float height,
                             const float normal[3])
{
    vec3 p, down;
    slope_point(s, u, v, height, p);
    glm_vec3_cross((float *)s->across, (float *)s->normal, down);
    return prom_solid_vertex(shape, p, normal,
                             glm_vec3_dot(p, (float *)s->across) / shape->repeat,
                             glm_vec3_dot(p, down) / shape->repeat);
}

// One course: its face, and the edge that it shows to below.
static void build_course(prom_solid *shape, const slope *s, int row)
{
    float v0 = (float)row / (float)s->rows, v1 = (float)(row + 1) / (float)s->rows;
    vec3 down;
    glm_vec3_cross((float *)s->across, (float *)s->normal, down);
    uint32_t before[4] = {0};
    for (int i = 0; i <= s->columns; i++) {
        float u = (float)i / (float)s->columns, wave = s->wave * (i % 2 ? -1.0f : 1.0f);
        vec3 tilted;
        glm_vec3_copy((float *)s->normal, tilted);
        uint32_t now[4] = {slope_vertex(shape, s, u, v0, s->step + wave, tilted),
                           slope_vertex(shape, s, u, v1, wave, tilted)};
        if (s->step > 0) {
            now[2] = slope_vertex(shape, s, u, v0, wave, down);
            now[3] = slope_vertex(shape, s, u, v0, s->step + wave, down);
        }
        for (int k = 0; i && k < (s->step > 0 ? 4 : 2); k += 2) {
            prom_solid_triangle(shape, before[k], now[k], now[k + 1]);
            // A triangular slope's last course comes to a point.
            bool point = k == 0 && row + 1 == s->rows &&
                         glm_vec3_distance((float *)s->c, (float *)s->d) < 1e-3f;
            if (!point) prom_solid_triangle(shape, before[k], now[k + 1], before[k + 1]);
        }
        for (int k = 0; k < 4; k++) before[k] = now[k];
    }
}

// Covers a slope and closes it below and at its edges (all four, by `edges` in the order ab,
// bc, cd, da).
static void build_slope(prom_solid *shape, const prom_roof *roof, const float a[3],
                        const float b[3], const float c[3], const float d[3], int edges)
{
    slope s = {.rows = 1, .columns = 1};
    glm_vec3_copy((float *)a, s.a);
    glm_vec3_copy((float *)b, s.b);
    glm_vec3_copy((float *)c, s.c);
    glm_vec3_copy((float *)d, s.d);
    vec3 ab, ac, mid_low, mid_high;
    glm_vec3_sub(s.b, s.a, ab);
    glm_vec3_sub(s.c, s.a, ac);
    glm_vec3_cross(ab, ac, s.normal);
    glm_vec3_normalize(s.normal);
    glm_vec3_normalize_to(ab, s.across);
    glm_vec3_lerp(s.a, s.b, 0.5f, mid_low);
    glm_vec3_lerp(s.d, s.c, 0.5f, mid_high);
    float length = glm_vec3_distance(mid_low, mid_high), width = glm_vec3_norm(ab);
    if (roof->detail >= 3) {
        s.rows = (int)fmaxf(2, roundf(length / (roof->detail == 3 ? 0.36f : 0.27f)));
        s.columns = (int)fmaxf(2, roundf(width / (roof->detail == 3 ? 0.62f : 0.24f)));
        s.step = 0.035f;
        s.wave = roof->detail == 3 ? 0.006f : 0.012f;
    }
    prom_solid_use(shape, roof->cover);
    for (int row = 0; row < s.rows; row++) build_course(shape, &s, row);
    prom_solid_use(shape, roof->trim);
    const float *top[4] = {s.a, s.b, s.c, s.d};
    vec3 under[4];
    for (int i = 0; i < 4; i++) {
        glm_vec3_copy((float *)top[i], under[i]);
        glm_vec3_muladds(s.normal, -THICKNESS, under[i]);
    }
    for (int i = 0; i < 4; i++)
        if (edges >> i & 1)
            prom_solid_quad(shape, under[i], under[(i + 1) % 4], top[(i + 1) % 4], top[i]);
    if (edges & 1) prom_solid_quad(shape, under[1], under[0], under[3], under[2]);
}

// ---- chimneys, dormers, gutters

static void build_chimney(prom_solid *shape, const prom_roof *roof, float x, float z,
                          float foot, float top)
{
    float w = 0.42f, d = 0.32f;
    prom_solid_use(shape, roof->brick);
    prom_solid_box(shape, x - w, foot, z - d, x + w, top, z + d, PROM_FACE_SIDES);
    prom_solid_use(shape, roof->trim);
    prom_solid_box(shape, x - w - 0.07f, top, z - d - 0.07f, x + w + 0.07f, top + 0.12f,
                   z + d + 0.07f, PROM_FACE_ALL);
    if (roof->detail < 2) return;
    static const float pot[5][2] = {
        {0.14f, 0}, {0.12f, 0.3f}, {0.15f, 0.32f}, {0.15f, 0.38f}, {0, 0.34f}};
    int sides = roof->detail == 2 ? 7 : roof->detail == 3 ? 10 : 16;
    prom_solid_use(shape, roof->cover);
    for (int i = -1; i <= 1; i += 2) {
        prom_solid_frame old = prom_solid_enter(shape, x + 0.2f * (float)i, top + 0.12f, z, 0);
        prom_solid_lathe(shape, pot, 5, sides, false);
        prom_solid_leave(shape, old);
    }
}

// A gabled dormer on a slope that rises towards -z: its surface is at y = eaves_y + rise *
// (eaves_z - z). The front stands `inset` behind the eaves, its gable is `ridge` high.
static void build_dormer(prom_city *city, prom_solid *shape, const prom_roof *roof, float x,
                         const float eaves[2], float rise, float inset, float ridge,
                         prom_random *random)
{
    float half = 0.78f, tall = 1.45f, z = eaves[1] - inset;
    float foot = eaves[0] + rise * inset, back = z - tall / rise,
          peak = z - (tall + ridge) / rise;
    prom_facade f = roof->window;
    const float floors[2] = {0, tall};
    const float opening[4] = {half - 0.5f, 0.25f, half + 0.5f, tall - 0.12f};
    prom_solid_frame old = prom_solid_enter(shape, x - half, foot, z, 0);
    f.width = 2 * half;
    f.storeys = f.bays = 1;
    f.floors = floors;
    f.wall = roof->wall;
    prom_solid_use(shape, roof->wall);
    // The front is a frame around the window; the pane lies behind it.
    prom_solid_quad(shape, (float[]){0, 0, 0}, (float[]){2 * half, 0, 0},
                    (float[]){2 * half, opening[1], 0}, (float[]){0, opening[1], 0});
    prom_solid_quad(shape, (float[]){0, opening[1], 0}, (float[]){opening[0], opening[1], 0},
                    (float[]){opening[0], opening[3], 0}, (float[]){0, opening[3], 0});
    prom_solid_quad(shape, (float[]){opening[2], opening[1], 0},
                    (float[]){2 * half, opening[1], 0}, (float[]){2 * half, opening[3], 0},
                    (float[]){opening[2], opening[3], 0});
    prom_solid_quad(shape, (float[]){0, opening[3], 0}, (float[]){2 * half, opening[3], 0},
                    (float[]){2 * half, tall, 0}, (float[]){0, tall, 0});
    prom_solid_flat_triangle(shape, (float[]){0, tall, 0}, (float[]){2 * half, tall, 0},
                             (float[]){half, tall + ridge, 0});
    prom_city_build_window(city, shape, &f, opening, random);
    prom_solid_leave(shape, old);
    prom_solid_use(shape, roof->wall);
    float l = x - half, r = x + half, y = foot + tall;
    prom_solid_flat_triangle(shape, (float[]){r, foot, z}, (float[]){r, y, back},
                             (float[]){r, y, z});
    prom_solid_flat_triangle(shape, (float[]){l, foot, z}, (float[]){l, y, z},
                             (float[]){l, y, back});
    prom_roof small = *roof;
    small.detail = roof->detail > 3 ? 3 : roof->detail - 1;
    float over = 0.15f, slant = ridge / half, out = z + 0.2f, e = y - over * slant;
    // The eaves run along z: on the right side from the back to the front as seen from outside.
    build_slope(shape, &small, (float[]){r + over, e, out}, (float[]){r + over, e, back + 0.1f},
                (float[]){x, y + ridge, peak}, (float[]){x, y + ridge, out}, 1 | 8);
    build_slope(shape, &small, (float[]){l - over, e, back + 0.1f}, (float[]){l - over, e, out},
                (float[]){x, y + ridge, out}, (float[]){x, y + ridge, peak}, 1 | 2);
}

static void build_gutter(prom_solid *shape, const prom_roof *roof, float x0, float x1, float y,
                         float z)
{
    static const float profile[6][2] = {{0, 0},          {-0.06f, 0.02f}, {-0.08f, 0.07f},
                                        {-0.05f, 0.12f}, {0.02f, 0.13f},  {0.02f, 0}};
    if (roof->detail < 2) return;
    prom_solid_frame old = prom_solid_enter(shape, 0, y, z, 0);
    prom_solid_use(shape, roof->window.frame);
    prom_solid_moulding(shape, profile, 6, x0, x1);
    prom_solid_leave(shape, old);
}

// ---- whole roofs

static void gable_walls(prom_solid *shape, const prom_roof *r, const float (*line)[2],
                        int points)
{
    // `line`: (z, y) from front to back, over both side walls.
    prom_solid_use(shape, r->wall);
    for (int i = 1; i + 1 < points; i++) {
        const float *a = line[0], *b = line[i], *c = line[i + 1];
        float x = r->width / 2;
        prom_solid_flat_triangle(shape, (float[]){x, a[1], a[0]}, (float[]){x, c[1], c[0]},
                                 (float[]){x, b[1], b[0]});
        prom_solid_flat_triangle(shape, (float[]){-x, a[1], a[0]}, (float[]){-x, b[1], b[0]},
                                 (float[]){-x, c[1], c[0]});
    }
}

static void street_gable(prom_city *city, prom_solid *shape, const prom_roof *r,
                         prom_random *random)
{
    float x = r->width / 2 + r->side_overhang, top = r->base + r->pitch * r->depth / 2;
    float mid = -r->depth / 2, low = r->base - EAVES * r->pitch, lift = THICKNESS;
    const float line[3][2] = {{0, r->base}, {mid, top}, {-r->depth, r->base}};
    gable_walls(shape, r, line, 3);
    build_slope(shape, r, (float[]){-x, low + lift, EAVES}, (float[]){x, low + lift, EAVES},
                (float[]){x, top + lift, mid}, (float[]){-x, top + lift, mid}, 1 | 2 | 8);
    build_slope(shape, r, (float[]){x, low + lift, -r->depth - EAVES},
                (float[]){-x, low + lift, -r->depth - EAVES}, (float[]){-x, top + lift, mid},
                (float[]){x, top + lift, mid}, 1 | 2 | 8);
    prom_solid_use(shape, r->cover);
    prom_solid_box(shape, -x, top + lift - 0.05f, mid - 0.14f, x, top + lift + 0.07f,
                   mid + 0.14f, PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    build_gutter(shape, r, -r->width / 2, r->width / 2, low + lift - 0.05f, EAVES);
    for (uint32_t i = 0; i < r->dormers; i++)
        build_dormer(city, shape, r, r->width * (((float)i + 0.5f) / (float)r->dormers - 0.5f),
                     (float[]){r->base + lift, 0}, r->pitch, 0.55f, 0.55f, random);
    for (uint32_t i = 0; i < r->chimneys; i++)
        build_chimney(shape, r, (i ? -1.0f : 1.0f) * (r->width / 2 - 0.7f), mid - 0.5f,
                      top - 1.0f, top + 1.0f);
}

static void build_steps(prom_solid *shape, const prom_roof *r, float top)
{
    const int steps = 5;
    float low = r->base - 0.02f;
    for (int i = 0; i < steps; i++) {
        float high = r->base + (top - r->base) * (float)(i + 1) / (float)steps + 0.25f;
        float x = r->width / 2 * (1 - (float)i / (float)steps);
        prom_solid_use(shape, r->wall);
        prom_solid_box(shape, -x, low, -0.3f, x, high, 0.02f, PROM_FACE_SIDES);
        prom_solid_use(shape, r->trim);
        prom_solid_box(shape, -x - 0.04f, high, -0.34f, x + 0.04f, high + 0.08f, 0.06f,
                       PROM_FACE_ALL);
        low = high;
    }
}

static void front_gable(prom_city *city, prom_solid *shape, const prom_roof *r,
                        prom_random *random)
{
    bool stepped = r->kind == PROM_ROOF_STEPPED_GABLE;
    float x = r->width / 2 + r->side_overhang, rise = r->pitch, half = r->width / 2;
    float top = r->base + rise * half, low = r->base - rise * r->side_overhang, lift = 0.1f;
    float front = stepped ? -0.1f : 0.3f, back = -r->depth - 0.15f;
    prom_solid_use(shape, r->wall);
    prom_solid_flat_triangle(shape, (float[]){-half, r->base, 0}, (float[]){half, r->base, 0},
                             (float[]){0, top, 0});
    prom_solid_flat_triangle(shape, (float[]){half, r->base, -r->depth},
                             (float[]){-half, r->base, -r->depth},
                             (float[]){0, top, -r->depth});
    build_slope(shape, r, (float[]){x, low + lift, front}, (float[]){x, low + lift, back},
                (float[]){0, top + lift, back}, (float[]){0, top + lift, front}, 1 | 2 | 8);
    build_slope(shape, r, (float[]){-x, low + lift, back}, (float[]){-x, low + lift, front},
                (float[]){0, top + lift, front}, (float[]){0, top + lift, back}, 1 | 2 | 8);
    if (stepped) build_steps(shape, r, top);
    // A window in the gable, before the wall: a box with a pane.
    float y = r->base + 0.12f * (top - r->base), h = fminf(1.5f, 0.45f * (top - r->base));
    float z = stepped ? 0.02f : 0;
    prom_facade f = r->window;
    f.wall = r->trim;
    prom_solid_frame old = prom_solid_enter(shape, 0, y, z + 0.16f, 0);
    prom_solid_use(shape, r->trim);
    prom_solid_box(shape, -0.6f, -0.1f, -0.16f, 0.6f, 0, 0.03f, PROM_FACE_NO_BACK);
    prom_solid_box(shape, -0.6f, h, -0.16f, 0.6f, h + 0.12f, 0.03f, PROM_FACE_NO_BACK);
    prom_solid_box(shape, -0.6f, 0, -0.16f, -0.48f, h, 0, PROM_FACE_SIDES);
    prom_solid_box(shape, 0.48f, 0, -0.16f, 0.6f, h, 0, PROM_FACE_SIDES);
    prom_city_build_window(city, shape, &f, (float[]){-0.48f, 0, 0.48f, h}, random);
    prom_solid_leave(shape, old);
    for (uint32_t i = 0; i < r->chimneys; i++)
        build_chimney(shape, r, (i ? -0.22f : 0.22f) * r->width, -0.7f * r->depth,
                      r->base + 0.3f * (top - r->base), top + 0.7f);
}

static void hip(prom_city *city, prom_solid *shape, const prom_roof *r, prom_random *random)
{
    float x = r->width / 2 + EAVES, f = EAVES, b = -r->depth - EAVES;
    float run = fminf(r->width, r->depth) / 2 + EAVES,
          low = r->base - EAVES * r->pitch + THICKNESS;
    float top = low + r->pitch * run;
    // The ridge: along x on a wide house, along z on a deep one.
    float *p = (float[]){-x + run, top, f - run}, *q = (float[]){x - run, top, f - run};
    float *s = (float[]){x - run, top, b + run}, *t = (float[]){-x + run, top, b + run};
    float *fl = (float[]){-x, low, f}, *fr = (float[]){x, low, f}, *br = (float[]){x, low, b},
          *bl = (float[]){-x, low, b};
    build_slope(shape, r, fl, fr, q, p, 1);
    build_slope(shape, r, fr, br, s, q, 1);
    build_slope(shape, r, br, bl, t, s, 1);
    build_slope(shape, r, bl, fl, p, t, 1);
    build_gutter(shape, r, -x, x, low - 0.05f, f);
    for (uint32_t i = 0; i < r->dormers && r->width > r->depth; i++)
        build_dormer(city, shape, r,
                     0.5f * r->width * (((float)i + 0.5f) / (float)r->dormers - 0.5f),
                     (float[]){r->base + THICKNESS, 0}, r->pitch, 0.55f, 0.55f, random);
    for (uint32_t i = 0; i < r->chimneys; i++)
        build_chimney(shape, r, (i ? -0.2f : 0.2f) * r->width, -r->depth / 2 - 0.6f, top - 1.2f,
                      top + 0.8f);
}

static void mansard(prom_city *city, prom_solid *shape, const prom_roof *r, prom_random *random)
{
    float x = r->width / 2 + r->side_overhang, steep = 2.6f, knee = 2.3f, in = knee / steep;
    float y = r->base + knee, mid = -r->depth / 2, top = y + 0.35f * (r->depth / 2 - in);
    float lift = 0.1f, over = 0.25f, low = r->base - 0.05f;
    const float line[5][2] = {
        {0, r->base}, {-in, y}, {mid, top}, {-r->depth + in, y}, {-r->depth, r->base}};
    gable_walls(shape, r, line, 5);
    build_slope(shape, r, (float[]){-x, low + lift, over}, (float[]){x, low + lift, over},
                (float[]){x, y + lift, -in + 0.06f}, (float[]){-x, y + lift, -in + 0.06f},
                1 | 2 | 8);
    build_slope(shape, r, (float[]){x, low + lift, -r->depth - over},
                (float[]){-x, low + lift, -r->depth - over},
                (float[]){-x, y + lift, -r->depth + in - 0.06f},
                (float[]){x, y + lift, -r->depth + in - 0.06f}, 1 | 2 | 8);
    build_slope(shape, r, (float[]){-x, y + lift - 0.02f, -in + 0.18f},
                (float[]){x, y + lift - 0.02f, -in + 0.18f}, (float[]){x, top + lift, mid},
                (float[]){-x, top + lift, mid}, 1 | 2 | 8);
    build_slope(shape, r, (float[]){x, y + lift - 0.02f, -r->depth + in - 0.18f},
                (float[]){-x, y + lift - 0.02f, -r->depth + in - 0.18f},
                (float[]){-x, top + lift, mid}, (float[]){x, top + lift, mid}, 1 | 2 | 8);
    build_gutter(shape, r, -r->width / 2, r->width / 2, low + lift - 0.02f, over);
    for (uint32_t i = 0; i < r->dormers; i++)
        build_dormer(city, shape, r, r->width * (((float)i + 0.5f) / (float)r->dormers - 0.5f),
                     (float[]){low + lift, over}, (y - low) / (over + in - 0.06f), 0.2f, 0.35f,
                     random);
    for (uint32_t i = 0; i < r->chimneys; i++)
        build_chimney(shape, r, (i ? -1.0f : 1.0f) * (r->width / 2 - 0.7f), mid, y, top + 1.1f);
}

static void flat(prom_city *city, prom_solid *shape, const prom_roof *r)
{
    float x = r->width / 2, b = -r->depth, y = r->base + 0.05f, h = r->base + 0.75f, t = 0.25f;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_GRAVEL, 0xc8c8c8, 2));
    prom_solid_floor(shape, -x, b, x, 0, y, 4);
    prom_solid_use(shape, r->wall);
    prom_solid_box(shape, -x, r->base, -t, x, h, 0, PROM_FACE_FRONT | PROM_FACE_BACK);
    prom_solid_box(shape, -x, r->base, b, x, h, b + t, PROM_FACE_FRONT | PROM_FACE_BACK);
    prom_solid_box(shape, -x, r->base, b, -x + t, h, 0, PROM_FACE_LEFT | PROM_FACE_RIGHT);
    prom_solid_box(shape, x - t, r->base, b, x, h, 0, PROM_FACE_LEFT | PROM_FACE_RIGHT);
    prom_solid_use(shape, r->trim);
    float o = 0.06f;
    prom_solid_box(shape, -x, h, -t - o, x, h + 0.1f, o, PROM_FACE_ALL);
    prom_solid_box(shape, -x, h, b - o, x, h + 0.1f, b + t + o, PROM_FACE_ALL);
    prom_solid_box(shape, -x, h, b + t + o, -x + t + o, h + 0.1f, -t - o, PROM_FACE_ALL);
    prom_solid_box(shape, x - t - o, h, b + t + o, x, h + 0.1f, -t - o, PROM_FACE_ALL);
    prom_solid_use(shape, r->wall);
    prom_solid_box(shape, -1.6f, y, b / 2 - 2, 1.2f, y + 2.3f, b / 2 + 1, PROM_FACE_SIDES);
    prom_solid_use(shape, r->trim);
    prom_solid_box(shape, -1.75f, y + 2.3f, b / 2 - 2.15f, 1.35f, y + 2.45f, b / 2 + 1.15f,
                   PROM_FACE_ALL);
    for (uint32_t i = 0; i < r->chimneys; i++)
        build_chimney(shape, r, (i ? -1.0f : 1.0f) * (x - 0.8f), 0.75f * b, y, y + 1.6f);
}

void prom_city_build_roof(prom_city *city, prom_solid *shape, const prom_roof *roof,
                          prom_random *random)
{
    switch (roof->kind) {
    case PROM_ROOF_FRONT_GABLE:
    case PROM_ROOF_STEPPED_GABLE:
        front_gable(city, shape, roof, random);
        break;
    case PROM_ROOF_HIP:
        hip(city, shape, roof, random);
        break;
    case PROM_ROOF_MANSARD:
        mansard(city, shape, roof, random);
        break;
    case PROM_ROOF_FLAT:
        flat(city, shape, roof);
        break;
    case PROM_ROOF_GABLE:
    default:
        street_gable(city, shape, roof, random);
        break;
    }
}
