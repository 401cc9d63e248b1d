// What stands in the streets and squares: lamps, benches, cars, bins, fountains, stalls.
#include "scenes/city_parts.h"

#include <math.h>

static int sides_of(const prom_city *city, int at_two)
{
    static const float factor[5] = {1, 0.5f, 1, 1.6f, 2.5f};
    return (int)((float)at_two * factor[city->options.detail]);
}

static prom_paint paint(prom_city *city, uint32_t rgb)
{
    return prom_city_paint(city, PROM_CITY_PLAIN, rgb, 1);
}

// ---- lamps

static void build_lantern(prom_city *city, prom_solid *shape, float y)
{
    static const float cage[5][2] = {
        {0, 0}, {0.10f, 0}, {0.12f, 0.04f}, {0.17f, 0.40f}, {0.19f, 0.42f}};
    static const float hood[5][2] = {
        {0.24f, 0}, {0.20f, 0.06f}, {0.10f, 0.14f}, {0.03f, 0.18f}, {0, 0.28f}};
    int sides = sides_of(city, 6);
    prom_solid_frame old = prom_solid_enter(shape, 0, y, 0, 0);
    prom_solid_use(shape, paint(city, 0xf6e7b4));
    prom_solid_lathe(shape, cage, 5, sides, false);
    prom_solid_leave(shape, old);
    old = prom_solid_enter(shape, 0, y + 0.42f, 0, 0);
    prom_solid_use(shape, paint(city, 0x2c332f));
    prom_solid_lathe(shape, hood, 5, sides, false);
    prom_solid_leave(shape, old);
}

static void build_lamp(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const float post[13][2] = {
        {0.17f, 0},     {0.17f, 0.10f},  {0.13f, 0.14f},  {0.12f, 0.55f},  {0.09f, 0.65f},
        {0.10f, 0.75f}, {0.055f, 0.85f}, {0.045f, 2.90f}, {0.075f, 2.95f}, {0.075f, 3.02f},
        {0.04f, 3.08f}, {0.04f, 3.40f},  {0.08f, 3.46f}};
    prom_solid_use(shape, paint(city, 0x2c332f));
    prom_solid_lathe(shape, post, 13, sides_of(city, 9), true);
    if (number % 2 == 0) {
        build_lantern(city, shape, 3.45f);
        return;
    }
    // Two lanterns on a cross-bar.
    for (int i = -1; i <= 1; i += 2) {
        float arm[5][3], radii[5];
        for (int k = 0; k < 5; k++) {
            float t = (float)k / 4;
            arm[k][0] = (float)i * 0.5f * t;
            arm[k][1] = 3.05f + 0.4f * t * t;
            arm[k][2] = 0;
            radii[k] = 0.03f;
        }
        prom_solid_use(shape, paint(city, 0x2c332f));
        prom_solid_tube(shape, (const float(*)[3])arm, radii, 5, sides_of(city, 5));
        prom_solid_frame old = prom_solid_enter(shape, (float)i * 0.5f, 0, 0, 0);
        build_lantern(city, shape, 3.4f);
        prom_solid_leave(shape, old);
    }
}

// ---- seats, bins, stalls

static void build_bench(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const uint32_t woods[] = {0xa9794e, 0x7d5a3c, 0x5c7a58};
    int slats = sides_of(city, 5);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, woods[number % 3], 1));
    for (int i = 0; i < slats; i++) {
        float at = (float)i / (float)slats, w = 0.8f / (float)slats;
        float z = 0.25f - 0.45f * at, y = 0.52f + 0.42f * at;
        prom_solid_box(shape, -0.85f, 0.42f, z - 0.45f * w, 0.85f, 0.455f, z, PROM_FACE_ALL);
        prom_solid_box(shape, -0.85f, y, -0.24f - 0.08f * at, 0.85f, y + 0.42f * w,
                       -0.21f - 0.08f * at, PROM_FACE_ALL);
    }
    prom_solid_use(shape, paint(city, 0x33383a));
    for (int i = -1; i <= 1; i += 2) {
        float x = 0.68f * (float)i;
        prom_solid_box(shape, x - 0.03f, 0, 0.16f, x + 0.03f, 0.42f, 0.22f, PROM_FACE_ALL);
        prom_solid_box(shape, x - 0.03f, 0, -0.27f, x + 0.03f, 0.42f, -0.2f, PROM_FACE_ALL);
        prom_solid_box(shape, x - 0.03f, 0.37f, -0.2f, x + 0.03f, 0.42f, 0.25f, PROM_FACE_ALL);
        prom_solid_box(shape, x - 0.03f, 0.42f, -0.33f, x + 0.03f, 0.92f, -0.27f,
                       PROM_FACE_ALL);
        prom_solid_box(shape, x - 0.04f, 0.62f, -0.27f, x + 0.04f, 0.66f, 0.22f, PROM_FACE_ALL);
    }
}

static void build_bin(prom_city *city, prom_solid *shape)
{
    static const float can[5][2] = {
        {0.2f, 0.08f}, {0.25f, 0.78f}, {0.28f, 0.80f}, {0.28f, 0.86f}, {0.2f, 0.87f}};
    static const float inside[3][2] = {{0.2f, 0.87f}, {0.19f, 0.6f}, {0, 0.6f}};
    int sides = sides_of(city, 12);
    prom_solid_use(shape, paint(city, 0x3d5a46));
    prom_solid_lathe(shape, can, 5, sides, false);
    prom_solid_use(shape, paint(city, 0x1c1f1d));
    prom_solid_lathe(shape, inside, 3, sides, false);
    prom_solid_lathe(shape, (const float[2][2]){{0.16f, 0}, {0.16f, 0.1f}}, 2, sides, true);
}

static void build_stall(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const uint32_t cloths[] = {0xffffff, 0xb8d0e8, 0xd0e0b0, 0xf0d0a0};
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0x9a7850, 1));
    prom_solid_box(shape, -1.4f, 0.78f, -0.5f, 1.4f, 0.84f, 0.6f, PROM_FACE_ALL);
    prom_solid_box(shape, -1.35f, 0, 0.5f, 1.35f, 0.78f, 0.55f, PROM_FACE_ALL);
    for (int i = 0; i < 4; i++) {
        float x = i & 1 ? 1.35f : -1.35f, z = i & 2 ? 0.9f : -0.9f;
        prom_solid_box(shape, x - 0.04f, 0, z - 0.04f, x + 0.04f, 2.2f, z + 0.04f,
                       PROM_FACE_SIDES);
    }
    int crates = sides_of(city, 6);
    for (int i = 0; i < crates; i++) {
        float x = -1.25f + 2.5f * (float)i / (float)crates, w = 2.2f / (float)crates;
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0xc8a070, 1));
        prom_solid_box(shape, x, 0.84f, 0, x + w, 1.0f, 0.5f, PROM_FACE_SIDES);
        static const uint32_t goods[] = {0xc8442e, 0xe0a030, 0x6a9a3a, 0xd8c860};
        prom_solid_use(shape, paint(city, goods[(i + (int)number) % 4]));
        static const float heap[4][2] = {{0.2f, 0}, {0.18f, 0.06f}, {0.1f, 0.12f}, {0, 0.14f}};
        prom_solid_frame old = prom_solid_enter(shape, x + w / 2, 0.97f, 0.25f, 0);
        prom_solid_lathe(shape, heap, 4, sides_of(city, 8), true);
        prom_solid_leave(shape, old);
    }
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_AWNING, cloths[number % 4], 1.6f));
    float y = 2.2f, top = 2.75f, x = 1.55f, z = 1.1f;
    float *a = (float[]){-x, y, z}, *b = (float[]){x, y, z}, *c = (float[]){x, y, -z},
          *d = (float[]){-x, y, -z}, *l = (float[]){-x, top, 0}, *r = (float[]){x, top, 0};
    prom_solid_quad(shape, a, b, r, l);
    prom_solid_quad(shape, b, a, l, r);
    prom_solid_quad(shape, c, d, l, r);
    prom_solid_quad(shape, d, c, r, l);
    prom_solid_flat_triangle(shape, b, c, r);
    prom_solid_flat_triangle(shape, c, b, r);
    prom_solid_flat_triangle(shape, d, a, l);
    prom_solid_flat_triangle(shape, a, d, l);
}

// ---- the fountain

static void build_fountain(prom_city *city, prom_solid *shape)
{
    static const float rim[8][2] = {{3.2f, 0},     {3.2f, 0.12f}, {2.9f, 0.16f}, {2.85f, 0.5f},
                                    {3.0f, 0.58f}, {3.0f, 0.66f}, {2.6f, 0.66f}, {2.6f, 0.2f}};
    static const float column[14][2] = {
        {0.75f, 0.2f}, {0.75f, 0.5f},  {0.5f, 0.6f},   {0.3f, 0.9f},  {0.28f, 1.3f},
        {0.4f, 1.45f}, {1.1f, 1.65f},  {1.35f, 1.85f}, {1.3f, 1.88f}, {0.3f, 1.7f},
        {0.22f, 2.2f}, {0.34f, 2.35f}, {0.26f, 2.6f},  {0, 2.75f}};
    int sides = sides_of(city, 28);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xc9c0ae, 2));
    prom_solid_lathe(shape, rim, 8, sides, false);
    prom_solid_lathe(shape, column, 14, sides, true);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WATER, 0xffffff, 2));
    prom_solid_lathe(shape, (const float[2][2]){{2.62f, 0.5f}, {0, 0.5f}}, 2, sides, false);
    prom_solid_lathe(shape, (const float[2][2]){{1.3f, 1.82f}, {0, 1.82f}}, 2, sides, false);
}

// ---- cars

// Height of the body's upper edge and half width along the car: bonnet, cabin, boot.
static void build_wheel(prom_city *city, prom_solid *shape, float x, float y, float z,
                        bool left)
{
    // A lathe stands upright: this one lies on its side, so its rings are made here.
    int sides = sides_of(city, 14);
    float radius = 0.31f, outer = left ? -0.1f : 0.1f;
    prom_solid_use(shape, paint(city, 0x1d1e20));
    for (int part = 0; part < 2; part++) {
        if (part) prom_solid_use(shape, paint(city, 0xb4b8bc));
        float r = part ? 0.18f : radius, dx = part ? outer * 1.05f : outer;
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
    prom_solid_use(shape, paint(city, 0x1d1e20));
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

static void build_car(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const uint32_t paints[] = {0x9c2f2b, 0x2d4f7c, 0xd9d9d4, 0x3f4446,
                                      0x5f7f62, 0xc9a548, 0x7fa3b5, 0x6b3c58};
    bool estate = number % 3 == 2;
    const car_section body[] = {
        {-2.05f, 0.42f, 0.72f, 0.74f, 0.70f}, {-1.95f, 0.28f, 0.92f, 0.80f, 0.74f},
        {-1.30f, 0.24f, 0.95f, 0.84f, 0.78f}, {0.75f, 0.24f, 0.93f, 0.84f, 0.78f},
        {1.70f, 0.26f, 0.80f, 0.82f, 0.74f},  {1.98f, 0.32f, 0.70f, 0.76f, 0.68f},
        {2.08f, 0.42f, 0.60f, 0.70f, 0.64f}};
    const car_section cabin[] = {{estate ? -1.95f : -1.55f, 0.93f, 0.95f, 0.76f, 0.72f},
                                 {estate ? -1.75f : -0.95f, 0.93f, 1.38f, 0.78f, 0.62f},
                                 {0.05f, 0.93f, 1.42f, 0.78f, 0.62f},
                                 {0.85f, 0.91f, 0.95f, 0.77f, 0.72f}};
    const car_section roof[] = {{cabin[1].z, 1.36f, 1.42f, 0.64f, 0.60f},
                                {-0.4f, 1.39f, 1.46f, 0.64f, 0.60f},
                                {0.05f, 1.38f, 1.43f, 0.64f, 0.60f}};
    int n = (int)(sizeof body / sizeof *body);
    prom_solid_use(shape, paint(city, paints[number % 8]));
    build_shell(shape, body, n);
    build_end(shape, &body[0], false);
    build_end(shape, &body[n - 1], true);
    build_shell(shape, roof, 3);
    build_end(shape, &roof[0], false);
    build_end(shape, &roof[2], true);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WINDOW_DARK, 0x9aa4ac, 1.5f));
    build_shell(shape, cabin, 4);
    prom_solid_use(shape, paint(city, 0x26282a));
    prom_solid_box(shape, -0.76f, 0.3f, -2.1f, 0.76f, 0.48f, -1.9f, PROM_FACE_ALL);
    prom_solid_box(shape, -0.74f, 0.3f, 1.9f, 0.74f, 0.46f, 2.13f, PROM_FACE_ALL);
    for (int i = -1; i <= 1; i += 2) {
        float x = 0.55f * (float)i;
        prom_solid_use(shape, paint(city, 0xf0eedc));
        prom_solid_box(shape, x - 0.13f, 0.5f, 1.9f, x + 0.13f, 0.62f, 2.09f, PROM_FACE_ALL);
        prom_solid_use(shape, paint(city, 0x8c1c18));
        prom_solid_box(shape, x - 0.13f, 0.55f, -2.08f, x + 0.13f, 0.68f, -1.9f, PROM_FACE_ALL);
        build_wheel(city, shape, 0.76f * (float)i, 0.31f, 1.28f, i < 0);
        build_wheel(city, shape, 0.76f * (float)i, 0.31f, -1.25f, i < 0);
    }
}

void prom_city_build_thing(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    switch (which->kind) {
    case PROM_CITY_LAMP:
        build_lamp(city, shape, which->number);
        break;
    case PROM_CITY_BENCH:
        build_bench(city, shape, which->number);
        break;
    case PROM_CITY_CAR:
        build_car(city, shape, which->number);
        break;
    case PROM_CITY_BIN:
        build_bin(city, shape);
        break;
    case PROM_CITY_STALL:
        build_stall(city, shape, which->number);
        break;
    case PROM_CITY_FOUNTAIN:
    default:
        build_fountain(city, shape);
        break;
    }
}
