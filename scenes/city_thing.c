// What stands on pavements: lamps, benches, bins, bollards, signs, columns for posters.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f

// ---- lamps

static void build_lantern(prom_city *city, prom_solid *shape, float y)
{
    static const float cage[5][2] = {
        {0, 0}, {0.10f, 0}, {0.12f, 0.04f}, {0.17f, 0.40f}, {0.19f, 0.42f}};
    static const float hood[5][2] = {
        {0.24f, 0}, {0.20f, 0.06f}, {0.10f, 0.14f}, {0.03f, 0.18f}, {0, 0.28f}};
    int sides = prom_city_sides(city, 6);
    prom_solid_frame old = prom_solid_enter(shape, 0, y, 0, 0);
    prom_solid_use(shape, prom_city_plain(city, 0xf6e7b4));
    prom_solid_lathe(shape, cage, 5, sides, false);
    prom_solid_leave(shape, old);
    old = prom_solid_enter(shape, 0, y + 0.42f, 0, 0);
    prom_solid_use(shape, prom_city_plain(city, 0x2c332f));
    prom_solid_lathe(shape, hood, 5, sides, false);
    prom_solid_leave(shape, old);
}

static void build_lamp(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const float post[13][2] = {
        {0.17f, 0},     {0.17f, 0.10f},  {0.13f, 0.14f},  {0.12f, 0.55f},  {0.09f, 0.65f},
        {0.10f, 0.75f}, {0.055f, 0.85f}, {0.045f, 2.90f}, {0.075f, 2.95f}, {0.075f, 3.02f},
        {0.04f, 3.08f}, {0.04f, 3.40f},  {0.08f, 3.46f}};
    prom_solid_use(shape, prom_city_plain(city, 0x2c332f));
    prom_solid_lathe(shape, post, 13, prom_city_sides(city, 9), true);
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
        prom_solid_use(shape, prom_city_plain(city, 0x2c332f));
        prom_solid_tube(shape, (const float(*)[3])arm, radii, 5, prom_city_sides(city, 5));
        prom_solid_frame old = prom_solid_enter(shape, (float)i * 0.5f, 0, 0, 0);
        build_lantern(city, shape, 3.4f);
        prom_solid_leave(shape, old);
    }
}

// A modern one: a tapering mast with an arm over the street and a flat head.
static void build_mast(prom_city *city, prom_solid *shape)
{
    static const float post[5][2] = {
        {0.13f, 0}, {0.13f, 0.9f}, {0.085f, 1.0f}, {0.06f, 6.2f}, {0, 6.25f}};
    float arm[6][3], radii[6];
    for (int k = 0; k < 6; k++) {
        float t = (float)k / 5;
        arm[k][0] = 0;
        arm[k][1] = 6.1f + 0.55f * sinf(PI / 2 * t);
        arm[k][2] = 1.9f * t * t + 0.1f * t;
        radii[k] = 0.055f - 0.02f * t;
    }
    prom_solid_use(shape, prom_city_plain(city, 0x8f979b));
    prom_solid_lathe(shape, post, 5, prom_city_sides(city, 9), true);
    prom_solid_tube(shape, (const float(*)[3])arm, radii, 6, prom_city_sides(city, 6));
    prom_solid_box(shape, -0.14f, 6.60f, 1.75f, 0.14f, 6.72f, 2.5f, PROM_FACE_ALL);
    prom_solid_use(shape, prom_city_plain(city, 0xf6f0d8));
    prom_solid_box(shape, -0.11f, 6.57f, 1.85f, 0.11f, 6.60f, 2.4f,
                   PROM_FACE_SIDES | PROM_FACE_BOTTOM);
}

// ---- seats and bins

static void build_bench(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const uint32_t woods[] = {0xa9794e, 0x7d5a3c, 0x5c7a58};
    int slats = prom_city_sides(city, 5);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, woods[number % 3], 1));
    for (int i = 0; i < slats; i++) {
        float at = (float)i / (float)slats, w = 0.8f / (float)slats;
        float z = 0.25f - 0.45f * at, y = 0.52f + 0.42f * at;
        prom_solid_box(shape, -0.85f, 0.42f, z - 0.45f * w, 0.85f, 0.455f, z, PROM_FACE_ALL);
        prom_solid_box(shape, -0.85f, y, -0.24f - 0.08f * at, 0.85f, y + 0.42f * w,
                       -0.21f - 0.08f * at, PROM_FACE_ALL);
    }
    prom_solid_use(shape, prom_city_plain(city, 0x33383a));
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
    int sides = prom_city_sides(city, 12);
    prom_solid_use(shape, prom_city_plain(city, 0x3d5a46));
    prom_solid_lathe(shape, can, 5, sides, false);
    prom_solid_use(shape, prom_city_plain(city, 0x1c1f1d));
    prom_solid_lathe(shape, inside, 3, sides, false);
    prom_solid_lathe(shape, (const float[2][2]){{0.16f, 0}, {0.16f, 0.1f}}, 2, sides, true);
}

// ---- bollards, signs, columns

static void build_bollard(prom_city *city, prom_solid *shape)
{
    static const float post[9][2] = {{0.11f, 0},     {0.11f, 0.08f}, {0.075f, 0.12f},
                                     {0.065f, 0.7f}, {0.09f, 0.74f}, {0.09f, 0.80f},
                                     {0.07f, 0.84f}, {0.07f, 0.92f}, {0, 0.97f}};
    prom_solid_use(shape, prom_city_plain(city, 0x2c332f));
    prom_solid_lathe(shape, post, 9, prom_city_sides(city, 8), true);
}

// A polygon of `sides` about (0, y), its first corner turned by `turn`.
static void build_plate(prom_solid *shape, float y, float radius, int sides, float turned,
                        float z0, float z1)
{
    float outline[64][2];
    for (int i = 0; i < sides; i++) {
        float a = turned + 2 * PI * (float)i / (float)sides;
        outline[i][0] = radius * cosf(a);
        outline[i][1] = y + radius * sinf(a);
    }
    prom_solid_extrude(shape, (const float(*)[2])outline, sides, z0, z1, PROM_FACE_ALL);
}

static void build_traffic_sign(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const float pole[3][2] = {{0.03f, -0.1f}, {0.03f, 2.85f}, {0, 2.87f}};
    const uint32_t rims[3] = {0xb8282c, 0x2456a8, 0xb8282c};
    const uint32_t fields[3] = {0xf4f2ec, 0x2f66bc, 0xf4f2ec};
    int round_sides = prom_city_sides(city, 16), sides = number == 2 ? 3 : round_sides;
    float y = 2.5f, r = number == 2 ? 0.40f : 0.30f, turned = number == 2 ? PI / 2 : 0;
    prom_solid_use(shape, prom_city_plain(city, 0x8f979b));
    prom_solid_lathe(shape, pole, 3, prom_city_sides(city, 6), false);
    build_plate(shape, y, r, sides, turned, 0.025f, 0.045f);
    prom_solid_use(shape, prom_city_plain(city, rims[number % 3]));
    build_plate(shape, y, 0.995f * r, sides, turned, 0.03f, 0.05f);
    prom_solid_use(shape, prom_city_plain(city, fields[number % 3]));
    build_plate(shape, y, 0.78f * r, sides, turned, 0.04f, 0.062f);
    prom_solid_use(shape, prom_city_plain(city, number == 1 ? 0xf4f2ec : 0x2a2c30));
    if (number == 1) { // a parking place: P
        prom_solid_box(shape, -0.10f, y - 0.15f, 0.062f, -0.05f, y + 0.15f, 0.07f,
                       PROM_FACE_NO_BACK);
        prom_solid_box(shape, -0.05f, y + 0.10f, 0.062f, 0.09f, y + 0.15f, 0.07f,
                       PROM_FACE_NO_BACK);
        prom_solid_box(shape, -0.05f, y - 0.02f, 0.062f, 0.09f, y + 0.03f, 0.07f,
                       PROM_FACE_NO_BACK);
        prom_solid_box(shape, 0.05f, y + 0.03f, 0.062f, 0.10f, y + 0.10f, 0.07f,
                       PROM_FACE_NO_BACK);
    } else if (number == 2) { // take care: !
        prom_solid_box(shape, -0.025f, y - 0.04f, 0.062f, 0.025f, y + 0.16f, 0.07f,
                       PROM_FACE_NO_BACK);
        prom_solid_box(shape, -0.025f, y - 0.12f, 0.062f, 0.025f, y - 0.07f, 0.07f,
                       PROM_FACE_NO_BACK);
    } else { // thirty: 3, 0
        for (int i = 0; i < 3; i++)
            prom_solid_box(shape, -0.13f, y - 0.12f + 0.105f * (float)i, 0.062f, -0.03f,
                           y - 0.09f + 0.105f * (float)i, 0.07f, PROM_FACE_NO_BACK);
        prom_solid_box(shape, -0.06f, y - 0.09f, 0.062f, -0.03f, y + 0.09f, 0.068f,
                       PROM_FACE_NO_BACK);
        for (int i = 0; i < 2; i++) {
            prom_solid_box(shape, 0.02f + 0.08f * (float)i, y - 0.12f, 0.062f,
                           0.05f + 0.08f * (float)i, y + 0.12f, 0.07f, PROM_FACE_NO_BACK);
            prom_solid_box(shape, 0.05f, y - 0.12f + 0.21f * (float)i, 0.062f, 0.10f,
                           y - 0.09f + 0.21f * (float)i, 0.068f, PROM_FACE_NO_BACK);
        }
    }
}

static void build_column(prom_city *city, prom_solid *shape)
{
    static const float foot[4][2] = {{0.62f, 0}, {0.62f, 0.2f}, {0.56f, 0.28f}, {0.54f, 0.3f}};
    static const float shaft[2][2] = {{0.54f, 0.3f}, {0.54f, 2.6f}};
    static const float hood[6][2] = {{0.54f, 2.6f},  {0.68f, 2.66f}, {0.68f, 2.76f},
                                     {0.45f, 2.95f}, {0.12f, 3.15f}, {0, 3.4f}};
    int sides = prom_city_sides(city, 14);
    prom_solid_use(shape, prom_city_plain(city, 0x3d5a4a));
    prom_solid_lathe(shape, foot, 4, sides, false);
    prom_solid_lathe(shape, hood, 6, sides, false);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_POSTERS, 0xffffff, 2.3f));
    prom_solid_lathe(shape, shaft, 2, sides, false);
}

void prom_city_build_thing(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    switch (which->kind) {
    case PROM_CITY_LAMP:
        build_lamp(city, shape, which->number);
        break;
    case PROM_CITY_MAST:
        build_mast(city, shape);
        break;
    case PROM_CITY_BENCH:
        build_bench(city, shape, which->number);
        break;
    case PROM_CITY_BIN:
        build_bin(city, shape);
        break;
    case PROM_CITY_BOLLARD:
        build_bollard(city, shape);
        break;
    case PROM_CITY_SIGN:
        build_traffic_sign(city, shape, which->number);
        break;
    case PROM_CITY_COLUMN:
    default:
        build_column(city, shape);
        break;
    }
}
