// The land around the city: gardens at its edge, fields, then wooded hills, with the river's
// valley and the roads that lead out.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f
#define REACH 640.0f // how far the land goes
#define FLAT 46.0f   // width of the belt of gardens
#define CREST 500.0f // beyond this the land falls again, behind the highest hills
#define ROAD_HALF 3.5f
#define VINEYARDS 14
#define BEND 240.0f // how far the river turns aside before the hills hide it

typedef struct land {
    float x0, z0, x1, z1;
    float river, road; // z of the river's middle, x of the road; far away: none
} land;

static float smooth_step(float from, float to, float at)
{
    float t = fminf(fmaxf((at - from) / (to - from), 0), 1);
    return t * t * (3 - 2 * t);
}

static float beyond(float low, float high, float at)
{
    return fmaxf(fmaxf(low - at, at - high), 0);
}

static float outside(const land *l, float x, float z)
{
    return hypotf(beyond(l->x0, l->x1, x), beyond(l->z0, l->z1, z));
}

// River and road leave the city in straight lines and then turn, and all the land with them.
static void land_shift(const void *user, float *x, float *z)
{
    const land *l = user;
    float along = beyond(l->x0, l->x1, *x), across = beyond(l->z0, l->z1, *z);
    float dz = (*x < 0 ? -BEND : BEND) * smooth_step(60, REACH, along);
    float dx = (*z < 0 ? BEND : -BEND) * smooth_step(30, REACH, across);
    *x += dx;
    *z += dz;
}

static float hills(float x, float z)
{
    return 0.50f + 0.26f * sinf(x * 0.0107f + 1.3f) * cosf(z * 0.0093f + 0.7f) +
           0.16f * sinf(x * 0.021f - z * 0.017f) + 0.08f * sinf(x * 0.043f + z * 0.037f + 2);
}

// Flat and a little lower at the city's edge, so that the outer streets cover its border; z as
// before the shift.
static float land_height(const void *user, float x, float z)
{
    const land *l = user;
    float out = outside(l, x, z), bank = fabsf(z - l->river), w = PROM_CITY_WATER_WIDTH / 2;
    float h = 34 * hills(x, z) * smooth_step(FLAT, 330, out) +
              75 * hills(0.6f * z + 90, 0.6f * x) * smooth_step(240, CREST, out) -
              50 * smooth_step(CREST, REACH, out);
    h *= 0.08f + 0.92f * smooth_step(30, 230, bank);
    h -= 0.06f;
    return bank < w + 12 ? -5 + (h + 5) * smooth_step(w - 2, w + 12, bank) : h;
}

// ---- fields

enum { MEADOW, WHEAT, CROPS, FOREST, ROAD, PAINT_COUNT };

static float patch_random(float x, float z, uint64_t salt)
{
    int64_t i = (int64_t)floorf(x), j = (int64_t)floorf(z);
    uint64_t h = prom_random_mix((uint64_t)i * 0x9e3779b97f4a7c15u + (uint64_t)j + salt);
    return (float)(h >> 40) * 0x1p-24f;
}

static bool is_forest(const land *l, float x, float z)
{
    float out = outside(l, x, z);
    float density = sinf(x * 0.0137f + 0.5f) * sinf(z * 0.0151f + 2.1f) +
                    0.45f * sinf(x * 0.031f + z * 0.027f);
    return out > 90 && fabsf(z - l->river) > 45 && fabsf(x - l->road) > 14 &&
           density > 0.42f - 0.75f * smooth_step(150, 600, out);
}

// Which mesh a cell belongs to, one for each side of the city, times its paint.
static int land_cell(const void *user, float x, float z)
{
    const land *l = user;
    int part = z < l->z0 ? 0 : z > l->z1 ? 1 : x < l->x0 ? 2 : x > l->x1 ? 3 : -1;
    if (part < 0) return -1;
    float out = outside(l, x, z), lot = patch_random(x / 74 + 0.2f * z / 74, z / 58, 7);
    int paint = MEADOW;
    if (fabsf(x - l->road) < ROAD_HALF)
        paint = ROAD;
    else if (is_forest(l, x, z))
        paint = FOREST;
    else if (out > FLAT && out < 420 && fabsf(z - l->river) > 32)
        paint = lot < 0.26f ? WHEAT : lot < 0.44f ? CROPS : MEADOW;
    return part * PAINT_COUNT + paint;
}

// Cells that grow from `near` to `far` towards the border.
static void cut_outwards(prom_cuts *c, float from, float to, bool growing)
{
    float sizes[64], total = 0, length = to - from;
    int n = 0;
    for (float size = 8; total < length && n < 64; size = fminf(size * 1.16f, 34), n++)
        total += sizes[n] = size;
    float at = from, factor = length / total;
    for (int i = 0; i < n; i++) {
        float size = sizes[growing ? i : n - 1 - i] * factor;
        prom_cut_to(c, at, i + 1 == n ? to : at + size, 1e9f);
        at += size;
    }
}

// The given places, where something has its border, must be cuts; they ascend.
static void cut_land(prom_cuts *c, float low, float high, const float *places, int count)
{
    // A very large city has coarser cells, so that the cuts suffice.
    float cell = fmaxf(16, (high - low) / 300), at = low;
    cut_outwards(c, low - REACH, low, false);
    for (int i = 0; i < count; i++) {
        if (places[i] <= at || places[i] >= high) continue;
        prom_cut_to(c, at, places[i], cell);
        at = places[i];
    }
    prom_cut_to(c, at, high, cell);
    cut_outwards(c, high, high + REACH, true);
}

static void build_land(prom_city *city, const land *l, uint32_t parent)
{
    static const char *const names[4] = {"land_north", "land_south", "land_west", "land_east"};
    static const struct {
        prom_city_texture texture;
        uint32_t rgb;
        float repeat;
    } paints[PAINT_COUNT] = {{PROM_CITY_GRASS, 0xf0ecd0, 7},
                             {PROM_CITY_ROWS, 0xffe8a0, 9},
                             {PROM_CITY_ROWS, 0xe6f0c8, 9},
                             {PROM_CITY_GRASS, 0x9aa888, 7},
                             {PROM_CITY_ASPHALT, 0xe8e4dc, 4}};
    float w = PROM_CITY_WATER_WIDTH / 2;
    const float river[8] = {l->river - w - 12, l->river - w - 5, l->river - w,
                            l->river - w + 2,  l->river + w - 2, l->river + w,
                            l->river + w + 5,  l->river + w + 12};
    const float road[2] = {l->road - ROAD_HALF, l->road + ROAD_HALF};
    prom_cuts x = {0}, z = {0};
    cut_land(&x, l->x0, l->x1, road, 2);
    cut_land(&z, l->z0, l->z1, river, 8);
    prom_grid g = {.x = &x,
                   .z = &z,
                   .paint_of = land_cell,
                   .height_of = land_height,
                   .shift = land_shift,
                   .user = l};
    for (int part = 0; part < 4; part++) {
        prom_solid shape;
        prom_solid_init(&shape);
        for (int i = 0; i < PAINT_COUNT; i++) {
            prom_solid_use(&shape, prom_city_paint(city, paints[i].texture, paints[i].rgb,
                                                   paints[i].repeat));
            prom_grid_build(&shape, &g, part * PAINT_COUNT + i);
        }
        prom_city_add_mesh(city, names[part], parent,
                           prom_solid_write(&shape, city->glb, names[part]), 0, 0, 0);
        prom_solid_finish(&shape);
    }
}

// ---- water

static int water_cell(const void *user, float x, float z)
{
    (void)user;
    (void)x;
    (void)z;
    return 0;
}

static float water_height(const void *user, float x, float z)
{
    (void)user;
    return PROM_CITY_WATER_LEVEL + 0.02f * sinf(0.9f * x + 0.4f * z) * sinf(0.7f * z);
}

static void build_water(prom_city *city, const land *l, uint32_t parent)
{
    prom_cuts x = {0}, z = {0};
    float w = PROM_CITY_WATER_WIDTH / 2 + 6; // into the banks
    cut_outwards(&x, l->x0 - CREST, l->x0, false);
    prom_cut_to(&x, l->x0, l->x1, fmaxf(5, (l->x1 - l->x0) / 400));
    cut_outwards(&x, l->x1, l->x1 + CREST, true);
    prom_cut_to(&z, l->river - w, l->river + w, 5);
    prom_grid g = {.x = &x,
                   .z = &z,
                   .paint_of = water_cell,
                   .height_of = water_height,
                   .shift = land_shift,
                   .user = l};
    prom_solid shape;
    prom_solid_init(&shape);
    prom_solid_use(&shape, prom_city_paint(city, PROM_CITY_WATER, 0xffffff, 9));
    prom_grid_build(&shape, &g, 0);
    prom_city_add_mesh(city, "water", parent, prom_solid_write(&shape, city->glb, "water"), 0,
                       0, 0);
    prom_solid_finish(&shape);
}

// ---- what grows and stands there

typedef struct planter {
    prom_city *city;
    const land *l;
    uint32_t node;
    prom_random random;
} planter;

static void plant(planter *p, prom_city_kind kind, float x, float z, float yaw, float sink,
                  float scale)
{
    float y = land_height(p->l, x, z) - sink;
    land_shift(p->l, &x, &z);
    prom_city_place_any(p->city, kind, p->node, x, y, z, yaw, scale, &p->random);
}

static float turn(planter *p)
{
    return prom_random_between(&p->random, 0, 2 * PI);
}

// Free-standing houses with gardens along the outer streets.
static void plant_villas(planter *p)
{
    const land *l = p->l;
    for (int side = 0; side < 4; side++) {
        bool along_x = side < 2;
        float length = along_x ? l->x1 - l->x0 : l->z1 - l->z0;
        uint32_t count = (uint32_t)(length / 33);
        float yaw = along_x ? (side ? PI : 0) : (side == 2 ? PI / 2 : -PI / 2);
        float edge = side == 0 ? l->z0 : side == 1 ? l->z1 : side == 2 ? l->x0 : l->x1;
        float away = side % 2 ? 1.0f : -1.0f;
        for (uint32_t i = 0; i < count; i++) {
            float at = length * ((float)i + 0.5f) / (float)count + (along_x ? l->x0 : l->z0);
            if (fabsf(at - (along_x ? l->road : l->river)) < (along_x ? 14.0f : 38.0f))
                continue;
            for (int thing = 0; thing < 4; thing++) {
                float out = 11, a = at;
                if (thing) {
                    out = prom_random_between(&p->random, 26, FLAT - 4);
                    a += prom_random_between(&p->random, -11, 11);
                }
                plant(p,
                      !thing      ? PROM_CITY_VILLA
                      : thing < 3 ? PROM_CITY_TREE
                                  : PROM_CITY_SHRUB,
                      along_x ? a : edge + away * out, along_x ? edge + away * out : a,
                      thing ? turn(p) : yaw, thing ? 0.1f : 0,
                      thing ? prom_random_between(&p->random, 0.7f, 1) : 1);
            }
        }
    }
}

static void plant_woods(planter *p)
{
    const land *l = p->l;
    float step = 50, w = l->x1 - l->x0 + 2 * CREST, d = l->z1 - l->z0 + 2 * CREST;
    // Not more in a large city's surroundings than one can afford.
    step = fmaxf(step, sqrtf(w * d / 1200));
    for (float z = l->z0 - CREST; z < l->z1 + CREST; z += step) {
        for (float x = l->x0 - CREST; x < l->x1 + CREST; x += step) {
            float px = x + prom_random_between(&p->random, -0.3f, 0.3f) * step;
            float pz = z + prom_random_between(&p->random, -0.3f, 0.3f) * step;
            float out = outside(l, px, pz);
            float far = smooth_step(150, CREST, out), lot = prom_random_unit(&p->random);
            if (out > CREST || !is_forest(l, px, pz) || lot < 0.25f * far) continue;
            plant(p, PROM_CITY_GROVE, px, pz, turn(p), 0.4f,
                  prom_random_between(&p->random, 0.85f, 1.1f) + 0.5f * far);
        }
    }
}

// Trees by the road, the river and between the fields.
static void plant_lines(planter *p)
{
    const land *l = p->l;
    for (float out = 18; out < 230; out += 17) {
        for (int side = 0; side < 4; side++) {
            float away = side & 1 ? 1.0f : -1.0f, edge = side & 2 ? 1.0f : -1.0f;
            float z = edge > 0 ? l->z1 + out : l->z0 - out;
            plant(p, PROM_CITY_STREET_TREE, l->road + 6 * away, z, turn(p), 0.1f,
                  prom_random_between(&p->random, 1.1f, 1.4f));
            if (out < 30 || prom_random_unit(&p->random) < 0.3f) continue;
            float x = edge > 0 ? l->x1 + out : l->x0 - out;
            float bank = PROM_CITY_WATER_WIDTH / 2 + prom_random_between(&p->random, 10, 17);
            plant(p, prom_random_unit(&p->random) < 0.5f ? PROM_CITY_WILLOW : PROM_CITY_TREE, x,
                  l->river + away * bank, turn(p), 0.15f, 1);
        }
    }
}

// Vineyards where a slope falls towards the city: each a set of terraces that follows it.
static void plant_vines(planter *p)
{
    const land *l = p->l;
    uint32_t first = p->city->first[PROM_CITY_TERRACE];
    float places[VINEYARDS][2];
    int placed = 0;
    for (int i = 0; i < 400 && placed < VINEYARDS; i++) {
        float angle = turn(p), reach = prom_random_between(&p->random, 110, 330);
        float x = (l->x0 + l->x1) / 2 + cosf(angle) * ((l->x1 - l->x0) / 2 + reach);
        float z = (l->z0 + l->z1) / 2 + sinf(angle) * ((l->z1 - l->z0) / 2 + reach);
        float dx = (land_height(l, x + 9, z) - land_height(l, x - 9, z)) / 18;
        float dz = (land_height(l, x, z + 9) - land_height(l, x, z - 9)) / 18;
        float slope = hypotf(dx, dz);
        if (slope < 0.17f || slope > 0.27f || is_forest(l, x, z) || fabsf(x - l->road) < 30 ||
            fabsf(z - l->river) < 60 || outside(l, x, z) < 60)
            continue;
        bool taken = false;
        for (int k = 0; k < placed; k++)
            taken |= hypotf(x - places[k][0], z - places[k][1]) < 52;
        if (taken) continue;
        places[placed][0] = x;
        places[placed++][1] = z;
        // Its front looks down the slope.
        float y = land_height(l, x, z);
        land_shift(l, &x, &z);
        prom_city_place(p->city, first, p->node, x, y, z, atan2f(-dx, -dz), 1);
    }
}

void prom_city_lay_land(prom_city *city, const prom_city_plan *plan, uint32_t root)
{
    // Just under the outer streets.
    float in = PROM_CITY_ROAD_WIDTH / 2 - 0.5f;
    bool river = plan->river != PROM_GLB_NONE;
    const land l = {
        .x0 = plan->street_x[0] - in,
        .z0 = plan->street_z[0] - in,
        .x1 = plan->street_x[plan->columns] + in,
        .z1 = plan->street_z[plan->rows] + in,
        .river =
            river ? (plan->street_z[plan->river] + plan->street_z[plan->river + 1]) / 2 : 1e6f,
        .road = plan->street_x[plan->middle],
    };
    uint32_t node = prom_city_add_group(city, "land", root, 0, 0, 0);
    build_land(city, &l, node);
    if (river) build_water(city, &l, node);
    planter p = {city, &l, node, prom_random_stream(city->options.seed, 300, 0)};
    plant_villas(&p);
    plant_woods(&p);
    plant_lines(&p);
    if (river) plant_vines(&p);
}
