// Cars of several makes, and bicycles.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f

// ---- cars: sections along the body, from the back to the front

static void build_wheel(prom_city *city, prom_solid *shape, float x, float y, float z,
                        float radius, bool left)
{
    // A lathe stands upright: this one lies on its side, so its rings are made here.
    int sides = prom_city_sides(city, 14);
    float outer = left ? -0.1f : 0.1f;
    prom_solid_use(shape, prom_city_plain(city, 0x1d1e20));
    for (int part = 0; part < 2; part++) {
        if (part) prom_solid_use(shape, prom_city_plain(city, 0xb4b8bc));
        float r = part ? 0.58f * radius : radius, dx = part ? outer * 1.05f : outer;
        const float out[3] = {left ? -1.0f : 1.0f, 0, 0};
        uint32_t hub = prom_solid_vertex(shape, (float[]){x + dx, y, z}, out, 0.5f, 0.5f);
        for (int i = 0; i <= sides; i++) {
            float a = 6.2831853f * (float)(i % sides) / (float)sides, c = cosf(a), s = sinf(a);
            prom_solid_vertex(shape, (float[]){x + dx, y + r * c, z + r * s}, out,
                              0.5f + 0.5f * c, 0.5f + 0.5f * s);
        }
        for (uint32_t i = 1; i <= (uint32_t)sides; i++) {
            if (left)
                prom_solid_triangle(shape, hub, hub + i + 1, hub + i);
            else
                prom_solid_triangle(shape, hub, hub + i, hub + i + 1);
        }
    }
    prom_solid_use(shape, prom_city_plain(city, 0x1d1e20));
    prom_solid_box(shape, x - outer * 0.9f - 0.01f, y - 0.6f * radius, z - 0.6f * radius,
                   x - outer * 0.9f + 0.01f, y + 0.6f * radius, z + 0.6f * radius,
                   left ? PROM_FACE_RIGHT : PROM_FACE_LEFT);
    const float line[2][3] = {{x - 0.1f, y, z}, {x + 0.1f, y, z}};
    prom_solid_tube(shape, line, (const float[2]){radius, radius}, 2, sides);
}

typedef struct car_section {
    float z, low, high, half, top_half;
} car_section;

static void build_shell(prom_solid *shape, const car_section *sections, int count)
{
    for (int i = 0; i + 1 < count; i++) {
        const car_section *a = &sections[i],
                          *b = &sections[i + 1]; // from the back to the front
        for (int side = -1; side <= 1; side += 2) {
            float f = (float)side;
            float p[4][3] = {{f * a->half, a->low, a->z},
                             {f * b->half, b->low, b->z},
                             {f * b->top_half, b->high, b->z},
                             {f * a->top_half, a->high, a->z}};
            if (side < 0)
                prom_solid_quad(shape, p[0], p[1], p[2], p[3]);
            else
                prom_solid_quad(shape, p[1], p[0], p[3], p[2]);
        }
        prom_solid_quad(shape, (float[]){-b->top_half, b->high, b->z},
                        (float[]){b->top_half, b->high, b->z},
                        (float[]){a->top_half, a->high, a->z},
                        (float[]){-a->top_half, a->high, a->z});
    }
}

static void build_end(prom_solid *shape, const car_section *s, bool front)
{
    float l = front ? -1.0f : 1.0f;
    prom_solid_quad(
        shape, (float[]){l * s->half, s->low, s->z}, (float[]){-l * s->half, s->low, s->z},
        (float[]){-l * s->top_half, s->high, s->z}, (float[]){l * s->top_half, s->high, s->z});
}

// What tells makes apart. Sections: z, lower edge, upper edge, half width there and on top.
typedef struct make {
    car_section body[7], cabin[5];
    int cabin_sections;
    float wheel, front_axle, rear_axle;
    bool van; // its back is closed: the body's colour up to the roof
} make;

static const make makes[] = {
    {// a saloon
     {{-2.18f, 0.42f, 0.74f, 0.74f, 0.70f},
      {-2.05f, 0.28f, 0.93f, 0.82f, 0.76f},
      {-1.30f, 0.24f, 0.97f, 0.86f, 0.80f},
      {0.70f, 0.24f, 0.93f, 0.86f, 0.80f},
      {1.70f, 0.26f, 0.80f, 0.83f, 0.75f},
      {2.05f, 0.32f, 0.70f, 0.77f, 0.69f},
      {2.16f, 0.42f, 0.60f, 0.70f, 0.64f}},
     {{-1.55f, 0.93f, 0.97f, 0.78f, 0.74f},
      {-0.95f, 0.93f, 1.38f, 0.79f, 0.63f},
      {-0.40f, 0.93f, 1.43f, 0.80f, 0.64f},
      {0.05f, 0.93f, 1.41f, 0.79f, 0.63f},
      {0.85f, 0.91f, 0.95f, 0.78f, 0.73f}},
     5,
     0.32f,
     1.32f,
     -1.30f,
     false},
    {// a hatchback
     {{-1.72f, 0.40f, 0.84f, 0.72f, 0.68f},
      {-1.66f, 0.28f, 0.98f, 0.79f, 0.73f},
      {-1.10f, 0.24f, 1.00f, 0.83f, 0.77f},
      {0.60f, 0.24f, 0.97f, 0.83f, 0.77f},
      {1.45f, 0.26f, 0.84f, 0.80f, 0.72f},
      {1.78f, 0.32f, 0.72f, 0.74f, 0.66f},
      {1.86f, 0.42f, 0.60f, 0.68f, 0.62f}},
     {{-1.62f, 0.94f, 1.00f, 0.74f, 0.70f},
      {-1.35f, 0.94f, 1.42f, 0.75f, 0.60f},
      {-0.40f, 0.94f, 1.50f, 0.77f, 0.62f},
      {0.15f, 0.94f, 1.47f, 0.77f, 0.61f},
      {0.95f, 0.92f, 0.97f, 0.76f, 0.71f}},
     5,
     0.31f,
     1.15f,
     -1.10f,
     false},
    {// an estate
     {{-2.25f, 0.42f, 0.80f, 0.76f, 0.72f},
      {-2.18f, 0.28f, 0.97f, 0.83f, 0.77f},
      {-1.30f, 0.24f, 0.99f, 0.87f, 0.81f},
      {0.70f, 0.24f, 0.95f, 0.87f, 0.81f},
      {1.70f, 0.26f, 0.82f, 0.84f, 0.76f},
      {2.08f, 0.32f, 0.72f, 0.78f, 0.70f},
      {2.18f, 0.42f, 0.60f, 0.71f, 0.65f}},
     {{-2.12f, 0.93f, 0.99f, 0.78f, 0.74f},
      {-1.80f, 0.93f, 1.42f, 0.79f, 0.63f},
      {-0.50f, 0.93f, 1.48f, 0.80f, 0.65f},
      {0.10f, 0.93f, 1.45f, 0.79f, 0.64f},
      {0.92f, 0.91f, 0.97f, 0.78f, 0.73f}},
     5,
     0.32f,
     1.34f,
     -1.32f,
     false},
    {// a tall one for rough roads
     {{-2.15f, 0.52f, 0.95f, 0.80f, 0.76f},
      {-2.08f, 0.40f, 1.12f, 0.87f, 0.81f},
      {-1.30f, 0.36f, 1.14f, 0.91f, 0.85f},
      {0.75f, 0.36f, 1.12f, 0.91f, 0.85f},
      {1.75f, 0.38f, 1.02f, 0.88f, 0.80f},
      {2.06f, 0.44f, 0.90f, 0.82f, 0.74f},
      {2.14f, 0.54f, 0.76f, 0.76f, 0.70f}},
     {{-2.05f, 1.08f, 1.14f, 0.82f, 0.78f},
      {-1.78f, 1.08f, 1.66f, 0.83f, 0.68f},
      {-0.50f, 1.08f, 1.72f, 0.84f, 0.70f},
      {0.20f, 1.08f, 1.69f, 0.83f, 0.69f},
      {0.90f, 1.06f, 1.12f, 0.82f, 0.77f}},
     5,
     0.38f,
     1.35f,
     -1.33f,
     false},
    {// a van
     {{-2.40f, 0.42f, 1.90f, 0.88f, 0.80f},
      {-2.36f, 0.32f, 2.02f, 0.90f, 0.82f},
      {-1.30f, 0.30f, 2.06f, 0.92f, 0.84f},
      {0.80f, 0.30f, 2.04f, 0.92f, 0.83f},
      {0.95f, 0.30f, 1.22f, 0.92f, 0.88f},
      {2.15f, 0.34f, 0.98f, 0.88f, 0.80f},
      {2.32f, 0.44f, 0.72f, 0.80f, 0.74f}},
     {{0.55f, 1.16f, 1.92f, 0.905f, 0.835f},
      {0.82f, 1.16f, 1.96f, 0.905f, 0.80f},
      {1.00f, 1.16f, 1.80f, 0.88f, 0.76f},
      {1.62f, 1.08f, 1.12f, 0.85f, 0.80f},
      {1.66f, 1.05f, 1.06f, 0.85f, 0.80f}},
     5,
     0.34f,
     1.52f,
     -1.45f,
     true},
};
#define MAKES (sizeof makes / sizeof *makes)

// The roof over the cabin's middle sections, and the pillars between the windows.
static void build_car_roof(prom_solid *shape, const make *m)
{
    const car_section *c = m->cabin;
    const car_section roof[] = {
        {c[1].z - 0.02f, c[1].high - 0.03f, c[1].high + 0.02f, c[1].top_half + 0.03f,
         c[1].top_half},
        {c[2].z, c[2].high - 0.04f, c[2].high + 0.04f, c[2].top_half + 0.03f, c[2].top_half},
        {c[3].z + 0.03f, c[3].high - 0.03f, c[3].high + 0.02f, c[3].top_half + 0.03f,
         c[3].top_half}};
    build_shell(shape, roof, 3);
    build_end(shape, &roof[0], false);
    build_end(shape, &roof[2], true);
    for (int i = 1; i <= 3; i++) {
        for (int side = -1; side <= 1; side += 2) {
            float f = (float)side, w = 0.045f, out = 0.012f;
            float low[3] = {f * (c[i].half + out), c[i].low, c[i].z};
            float high[3] = {f * (c[i].top_half + out), c[i].high, c[i].z};
            float *a = (float[]){low[0], low[1], low[2] + f * w},
                  *b = (float[]){low[0], low[1], low[2] - f * w},
                  *d = (float[]){high[0], high[1], high[2] - f * w},
                  *e = (float[]){high[0], high[1], high[2] + f * w};
            prom_solid_quad(shape, a, b, d, e);
        }
    }
}

static void build_trimmings(prom_city *city, prom_solid *shape, const make *m)
{
    const car_section *back = &m->body[0], *front = &m->body[6];
    float y = back->low, z0 = back->z, z1 = front->z, under = m->body[2].low + 0.02f;
    prom_solid_use(shape, prom_city_plain(city, 0x26282a));
    prom_solid_quad(shape, (float[]){-0.78f, under, z0 + 0.1f},
                    (float[]){0.78f, under, z0 + 0.1f}, (float[]){0.78f, under, z1 - 0.15f},
                    (float[]){-0.78f, under, z1 - 0.15f});
    prom_solid_box(shape, -0.76f, y - 0.1f, z0 - 0.06f, 0.76f, y + 0.08f, z0 + 0.2f,
                   PROM_FACE_ALL);
    prom_solid_box(shape, -0.74f, front->low - 0.1f, z1 - 0.2f, 0.74f, front->low + 0.06f,
                   z1 + 0.06f, PROM_FACE_ALL);
    for (int i = -1; i <= 1; i += 2) { // mirrors
        float x = (float)i * (m->cabin[3].half + 0.10f), z = m->cabin[3].z + 0.42f;
        prom_solid_box(shape, x - 0.09f, m->cabin[3].low + 0.04f, z - 0.05f, x + 0.09f,
                       m->cabin[3].low + 0.2f, z + 0.05f, PROM_FACE_ALL);
    }
    prom_solid_use(shape, prom_city_plain(city, 0xeceae2)); // plates
    prom_solid_box(shape, -0.25f, y + 0.1f, z0 - 0.03f, 0.25f, y + 0.21f, z0 + 0.1f,
                   PROM_FACE_ALL);
    prom_solid_box(shape, -0.25f, front->low + 0.0f, z1, 0.25f, front->low + 0.10f, z1 + 0.07f,
                   PROM_FACE_ALL);
    for (int i = -1; i <= 1; i += 2) {
        float x = 0.56f * (float)i, high = front->high - 0.03f;
        prom_solid_use(shape, prom_city_plain(city, 0xf0eedc));
        prom_solid_box(shape, x - 0.13f, high - 0.12f, z1 - 0.25f, x + 0.13f, high, z1 + 0.01f,
                       PROM_FACE_ALL);
        prom_solid_use(shape, prom_city_plain(city, 0x8c1c18));
        prom_solid_box(shape, x - 0.12f, y + 0.16f, z0 - 0.02f, x + 0.12f, y + 0.3f, z0 + 0.2f,
                       PROM_FACE_ALL);
    }
}

void prom_city_build_car(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    static const uint32_t paints[] = {0xd9d9d4, 0x9c2f2b, 0x2d4f7c, 0x3f4446, 0x8f969a,
                                      0x5f7f62, 0xc9a548, 0x22262c, 0x7fa3b5, 0x6b3c58,
                                      0xe6e2d4, 0x274a3c, 0xb2643a};
    // Different primes, so that makes and colours mix.
    const make *m = &makes[which->number % MAKES];
    prom_solid_use(shape, prom_city_plain(city, paints[(which->number * 5 + 2) % 13]));
    build_shell(shape, m->body, 7);
    build_end(shape, &m->body[0], false);
    build_end(shape, &m->body[6], true);
    if (!m->van) build_car_roof(shape, m);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WINDOW_DARK, 0x9aa4ac, 1.5f));
    build_shell(shape, m->cabin, m->cabin_sections);
    build_trimmings(city, shape, m);
    for (int i = -1; i <= 1; i += 2) {
        float x = (float)i * (m->body[2].half - 0.08f);
        build_wheel(city, shape, x, m->wheel, m->front_axle, m->wheel, i < 0);
        build_wheel(city, shape, x, m->wheel, m->rear_axle, m->wheel, i < 0);
    }
}

// ---- bicycles: along z

static void build_rim(prom_city *city, prom_solid *shape, float z)
{
    float line[33][3], radii[33], r = 0.33f;
    int n = prom_city_sides(city, 14);
    if (n > 32) n = 32;
    for (int i = 0; i <= n; i++) {
        float a = 2 * PI * (float)(i % n) / (float)n;
        line[i][0] = 0;
        line[i][1] = 0.345f + r * cosf(a);
        line[i][2] = z + r * sinf(a);
        radii[i] = 0.018f;
    }
    prom_solid_use(shape, prom_city_plain(city, 0x222426));
    prom_solid_tube(shape, (const float(*)[3])line, radii, n + 1, 3);
    prom_solid_use(shape, prom_city_plain(city, 0xb8bcc0));
    for (int i = 0; i < 4; i++) { // spokes
        float a = PI * (float)i / 4, dy = 0.32f * cosf(a), dz = 0.32f * sinf(a);
        const float spoke[2][3] = {{0, 0.345f - dy, z - dz}, {0, 0.345f + dy, z + dz}};
        prom_solid_tube(shape, spoke, (const float[]){0.005f, 0.005f}, 2, 3);
    }
}

static void build_bicycle(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const uint32_t paints[] = {0x1f4a3c, 0xb23a30, 0x2a3f6a, 0xc8c4b8};
    static const float frame[][2][3] = {
        {{0, 0.345f, -0.52f}, {0, 0.30f, -0.06f}}, {{0, 0.30f, -0.06f}, {0, 0.88f, -0.22f}},
        {{0, 0.345f, -0.52f}, {0, 0.78f, -0.19f}}, {{0, 0.30f, -0.06f}, {0, 0.76f, 0.34f}},
        {{0, 0.80f, -0.20f}, {0, 0.82f, 0.33f}},   {{0, 0.345f, 0.52f}, {0, 0.98f, 0.28f}},
        {{0, 0.30f, -0.06f}, {0.16f, 0, -0.10f}}};
    prom_solid_use(shape, prom_city_plain(city, paints[number % 4]));
    for (size_t i = 0; i < sizeof frame / sizeof *frame; i++)
        prom_solid_tube(shape, frame[i], (const float[]){0.018f, 0.018f}, 2,
                        prom_city_sides(city, 4));
    build_rim(city, shape, -0.52f);
    build_rim(city, shape, 0.52f);
    prom_solid_use(shape, prom_city_plain(city, 0x26282a));
    prom_solid_box(shape, -0.06f, 0.88f, -0.34f, 0.06f, 0.93f, -0.10f, PROM_FACE_ALL);
    const float bar[4][3] = {{-0.27f, 1.0f, 0.18f},
                             {-0.16f, 1.02f, 0.27f},
                             {0.16f, 1.02f, 0.27f},
                             {0.27f, 1.0f, 0.18f}};
    static const float radii[4] = {0.016f, 0.016f, 0.016f, 0.016f};
    prom_solid_tube(shape, bar, radii, 4, prom_city_sides(city, 4));
}

// A rack with some bicycles in it.
void prom_city_build_bicycle(prom_city *city, const prom_city_prototype *which,
                             prom_solid *shape)
{
    prom_random random = prom_random_stream(city->options.seed, 240, which->number);
    for (int i = 0; i < 4; i++) {
        float x = 0.7f * ((float)i - 1.5f), y = 0.62f;
        const float loop[5][3] = {{x + 0.2f, 0, 0.5f},
                                  {x + 0.2f, 0.8f * y, 0.5f},
                                  {x + 0.2f, y, 0.62f},
                                  {x + 0.2f, 0.8f * y, 0.74f},
                                  {x + 0.2f, 0, 0.74f}};
        static const float radii[5] = {0.022f, 0.022f, 0.022f, 0.022f, 0.022f};
        prom_solid_use(shape, prom_city_plain(city, 0x8f979b));
        prom_solid_tube(shape, loop, radii, 5, prom_city_sides(city, 5));
        if ((which->number + (uint32_t)i) % 4 == 3) continue; // this one is out
        prom_solid_frame old =
            prom_solid_enter(shape, x, 0, prom_random_between(&random, -0.08f, 0.08f),
                             prom_random_between(&random, -0.1f, 0.1f));
        build_bicycle(city, shape, which->number + 3 * (uint32_t)i);
        prom_solid_leave(shape, old);
    }
}
