// What stands free in a room. The middle lines between doors stay clear: things stand in the
// room's quarters.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f
#define LANE 0.9f   // half width of what stays clear
#define ALONG 0.75f // depth of what stands along the walls

typedef struct place {
    prom_gallery *g;
    uint32_t room, parent;
    const prom_gallery_room *r;
    prom_random *random;
    float x, z; // middle
} place;

static uint32_t pick(place *p)
{
    return (uint32_t)prom_random_next(p->random) & 1023;
}

static void put(const place *p, prom_gallery_thing thing, uint32_t variant, float x, float y,
                float z, float yaw, float scale)
{
    prom_gallery_place(p->g, p->parent, thing, variant, (float[]){x, p->r->y0 + y, z}, yaw,
                       scale);
}

// The middle of a quarter (0 to 3).
static void quarter(const place *p, int q, float at[2])
{
    float w = 0.5f * (p->r->x1 - p->r->x0), d = 0.5f * (p->r->z1 - p->r->z0);
    float x = 0.5f * (LANE + fmaxf(w - ALONG, LANE)),
          z = 0.5f * (LANE + fmaxf(d - ALONG, LANE));
    at[0] = p->x + (q & 1 ? x : -x);
    at[1] = p->z + (q & 2 ? z : -z);
}

static float facing(const place *p, const float at[2])
{
    return atan2f(p->x - at[0], p->z - at[1]);
}

static void see(const place *p, float x, float y, float z)
{
    prom_gallery_see(p->g, p->room, x, p->r->y0 + y, z);
}

// ---- groups

static void put_sculpture(place *p, float x, float z, float yaw, float scale)
{
    uint32_t v = pick(p);
    put(p, PROM_GALLERY_PLINTH, v / 4, x, 0, z, yaw, scale);
    put(p, v % 3 ? PROM_GALLERY_STATUE : PROM_GALLERY_ABSTRACT, v / 3, x, 0.5f * scale, z, yaw,
        scale);
    see(p, x, 1.5f * scale, z);
}

// An exhibit: most are vessels.
static void put_exhibit(place *p, float x, float y, float z, float yaw, float scale)
{
    static const prom_gallery_thing kinds[] = {
        PROM_GALLERY_VASE,  PROM_GALLERY_BOWL,    PROM_GALLERY_VASE, PROM_GALLERY_MODEL,
        PROM_GALLERY_SHELL, PROM_GALLERY_CRYSTAL, PROM_GALLERY_MASK, PROM_GALLERY_COINS};
    uint32_t v = pick(p);
    put(p, kinds[v % 8], v / 8, x, y, z, yaw, scale);
}

static void put_table_vitrine(place *p, float x, float z, float yaw)
{
    put(p, PROM_GALLERY_TABLE_VITRINE, pick(p), x, 0, z, yaw, 1);
    for (int k = -1; k <= 1; k++) {
        float u = 0.40f * (float)k;
        put_exhibit(p, x + u * cosf(yaw), PROM_GALLERY_TABLE_TOP, z - u * sinf(yaw), yaw, 1);
    }
    see(p, x, 1.0f, z);
}

static void put_tall_vitrine(place *p, float x, float z, float yaw)
{
    put(p, PROM_GALLERY_TALL_VITRINE, pick(p), x, 0, z, yaw, 1);
    for (int k = 0; k < 4; k++) {
        float u = k & 1 ? 0.21f : -0.21f;
        put_exhibit(p, x + u * cosf(yaw),
                    k & 2 ? PROM_GALLERY_TALL_SHELF : PROM_GALLERY_TALL_TOP, z - u * sinf(yaw),
                    yaw, 1.15f);
    }
    see(p, x, 1.35f, z);
}

static void put_seats(place *p, const float at[2], float yaw)
{
    uint32_t v = pick(p);
    put(p, PROM_GALLERY_RUG, v, at[0], 0, at[1], yaw, 0.85f);
    put(p, PROM_GALLERY_TABLE, v, at[0], 0.012f, at[1], yaw, 0.8f);
    for (int k = -1; k <= 1; k += 2) {
        float u = 0.82f * (float)k;
        put(p, PROM_GALLERY_ARMCHAIR, v, at[0] + u * cosf(yaw), 0.012f, at[1] - u * sinf(yaw),
            yaw - (float)k * PI / 2, 0.9f);
    }
    put(p, v & 4 ? PROM_GALLERY_VASE : PROM_GALLERY_BOWL, v, at[0], 0.60f, at[1], yaw, 1);
}

static void put_desk(place *p, const float at[2], float yaw)
{
    uint32_t v = pick(p);
    float c = cosf(yaw), s = sinf(yaw);
    put(p, PROM_GALLERY_DESK, v, at[0], 0, at[1], yaw, 1);
    put(p, PROM_GALLERY_CHAIR, v, at[0] + 0.62f * s, 0, at[1] + 0.62f * c, yaw + PI, 1);
}

// ---- rooms

static void furnish_quarter(place *p, int q)
{
    float at[2], yaw;
    quarter(p, q, at);
    yaw = facing(p, at);
    float straight = q & 2 ? PI : 0;
    uint32_t v = pick(p);
    switch (p->r->kind) {
    case PROM_GALLERY_CABINET:
        if (q == 0 || q == 3)
            put(p, PROM_GALLERY_BENCH, v, at[0], 0, at[1], v & 1 ? PI / 2 : 0, 1);
        break;
    case PROM_GALLERY_SCULPTURES:
        put_sculpture(p, at[0], at[1], yaw, 1);
        break;
    case PROM_GALLERY_VITRINES:
        if (q % 3)
            put_tall_vitrine(p, at[0], at[1], straight);
        else
            put_table_vitrine(p, at[0], at[1], straight);
        break;
    case PROM_GALLERY_LIBRARY:
        if (q == 0 || q == 3) {
            put_desk(p, at, straight);
        } else if (q == 1) {
            put(p, PROM_GALLERY_GLOBE, v, at[0], 0, at[1], yaw, 1);
        } else {
            put_seats(p, at, 0);
        }
        break;
    case PROM_GALLERY_SALON:
        if (q == 0 || q == 3) {
            put_seats(p, at, 0);
        } else {
            put(p, PROM_GALLERY_LAMP, v, at[0] + (q & 1 ? 0.7f : -0.7f), 0,
                at[1] + (q & 2 ? 0.4f : -0.4f), 0, 1);
            put(p, PROM_GALLERY_ARMCHAIR, v, at[0], 0, at[1], yaw, 1);
        }
        break;
    case PROM_GALLERY_MODERN:
        if (q == 0 || q == 3) {
            put(p, PROM_GALLERY_PLINTH, v, at[0], 0, at[1], 0, 1);
            put(p, PROM_GALLERY_ABSTRACT, v / 2, at[0], 0.5f, at[1], yaw, 1.15f);
            see(p, at[0], 1.2f, at[1]);
        } else {
            put(p, PROM_GALLERY_BENCH, 1, at[0], 0, at[1], PI / 2, 1);
        }
        break;
    default:
        break;
    }
}

static void put_corners(place *p)
{
    const prom_gallery_room *r = p->r;
    for (int k = 0; k < 4; k++) {
        uint32_t v = pick(p);
        if (v % 5 > 1) continue;
        put(p, PROM_GALLERY_PLANT, v, k & 1 ? r->x1 - 0.5f : r->x0 + 0.5f, 0,
            k & 2 ? r->z1 - 0.5f : r->z0 + 0.5f, (float)v, 1);
    }
}

static void put_lights(place *p)
{
    const prom_gallery_room *r = p->r;
    if (r->ceiling == PROM_GALLERY_SKYLIGHT || p->g->options.roofless) return;
    float top = r->y1 - r->y0;
    if (r->ceiling == PROM_GALLERY_COFFERS) return;
    if (r->ceiling == PROM_GALLERY_VAULT)
        top += fminf(0.5f * (r->x1 - r->x0), 5.75f - top) - 0.11f;
    if (r->kind == PROM_GALLERY_CORRIDOR) {
        int n = (int)((r->z1 - r->z0) / 6);
        for (int i = 0; i < n; i++)
            put(p, PROM_GALLERY_PENDANT, 1, p->x, top,
                r->z0 + (r->z1 - r->z0) * ((float)i + 0.5f) / (float)n, 0, 1);
        return;
    }
    bool grand = r->kind == PROM_GALLERY_SALON || r->kind == PROM_GALLERY_CABINET ||
                 r->kind == PROM_GALLERY_LIBRARY;
    if (r->ceiling == PROM_GALLERY_FLAT) top -= 0.12f; // below the rosette
    put(p, grand ? PROM_GALLERY_CHANDELIER : PROM_GALLERY_PENDANT, r->color, p->x, top, p->z, 0,
        1);
}

// ---- the great rooms

static void furnish_hall(place *p)
{
    const prom_gallery_room *r = p->r;
    float depth = r->z1 - r->z0;
    for (int k = -1; k <= 1; k += 2) {
        float side = (float)k, turn = -side * PI / 2;
        for (int i = 0; i < 3; i++) {
            float z = r->z0 + depth * (0.62f + 0.12f * (float)i);
            put_sculpture(p, p->x + side * 2.9f, z, turn, i == 1 ? 1.25f : 1.05f);
        }
        put(p, PROM_GALLERY_ROPES, 0, p->x + side * 2.9f, 0, r->z0 + depth * 0.74f, 0, 0.85f);
        for (int i = 0; i < 2; i++) {
            float z = r->z0 + depth * (0.20f + 0.16f * (float)i);
            put_sculpture(p, p->x + side * 3.6f, z, turn, 1.1f);
            put(p, PROM_GALLERY_BENCH, 0, p->x + side * 4.4f, 0,
                r->z0 + depth * (0.68f + 0.12f * (float)i), PI / 2, 1);
        }
        put(p, PROM_GALLERY_PLANT, 1, p->x + side * 1.95f, 0, r->z0 + depth * 0.455f, side,
            1.3f);
    }
    for (int i = 0; i < 3 && !p->g->options.roofless; i++)
        put(p, PROM_GALLERY_CHANDELIER, 0, p->x, r->y1 + 1.0f,
            r->z0 + depth * (0.25f + 0.25f * (float)i), 0, 1.5f);
}

static void furnish_rotunda(place *p)
{
    float out = 0.5f * fminf(p->r->x1 - p->r->x0, p->r->z1 - p->r->z0) - 0.95f;
    put_sculpture(p, p->x, p->z, -PI / 2, 1.35f);
    for (int k = 0; k < 4; k++) {
        float a = PI / 4 + PI / 2 * (float)k, x = p->x + out * cosf(a),
              z = p->z + out * sinf(a);
        uint32_t v = pick(p);
        put(p, PROM_GALLERY_PEDESTAL, v, x, 0, z, facing(p, (float[]){x, z}), 1);
        put(p, PROM_GALLERY_BUST, v / 4, x, 1.0f, z, facing(p, (float[]){x, z}), 1.15f);
        see(p, x, 1.6f, z);
    }
}

static void furnish_stairs(place *p)
{
    put_sculpture(p, p->x, p->z + 0.8f, PI, 1.1f);
    if (!p->g->options.roofless)
        put(p, PROM_GALLERY_CHANDELIER, 2, p->x, p->r->y1 - p->r->y0 + 0.9f, p->z, 0, 1.6f);
    for (int k = -1; k <= 1; k += 2)
        put(p, PROM_GALLERY_PLANT, 1, p->x + 1.3f * (float)k, 0, p->r->z1 - 0.6f, 0, 1.2f);
}

static void furnish_court(place *p)
{
    const prom_gallery_room *r = p->r;
    prom_solid ground;
    prom_solid_init(&ground);
    prom_solid_use(&ground, prom_gallery_paint(p->g, PROM_GALLERY_GRAVEL, 0xffffff, 2.0f));
    prom_gallery_slab(&ground, r->x0, r->z0, r->x1, r->z1, 0, NULL, 0, true);
    prom_solid_use(&ground, prom_gallery_paint(p->g, PROM_GALLERY_GRASS, 0xffffff, 3.0f));
    for (int q = 0; q < 4; q++) {
        float at[2], w = 0.5f * (r->x1 - r->x0) - 1.9f, d = 0.5f * (r->z1 - r->z0) - 1.9f;
        at[0] = p->x + (q & 1 ? 1.0f : -1.0f) * (0.8f + w / 2);
        at[1] = p->z + (q & 2 ? 1.0f : -1.0f) * (0.8f + d / 2);
        prom_solid_box(&ground, at[0] - w / 2, 0, at[1] - d / 2, at[0] + w / 2, 0.08f,
                       at[1] + d / 2, PROM_FACE_ALL & ~PROM_FACE_BOTTOM);
        put(p, PROM_GALLERY_TREE, pick(p), at[0], 0.05f, at[1], (float)q, 0.62f);
    }
    put(p, PROM_GALLERY_FOUNTAIN, 0, p->x, 0, p->z, 0, 0.5f);
    prom_gallery_add(p->g, p->parent, "garden", &ground);
}

void prom_gallery_furnish(prom_gallery *g, uint32_t room, uint32_t parent)
{
    const prom_gallery_room *r = &g->plan.rooms.data[room];
    prom_random random = prom_random_stream(g->options.seed, 11, room);
    place p = {g, room, parent, r, &random, 0.5f * (r->x0 + r->x1), 0.5f * (r->z0 + r->z1)};
    switch (r->kind) {
    case PROM_GALLERY_HALL:
        furnish_hall(&p);
        break;
    case PROM_GALLERY_ROTUNDA:
        furnish_rotunda(&p);
        return;
    case PROM_GALLERY_STAIRS:
        furnish_stairs(&p);
        break;
    case PROM_GALLERY_COURT:
        furnish_court(&p);
        return;
    default:
        for (int q = 0; q < 4 && r->kind != PROM_GALLERY_CORRIDOR; q++) furnish_quarter(&p, q);
        if (r->kind != PROM_GALLERY_CORRIDOR && r->kind != PROM_GALLERY_LIBRARY)
            put_corners(&p);
        put_lights(&p);
    }
    prom_gallery_hang(g, room, parent, &random);
}
