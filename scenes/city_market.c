// What stands in squares: market stalls, a cafe's tables, a fountain, a monument.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f

// ---- the market

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
    int crates = prom_city_sides(city, 6);
    for (int i = 0; i < crates; i++) {
        float x = -1.25f + 2.5f * (float)i / (float)crates, w = 2.2f / (float)crates;
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0xc8a070, 1));
        prom_solid_box(shape, x, 0.84f, 0, x + w, 1.0f, 0.5f, PROM_FACE_SIDES);
        static const uint32_t goods[] = {0xc8442e, 0xe0a030, 0x6a9a3a, 0xd8c860};
        prom_solid_use(shape, prom_city_plain(city, goods[(i + (int)number) % 4]));
        static const float heap[4][2] = {{0.2f, 0}, {0.18f, 0.06f}, {0.1f, 0.12f}, {0, 0.14f}};
        prom_solid_frame old = prom_solid_enter(shape, x + w / 2, 0.97f, 0.25f, 0);
        prom_solid_lathe(shape, heap, 4, prom_city_sides(city, 8), true);
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

// ---- a table, four chairs, a parasol

static void build_chair(prom_city *city, prom_solid *shape)
{
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0xb98a5c, 1));
    prom_solid_box(shape, -0.21f, 0.42f, -0.21f, 0.21f, 0.46f, 0.21f, PROM_FACE_ALL);
    prom_solid_box(shape, -0.20f, 0.62f, -0.22f, 0.20f, 0.86f, -0.19f, PROM_FACE_ALL);
    prom_solid_use(shape, prom_city_plain(city, 0x33383a));
    for (int i = 0; i < 4; i++) {
        float x = i & 1 ? 0.18f : -0.18f, z = i & 2 ? 0.18f : -0.205f;
        prom_solid_box(shape, x - 0.015f, 0, z - 0.015f, x + 0.015f, i & 2 ? 0.42f : 0.84f,
                       z + 0.015f, PROM_FACE_SIDES);
    }
}

static void build_cafe(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const float table[7][2] = {{0.22f, 0},     {0.22f, 0.03f}, {0.03f, 0.05f},
                                      {0.03f, 0.70f}, {0.42f, 0.71f}, {0.42f, 0.74f},
                                      {0, 0.741f}};
    static const float cover[2][2] = {{1.45f, 2.15f}, {0, 2.75f}};
    static const float lining[2][2] = {{0, 2.70f}, {1.45f, 2.14f}};
    static const uint32_t cloths[2] = {0xc84a3c, 0xe8dcc0};
    prom_solid_use(shape, prom_city_plain(city, 0xd8d4cc));
    prom_solid_lathe(shape, table, 7, prom_city_sides(city, 12), false);
    prom_solid_lathe(shape, (const float[2][2]){{0.025f, 0.74f}, {0.025f, 2.7f}}, 2,
                     prom_city_sides(city, 5), false);
    prom_solid_use(shape, prom_city_plain(city, cloths[number % 2]));
    prom_solid_lathe(shape, cover, 2, 8, false);
    prom_solid_lathe(shape, lining, 2, 8, false);
    for (int i = 0; i < 4; i++) {
        float a = PI / 2 * (float)i + 0.3f;
        prom_solid_frame old =
            prom_solid_enter(shape, 0.78f * sinf(a), 0, 0.78f * cosf(a), a + PI);
        build_chair(city, shape);
        prom_solid_leave(shape, old);
    }
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
    int sides = prom_city_sides(city, 28);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xc9c0ae, 2));
    prom_solid_lathe(shape, rim, 8, sides, false);
    prom_solid_lathe(shape, column, 14, sides, true);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WATER, 0xffffff, 2));
    prom_solid_lathe(shape, (const float[2][2]){{2.62f, 0.5f}, {0, 0.5f}}, 2, sides, false);
    prom_solid_lathe(shape, (const float[2][2]){{1.3f, 1.82f}, {0, 1.82f}}, 2, sides, false);
}

// ---- monuments

// A man in a long coat, one arm raised, of bronze.
static void build_statue(prom_city *city, prom_solid *shape)
{
    static const float coat[10][2] = {
        {0.42f, 0},     {0.40f, 0.25f}, {0.30f, 0.9f},  {0.24f, 1.2f}, {0.31f, 1.6f},
        {0.33f, 1.85f}, {0.22f, 2.02f}, {0.10f, 2.08f}, {0.09f, 2.2f}, {0, 2.22f}};
    static const float head[6][2] = {{0, 2.12f},     {0.11f, 2.18f}, {0.15f, 2.32f},
                                     {0.14f, 2.44f}, {0.08f, 2.54f}, {0, 2.56f}};
    static const float hat[5][2] = {
        {0.27f, 2.43f}, {0.27f, 2.45f}, {0.15f, 2.47f}, {0.13f, 2.62f}, {0, 2.64f}};
    int sides = prom_city_sides(city, 12);
    prom_solid_use(shape, prom_city_plain(city, 0x5f8272));
    prom_solid_lathe(shape, coat, 10, sides, true);
    prom_solid_lathe(shape, head, 6, sides, true);
    prom_solid_lathe(shape, hat, 5, sides, false);
    const float raised[4][3] = {
        {0.28f, 1.82f, 0}, {0.55f, 1.75f, 0.15f}, {0.72f, 2.1f, 0.42f}, {0.76f, 2.3f, 0.55f}};
    const float down[4][3] = {{-0.28f, 1.82f, 0},
                              {-0.45f, 1.5f, 0.02f},
                              {-0.42f, 1.15f, 0.16f},
                              {-0.38f, 1.0f, 0.24f}};
    static const float radii[4] = {0.11f, 0.1f, 0.08f, 0.06f};
    prom_solid_tube(shape, raised, radii, 4, prom_city_sides(city, 8));
    prom_solid_tube(shape, down, radii, 4, prom_city_sides(city, 8));
}

static void build_monument(prom_city *city, prom_solid *shape, uint32_t number)
{
    prom_paint stone = prom_city_paint(city, PROM_CITY_STONE, 0xc8bfae, 2.4f);
    prom_paint trim = prom_city_paint(city, PROM_CITY_PLASTER, 0xd8d0c0, 2);
    prom_solid_use(shape, stone);
    for (int i = 0; i < 3; i++) {
        float half = 2.0f - 0.4f * (float)i, y = 0.18f * (float)i;
        prom_solid_box(shape, -half, y - 0.05f, -half, half, y + 0.18f, half,
                       PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    }
    prom_solid_box(shape, -0.75f, 0.54f, -0.75f, 0.75f, 2.3f, 0.75f, PROM_FACE_SIDES);
    prom_solid_use(shape, trim);
    prom_solid_box(shape, -0.88f, 0.54f, -0.88f, 0.88f, 0.75f, 0.88f, PROM_FACE_ALL);
    prom_solid_box(shape, -0.88f, 2.3f, -0.88f, 0.88f, 2.48f, 0.88f, PROM_FACE_ALL);
    prom_solid_frame old = prom_solid_enter(shape, 0, 2.48f, 0, 0);
    if (number % 2 == 0) {
        build_statue(city, shape);
    } else { // an obelisk
        prom_solid_use(shape, stone);
        prom_solid_enter(shape, 0, 0, 0, PI / 4);
        prom_solid_lathe(shape, (const float[3][2]){{0.78f, 0}, {0.5f, 6}, {0, 6.7f}}, 3, 4,
                         false);
    }
    prom_solid_leave(shape, old);
}

void prom_city_build_square_thing(prom_city *city, const prom_city_prototype *which,
                                  prom_solid *shape)
{
    switch (which->kind) {
    case PROM_CITY_STALL:
        build_stall(city, shape, which->number);
        break;
    case PROM_CITY_CAFE:
        build_cafe(city, shape, which->number);
        break;
    case PROM_CITY_MONUMENT:
        build_monument(city, shape, which->number);
        break;
    case PROM_CITY_FOUNTAIN:
    default:
        build_fountain(city, shape);
        break;
    }
}
