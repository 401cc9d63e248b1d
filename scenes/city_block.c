// What stands on a block of houses: rows around gardens; and along every block's pavement.
#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f
#define ROW_MAX 48
#define STRETCH 1.06f // houses grow by up to this to close a row
#define GAP_MIN 2.2f  // a gap that is left in a row is at least a passage
#define HOUSE_DEPTH 11.7f

static float turn(prom_city_site *s)
{
    return prom_random_between(s->random, 0, 2 * PI);
}

static void place_any(prom_city_site *s, prom_city_kind kind, float x, float z, float yaw,
                      float low, float high)
{
    prom_city_place_any(s->city, kind, s->node, x, PROM_CITY_KERB, z, yaw,
                        prom_random_between(s->random, low, high), s->random);
}

// ---- rows of houses

// What a place in a row asks for.
typedef struct wish {
    bool corner, warehouse;
    int tower_side; // where a tower may stand; 0: nowhere
    float widest;
} wish;

static bool fits(const prom_city_prototype *house, const wish *w)
{
    if (house->corner != w->corner || house->width > w->widest) return false;
    if (house->class == PROM_HOUSE_TOWER) return house->tower_side == w->tower_side;
    return w->corner || (house->class == PROM_HOUSE_WAREHOUSE) == w->warehouse;
}

// The least used of a few houses that fit, so that each style is seen; PROM_GLB_NONE: none
// fits.
static uint32_t pick_house(prom_city_site *s, const wish *w)
{
    uint32_t best = PROM_GLB_NONE, first = s->city->first[PROM_CITY_HOUSE];
    uint32_t count = s->city->first[PROM_CITY_HOUSE + 1] - first;
    const prom_city_prototype *all = s->city->prototypes.data;
    uint32_t start = prom_random_below(s->random, count), tries = 0;
    for (uint32_t k = 0; k < count && tries < 6; k++) {
        uint32_t i = first + (start + k) % count;
        if (!fits(&all[i], w)) continue;
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

static bool add_house(prom_city_site *s, row *r, const wish *w)
{
    uint32_t house = r->count < ROW_MAX ? pick_house(s, w) : PROM_GLB_NONE;
    if (house == PROM_GLB_NONE && w->warehouse)
        house = pick_house(s, &(wish){.widest = w->widest});
    if (house == PROM_GLB_NONE) return false;
    r->houses[r->count++] = house;
    r->total += s->city->prototypes.data[house].width;
    s->city->prototypes.data[house].uses++; // counted at once, so that a row varies
    return true;
}

// A row along `length` from (x, z), its fronts looking along the yaw's +z, its first house at
// the left end as seen from the street. Ends are houses with windows to the side, with towers
// where the ends are street corners.
static void fill_row(prom_city_site *s, float x, float z, float yaw, float length, bool corners,
                     bool warehouses)
{
    row r = {0};
    wish w = {.corner = true, .tower_side = corners ? -1 : 0, .widest = length};
    if (!add_house(s, &r, &w)) return;
    w.tower_side = -w.tower_side;
    w.widest = length - r.total;
    bool closed = add_house(s, &r, &w);
    do {
        w = (wish){.warehouse = warehouses, .widest = length - r.total};
    } while (closed && add_house(s, &r, &w));
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
    uint32_t gap = r.count > 1 ? 1 + prom_random_below(s->random, r.count - 1) : 0;
    float at = 0, c = cosf(yaw), sine = sinf(yaw);
    for (uint32_t i = 0; i < r.count; i++) {
        prom_city_prototype *house = &s->city->prototypes.data[r.houses[i]];
        if (i == gap) at += rest;
        float mid = at + house->width * scale / 2;
        house->uses--; // prom_city_place counts it again
        prom_city_place(s->city, r.houses[i], s->node, x + c * mid, PROM_CITY_KERB,
                        z - sine * mid, yaw, scale);
        at += house->width * scale;
    }
}

void prom_city_fill_houses(prom_city_site *s)
{
    float w = s->width, d = s->depth, o = PROM_CITY_PAVEMENT, between = HOUSE_DEPTH + 3;
    fill_row(s, o, o + d, 0, w, true, s->warehouses_to_south);
    fill_row(s, o + w, o, PI, w, true, s->warehouses_to_north);
    fill_row(s, o + w, o + d - between, PI / 2, d - 2 * between, false, false);
    fill_row(s, o, o + between, -PI / 2, d - 2 * between, false, false);
    float x0 = o + HOUSE_DEPTH + 2, x1 = o + w - HOUSE_DEPTH - 2;
    float z0 = o + HOUSE_DEPTH + 2, z1 = o + d - HOUSE_DEPTH - 2;
    uint32_t trees = 3 + prom_random_below(s->random, 3);
    for (uint32_t i = 0; i < trees; i++)
        place_any(s, PROM_CITY_TREE, prom_random_between(s->random, x0, x1),
                  prom_random_between(s->random, z0, z1), turn(s), 0.6f, 0.85f);
    for (uint32_t i = 0; i < 3; i++)
        place_any(s, PROM_CITY_SHRUB, prom_random_between(s->random, x0, x1),
                  prom_random_between(s->random, z0, z1), turn(s), 0.8f, 1.3f);
}

// ---- pavements

void prom_city_park_car(prom_city *city, uint32_t node, float x, float z, float yaw,
                        prom_random *random)
{
    bool back = prom_random_unit(random) < 0.15f;
    prom_city_place_any(city, PROM_CITY_CAR, node, x, 0, z, yaw + (back ? -PI / 2 : PI / 2),
                        prom_random_between(random, 0.97f, 1.04f), random);
}

// A place along one side of the block: `along` it and `in` from the kerb (negative: on the
// pavement).
typedef struct side {
    prom_city_site *site;
    float x, z, yaw;
} side;

static void put(const side *e, prom_city_kind kind, float along, float in, float yaw,
                float scale)
{
    float c = cosf(e->yaw), s = sinf(e->yaw);
    prom_city_place_any(e->site->city, kind, e->site->node, e->x + c * along + s * in,
                        PROM_CITY_KERB, e->z - s * along + c * in, e->yaw + yaw, scale,
                        e->site->random);
}

// Between two trees: something small, by lot.
static void put_between(const side *e, float along)
{
    prom_random *random = e->site->random;
    float lot = prom_random_unit(random);
    if (lot < 0.14f) put(e, PROM_CITY_BENCH, along, -0.8f, PI, 1);
    if (lot > 0.95f) put(e, PROM_CITY_BIN, along, -0.6f, 0, 1);
    if (lot > 0.20f && lot < 0.30f) put(e, PROM_CITY_BICYCLE, along, -1.15f, 0, 1);
    if (lot > 0.36f && lot < 0.40f) put(e, PROM_CITY_COLUMN, along, -1.1f, turn(e->site), 1);
}

static void fill_side(prom_city_site *site, float x, float z, float yaw, float length,
                      prom_city_kind lamp, bool gate)
{
    side e = {site, x, z, yaw};
    prom_random *random = site->random;
    float step = 9.3f;
    uint32_t n = (uint32_t)((length - 12) / step);
    for (uint32_t i = 0; i <= n; i++) {
        float along = (length - step * (float)n) / 2 + step * (float)i;
        bool free = gate && fabsf(along - length / 2) < PROM_CITY_PASSAGE;
        bool next_free = gate && fabsf(along + step / 2 - length / 2) < PROM_CITY_PASSAGE;
        if (free) continue;
        if (i % 3 == 1)
            put(&e, lamp, along, -0.7f, 0, 1);
        else
            put(&e, PROM_CITY_STREET_TREE, along, -0.95f, turn(site),
                prom_random_between(random, 0.9f, 1.1f));
        if (i < n && !next_free) put_between(&e, along + step / 2);
    }
    if (lamp == PROM_CITY_MAST) put(&e, PROM_CITY_SIGN, length - 5.6f, -0.45f, PI / 2, 1);
    float c = cosf(yaw), s = sinf(yaw), offset = 1.1f;
    for (uint32_t i = 0; i < prom_city_bays(length); i++) {
        if (prom_random_unit(random) > 0.28f) continue;
        float bay = prom_city_bay(length, i), along = length / 2 + bay;
        if (gate && fabsf(bay) < PROM_CITY_PASSAGE + PROM_CITY_BAY / 2) continue;
        prom_city_park_car(site->city, site->node, x + c * along + s * offset,
                           z - s * along + c * offset, yaw, random);
    }
}

void prom_city_fill_pavements(prom_city_site *s)
{
    float w = s->width + 2 * PROM_CITY_PAVEMENT, d = s->depth + 2 * PROM_CITY_PAVEMENT;
    // Old lamps along one direction of streets, modern ones along the other.
    fill_side(s, 0, d, 0, w, PROM_CITY_LAMP, false);
    fill_side(s, w, 0, PI, w, PROM_CITY_LAMP, s->gate);
    fill_side(s, w, d, PI / 2, d, PROM_CITY_MAST, false);
    fill_side(s, 0, 0, -PI / 2, d, PROM_CITY_MAST, false);
}
