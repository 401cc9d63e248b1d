// Boats: along z, the bow at +z, the waterline at y = 0.
#include "scenes/city_parts.h"

#include <math.h>

// A section of the hull: its half width and height at the gunwale, half width at the bilge.
typedef struct rib {
    float z, half, sheer, bilge;
} rib;

// Both sides from below the water to the gunwale, in two strakes, and the stern.
static void build_hull(prom_solid *shape, const rib *r, int n, prom_paint low, prom_paint high,
                       float draught)
{
    for (int strake = 0; strake < 2; strake++) {
        prom_solid_use(shape, strake ? high : low);
        for (int i = 0; i + 1 < n; i++) {
            for (int side = -1; side <= 1; side += 2) {
                float f = (float)side, p[2][2][3];
                for (int k = 0; k < 2; k++) {
                    const rib *at = &r[i + k];
                    float mid = 0.55f * at->sheer;
                    float wide = at->bilge + 0.75f * (at->half - at->bilge);
                    p[k][0][0] = f * (strake ? wide : at->bilge);
                    p[k][0][1] = strake ? mid : -draught;
                    p[k][1][0] = f * (strake ? at->half : wide);
                    p[k][1][1] = strake ? at->sheer : mid;
                    p[k][0][2] = p[k][1][2] = at->z;
                }
                if (side > 0)
                    prom_solid_quad(shape, p[1][0], p[0][0], p[0][1], p[1][1]);
                else
                    prom_solid_quad(shape, p[0][0], p[1][0], p[1][1], p[0][1]);
            }
        }
        const rib *s = &r[0];
        float mid = 0.55f * s->sheer, wide = s->bilge + 0.75f * (s->half - s->bilge);
        float a = strake ? wide : s->bilge, b = strake ? s->half : wide;
        prom_solid_quad(shape, (float[]){a, strake ? mid : -draught, s->z},
                        (float[]){-a, strake ? mid : -draught, s->z},
                        (float[]){-b, strake ? s->sheer : mid, s->z},
                        (float[]){b, strake ? s->sheer : mid, s->z});
    }
}

// A deck at `down` below the gunwale, `in` from the hull's sides; or the planks inside a boat.
static void build_deck(prom_solid *shape, const rib *r, int n, float down, float in)
{
    for (int i = 0; i + 1 < n; i++) {
        const rib *a = &r[i], *b = &r[i + 1];
        float x = fmaxf(a->half - in, 0.01f), w = fmaxf(b->half - in, 0.01f);
        prom_solid_quad(
            shape, (float[]){-x, a->sheer - down, a->z}, (float[]){-w, b->sheer - down, b->z},
            (float[]){w, b->sheer - down, b->z}, (float[]){x, a->sheer - down, a->z});
    }
}

// The inner side of an open boat, and its gunwale.
static void build_inside(prom_solid *shape, const rib *r, int n, float down, float thick)
{
    for (int i = 0; i + 1 < n; i++) {
        for (int side = -1; side <= 1; side += 2) {
            const rib *a = side > 0 ? &r[i] : &r[i + 1], *b = side > 0 ? &r[i + 1] : &r[i];
            float f = (float)side;
            float ai = fmaxf(a->half - thick, 0.01f), bi = fmaxf(b->half - thick, 0.01f);
            float *p = (float[]){f * ai, a->sheer, a->z},
                  *q = (float[]){f * bi, b->sheer, b->z};
            prom_solid_quad(shape, (float[]){f * ai, a->sheer - down, a->z},
                            (float[]){f * bi, b->sheer - down, b->z}, q, p);
            prom_solid_quad(shape, p, q, (float[]){f * b->half, b->sheer, b->z},
                            (float[]){f * a->half, a->sheer, a->z});
        }
    }
    const rib *s = &r[0];
    float x = s->half - thick;
    prom_solid_quad(shape, (float[]){-x, s->sheer - down, s->z + thick},
                    (float[]){x, s->sheer - down, s->z + thick},
                    (float[]){x, s->sheer, s->z + thick},
                    (float[]){-x, s->sheer, s->z + thick});
    prom_solid_quad(shape, (float[]){-s->half, s->sheer, s->z + thick},
                    (float[]){s->half, s->sheer, s->z + thick},
                    (float[]){s->half, s->sheer, s->z}, (float[]){-s->half, s->sheer, s->z});
}

static prom_paint wood(prom_city *city, uint32_t rgb)
{
    return prom_city_paint(city, PROM_CITY_WOOD, rgb, 1.2f);
}

static void build_rowing_boat(prom_city *city, prom_solid *shape, uint32_t number)
{
    static const rib ribs[] = {{-1.9f, 0.52f, 0.48f, 0.36f}, {-1.0f, 0.72f, 0.42f, 0.50f},
                               {0.2f, 0.76f, 0.40f, 0.52f},  {1.2f, 0.58f, 0.45f, 0.34f},
                               {1.8f, 0.30f, 0.54f, 0.12f},  {2.15f, 0.03f, 0.66f, 0.01f}};
    const int n = sizeof ribs / sizeof *ribs;
    uint32_t color = number % 2 ? 0xc05a3c : 0x3c6a8a;
    build_hull(shape, ribs, n, wood(city, 0x6a4a34), wood(city, color), 0.15f);
    prom_solid_use(shape, wood(city, 0xc09a6c));
    build_deck(shape, ribs, n, 0.34f, 0.05f);
    build_inside(shape, ribs, n, 0.34f, 0.05f);
    for (int i = 0; i < 3; i++) {
        float z = -1.2f + 1.1f * (float)i;
        prom_solid_box(shape, -0.66f, 0.26f, z - 0.12f, 0.66f, 0.30f, z + 0.12f, PROM_FACE_ALL);
    }
    for (int i = -1; i <= 1; i += 2) { // oars, shipped
        float x = 0.4f * (float)i;
        const float oar[2][3] = {{x, 0.33f, -1.5f}, {0.8f * x, 0.36f, 0.9f}};
        prom_solid_tube(shape, oar, (const float[]){0.02f, 0.02f}, 2, prom_city_sides(city, 5));
        prom_solid_box(shape, x - 0.07f, 0.31f, -1.75f, x + 0.07f, 0.34f, -1.3f, PROM_FACE_ALL);
    }
}

// Windows along a cabin's side at x, their glass just before the wall.
static void cabin_windows(prom_city *city, prom_solid *shape, float x, float z0, float z1,
                          float y0, float y1, int count)
{
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WINDOW_DARK, 0xc0c8d0, 1));
    float step = (z1 - z0) / (float)count, gap = 0.14f * step;
    for (int i = 0; i < count; i++) {
        float a = z0 + step * (float)i + gap, b = z0 + step * (float)(i + 1) - gap;
        float out = x + 0.02f;
        prom_solid_picture(shape, (float[]){out, y0, b}, (float[]){out, y0, a},
                           (float[]){out, y1, a}, (float[]){out, y1, b});
        prom_solid_picture(shape, (float[]){-out, y0, a}, (float[]){-out, y0, b},
                           (float[]){-out, y1, b}, (float[]){-out, y1, a});
    }
}

static const rib barge[] = {{-8.2f, 1.7f, 1.25f, 1.3f}, {-7.6f, 2.1f, 1.15f, 1.7f},
                            {-4.0f, 2.2f, 1.0f, 1.9f},  {4.0f, 2.2f, 1.0f, 1.9f},
                            {6.6f, 1.9f, 1.2f, 1.4f},   {7.8f, 1.2f, 1.5f, 0.6f},
                            {8.5f, 0.05f, 1.8f, 0.02f}};
#define BARGE_RIBS ((int)(sizeof barge / sizeof *barge))

// A barge that somebody lives on.
static void build_house_boat(prom_city *city, prom_solid *shape)
{
    build_hull(shape, barge, BARGE_RIBS, prom_city_plain(city, 0x4a2a26),
               prom_city_plain(city, 0x23463e), 0.5f);
    prom_solid_use(shape, wood(city, 0xa88a66));
    build_deck(shape, barge, BARGE_RIBS, 0.12f, 0.06f);
    build_inside(shape, barge, BARGE_RIBS, 0.12f, 0.06f);
    prom_solid_use(shape, wood(city, 0xe6dcc4));
    prom_solid_box(shape, -1.5f, 0.8f, -5.4f, 1.5f, 2.2f, 3.4f, PROM_FACE_SIDES);
    prom_solid_use(shape, wood(city, 0x8a5a3a));
    prom_solid_box(shape, -1.65f, 2.2f, -5.55f, 1.65f, 2.34f, 3.55f, PROM_FACE_ALL);
    cabin_windows(city, shape, 1.5f, -5.0f, 3.0f, 1.15f, 1.85f, 6);
    prom_solid_use(shape, prom_city_plain(city, 0xe8e4da)); // the wheelhouse
    prom_solid_box(shape, -1.0f, 0.9f, -7.4f, 1.0f, 2.9f, -5.7f, PROM_FACE_SIDES);
    prom_solid_box(shape, -1.15f, 2.9f, -7.55f, 1.15f, 3.0f, -5.55f, PROM_FACE_ALL);
    cabin_windows(city, shape, 1.0f, -7.3f, -5.8f, 1.9f, 2.65f, 2);
    prom_solid_use(shape, prom_city_plain(city, 0x2a2c30));
    prom_solid_frame old = prom_solid_enter(shape, 0.7f, 2.34f, 1.8f, 0);
    prom_solid_lathe(shape,
                     (const float[4][2]){{0.1f, 0}, {0.1f, 0.8f}, {0.15f, 0.85f}, {0, 1}}, 4,
                     prom_city_sides(city, 8), false);
    prom_solid_leave(shape, old);
    // Pots with plants on the roof.
    for (int i = 0; i < 4; i++) {
        float z = -4.2f + 1.9f * (float)i, x = i & 1 ? 0.9f : -0.9f;
        prom_solid_use(shape, prom_city_plain(city, 0xb5684a));
        prom_solid_box(shape, x - 0.2f, 2.34f, z - 0.2f, x + 0.2f, 2.65f, z + 0.2f,
                       PROM_FACE_ALL);
        prom_solid_use(shape, prom_city_paint(city, PROM_CITY_LEAVES_SMALL, 0xd8e8d0, 1));
        for (int k = 0; k < 2; k++) {
            float dx = k ? 0.3f : -0.3f, up[4][3] = {{x - dx, 2.6f, z - 0.3f},
                                                     {x + dx, 2.6f, z + 0.3f},
                                                     {x + dx, 3.25f, z + 0.3f},
                                                     {x - dx, 3.25f, z - 0.3f}};
            prom_solid_picture(shape, up[0], up[1], up[2], up[3]);
        }
    }
}

static void build_tour_boat(prom_city *city, prom_solid *shape)
{
    build_hull(shape, barge, BARGE_RIBS, prom_city_plain(city, 0x2f4a72),
               prom_city_plain(city, 0xeeece4), 0.5f);
    prom_solid_use(shape, wood(city, 0xb49468));
    build_deck(shape, barge, BARGE_RIBS, 0.12f, 0.06f);
    build_inside(shape, barge, BARGE_RIBS, 0.12f, 0.06f);
    prom_solid_use(shape, prom_city_plain(city, 0xf2f0ea));
    prom_solid_box(shape, -1.6f, 0.8f, -4.6f, 1.6f, 1.3f, 4.4f, PROM_FACE_SIDES);
    prom_solid_box(shape, -1.7f, 2.3f, -4.8f, 1.7f, 2.42f, 4.6f, PROM_FACE_ALL);
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_WINDOW_WIDE, 0xe0e8f0, 3));
    prom_solid_box(shape, -1.56f, 1.3f, -4.56f, 1.56f, 2.3f, 4.36f, PROM_FACE_SIDES);
    prom_solid_use(shape, prom_city_plain(city, 0xf2f0ea));
    for (int i = 0; i <= 6; i++)
        for (int side = -1; side <= 1; side += 2) {
            float z = -4.55f + 1.49f * (float)i, x = 1.58f * (float)side;
            prom_solid_box(shape, x - 0.04f, 1.3f, z - 0.05f, x + 0.04f, 2.3f, z + 0.05f,
                           PROM_FACE_SIDES);
        }
    prom_solid_use(shape, prom_city_plain(city, 0xb83a34));
    for (int side = -1; side <= 1; side += 2) // benches on the fore deck
        prom_solid_box(shape, (float)side * 0.9f - 0.5f, 1.1f, 4.9f, (float)side * 0.9f + 0.5f,
                       1.4f, 5.4f, PROM_FACE_ALL);
}

static void build_sailing_boat(prom_city *city, prom_solid *shape)
{
    static const rib ribs[] = {{-2.6f, 0.7f, 0.6f, 0.5f},  {-1.4f, 1.0f, 0.55f, 0.7f},
                               {0.4f, 1.05f, 0.55f, 0.7f}, {1.8f, 0.75f, 0.62f, 0.4f},
                               {2.7f, 0.35f, 0.74f, 0.1f}, {3.2f, 0.03f, 0.86f, 0.01f}};
    const int n = sizeof ribs / sizeof *ribs;
    build_hull(shape, ribs, n, prom_city_plain(city, 0x7a2f2a), prom_city_plain(city, 0xf0eee6),
               0.3f);
    prom_solid_use(shape, wood(city, 0xc09a6c));
    build_deck(shape, ribs, n, 0.08f, 0.04f);
    build_inside(shape, ribs, n, 0.08f, 0.04f);
    prom_solid_use(shape, prom_city_plain(city, 0xe8e4da));
    prom_solid_box(shape, -0.55f, 0.5f, -0.2f, 0.55f, 0.95f, 1.5f,
                   PROM_FACE_SIDES | PROM_FACE_TOP);
    prom_solid_use(shape, wood(city, 0xb08458));
    const float mast[2][3] = {{0, 0.4f, 1.0f}, {0, 7.4f, 0.9f}};
    const float boom[2][3] = {{0, 1.5f, 0.95f}, {0, 1.5f, -1.9f}};
    prom_solid_tube(shape, mast, (const float[]){0.06f, 0.03f}, 2, prom_city_sides(city, 7));
    prom_solid_tube(shape, boom, (const float[]){0.04f, 0.03f}, 2, prom_city_sides(city, 6));
    prom_solid_use(shape, prom_city_plain(city, 0xefe8d8)); // the sail, furled
    const float sail[3][3] = {{0, 1.62f, 0.85f}, {0, 1.66f, -0.4f}, {0, 1.58f, -1.8f}};
    prom_solid_tube(shape, sail, (const float[]){0.10f, 0.13f, 0.05f}, 3,
                    prom_city_sides(city, 7));
}

void prom_city_build_boat(prom_city *city, const prom_city_prototype *which, prom_solid *shape)
{
    switch (which->number) {
    case 0:
    case 1:
        build_rowing_boat(city, shape, which->number);
        break;
    case 2:
        build_house_boat(city, shape);
        break;
    case 3:
        build_tour_boat(city, shape);
        break;
    default:
        build_sailing_boat(city, shape);
        break;
    }
}
