#include "scenes/city_parts.h"

#include <math.h>

// What is drawn by lot for a house.
typedef struct style {
    float width, depth;
    uint32_t storeys, bays, door_bay, wall_rgb, trim_rgb, roof_rgb, door_rgb, shutter_rgb;
    float floors[6];
    prom_city_texture wall, cover;
    float pitch;
    prom_roof_kind roof;
    bool corner, shop, shutters, pediments, keystones, balcony, surrounds, courses, quoins;
    int bars_across, bars_up;
    uint32_t dormers, chimneys;
} style;

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

static void draw_colors(style *s, prom_random *random)
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

static void draw_roof(style *s, prom_random *random)
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

static style draw_style(const prom_city *city, uint32_t number)
{
    style s = {0};
    prom_random random = prom_random_stream(city->options.seed, PROM_CITY_HOUSE, number);
    // Every third style may stand at a corner.
    s.corner = number % 3 == 1;
    s.bays = 2 + prom_random_below(&random, 3);
    s.width = (float)s.bays * prom_random_between(&random, 2.35f, 2.75f) + 0.6f;
    s.depth = prom_random_between(&random, 8.5f, 11.0f);
    s.storeys = 2 + prom_random_below(&random, 2) + (prom_random_unit(&random) < 0.25f);
    s.shop = prom_random_unit(&random) < 0.3f;
    float tall = prom_random_between(&random, 2.75f, 3.25f);
    for (uint32_t i = 0; i < s.storeys; i++)
        s.floors[i + 1] =
            s.floors[i] + tall + (i ? 0 : 0.45f) - (i + 1 == s.storeys ? 0.25f : 0);
    s.door_bay = prom_random_below(&random, 2) ? 0 : s.bays - 1;
    draw_colors(&s, &random);
    draw_roof(&s, &random);
    float ornament = prom_random_unit(&random);
    s.shutters = ornament < 0.25f;
    s.surrounds = !s.shutters && ornament < 0.8f;
    s.pediments = ornament > 0.62f && ornament < 0.8f;
    s.keystones = ornament > 0.4f && ornament < 0.7f;
    s.courses = prom_random_unit(&random) < 0.6f;
    s.quoins = prom_random_unit(&random) < 0.4f;
    s.balcony = prom_random_unit(&random) < 0.22f;
    s.bars_across = 1 + (int)prom_random_below(&random, 2);
    s.bars_up = 1 + (prom_random_unit(&random) < 0.2f);
    return s;
}

void prom_city_measure_house(const prom_city *city, prom_city_prototype *house)
{
    style s = draw_style(city, house->number);
    house->width = s.width;
    house->depth = s.depth;
    house->corner = s.corner;
}

// ---- geometry

// The mouldings of a front: plinth between the doors, courses between the storeys, a cornice.
static void build_bands(prom_solid *shape, const prom_facade *f, bool courses, bool plain)
{
    static const float course[4][2] = {{0, 0}, {0, 0.07f}, {0.12f, 0.07f}, {0.16f, 0}};
    static const float cornice[9][2] = {{0, 0},         {0.04f, 0.05f}, {0.10f, 0.06f},
                                        {0.12f, 0.11f}, {0.17f, 0.15f}, {0.20f, 0.21f},
                                        {0.27f, 0.22f}, {0.27f, 0.24f}, {0.30f, 0}};
    static const float simple[3][2] = {{0, 0}, {0.22f, 0.2f}, {0.3f, 0}};
    float top = f->floors[f->storeys], bay = f->width / (float)(f->bays ? f->bays : 1);
    prom_solid_use(shape, f->trim);
    float x = 0;
    for (uint32_t i = 0; i <= f->bays; i++) {
        bool last = i == f->bays, door = f->has_door && i == f->door_bay;
        if (!last && !door) continue;
        float end = last ? f->width : bay * ((float)i + 0.5f) - 0.72f;
        if (end > x + 0.05f)
            prom_solid_box(shape, x, -0.1f, 0, end, 0.42f, 0.05f, PROM_FACE_NO_BACK);
        x = end + 1.44f;
    }
    for (uint32_t s = 1; courses && !plain && s < f->storeys; s++) {
        prom_solid_frame old = prom_solid_enter(shape, 0, f->floors[s] + 0.1f, 0, 0);
        prom_solid_moulding(shape, course, 4, 0, f->width);
        prom_solid_leave(shape, old);
    }
    prom_solid_frame old = prom_solid_enter(shape, 0, top - 0.3f, 0, 0);
    if (plain || f->detail < 2)
        prom_solid_moulding(shape, simple, 3, 0, f->width);
    else
        prom_solid_moulding(shape, cornice, 9, 0, f->width);
    prom_solid_leave(shape, old);
    // Blocks under the cornice.
    float gap = f->detail == 3 ? 0.5f : 0.3f;
    for (int i = 0; f->detail > 2 && !plain && (float)i * gap < f->width - 0.3f; i++)
        prom_solid_box(shape, 0.12f + gap * (float)i, top - 0.46f, 0, 0.24f + gap * (float)i,
                       top - 0.3f, 0.12f, PROM_FACE_NO_BACK & ~PROM_FACE_TOP);
}

static void build_quoins(prom_solid *shape, const prom_facade *f)
{
    int n = (int)((f->floors[f->storeys] - 0.9f) / 0.42f);
    prom_solid_use(shape, f->trim);
    for (int i = 0; i < n; i++) {
        float y = 0.44f + 0.42f * (float)i, w = i % 2 ? 0.3f : 0.48f;
        prom_solid_box(shape, 0, y, 0, w, y + 0.39f, 0.04f, PROM_FACE_NO_BACK);
        prom_solid_box(shape, f->width - w, y, 0, f->width, y + 0.39f, 0.04f,
                       PROM_FACE_NO_BACK);
    }
}

static void build_downpipe(prom_solid *shape, const prom_facade *f)
{
    float top = f->floors[f->storeys];
    const float points[4][3] = {{0.18f, 0.05f, 0.13f},
                                {0.18f, top - 0.55f, 0.13f},
                                {0.18f, top - 0.3f, 0.36f},
                                {0.18f, top - 0.1f, 0.36f}};
    static const float radii[4] = {0.05f, 0.05f, 0.05f, 0.05f};
    prom_solid_use(shape, f->frame);
    prom_solid_tube(shape, points, radii, 4, f->detail < 3 ? 5 : f->detail == 3 ? 8 : 12);
}

static void build_walls(prom_city *city, prom_solid *shape, const style *s, prom_facade front,
                        prom_random *random)
{
    prom_facade back = front, side = front;
    prom_solid_frame old = prom_solid_enter(shape, -s->width / 2, 0, 0, 0);
    prom_city_build_facade(city, shape, &front, random);
    build_bands(shape, &front, s->courses, false);
    if (s->quoins && front.detail > 1) build_quoins(shape, &front);
    if (front.detail > 1) build_downpipe(shape, &front);
    prom_solid_leave(shape, old);
    // Behind and at the sides everything is plainer.
    back.surrounds = back.pediments = back.keystones = back.balcony = back.shutters = false;
    back.has_shop = false;
    back.bars_across = 1;
    back.door_bay = s->bays / 2;
    old = prom_solid_enter(shape, s->width / 2, 0, -s->depth, 3.14159265f);
    prom_city_build_facade(city, shape, &back, random);
    build_bands(shape, &back, false, true);
    prom_solid_leave(shape, old);
    side = back;
    side.width = s->depth;
    side.has_door = false;
    side.surrounds = front.surrounds;
    // No window in a wall that a neighbour leans on.
    side.bays = s->corner ? 3 : 0;
    for (int i = 0; i < 2; i++) {
        old = i ? prom_solid_enter(shape, -s->width / 2, 0, -s->depth, -1.57079633f)
                : prom_solid_enter(shape, s->width / 2, 0, 0, 1.57079633f);
        prom_city_build_facade(city, shape, &side, random);
        if (s->corner) build_bands(shape, &side, s->courses, s->roof != PROM_ROOF_FLAT);
        prom_solid_leave(shape, old);
    }
}

void prom_city_build_house(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    style s = draw_style(city, which->number);
    prom_random random = prom_random_stream(city->options.seed, 100, which->number);
    float wall_repeat = s.wall == PROM_CITY_BRICK ? 1.3f : s.wall == PROM_CITY_STONE ? 2.4f : 3;
    prom_facade front = {
        .width = s.width,
        .bays = s.bays,
        .storeys = s.storeys,
        .floors = s.floors,
        .wall = prom_city_paint(city, s.wall, s.wall_rgb, wall_repeat),
        .trim = prom_city_paint(city, PROM_CITY_PLASTER, s.trim_rgb, 3),
        .frame = prom_city_paint(city, PROM_CITY_PLAIN, 0xf2efe8, 1),
        .door = prom_city_paint(city, PROM_CITY_WOOD, s.door_rgb, 1),
        .shutter = prom_city_paint(city, PROM_CITY_WOOD, s.shutter_rgb, 1),
        .has_door = true,
        .has_shop = s.shop,
        .door_bay = s.door_bay,
        .surrounds = s.surrounds,
        .shutters = s.shutters,
        .pediments = s.pediments,
        .keystones = s.keystones,
        .balcony = s.balcony,
        .bars_across = s.bars_across,
        .bars_up = s.bars_up,
        .detail = (int)city->options.detail,
    };
    build_walls(city, shape, &s, front, &random);
    prom_roof roof = {
        .kind = s.roof,
        .width = s.width,
        .depth = s.depth,
        .base = s.floors[s.storeys],
        .pitch = s.pitch,
        .side_overhang = s.corner ? 0.25f : 0.03f,
        .cover =
            prom_city_paint(city, s.cover, s.roof_rgb, s.cover == PROM_CITY_TILES ? 2.6f : 2),
        .wall = front.wall,
        .trim = front.trim,
        .brick = prom_city_paint(city, PROM_CITY_BRICK, bricks[2], 1.3f),
        .dormers = s.dormers,
        .chimneys = s.chimneys,
        .window = front,
        .detail = front.detail,
    };
    roof.window.surrounds = false;
    prom_city_build_roof(city, shape, &roof, &random);
}
