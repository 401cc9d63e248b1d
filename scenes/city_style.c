#include "scenes/city_style.h"

#include <math.h>

#define VILLAS_FROM 100000u // their numbers, apart from those of the houses in rows

#define PICK(random, table)                                                                    \
    ((table)[prom_random_below((random), sizeof(table) / sizeof *(table))])

// Colours chosen by taste: bricks, limes and stones of a northern town.
static const uint32_t bricks[] = {0xc98a6e, 0xbf7a62, 0xb26e5e, 0xcf9c78, 0xa87264, 0xd6b08e};
static const uint32_t limes[] = {0xf2e3c4, 0xe9cf9f, 0xf0d9b0, 0xe8b98e, 0xdca58c, 0xcfd8c4,
                                 0xb9cbd2, 0xf4efe4, 0xe3c4bd, 0xd8c9a8, 0xbfcfae, 0xe6dfd2};
static const uint32_t stones[] = {0xd9cfbb, 0xcbbfa6, 0xc2bdb2, 0xe0d2b4};
static const uint32_t clays[] = {0xc97f62, 0xbd7056, 0xb06852, 0xd4906c, 0xa86e5c};
static const uint32_t slates[] = {0x828b95, 0x737983, 0x8a878b, 0x6c767c};
static const uint32_t trims[] = {0xf4f0e6, 0xe9e2d2, 0xd8d0c0, 0xfaf8f2};
static const uint32_t doors[] = {0x2f5d50, 0x7a2f2a, 0x2c4a6e, 0x5a4632,
                                 0x3d3d40, 0x8a5a2c, 0x466b3a, 0x6e2f4a};

static uint32_t jitter(prom_random *random, uint32_t rgb)
{
    // Each style has a tint of its own.
    uint32_t out = 0;
    float factor = prom_random_between(random, 0.92f, 1.05f);
    for (int shift = 16; shift >= 0; shift -= 8) {
        float v =
            (float)(rgb >> shift & 255) * factor * prom_random_between(random, 0.97f, 1.03f);
        out |= (uint32_t)fminf(fmaxf(v, 0), 255) << shift;
    }
    return out;
}

static void draw_colors(prom_house_style *s, prom_random *random)
{
    float kind = prom_random_unit(random);
    if (kind < 0.42f) {
        s->wall = PROM_CITY_BRICK;
        s->wall_rgb = PICK(random, bricks);
    } else if (kind < 0.88f) {
        s->wall = PROM_CITY_PLASTER;
        s->wall_rgb = PICK(random, limes);
    } else {
        s->wall = PROM_CITY_STONE;
        s->wall_rgb = PICK(random, stones);
    }
    s->wall_rgb = jitter(random, s->wall_rgb);
    bool clay = prom_random_unit(random) < 0.62f;
    s->cover = clay ? PROM_CITY_TILES : PROM_CITY_SLATE;
    s->roof_rgb = clay ? PICK(random, clays) : PICK(random, slates);
    s->trim_rgb = PICK(random, trims);
    s->door_rgb = PICK(random, doors);
    s->shutter_rgb = PICK(random, doors);
}

static void draw_roof(prom_house_style *s, prom_random *random)
{
    static const prom_roof_kind row[] = {
        PROM_ROOF_GABLE,   PROM_ROOF_GABLE,       PROM_ROOF_GABLE,         PROM_ROOF_MANSARD,
        PROM_ROOF_MANSARD, PROM_ROOF_FRONT_GABLE, PROM_ROOF_STEPPED_GABLE, PROM_ROOF_FLAT};
    static const prom_roof_kind free[] = {PROM_ROOF_HIP, PROM_ROOF_HIP, PROM_ROOF_GABLE,
                                          PROM_ROOF_MANSARD, PROM_ROOF_STEPPED_GABLE};
    s->roof = s->corner ? PICK(random, free) : PICK(random, row);
    s->pitch = prom_random_between(random, 0.75f, 1.1f);
    if (s->roof == PROM_ROOF_HIP) s->pitch *= 0.75f;
    if (s->roof == PROM_ROOF_FRONT_GABLE || s->roof == PROM_ROOF_STEPPED_GABLE)
        s->pitch *= 1.25f;
    if (s->roof == PROM_ROOF_MANSARD) {
        s->cover = PROM_CITY_SLATE;
        s->roof_rgb = PICK(random, slates);
        s->dormers = s->bays > 3 ? 3 : 2;
    } else {
        s->dormers = prom_random_below(random, s->bays > 2 ? 3 : 2);
    }
    s->chimneys = prom_random_below(random, 3);
}

// Bays with balconies: the middle, every other one, or all.
static void draw_balconies(prom_house_style *s, prom_random *random)
{
    uint32_t lot = prom_random_below(random, 3);
    s->balconies = lot == 0 ? 1u << s->bays / 2 : lot == 1 ? 0x55u : 0xffu;
    s->balcony_top = lot == 0 && prom_random_below(random, 2) ? 1 : s->storeys - 1;
    if (lot == 2) s->balcony_top = 1;
}

static void set_floors(prom_house_style *s, float tall)
{
    for (uint32_t i = 0; i < s->storeys; i++)
        s->floors[i + 1] =
            s->floors[i] + tall + (i ? 0 : 0.45f) - (i + 1 == s->storeys ? 0.25f : 0);
}

static void draw_town(prom_house_style *s, prom_random *random)
{
    float ornament = prom_random_unit(random);
    s->shutters = ornament < 0.25f;
    s->surrounds = !s->shutters && ornament < 0.8f;
    s->pediments = ornament > 0.62f && ornament < 0.8f;
    s->keystones = ornament > 0.4f && ornament < 0.7f;
    s->courses = prom_random_unit(random) < 0.6f;
    s->quoins = prom_random_unit(random) < 0.4f;
    if (!s->shutters && prom_random_unit(random) < 0.42f) draw_balconies(s, random);
    s->flowers = prom_random_unit(random) < 0.3f;
    s->bars_across = 1 + (int)prom_random_below(random, 2);
    s->bars_up = 1 + (prom_random_unit(random) < 0.2f);
}

static void draw_tower_house(prom_house_style *s, uint32_t number)
{
    s->tower_side = number % 12 == 4 ? -1 : 1;
    s->storeys = s->storeys < 3 ? 3 : s->storeys;
    s->roof = PROM_ROOF_HIP;
    s->dormers = 1;
}

static void draw_arcade(prom_house_style *s, prom_random *random)
{
    s->storeys = s->storeys < 3 ? 3 : s->storeys;
    s->shop = true;
    s->quoins = false; // they would hang over the arches
    s->door_bay = s->bays - 1;
    if (s->wall == PROM_CITY_BRICK) {
        s->wall = PROM_CITY_PLASTER;
        s->wall_rgb = jitter(random, PICK(random, limes));
    }
}

static void draw_warehouse(prom_house_style *s, prom_random *random)
{
    static const uint32_t dark[] = {0xa8644e, 0x96564a, 0xb07858, 0x8c5a4c};
    s->bays = 3;
    s->storeys = 4 + prom_random_below(random, 2);
    s->width = prom_random_between(random, 8.6f, 10.4f);
    s->wall = PROM_CITY_BRICK;
    s->wall_rgb = jitter(random, PICK(random, dark));
    s->roof = prom_random_below(random, 3) ? PROM_ROOF_FRONT_GABLE : PROM_ROOF_STEPPED_GABLE;
    s->pitch = prom_random_between(random, 0.85f, 1.05f);
    s->dormers = s->chimneys = 0;
    s->shutters = s->surrounds = s->pediments = s->flowers = s->shop = s->quoins = false;
    s->balconies = 0;
    s->bars_across = 2;
    s->bars_up = 2;
}

static void draw_modern(prom_house_style *s, prom_random *random)
{
    static const uint32_t light[] = {0xf4f3ef, 0xe2e2de, 0xd6cdbf, 0xb9b4ac, 0xc88a66};
    s->bays = 2 + prom_random_below(random, 2);
    s->width = (float)s->bays * prom_random_between(random, 3.1f, 3.7f) + 0.4f;
    s->storeys = 3 + prom_random_below(random, 2);
    s->wall = prom_random_below(random, 4) ? PROM_CITY_PLASTER : PROM_CITY_BRICK;
    s->wall_rgb = jitter(random, PICK(random, light));
    s->trim_rgb = 0x9a9c9c;
    s->roof = PROM_ROOF_FLAT;
    s->chimneys = s->dormers = 0;
    s->shutters = s->surrounds = s->pediments = s->courses = s->quoins = s->flowers = false;
    s->balconies = prom_random_below(random, 3) ? 1u + prom_random_below(random, 6) : 0;
    s->balcony_top = s->storeys - 1;
    s->door_rgb = 0x44484c;
}

static void draw_villa(prom_house_style *s, prom_random *random)
{
    s->storeys = 2;
    s->bays = 3 + prom_random_below(random, 2);
    s->width = (float)s->bays * prom_random_between(random, 2.4f, 2.8f) + 0.6f;
    s->depth = prom_random_between(random, 8, 9.5f);
    s->shop = false;
    s->roof = prom_random_below(random, 3) ? PROM_ROOF_HIP : PROM_ROOF_GABLE;
    s->pitch = prom_random_between(random, 0.65f, 0.85f);
    s->chimneys = 1;
    s->dormers = prom_random_below(random, 2);
    s->balcony_top = 1;
    s->balconies &= 1u << s->bays / 2;
}

static prom_house_class class_of(uint32_t number)
{
    if (number >= VILLAS_FROM) return PROM_HOUSE_VILLA;
    if (number % 24 == 10) return PROM_HOUSE_TOWN;
    // The 2nd, 5th, 8th and 11th may stand at corners.
    static const prom_house_class classes[12] = {
        PROM_HOUSE_TOWN,  PROM_HOUSE_TOWN,      PROM_HOUSE_MODERN, PROM_HOUSE_ARCADE,
        PROM_HOUSE_TOWER, PROM_HOUSE_WAREHOUSE, PROM_HOUSE_TOWN,   PROM_HOUSE_TOWER,
        PROM_HOUSE_TOWN,  PROM_HOUSE_TOWN,      PROM_HOUSE_MODERN, PROM_HOUSE_WAREHOUSE};
    return classes[number % 12];
}

prom_house_style prom_city_draw_style(const prom_city *city, const prom_city_prototype *house)
{
    uint32_t number = house->number + (house->kind == PROM_CITY_VILLA ? VILLAS_FROM : 0);
    prom_house_style s = {.class = class_of(number),
                          .corner = number % 3 == 1 || number >= VILLAS_FROM};
    prom_random random = prom_random_stream(city->options.seed, PROM_CITY_HOUSE, number);
    s.bays = 2 + prom_random_below(&random, 3);
    s.width = (float)s.bays * prom_random_between(&random, 2.35f, 2.75f) + 0.6f;
    s.depth = prom_random_between(&random, 8.5f, 11.0f);
    s.storeys = 2 + prom_random_below(&random, 2) + (prom_random_unit(&random) < 0.25f);
    s.shop = prom_random_unit(&random) < 0.35f;
    float tall = prom_random_between(&random, 2.75f, 3.25f);
    draw_colors(&s, &random);
    draw_roof(&s, &random);
    draw_town(&s, &random);
    if (s.class == PROM_HOUSE_TOWER) draw_tower_house(&s, number);
    if (s.class == PROM_HOUSE_ARCADE) draw_arcade(&s, &random);
    if (s.class == PROM_HOUSE_WAREHOUSE) draw_warehouse(&s, &random);
    if (s.class == PROM_HOUSE_MODERN) draw_modern(&s, &random);
    if (s.class == PROM_HOUSE_VILLA) draw_villa(&s, &random);
    if (s.class != PROM_HOUSE_ARCADE)
        s.door_bay = prom_random_below(&random, 2) ? 0 : s.bays - 1;
    set_floors(&s, tall);
    return s;
}

void prom_city_measure_house(const prom_city *city, prom_city_prototype *house)
{
    prom_house_style s = prom_city_draw_style(city, house);
    house->width = s.width;
    house->depth = s.depth;
    house->corner = s.corner;
    house->class = s.class;
    house->tower_side = s.tower_side;
}
