#include "scenes/city_parts.h"

#include <math.h>

#define KERB_WIDTH 0.25f
#define CELL 4.0f // edge of a ground cell, about
#define PATH 1.5f // half the width of a path

enum { USE_STREET = 100, USE_PASSAGE, USE_CROSSING };

// ---- blocks

enum { CELL_KERB, CELL_PAVING, CELL_GRASS, CELL_GRAVEL, CELL_COBBLES, CELL_COUNT };

typedef struct block {
    prom_city_use use;
    float width, depth;
} block;

static int block_paint(const void *user, float x, float z)
{
    const block *b = user;
    float edge = fminf(fminf(x, b->width - x), fminf(z, b->depth - z));
    if (edge < KERB_WIDTH) return CELL_KERB;
    if (edge < PROM_CITY_PAVEMENT) return CELL_PAVING;
    bool path = fabsf(x - b->width / 2) < PATH || fabsf(z - b->depth / 2) < PATH;
    switch (b->use) {
    case PROM_CITY_USE_SQUARE:
        return path ? CELL_PAVING : CELL_COBBLES;
    case PROM_CITY_USE_PARK:
        return path ? CELL_GRAVEL : CELL_GRASS;
    case PROM_CITY_USE_CHURCH:
        return fabsf(x - b->width / 2) < PATH ? CELL_GRAVEL : CELL_GRASS;
    case PROM_CITY_USE_HOUSES:
    default:
        return CELL_GRASS;
    }
}

static void cut_block(prom_cuts *c, float size, bool path)
{
    const float p = PROM_CITY_PAVEMENT, half = size / 2;
    prom_cut_to(c, 0, KERB_WIDTH, 1);
    prom_cut_to(c, KERB_WIDTH, p, CELL);
    if (path) {
        prom_cut_to(c, p, half - PATH, CELL);
        prom_cut_to(c, half - PATH, half + PATH, CELL);
        prom_cut_to(c, half + PATH, size - p, CELL);
    } else {
        prom_cut_to(c, p, size - p, CELL);
    }
    prom_cut_to(c, size - p, size - KERB_WIDTH, CELL);
    prom_cut_to(c, size - KERB_WIDTH, size, 1);
}

// The kerb's face goes below the carriageway, so that no gap can show between them.
static void build_kerb(prom_solid *shape, const prom_cuts *x, const prom_cuts *z)
{
    const float low = -0.12f, y = PROM_CITY_KERB;
    float w = x->at[x->count - 1], d = z->at[z->count - 1];
    for (uint32_t i = 0; i + 1 < x->count; i++) {
        float a = x->at[i], b = x->at[i + 1];
        prom_solid_quad(shape, (float[]){a, low, d}, (float[]){b, low, d}, (float[]){b, y, d},
                        (float[]){a, y, d});
        prom_solid_quad(shape, (float[]){b, low, 0}, (float[]){a, low, 0}, (float[]){a, y, 0},
                        (float[]){b, y, 0});
    }
    for (uint32_t i = 0; i + 1 < z->count; i++) {
        float a = z->at[i], b = z->at[i + 1];
        prom_solid_quad(shape, (float[]){w, low, b}, (float[]){w, low, a}, (float[]){w, y, a},
                        (float[]){w, y, b});
        prom_solid_quad(shape, (float[]){0, low, a}, (float[]){0, low, b}, (float[]){0, y, b},
                        (float[]){0, y, a});
    }
}

static void build_block(prom_city *city, prom_solid *shape, const block *b)
{
    static const struct {
        prom_city_texture texture;
        uint32_t rgb;
        float repeat;
    } paints[CELL_COUNT] = {{PROM_CITY_PLASTER, 0xb0aca4, 2},
                            {PROM_CITY_PAVING, 0xf4f0ea, 2.2f},
                            {PROM_CITY_GRASS, 0xffffff, 5},
                            {PROM_CITY_GRAVEL, 0xffffff, 2.5f},
                            {PROM_CITY_COBBLES, 0xffffff, 2.4f}};
    prom_cuts x = {0}, z = {0};
    bool path = b->use != PROM_CITY_USE_HOUSES;
    cut_block(&x, b->width, path);
    cut_block(&z, b->depth, path);
    prom_grid g = {.x = &x, .z = &z, .paint_of = block_paint, .y = PROM_CITY_KERB, .user = b};
    for (int i = 0; i < CELL_COUNT; i++) {
        prom_solid_use(
            shape, prom_city_paint(city, paints[i].texture, paints[i].rgb, paints[i].repeat));
        prom_grid_build(shape, &g, i);
        if (i == CELL_KERB) build_kerb(shape, &x, &z);
    }
}

// ---- streets

#define ZEBRA_FROM 0.8f
#define ZEBRA_TO 3.8f
#define STOP_FROM 4.6f
#define STOP_TO 5.0f
#define PICTURE (2 * PROM_CITY_BAY) // length of the carriageway's picture
#define PARKING 2.1f                // width of a bay

uint32_t prom_city_bays(float length)
{
    return (uint32_t)fmaxf(0, (length - 2 * STOP_TO) / PROM_CITY_BAY);
}

float prom_city_bay(float length, uint32_t i)
{
    return PROM_CITY_BAY * ((float)i + 0.5f - (float)prom_city_bays(length) / 2);
}

// A strip of carriageway over its whole width whose picture begins at z0.
static void build_strip(prom_solid *shape, prom_paint paint, float z0, float z1)
{
    static const float up[3] = {0, 1, 0};
    int n = (int)fmaxf(1, roundf((z1 - z0) / CELL));
    uint32_t first = 0;
    prom_solid_use(shape, paint);
    for (int j = 0; j <= n; j++) {
        for (int i = 0; i < 3; i++) {
            float z = z0 + (z1 - z0) * (float)j / (float)n, u = (float)i / 2;
            uint32_t id = prom_solid_vertex(shape, (float[]){u * PROM_CITY_ROAD_WIDTH, 0, z},
                                            up, u, (z - z0) / PICTURE);
            if (!i && !j) first = id;
        }
    }
    for (uint32_t j = 0; j < (uint32_t)n; j++) {
        for (uint32_t i = 0; i < 2; i++) {
            uint32_t a = first + 3 * j + i;
            prom_solid_triangle(shape, a, a + 3, a + 4);
            prom_solid_triangle(shape, a, a + 4, a + 1);
        }
    }
}

// Where traffic waits: a white bar over its lane, the one on the right.
static void build_stop(prom_city *city, prom_solid *shape, float z0, float z1, bool left)
{
    prom_paint plain = prom_city_paint(city, PROM_CITY_ASPHALT, 0xffffff, 4);
    float mid = PROM_CITY_ROAD_WIDTH / 2, end = PROM_CITY_ROAD_WIDTH;
    float a = left ? PARKING : mid, b = left ? mid : end - PARKING;
    prom_solid_use(shape, plain);
    prom_solid_floor(shape, 0, z0, a, z1, 0, CELL);
    prom_solid_floor(shape, b, z0, end, z1, 0, CELL);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xe4e4e0, 2));
    prom_solid_floor(shape, a, z0, b, z1, 0, CELL);
}

static void build_street(prom_city *city, prom_solid *shape, float length, bool passage)
{
    prom_paint plain = prom_city_paint(city, PROM_CITY_ASPHALT, 0xffffff, 4);
    prom_paint zebra = prom_city_paint(city, PROM_CITY_ZEBRA, 0xffffff, PROM_CITY_ROAD_WIDTH);
    prom_paint lane = prom_city_paint(city, PROM_CITY_LANE, 0xffffff, PROM_CITY_ROAD_WIDTH);
    prom_paint road = prom_city_paint(city, PROM_CITY_ROAD, 0xffffff, PROM_CITY_ROAD_WIDTH);
    float bays = PROM_CITY_BAY * (float)prom_city_bays(length), from = (length - bays) / 2;
    prom_solid_enter(shape, -PROM_CITY_ROAD_WIDTH / 2, 0, -length / 2, 0);
    const float at[4] = {0, ZEBRA_FROM, ZEBRA_TO, STOP_FROM};
    const prom_paint paints[3] = {plain, zebra, plain};
    for (int i = 0; i < 3; i++) {
        prom_solid_use(shape, paints[i]);
        prom_solid_floor(shape, 0, at[i], PROM_CITY_ROAD_WIDTH, at[i + 1], 0, CELL);
        prom_solid_floor(shape, 0, length - at[i + 1], PROM_CITY_ROAD_WIDTH, length - at[i], 0,
                         CELL);
    }
    build_stop(city, shape, STOP_FROM, STOP_TO, false);
    build_stop(city, shape, length - STOP_TO, length - STOP_FROM, true);
    if (from > STOP_TO) {
        build_strip(shape, lane, STOP_TO, from);
        build_strip(shape, lane, length - from, length - STOP_TO);
    }
    if (!passage) {
        build_strip(shape, road, from, length - from);
        return;
    }
    float mid = length / 2, half = (ZEBRA_TO - ZEBRA_FROM) / 2;
    build_strip(shape, road, from, mid - half);
    build_strip(shape, road, mid + half, length - from);
    prom_solid_use(shape, zebra);
    prom_solid_floor(shape, 0, mid - half, PROM_CITY_ROAD_WIDTH, mid + half, 0, CELL);
}

// ---- shared meshes

static uint32_t ground_mesh(prom_city *city, int use, float width, float depth,
                            const char *name)
{
    for (size_t i = 0; i < city->grounds.count; i++) {
        const prom_city_ground *g = &city->grounds.data[i];
        if (g->use == use && g->width == width && g->depth == depth) return g->mesh;
    }
    prom_solid shape;
    prom_solid_init(&shape);
    if (use == USE_STREET || use == USE_PASSAGE) {
        build_street(city, &shape, depth, use == USE_PASSAGE);
    } else if (use == USE_CROSSING) {
        float half = PROM_CITY_ROAD_WIDTH / 2;
        prom_solid_use(&shape, prom_city_paint(city, PROM_CITY_ASPHALT, 0xffffff, 4));
        prom_solid_floor(&shape, -half, -half, half, half, 0, CELL);
    } else {
        build_block(city, &shape, &(block){(prom_city_use)use, width, depth});
    }
    prom_city_ground g = {use, width, depth, prom_solid_write(&shape, city->glb, name)};
    prom_solid_finish(&shape);
    prom_array_push(&city->grounds, g);
    return g.mesh;
}

uint32_t prom_city_block_ground(prom_city *city, prom_city_use use, float width, float depth)
{
    static const char *const names[] = {"ground_houses", "ground_park", "ground_square",
                                        "ground_church"};
    return ground_mesh(city, (int)use, width, depth, names[use]);
}

uint32_t prom_city_street_ground(prom_city *city, float length, bool passage)
{
    return ground_mesh(city, passage ? USE_PASSAGE : USE_STREET, PROM_CITY_ROAD_WIDTH, length,
                       "street");
}

uint32_t prom_city_crossing_ground(prom_city *city)
{
    return ground_mesh(city, USE_CROSSING, PROM_CITY_ROAD_WIDTH, PROM_CITY_ROAD_WIDTH,
                       "crossing");
}
