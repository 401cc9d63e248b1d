#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265f
#define VILLAS_FROM 100000u // their numbers, apart from those of the houses in rows
#define ARCADE_DEPTH 2.7f
#define ARCADE_THICK 0.45f

// What is drawn by lot for a house.
typedef struct style {
    prom_house_class class;
    int tower_side;
    float width, depth;
    uint32_t storeys, bays, door_bay, wall_rgb, trim_rgb, roof_rgb, door_rgb, shutter_rgb;
    float floors[7];
    prom_city_texture wall, cover;
    float pitch;
    prom_roof_kind roof;
    bool corner, shop, shutters, pediments, keystones, surrounds, courses, quoins, flowers;
    uint32_t balconies, balcony_top;
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

// Bays with balconies: the middle, every other one, or all.
static void draw_balconies(style *s, prom_random *random)
{
    uint32_t lot = prom_random_below(random, 3);
    s->balconies = lot == 0 ? 1u << s->bays / 2 : lot == 1 ? 0x55u : 0xffu;
    s->balcony_top = lot == 0 && prom_random_below(random, 2) ? 1 : s->storeys - 1;
    if (lot == 2) s->balcony_top = 1;
}

static void set_floors(style *s, float tall)
{
    for (uint32_t i = 0; i < s->storeys; i++)
        s->floors[i + 1] =
            s->floors[i] + tall + (i ? 0 : 0.45f) - (i + 1 == s->storeys ? 0.25f : 0);
}

static void draw_town(style *s, prom_random *random)
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

static void draw_tower_house(style *s, uint32_t number)
{
    s->tower_side = number % 12 == 4 ? -1 : 1;
    s->storeys = s->storeys < 3 ? 3 : s->storeys;
    s->roof = PROM_ROOF_HIP;
    s->dormers = 1;
}

static void draw_arcade(style *s, prom_random *random)
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

static void draw_warehouse(style *s, prom_random *random)
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

static void draw_modern(style *s, prom_random *random)
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

static void draw_villa(style *s, prom_random *random)
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

static style draw_style(const prom_city *city, uint32_t number)
{
    style s = {.class = class_of(number), .corner = number % 3 == 1 || number >= VILLAS_FROM};
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
    style s = draw_style(city, house->number);
    house->width = s.width;
    house->depth = s.depth;
    house->corner = s.corner;
    house->class = s.class;
    house->tower_side = s.tower_side;
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
    for (uint32_t i = 0; !f->from && !f->loading && i <= f->bays; i++) {
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

// The open ground storey of an arcade: arches in front, shops behind.
static void build_arcade_storey(prom_city *city, prom_solid *shape, const style *s,
                                const prom_facade *front, prom_random *random)
{
    prom_facade inner = *front;
    float h = s->floors[1], w = s->width, in = 0.02f, z = -ARCADE_DEPTH;
    int points = front->detail < 2 ? 6 : front->detail < 4 ? 10 : 20;
    inner.from = 0;
    inner.storeys = 1;
    inner.surrounds = inner.pediments = false;
    prom_solid_frame old = prom_solid_enter(shape, 0, 0, z, 0);
    prom_city_build_facade(city, shape, &inner, random);
    prom_solid_leave(shape, old);
    prom_solid_use(shape, front->wall);
    prom_city_build_arcade(shape, w, s->bays, h, ARCADE_THICK, points);
    prom_solid_quad(shape, (float[]){in, 0, -ARCADE_THICK}, (float[]){in, 0, z},
                    (float[]){in, h, z}, (float[]){in, h, -ARCADE_THICK});
    prom_solid_quad(shape, (float[]){w - in, 0, z}, (float[]){w - in, 0, -ARCADE_THICK},
                    (float[]){w - in, h, -ARCADE_THICK}, (float[]){w - in, h, z});
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, 0xf2ede2, 3));
    prom_solid_quad(shape, (float[]){0, h - 0.03f, z}, (float[]){w, h - 0.03f, z},
                    (float[]){w, h - 0.03f, -0.1f}, (float[]){0, h - 0.03f, -0.1f});
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PAVING, 0xe0d8cc, 1.6f));
    prom_solid_floor(shape, 0, z, w, 0.02f, 0.03f, 4);
}

static void build_tower(prom_city *city, prom_solid *shape, const style *s, prom_facade face,
                        prom_random *random)
{
    const float r = 1.65f, low = s->floors[1] + 0.02f;
    const float in = r * cosf(PI / 8), width = 2 * r * sinf(PI / 8);
    float floors[8], top = s->floors[s->storeys];
    memcpy(floors, s->floors, sizeof s->floors);
    floors[s->storeys + 1] = top + 2.6f;
    face.width = width;
    face.bays = 1;
    face.storeys = s->storeys + 1;
    face.from = 1;
    face.floors = floors;
    face.balconies = 0;
    face.detail = face.detail > 1 ? face.detail - 1 : 1;
    face.shutters = face.surrounds = face.flowers = false;
    prom_solid_frame old =
        prom_solid_enter(shape, (float)s->tower_side * (s->width / 2 - 0.1f), 0, -0.1f, 0);
    for (int i = 0; i < 8; i++) {
        float yaw = PI / 4 * (float)i;
        // The side in the house's corner is left out.
        if (sinf(yaw) * (float)s->tower_side < -0.5f && cosf(yaw) < -0.5f) continue;
        prom_solid_frame side = prom_solid_enter(shape, 0, 0, 0, yaw);
        prom_solid_enter(shape, -width / 2, 0, in, 0);
        prom_city_build_facade(city, shape, &face, random);
        prom_solid_leave(shape, side);
    }
    const float corbel[4][2] = {
        {0.1f, low - 1.5f}, {0.8f, low - 1.0f}, {r, low - 0.2f}, {r + 0.06f, low}};
    const float course[4][2] = {{r, top + 2.3f},
                                {r + 0.14f, top + 2.42f},
                                {r + 0.22f, top + 2.6f},
                                {r - 0.1f, top + 2.66f}};
    const float cone[4][2] = {
        {r + 0.3f, top + 2.55f}, {r * 0.72f, top + 3.5f}, {0.1f, top + 7.0f}, {0, top + 7.9f}};
    prom_solid_frame octagon = prom_solid_enter(shape, 0, 0, 0, PI / 8);
    prom_solid_use(shape, face.trim);
    prom_solid_lathe(shape, corbel, 4, 8, false);
    prom_solid_lathe(shape, course, 4, 8, false);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_SLATE, s->roof_rgb, 2));
    prom_solid_lathe(shape, cone, 4, 8, false);
    prom_solid_leave(shape, octagon);
    prom_solid_leave(shape, old);
}

// The beam and hook above a warehouse's doors.
static void build_hoist(prom_city *city, prom_solid *shape, const style *s)
{
    float y = s->floors[s->storeys] + 0.25f;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0x6a5140, 1));
    prom_solid_box(shape, -0.12f, y - 0.35f, 0, 0.12f, y - 0.08f, 1.5f, PROM_FACE_NO_BACK);
    prom_solid_use(shape, prom_city_plain(city, 0x26282a));
    prom_solid_box(shape, -0.02f, y - 1.4f, 1.28f, 0.02f, y - 0.35f, 1.32f, PROM_FACE_ALL);
    prom_solid_box(shape, -0.10f, y - 1.5f, 1.26f, 0.10f, y - 1.4f, 1.34f, PROM_FACE_ALL);
}

static void build_front(prom_city *city, prom_solid *shape, const style *s,
                        const prom_facade *front, prom_random *random)
{
    prom_solid_frame old = prom_solid_enter(shape, -s->width / 2, 0, 0, 0);
    prom_city_build_facade(city, shape, front, random);
    build_bands(shape, front, s->courses, s->class == PROM_HOUSE_MODERN);
    if (s->quoins && front->detail > 1) build_quoins(shape, front);
    if (front->detail > 1 && !front->from && s->class != PROM_HOUSE_MODERN)
        build_downpipe(shape, front);
    if (front->from) build_arcade_storey(city, shape, s, front, random);
    prom_solid_leave(shape, old);
}

static void build_walls(prom_city *city, prom_solid *shape, const style *s,
                        const prom_facade *front, prom_random *random)
{
    prom_facade back = *front, side;
    build_front(city, shape, s, front, random);
    // Behind and at the sides everything is plainer.
    back.from = 0;
    back.surrounds = back.pediments = back.keystones = back.shutters = back.flowers = false;
    back.has_shop = back.loading = false;
    back.has_door = true;
    if (!front->wide) back.balconies = 0;
    back.bars_across = 1;
    back.door_bay = s->bays / 2;
    prom_solid_frame old = prom_solid_enter(shape, s->width / 2, 0, -s->depth, PI);
    prom_city_build_facade(city, shape, &back, random);
    build_bands(shape, &back, false, true);
    prom_solid_leave(shape, old);
    side = back;
    side.width = s->depth;
    side.has_door = false;
    side.balconies = 0;
    side.surrounds = front->surrounds;
    // No window in a wall that a neighbour leans on.
    side.bays = s->corner ? 3 : 0;
    for (int i = 0; i < 2; i++) {
        old = i ? prom_solid_enter(shape, -s->width / 2, 0, -s->depth, -PI / 2)
                : prom_solid_enter(shape, s->width / 2, 0, 0, PI / 2);
        prom_city_build_facade(city, shape, &side, random);
        if (s->corner)
            build_bands(shape, &side, s->courses, s->roof != PROM_ROOF_FLAT || front->wide);
        prom_solid_leave(shape, old);
    }
}

void prom_city_build_house(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    uint32_t number = which->number + (which->kind == PROM_CITY_VILLA ? VILLAS_FROM : 0);
    style s = draw_style(city, number);
    prom_random random = prom_random_stream(city->options.seed, 100, number);
    float wall_repeat = s.wall == PROM_CITY_BRICK ? 1.3f : s.wall == PROM_CITY_STONE ? 2.4f : 3;
    prom_facade front = {
        .width = s.width,
        .bays = s.bays,
        .storeys = s.storeys,
        .floors = s.floors,
        .wall = prom_city_paint(city, s.wall, s.wall_rgb, wall_repeat),
        .trim = prom_city_paint(city, PROM_CITY_PLASTER, s.trim_rgb, 3),
        .frame = prom_city_plain(city, s.class == PROM_HOUSE_MODERN ? 0x3a3f44 : 0xf2efe8),
        .door = prom_city_paint(city, PROM_CITY_WOOD, s.door_rgb, 1),
        .shutter = prom_city_paint(city, PROM_CITY_WOOD, s.shutter_rgb, 1),
        .from = s.class == PROM_HOUSE_ARCADE,
        .wide = s.class == PROM_HOUSE_MODERN,
        .arched = s.class == PROM_HOUSE_WAREHOUSE,
        .loading = s.class == PROM_HOUSE_WAREHOUSE,
        .flowers = s.flowers,
        .has_door = s.class != PROM_HOUSE_WAREHOUSE,
        .has_shop = s.shop,
        .door_bay = s.door_bay,
        .surrounds = s.surrounds,
        .shutters = s.shutters,
        .pediments = s.pediments,
        .keystones = s.keystones,
        .balconies = s.balconies,
        .balcony_top = s.balcony_top,
        .bars_across = s.bars_across,
        .bars_up = s.bars_up,
        .detail = (int)city->options.detail,
    };
    build_walls(city, shape, &s, &front, &random);
    if (s.class == PROM_HOUSE_TOWER) build_tower(city, shape, &s, front, &random);
    if (s.class == PROM_HOUSE_WAREHOUSE) build_hoist(city, shape, &s);
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
    roof.window.surrounds = roof.window.arched = false;
    prom_city_build_roof(city, shape, &roof, &random);
}
