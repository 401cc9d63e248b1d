#include "scenes/city_style.h"

#include <math.h>

#define PI 3.14159265f
#define ARCADE_DEPTH 2.7f
#define ARCADE_THICK 0.45f

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
static void build_arcade_storey(prom_city *city, prom_solid *shape, const prom_house_style *s,
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

static void build_tower(prom_city *city, prom_solid *shape, const prom_house_style *s,
                        prom_facade face, prom_random *random)
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
static void build_hoist(prom_city *city, prom_solid *shape, const prom_house_style *s)
{
    float y = s->floors[s->storeys] + 0.25f;
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WOOD, 0x6a5140, 1));
    prom_solid_box(shape, -0.12f, y - 0.35f, 0, 0.12f, y - 0.08f, 1.5f, PROM_FACE_NO_BACK);
    prom_solid_use(shape, prom_city_plain(city, 0x26282a));
    prom_solid_box(shape, -0.02f, y - 1.4f, 1.28f, 0.02f, y - 0.35f, 1.32f, PROM_FACE_ALL);
    prom_solid_box(shape, -0.10f, y - 1.5f, 1.26f, 0.10f, y - 1.4f, 1.34f, PROM_FACE_ALL);
}

static void build_front(prom_city *city, prom_solid *shape, const prom_house_style *s,
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

static void build_walls(prom_city *city, prom_solid *shape, const prom_house_style *s,
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

// What a villa has before it: a path to the street, a gate's posts, a hedge.
static void build_garden(prom_city *city, prom_solid *shape, const prom_house_style *s)
{
    const float front = 9.6f, gate = 0.9f, half = s->width / 2 + 4.5f;
    float door = s->width * (((float)s->door_bay + 0.5f) / (float)s->bays - 0.5f);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_GRAVEL, 0xffffff, 2));
    prom_solid_floor(shape, door - 0.7f, 0.3f, door + 0.7f, front + 0.4f, 0.02f, 3);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_GRASS, 0xa8c498, 1.7f));
    prom_solid_box(shape, -half, -0.1f, front - 0.7f, door - gate - 0.3f, 1.15f, front,
                   PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    prom_solid_box(shape, door + gate + 0.3f, -0.1f, front - 0.7f, half, 1.15f, front,
                   PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
    for (int i = 0; i < 2; i++) {
        float x = i ? half - 0.7f : -half;
        prom_solid_box(shape, x, -0.1f, -s->depth, x + 0.7f, 1.1f, front - 0.7f,
                       PROM_FACE_ALL & ~(PROM_FACE_BOTTOM | PROM_FACE_FRONT));
        float post = door + (i ? gate : -gate - 0.3f);
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_PLASTER, s->trim_rgb, 3));
        prom_solid_box(shape, post, -0.1f, front - 0.5f, post + 0.3f, 1.4f, front - 0.2f,
                       PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_GRASS, 0xa8c498, 1.7f));
    }
}

void prom_city_build_house(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    prom_house_style s = prom_city_draw_style(city, which);
    prom_random random =
        prom_random_stream(city->options.seed, 100 + which->kind, which->number);
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
    if (s.class == PROM_HOUSE_VILLA) build_garden(city, shape, &s);
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
        .brick = prom_city_paint(city, PROM_CITY_BRICK, 0xb26e5e, 1.3f),
        .dormers = s.dormers,
        .chimneys = s.chimneys,
        .window = front,
        .detail = front.detail,
    };
    roof.window.surrounds = roof.window.arched = false;
    prom_city_build_roof(city, shape, &roof, &random);
}
