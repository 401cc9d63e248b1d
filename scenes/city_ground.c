#include "scenes/city_parts.h"

#include <assert.h>
#include <math.h>

#define KERB_WIDTH 0.25f
#define CELL 4.0f   // edge of a ground cell, about
#define LAND 260.0f // how far the land reaches
#define LAND_CELL 12.0f
#define CUTS_MAX 512u

enum { USE_STREET = 100, USE_CROSSING };

// ---- grids of cells with a paint each

typedef struct cuts {
    float at[CUTS_MAX];
    uint32_t count;
} cuts;

// Adds cuts from the last one (or from `from`, the first) to `to`, about `cell` apart.
static void cut_to(cuts *c, float from, float to, float cell)
{
    uint32_t n = (uint32_t)fmaxf(1, roundf((to - from) / cell));
    if (!c->count) c->at[c->count++] = from;
    for (uint32_t i = 1; i <= n && c->count < CUTS_MAX; i++)
        c->at[c->count++] = i == n ? to : from + (to - from) * (float)i / (float)n;
}

typedef struct grid {
    const cuts *x, *z;
    // Paint number of the cell at a point; negative: none.
    int (*paint_of)(const void *user, float x, float z);
    float (*height_of)(const void *user, float x, float z); // NULL: `y`
    float y;
    const void *user;
} grid;

static uint32_t grid_vertex(prom_solid *shape, const grid *g, float x, float z)
{
    float y = g->y;
    float normal[3] = {0, 1, 0};
    if (g->height_of) {
        const float e = 0.5f;
        y = g->height_of(g->user, x, z);
        float dx =
            (g->height_of(g->user, x + e, z) - g->height_of(g->user, x - e, z)) / (2 * e);
        float dz =
            (g->height_of(g->user, x, z + e) - g->height_of(g->user, x, z - e)) / (2 * e);
        float length = sqrtf(dx * dx + 1 + dz * dz);
        normal[0] = -dx / length;
        normal[1] = 1 / length;
        normal[2] = -dz / length;
    }
    return prom_solid_vertex(shape, (float[]){x, y, z}, normal, x / shape->repeat,
                             z / shape->repeat);
}

// The cells of one paint, connected where they touch. Neighbours of another paint have the same
// corners, so that no gap can show.
static void build_grid(prom_solid *shape, const grid *g, int paint)
{
    uint32_t nx = g->x->count, nz = g->z->count;
    uint32_t *ids = prom_alloc((size_t)nx * nz, sizeof *ids);
    memset(ids, 255, (size_t)nx * nz * sizeof *ids);
    for (uint32_t j = 0; j + 1 < nz; j++) {
        for (uint32_t i = 0; i + 1 < nx; i++) {
            float mx = (g->x->at[i] + g->x->at[i + 1]) / 2;
            float mz = (g->z->at[j] + g->z->at[j + 1]) / 2;
            if (g->paint_of(g->user, mx, mz) != paint) continue;
            uint32_t at[4] = {j * nx + i, (j + 1) * nx + i, (j + 1) * nx + i + 1,
                              j * nx + i + 1};
            for (int k = 0; k < 4; k++)
                if (ids[at[k]] == UINT32_MAX)
                    ids[at[k]] =
                        grid_vertex(shape, g, g->x->at[at[k] % nx], g->z->at[at[k] / nx]);
            prom_solid_triangle(shape, ids[at[0]], ids[at[1]], ids[at[2]]);
            prom_solid_triangle(shape, ids[at[0]], ids[at[2]], ids[at[3]]);
        }
    }
    prom_free(ids);
}

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
    if (b->use == PROM_CITY_USE_SQUARE) return CELL_COBBLES;
    bool on_path = fabsf(x - b->width / 2) < 1.5f || fabsf(z - b->depth / 2) < 1.5f;
    if (b->use == PROM_CITY_USE_PARK && on_path) return CELL_GRAVEL;
    return CELL_GRASS;
}

static void cut_block(cuts *c, float size, bool path)
{
    cut_to(c, 0, KERB_WIDTH, 1);
    cut_to(c, KERB_WIDTH, PROM_CITY_PAVEMENT, CELL);
    if (path) {
        cut_to(c, PROM_CITY_PAVEMENT, size / 2 - 1.5f, CELL);
        cut_to(c, size / 2 - 1.5f, size / 2 + 1.5f, CELL);
        cut_to(c, size / 2 + 1.5f, size - PROM_CITY_PAVEMENT, CELL);
    } else {
        cut_to(c, PROM_CITY_PAVEMENT, size - PROM_CITY_PAVEMENT, CELL);
    }
    cut_to(c, size - PROM_CITY_PAVEMENT, size - KERB_WIDTH, CELL);
    cut_to(c, size - KERB_WIDTH, size, 1);
}

// The kerb's face goes below the carriageway, so that no gap can show between them.
static void build_kerb(prom_solid *shape, const cuts *x, const cuts *z)
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
    cuts x = {0}, z = {0};
    cut_block(&x, b->width, b->use == PROM_CITY_USE_PARK);
    cut_block(&z, b->depth, b->use == PROM_CITY_USE_PARK);
    grid g = {.x = &x, .z = &z, .paint_of = block_paint, .y = PROM_CITY_KERB, .user = b};
    for (int i = 0; i < CELL_COUNT; i++) {
        prom_solid_use(
            shape, prom_city_paint(city, paints[i].texture, paints[i].rgb, paints[i].repeat));
        build_grid(shape, &g, i);
        if (i == CELL_KERB) build_kerb(shape, &x, &z);
    }
}

// ---- streets

static void build_street(prom_city *city, prom_solid *shape, float length)
{
    // Plain, zebra, road, zebra, plain.
    const float at[6] = {0, 0.8f, 3.8f, length - 3.8f, length - 0.8f, length};
    prom_paint plain = prom_city_paint(city, PROM_CITY_ASPHALT, 0xffffff, 4);
    prom_paint zebra = prom_city_paint(city, PROM_CITY_ZEBRA, 0xffffff, PROM_CITY_ROAD_WIDTH);
    prom_paint road = prom_city_paint(city, PROM_CITY_ROAD, 0xffffff, PROM_CITY_ROAD_WIDTH);
    const prom_paint paints[5] = {plain, zebra, road, zebra, plain};
    prom_solid_enter(shape, -PROM_CITY_ROAD_WIDTH / 2, 0, -length / 2, 0);
    for (int i = 0; i < 5; i++) {
        prom_solid_use(shape, paints[i]);
        prom_solid_floor(shape, 0, at[i], PROM_CITY_ROAD_WIDTH, at[i + 1], 0, CELL);
    }
}

static uint32_t ground_mesh(prom_city *city, int use, float width, float depth,
                            const char *name)
{
    for (size_t i = 0; i < city->grounds.count; i++) {
        const prom_city_ground *g = &city->grounds.data[i];
        if (g->use == use && g->width == width && g->depth == depth) return g->mesh;
    }
    prom_solid shape;
    prom_solid_init(&shape);
    if (use == USE_STREET) {
        build_street(city, &shape, depth);
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
    static const char *const names[] = {"ground_houses", "ground_park", "ground_square"};
    return ground_mesh(city, (int)use, width, depth, names[use]);
}

uint32_t prom_city_street_ground(prom_city *city, float length)
{
    return ground_mesh(city, USE_STREET, PROM_CITY_ROAD_WIDTH, length, "street");
}

uint32_t prom_city_crossing_ground(prom_city *city)
{
    return ground_mesh(city, USE_CROSSING, PROM_CITY_ROAD_WIDTH, PROM_CITY_ROAD_WIDTH,
                       "crossing");
}

// ---- the land around

typedef struct land {
    float x0, z0, x1, z1;
} land;

// Flat and a little lower at the city's edge, so that the outer streets cover its border; then
// rising to hills.
static float land_height(const void *user, float x, float z)
{
    const land *l = user;
    float dx = fmaxf(fmaxf(l->x0 - x, x - l->x1), 0),
          dz = fmaxf(fmaxf(l->z0 - z, z - l->z1), 0);
    float t = fminf(hypotf(dx, dz) / LAND, 1);
    float waves = 0.55f + 0.25f * sinf(x * 0.013f + 1.3f) * cosf(z * 0.011f + 0.7f) +
                  0.20f * sinf(x * 0.031f - z * 0.027f);
    return -0.06f + 26 * waves * t * t * (3 - 2 * t);
}

// Which of the four meshes a cell belongs to.
static int land_part(const void *user, float x, float z)
{
    const land *l = user;
    if (z < l->z0) return 0;
    if (z > l->z1) return 1;
    if (x < l->x0) return 2;
    return x > l->x1 ? 3 : -1;
}

static void cut_land(cuts *c, float low, float high)
{
    // A very large city has coarser cells, so that the cuts suffice.
    float cell = fmaxf(LAND_CELL, (high - low + 2 * LAND) / (float)(CUTS_MAX - 8));
    cut_to(c, low - LAND, low, cell);
    cut_to(c, low, high, cell);
    cut_to(c, high, high + LAND, cell);
}

static void plant_land(prom_city *city, const land *l, uint32_t parent)
{
    prom_random random = prom_random_stream(city->options.seed, 300, 0);
    float w = l->x1 - l->x0, d = l->z1 - l->z0;
    uint32_t first = city->first[PROM_CITY_TREE];
    uint32_t kinds = city->first[PROM_CITY_TREE + 1] - first;
    uint32_t wanted = (uint32_t)((w + d) / 10);
    for (uint32_t i = 0; i < wanted; i++) {
        float out = 9 + 140 * prom_random_unit(&random) * prom_random_unit(&random);
        float along = prom_random_between(&random, -out, (i % 2 ? d : w) + out);
        bool far = i & 2;
        float x = i % 2 ? (far ? l->x1 + out : l->x0 - out) : l->x0 + along;
        float z = i % 2 ? l->z0 + along : (far ? l->z1 + out : l->z0 - out);
        prom_city_place(city, first + prom_random_below(&random, kinds), parent, x,
                        land_height(l, x, z) - 0.1f, z,
                        prom_random_between(&random, 0, 6.2831853f),
                        prom_random_between(&random, 0.85f, 1.25f));
    }
}

void prom_city_land(prom_city *city, float x0, float z0, float x1, float z1, uint32_t parent)
{
    static const char *const names[4] = {"land_north", "land_south", "land_west", "land_east"};
    const land l = {x0 + 0.5f, z0 + 0.5f, x1 - 0.5f, z1 - 0.5f};
    cuts x = {0}, z = {0};
    cut_land(&x, l.x0, l.x1);
    cut_land(&z, l.z0, l.z1);
    grid g = {.x = &x, .z = &z, .paint_of = land_part, .height_of = land_height, .user = &l};
    for (int i = 0; i < 4; i++) {
        prom_solid shape;
        prom_solid_init(&shape);
        prom_solid_use(&shape, prom_city_paint(city, PROM_CITY_GRASS, 0xf0ecd0, 7));
        build_grid(&shape, &g, i);
        prom_glb_node node = {.name = names[i],
                              .parent = parent,
                              .mesh = prom_solid_write(&shape, city->glb, names[i]),
                              .scale = 1};
        prom_glb_add_node(city->glb, &node);
        prom_solid_finish(&shape);
    }
    plant_land(city, &l, parent);
}
