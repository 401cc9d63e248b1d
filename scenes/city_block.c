// What stands on a block: rows of houses around gardens, a park, or a square.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f
#define ROW_MAX 48
#define STRETCH 1.06f // houses grow by up to this to close a row
#define GAP_MIN 2.2f  // a gap that is left in a row is at least a passage
#define HOUSE_DEPTH 11.7f

typedef struct filler {
    prom_city *city;
    uint32_t node;
    float width, depth;
    prom_random *random;
} filler;

static float turn(filler *f)
{
    return prom_random_between(f->random, 0, 2 * PI);
}

// Things of a kind: one by lot.
static void place_any(filler *f, prom_city_kind kind, float x, float z, float yaw, float low,
                      float high)
{
    uint32_t first = f->city->first[kind], count = f->city->first[kind + 1] - first;
    prom_city_place(f->city, first + prom_random_below(f->random, count), f->node, x,
                    PROM_CITY_KERB, z, yaw, prom_random_between(f->random, low, high));
}

// ---- rows of houses

// The least used of a few houses that fit, so that each style is seen; PROM_GLB_NONE: none
// fits.
static uint32_t pick_house(filler *f, bool corner, float widest)
{
    uint32_t best = PROM_GLB_NONE, first = f->city->first[PROM_CITY_HOUSE];
    uint32_t count = f->city->first[PROM_CITY_HOUSE + 1] - first;
    const prom_city_prototype *all = f->city->prototypes.data;
    uint32_t start = prom_random_below(f->random, count), tries = 0;
    for (uint32_t k = 0; k < count && tries < 6; k++) {
        uint32_t i = first + (start + k) % count;
        if (all[i].corner != corner || all[i].width > widest) continue;
        tries++;
        if (best == PROM_GLB_NONE || all[i].uses < all[best].uses) best = i;
    }
    return best;
}

typedef struct row {
    uint32_t houses[ROW_MAX];
    uint32_t count;
    float total;
} row;

static bool add_house(filler *f, row *r, bool corner, float widest)
{
    uint32_t house = r->count < ROW_MAX ? pick_house(f, corner, widest) : PROM_GLB_NONE;
    if (house == PROM_GLB_NONE) return false;
    r->houses[r->count++] = house;
    r->total += f->city->prototypes.data[house].width;
    f->city->prototypes.data[house].uses++; // counted at once, so that a row varies
    return true;
}

// A row along `length` from (x, z), its fronts looking along the yaw's +z, its first house at
// the right end as seen from the street. Ends are houses with windows to the side.
static void fill_row(filler *f, float x, float z, float yaw, float length)
{
    row r = {0};
    if (!add_house(f, &r, true, length)) return;
    bool closed = add_house(f, &r, true, length - r.total);
    while (closed && add_house(f, &r, false, length - r.total)) continue;
    if (closed) { // the second corner house goes to the far end
        uint32_t last = r.houses[1];
        memmove(&r.houses[1], &r.houses[2], (r.count - 2) * sizeof *r.houses);
        r.houses[r.count - 1] = last;
    }
    float scale = fminf(length / r.total, STRETCH), rest = length - r.total * scale;
    if (rest > 0 && rest < GAP_MIN) {
        scale = fminf(scale, (length - GAP_MIN) / r.total);
        rest = length - r.total * scale;
    }
    uint32_t gap = r.count > 1 ? 1 + prom_random_below(f->random, r.count - 1) : 0;
    float at = 0, c = cosf(yaw), s = sinf(yaw);
    for (uint32_t i = 0; i < r.count; i++) {
        prom_city_prototype *house = &f->city->prototypes.data[r.houses[i]];
        if (i == gap) at += rest;
        float mid = at + house->width * scale / 2;
        house->uses--; // prom_city_place counts it again
        prom_city_place(f->city, r.houses[i], f->node, x + c * mid, PROM_CITY_KERB, z - s * mid,
                        yaw, scale);
        at += house->width * scale;
    }
}

static void fill_houses(filler *f)
{
    float w = f->width, d = f->depth, o = PROM_CITY_PAVEMENT, between = HOUSE_DEPTH + 3;
    fill_row(f, o, o + d, 0, w);
    fill_row(f, o + w, o, PI, w);
    fill_row(f, o + w, o + d - between, PI / 2, d - 2 * between);
    fill_row(f, o, o + between, -PI / 2, d - 2 * between);
    float x0 = o + HOUSE_DEPTH + 2, x1 = o + w - HOUSE_DEPTH - 2;
    float z0 = o + HOUSE_DEPTH + 2, z1 = o + d - HOUSE_DEPTH - 2;
    uint32_t trees = 3 + prom_random_below(f->random, 3);
    for (uint32_t i = 0; i < trees; i++)
        place_any(f, PROM_CITY_TREE, prom_random_between(f->random, x0, x1),
                  prom_random_between(f->random, z0, z1), turn(f), 0.6f, 0.9f);
    for (uint32_t i = 0; i < 5; i++)
        place_any(f, PROM_CITY_SHRUB, prom_random_between(f->random, x0, x1),
                  prom_random_between(f->random, z0, z1), turn(f), 0.8f, 1.3f);
}

// ---- parks and squares

static void fill_park(filler *f)
{
    float w = f->width, d = f->depth, o = PROM_CITY_PAVEMENT, step = 8.5f;
    for (float z = 4; z < d - 3; z += step) {
        for (float x = 4; x < w - 3; x += step) {
            float px = x + prom_random_between(f->random, -2.2f, 2.2f);
            float pz = z + prom_random_between(f->random, -2.2f, 2.2f);
            float path = fminf(fabsf(px - w / 2), fabsf(pz - d / 2));
            if (path < 3.2f) continue;
            bool small = prom_random_unit(f->random) < 0.2f;
            place_any(f, small ? PROM_CITY_SHRUB : PROM_CITY_TREE, o + px, o + pz, turn(f),
                      0.8f, 1.15f);
        }
    }
    for (int i = 0; i < 8; i++) {
        // Along both paths, on both sides, looking at the path.
        float side = i & 1 ? 1.0f : -1.0f, at = i & 2 ? 0.3f : 0.7f;
        if (i & 4)
            place_any(f, PROM_CITY_BENCH, o + w / 2 + 2.1f * side, o + d * at, -side * PI / 2,
                      1, 1);
        else
            place_any(f, PROM_CITY_BENCH, o + w * at, o + d / 2 + 2.1f * side,
                      side > 0 ? PI : 0, 1, 1);
        if (i & 1) continue;
        float lx = i & 4 ? w / 2 + (i & 2 ? 2.0f : -2.0f) : w * (at + 0.12f);
        float lz = i & 4 ? d * (at + 0.12f) : d / 2 + (i & 2 ? 2.0f : -2.0f);
        place_any(f, PROM_CITY_LAMP, o + lx, o + lz, 0, 1, 1);
    }
}

static void fill_square(filler *f)
{
    float w = f->width, d = f->depth, o = PROM_CITY_PAVEMENT, cx = o + w / 2, cz = o + d / 2;
    place_any(f, PROM_CITY_FOUNTAIN, cx, cz, 0, 1, 1);
    for (int i = 0; i < 8; i++) {
        float a = 2 * PI * ((float)i + 0.5f) / 8;
        place_any(f, PROM_CITY_BENCH, cx + 6 * sinf(a), cz + 6 * cosf(a), a + PI, 1, 1);
    }
    for (int i = 0; i < 10; i++) {
        float x = o + w * (0.12f + 0.76f * (float)(i % 5) / 4);
        float z = cz + (i < 5 ? -0.30f : 0.30f) * d;
        if (prom_random_unit(f->random) < 0.8f)
            place_any(f, PROM_CITY_STALL, x, z, i < 5 ? 0 : PI, 1, 1);
    }
    for (float x = 3; x < w - 2; x += 7.5f)
        for (int k = 0; k < 2; k++)
            place_any(f, PROM_CITY_TREE, o + x, o + (k ? d - 2.5f : 2.5f), turn(f), 0.6f,
                      0.75f);
    for (int i = 0; i < 4; i++)
        place_any(f, PROM_CITY_LAMP, cx + (i & 1 ? 11.0f : -11.0f), cz + (i & 2 ? 7.0f : -7.0f),
                  PI / 4, 1, 1);
}

// ---- pavements

// Along one side of the block from (x, z) in the yaw's +x direction; the street is at its +z.
static void fill_side(filler *f, float x, float z, float yaw, float length)
{
    float c = cosf(yaw), s = sinf(yaw), step = 8.5f;
    uint32_t n = (uint32_t)((length - 12) / step);
    for (uint32_t i = 0; i <= n; i++) {
        float along = (length - step * (float)n) / 2 + step * (float)i, in = -0.95f;
        float px = x + c * along + s * in, pz = z - s * along + c * in;
        if (i % 3 == 1)
            place_any(f, PROM_CITY_LAMP, px, pz, yaw, 1, 1);
        else
            place_any(f, PROM_CITY_STREET_TREE, px, pz, turn(f), 0.9f, 1.1f);
        float lot = prom_random_unit(f->random), next = along + step / 2;
        px = x + c * next + s * in;
        pz = z - s * next + c * in;
        if (lot < 0.16f) place_any(f, PROM_CITY_BENCH, px, pz, yaw + PI, 1, 1);
        if (lot > 0.9f) place_any(f, PROM_CITY_BIN, px, pz, yaw, 1, 1);
        float offset = 1.15f; // a parked car, by the kerb, either way round
        if (i == n || prom_random_unit(f->random) > 0.36f) continue;
        uint32_t first = f->city->first[PROM_CITY_CAR];
        uint32_t cars = f->city->first[PROM_CITY_CAR + 1] - first;
        prom_city_place(f->city, first + prom_random_below(f->random, cars), f->node,
                        x + c * next + s * offset, 0, z - s * next + c * offset,
                        yaw + (prom_random_unit(f->random) < 0.5f ? PI / 2 : -PI / 2),
                        prom_random_between(f->random, 0.96f, 1.06f));
    }
}

void prom_city_fill_block(prom_city *city, uint32_t node, prom_city_use use, float width,
                          float depth, prom_random *random)
{
    filler f = {city, node, width, depth, random};
    float w = width + 2 * PROM_CITY_PAVEMENT, d = depth + 2 * PROM_CITY_PAVEMENT;
    if (use == PROM_CITY_USE_PARK)
        fill_park(&f);
    else if (use == PROM_CITY_USE_SQUARE)
        fill_square(&f);
    else
        fill_houses(&f);
    fill_side(&f, 0, d, 0, w);
    fill_side(&f, w, 0, PI, w);
    fill_side(&f, w, d, PI / 2, d);
    fill_side(&f, 0, 0, -PI / 2, d);
}
