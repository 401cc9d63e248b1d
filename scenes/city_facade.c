#include "scenes/city_parts.h"

#include <math.h>

#define REVEAL 0.14f
#define DOOR_REVEAL 0.26f
#define STEP 0.16f
#define OPENINGS_MAX 64u

typedef enum opening_kind { WINDOW, DOOR, SHOP } opening_kind;

typedef struct opening {
    float x0, y0, x1, y1;
    opening_kind kind;
    uint32_t storey;
} opening;

// ---- the wall around the openings

typedef struct cuts {
    float at[2 * OPENINGS_MAX + 2];
    int count;
} cuts;

static void add_cut(cuts *c, float at)
{
    int i = c->count;
    for (int k = 0; k < c->count; k++)
        if (fabsf(c->at[k] - at) < 1e-3f) return;
    for (; i > 0 && c->at[i - 1] > at; i--) c->at[i] = c->at[i - 1];
    c->at[i] = at;
    c->count++;
}

static bool in_opening(const opening *openings, uint32_t count, float x, float y)
{
    for (uint32_t i = 0; i < count; i++)
        if (x > openings[i].x0 && x < openings[i].x1 && y > openings[i].y0 &&
            y < openings[i].y1)
            return true;
    return false;
}

// One connected grid with the openings left out: no edge ends in the middle of another.
static void build_wall(prom_solid *shape, float width, float height, const opening *openings,
                       uint32_t count)
{
    static const float out[3] = {0, 0, 1};
    cuts x = {0}, y = {0};
    uint32_t first = 0;
    add_cut(&x, 0);
    add_cut(&x, width);
    add_cut(&y, 0);
    add_cut(&y, height);
    for (uint32_t i = 0; i < count; i++) {
        add_cut(&x, openings[i].x0);
        add_cut(&x, openings[i].x1);
        add_cut(&y, openings[i].y0);
        add_cut(&y, openings[i].y1);
    }
    for (int j = 0; j < y.count; j++) {
        for (int i = 0; i < x.count; i++) {
            uint32_t id = prom_solid_vertex(shape, (float[]){x.at[i], y.at[j], 0}, out,
                                            x.at[i] / shape->repeat, -y.at[j] / shape->repeat);
            if (!i && !j) first = id;
        }
    }
    for (int j = 0; j + 1 < y.count; j++) {
        for (int i = 0; i + 1 < x.count; i++) {
            if (in_opening(openings, count, (x.at[i] + x.at[i + 1]) / 2,
                           (y.at[j] + y.at[j + 1]) / 2))
                continue;
            uint32_t a = first + (uint32_t)(j * x.count + i), b = a + (uint32_t)x.count;
            prom_solid_triangle(shape, a, a + 1, b + 1);
            prom_solid_triangle(shape, a, b + 1, b);
        }
    }
}

// The sides of an opening from z = 0 to z = -depth, facing inwards.
static void build_reveal(prom_solid *shape, const float o[4], float depth, bool bottom)
{
    float x0 = o[0], y0 = o[1], x1 = o[2], y1 = o[3], z = -depth;
    prom_solid_quad(shape, (float[]){x0, y0, 0}, (float[]){x0, y0, z}, (float[]){x0, y1, z},
                    (float[]){x0, y1, 0});
    prom_solid_quad(shape, (float[]){x1, y0, z}, (float[]){x1, y0, 0}, (float[]){x1, y1, 0},
                    (float[]){x1, y1, z});
    prom_solid_quad(shape, (float[]){x0, y1, z}, (float[]){x1, y1, z}, (float[]){x1, y1, 0},
                    (float[]){x0, y1, 0});
    if (bottom)
        prom_solid_quad(shape, (float[]){x0, y0, 0}, (float[]){x1, y0, 0}, (float[]){x1, y0, z},
                        (float[]){x0, y0, z});
}

// A mitred frame of thickness t inside a rectangle, from z0 out to z1: front and inner faces.
static void build_ring(prom_solid *shape, const float o[4], float t, float z0, float z1)
{
    const float outer[4][2] = {{o[0], o[1]}, {o[2], o[1]}, {o[2], o[3]}, {o[0], o[3]}};
    const float inner[4][2] = {
        {o[0] + t, o[1] + t}, {o[2] - t, o[1] + t}, {o[2] - t, o[3] - t}, {o[0] + t, o[3] - t}};
    for (int i = 0; i < 4; i++) {
        const float *a = outer[i], *b = outer[(i + 1) % 4];
        const float *c = inner[(i + 1) % 4], *d = inner[i];
        prom_solid_quad(shape, (float[]){a[0], a[1], z1}, (float[]){b[0], b[1], z1},
                        (float[]){c[0], c[1], z1}, (float[]){d[0], d[1], z1});
        prom_solid_quad(shape, (float[]){d[0], d[1], z1}, (float[]){c[0], c[1], z1},
                        (float[]){c[0], c[1], z0}, (float[]){d[0], d[1], z0});
    }
}

// ---- windows

static prom_paint glass_paint(prom_city *city, prom_random *random)
{
    static const prom_city_texture kinds[] = {
        PROM_CITY_WINDOW_DARK, PROM_CITY_WINDOW_CURTAIN, PROM_CITY_WINDOW_CURTAIN,
        PROM_CITY_WINDOW_DARK, PROM_CITY_WINDOW_CURTAIN, PROM_CITY_WINDOW_WARM};
    return prom_city_paint(city, kinds[prom_random_below(random, 6)], 0xffffff, 1);
}

static void build_glass(prom_city *city, prom_solid *shape, const float o[4], float z,
                        prom_random *random)
{
    prom_solid_use(shape, glass_paint(city, random));
    prom_solid_picture(shape, (float[]){o[0], o[1], z}, (float[]){o[2], o[1], z},
                       (float[]){o[2], o[3], z}, (float[]){o[0], o[3], z});
}

static void build_bars(prom_solid *shape, const float o[4], int across, int up, float z)
{
    const float half = 0.018f, out = z + 0.035f;
    for (int i = 1; i <= up; i++) {
        float x = o[0] + (o[2] - o[0]) * (float)i / (float)(up + 1);
        prom_solid_box(shape, x - half, o[1], z, x + half, o[3], out,
                       PROM_FACE_FRONT | PROM_FACE_LEFT | PROM_FACE_RIGHT);
    }
    for (int i = 1; i <= across; i++) {
        // The upper panes are lower than the rest.
        float y = across == 1 ? o[1] + 0.66f * (o[3] - o[1])
                              : o[1] + (o[3] - o[1]) * (float)i / (float)(across + 1);
        prom_solid_box(shape, o[0], y - half, z, o[2], y + half, out - 0.004f,
                       PROM_FACE_FRONT | PROM_FACE_TOP | PROM_FACE_BOTTOM);
    }
}

static void build_sash(prom_solid *shape, const prom_facade *f, const float o[4], float depth)
{
    prom_solid_use(shape, f->frame);
    float t = 0.065f, z = -depth;
    if (f->detail < 2) return;
    build_ring(shape, o, t, z, z + 0.07f);
    float inner[4] = {o[0] + t, o[1] + t, o[2] - t, o[3] - t};
    for (int i = 3; i <= f->detail; i++) { // a moulded frame: rings behind one another
        build_ring(shape, inner, 0.03f, z, z + 0.05f - 0.012f * (float)(i - 3));
        for (int k = 0; k < 4; k++) inner[k] += k < 2 ? 0.03f : -0.03f;
    }
    build_bars(shape, inner, f->bars_across, f->bars_up, z);
}

static void build_shutter(prom_solid *shape, const prom_facade *f, float x0, float y0, float x1,
                          float y1)
{
    prom_solid_use(shape, f->shutter);
    if (f->detail < 3) {
        prom_solid_box(shape, x0, y0, 0, x1, y1, 0.045f, PROM_FACE_NO_BACK);
        return;
    }
    const float o[4] = {x0, y0, x1, y1};
    prom_solid_box(shape, x0, y0, 0, x1, y1, 0.02f, PROM_FACE_FRONT);
    prom_solid_box(shape, x0, y0, 0, x1, y1, 0.055f, PROM_FACE_NO_BACK & ~PROM_FACE_FRONT);
    build_ring(shape, o, 0.055f, 0.02f, 0.055f);
    int slats = f->detail == 3 ? 9 : 16;
    for (int i = 0; i < slats; i++) {
        float a = y0 + 0.06f + (y1 - y0 - 0.12f) * (float)i / (float)slats;
        float b = a + 0.7f * (y1 - y0 - 0.12f) / (float)slats;
        prom_solid_box(shape, x0 + 0.055f, a, 0.02f, x1 - 0.055f, b, 0.042f,
                       PROM_FACE_FRONT | PROM_FACE_TOP | PROM_FACE_BOTTOM);
    }
}

// A small roof over an opening: a moulding and a triangle.
static void build_pediment(prom_solid *shape, float x0, float x1, float y)
{
    float rise = 0.22f * (x1 - x0), mid = (x0 + x1) / 2, z = 0.14f;
    static const float profile[4][2] = {{0, 0}, {0.03f, 0.10f}, {0.09f, 0.14f}, {0.10f, 0}};
    prom_solid_frame old = prom_solid_enter(shape, 0, y, 0, 0);
    prom_solid_moulding(shape, profile, 4, x0, x1);
    prom_solid_leave(shape, old);
    y += 0.09f;
    float *l = (float[]){x0, y, z}, *r = (float[]){x1, y, z}, *t = (float[]){mid, y + rise, z};
    prom_solid_flat_triangle(shape, l, r, t);
    prom_solid_quad(shape, t, r, (float[]){x1, y, 0}, (float[]){mid, y + rise, 0});
    prom_solid_quad(shape, l, t, (float[]){mid, y + rise, 0}, (float[]){x0, y, 0});
}

static void build_surround(prom_solid *shape, const prom_facade *f, const float o[4],
                           bool pediment)
{
    float x0 = o[0], y0 = o[1], x1 = o[2], y1 = o[3], t = 0.13f;
    prom_solid_use(shape, f->trim);
    for (int step = 0; step < (f->detail > 2 ? f->detail - 1 : 1); step++) {
        float out = 0.05f - 0.014f * (float)step, w = t + 0.03f * (float)step;
        int sides = PROM_FACE_FRONT | PROM_FACE_LEFT | PROM_FACE_RIGHT;
        prom_solid_box(shape, x0 - w, y0, 0, x0, y1, out, sides);
        prom_solid_box(shape, x1, y0, 0, x1 + w, y1, out, sides);
        prom_solid_box(shape, x0 - w, y1, 0, x1 + w, y1 + w, out, PROM_FACE_NO_BACK);
    }
    if (pediment)
        build_pediment(shape, x0 - t - 0.06f, x1 + t + 0.06f, y1 + t);
    else if (f->keystones)
        prom_solid_box(shape, (x0 + x1) / 2 - 0.08f, y1 - 0.02f, 0, (x0 + x1) / 2 + 0.08f,
                       y1 + 0.24f, 0.09f, PROM_FACE_NO_BACK);
}

void prom_city_build_window(prom_city *city, prom_solid *shape, const prom_facade *f,
                            const float o[4], prom_random *random)
{
    prom_solid_use(shape, f->wall);
    build_reveal(shape, o, REVEAL, false);
    build_glass(city, shape, o, -REVEAL, random);
    build_sash(shape, f, o, REVEAL);
    prom_solid_use(shape, f->trim);
    prom_solid_box(shape, o[0] - 0.07f, o[1] - 0.08f, -REVEAL, o[2] + 0.07f, o[1], 0.11f,
                   f->detail > 1 ? PROM_FACE_NO_BACK : PROM_FACE_FRONT | PROM_FACE_TOP);
}

static void build_balcony(prom_solid *shape, const prom_facade *f, const opening *o)
{
    float x0 = o->x0 - 0.35f, x1 = o->x1 + 0.35f, y = o->y0 - 0.14f, z = 0.85f;
    prom_solid_use(shape, f->trim);
    prom_solid_box(shape, x0, y, 0, x1, y + 0.14f, z, PROM_FACE_NO_BACK);
    prom_solid_use(shape, f->frame);
    prom_solid_box(shape, x0, y + 0.98f, z - 0.07f, x1, y + 1.04f, z, PROM_FACE_ALL);
    int rods = f->detail < 2 ? 4 : f->detail < 4 ? 12 : 22;
    for (int i = 0; i <= rods; i++) {
        float x = x0 + 0.03f + (x1 - x0 - 0.06f) * (float)i / (float)rods;
        prom_solid_box(shape, x - 0.014f, y + 0.14f, z - 0.05f, x + 0.014f, y + 0.98f,
                       z - 0.02f, PROM_FACE_SIDES);
    }
    for (int side = 0; side < 2; side++) {
        float x = side ? x1 - 0.04f : x0;
        prom_solid_box(shape, x, y + 0.98f, 0, x + 0.04f, y + 1.04f, z - 0.07f, PROM_FACE_ALL);
        for (int i = 1; i <= rods / 3; i++) {
            float at = z * (float)i / (float)(rods / 3 + 1);
            prom_solid_box(shape, x + 0.006f, y + 0.14f, at - 0.014f, x + 0.034f, y + 0.98f,
                           at + 0.014f, PROM_FACE_SIDES);
        }
    }
}

// ---- doors and shops

static void build_door_leaf(prom_solid *shape, const prom_facade *f, const float o[4], float z)
{
    prom_solid_use(shape, f->door);
    prom_solid_box(shape, o[0], o[1], z - 0.05f, o[2], o[3], z, PROM_FACE_FRONT);
    if (f->detail < 2) return;
    int rows = f->detail < 4 ? 3 : 5;
    float w = (o[2] - o[0]) / 2, h = (o[3] - o[1]) / (float)rows;
    for (int i = 0; i < 2; i++)
        for (int j = 0; j < rows; j++)
            prom_solid_box(shape, o[0] + w * (float)i + 0.09f, o[1] + h * (float)j + 0.08f, z,
                           o[0] + w * (float)(i + 1) - 0.09f, o[1] + h * (float)(j + 1) - 0.08f,
                           z + 0.025f, PROM_FACE_NO_BACK);
    prom_solid_use(shape, f->frame);
    prom_solid_box(shape, o[2] - 0.12f, o[1] + 1.0f, z, o[2] - 0.07f, o[1] + 1.12f, z + 0.06f,
                   PROM_FACE_NO_BACK);
}

static void build_door(prom_city *city, prom_solid *shape, const prom_facade *f,
                       const float o[4], prom_random *random)
{
    float z = -DOOR_REVEAL, head = fminf(o[1] + 2.1f, o[3] - 0.25f);
    prom_solid_use(shape, f->wall);
    build_reveal(shape, o, DOOR_REVEAL, true);
    build_door_leaf(shape, f, (float[]){o[0], o[1], o[2], head}, z);
    prom_solid_use(shape, f->frame);
    prom_solid_box(shape, o[0], head, z, o[2], head + 0.07f, z + 0.06f,
                   PROM_FACE_FRONT | PROM_FACE_TOP | PROM_FACE_BOTTOM);
    const float light[4] = {o[0], head + 0.07f, o[2], o[3]};
    build_glass(city, shape, light, z, random);
    prom_solid_use(shape, f->frame);
    if (f->detail > 1) build_bars(shape, light, 0, 2, z);
    build_surround(shape, f, o, f->pediments);
    prom_solid_use(shape, f->trim);
    prom_solid_box(shape, o[0] - 0.2f, -0.1f, -0.05f, o[2] + 0.2f, STEP, 0.32f,
                   PROM_FACE_NO_BACK & ~PROM_FACE_BOTTOM);
}

static void build_awning(prom_city *city, prom_solid *shape, float x0, float x1, float y)
{
    prom_solid_use(shape, prom_city_paint(city, PROM_CITY_AWNING, 0xffffff, 2.4f));
    float low = y - 0.55f, z = 1.05f;
    float *a = (float[]){x0, low, z}, *b = (float[]){x1, low, z}, *c = (float[]){x1, y, 0.03f},
          *d = (float[]){x0, y, 0.03f};
    float *e = (float[]){x0, low - 0.2f, z}, *g = (float[]){x1, low - 0.2f, z};
    prom_solid_quad(shape, a, b, c, d);
    prom_solid_quad(shape, b, a, d, c);
    prom_solid_quad(shape, e, g, b, a);
    prom_solid_quad(shape, g, e, a, b);
}

static void build_shop(prom_city *city, prom_solid *shape, const prom_facade *f,
                       const float o[4], bool awning, prom_random *random)
{
    prom_solid_use(shape, f->wall);
    build_reveal(shape, o, REVEAL, true);
    build_glass(city, shape, o, -REVEAL, random);
    prom_solid_use(shape, f->door);
    build_ring(shape, o, 0.09f, -REVEAL, -0.03f);
    build_bars(shape, o, 1, f->detail < 2 ? 1 : 3, -REVEAL);
    prom_solid_box(shape, o[0] - 0.1f, o[3] + 0.05f, 0, o[2] + 0.1f, o[3] + 0.5f, 0.08f,
                   PROM_FACE_NO_BACK);
    if (awning) build_awning(city, shape, o[0] - 0.1f, o[2] + 0.1f, o[3] + 0.03f);
}

// ---- the whole

static uint32_t place_openings(const prom_facade *f, opening *openings)
{
    uint32_t count = 0;
    float bay = f->width / (float)(f->bays ? f->bays : 1);
    for (uint32_t s = 0; s < f->storeys; s++) {
        float floor = f->floors[s], height = f->floors[s + 1] - floor;
        float half = fminf(0.58f, 0.27f * bay), sill = floor + 0.29f * height;
        float head = floor + (s ? 0.82f : 0.80f) * height;
        for (uint32_t b = 0; b < f->bays && count < OPENINGS_MAX; b++) {
            float mid = bay * ((float)b + 0.5f);
            opening o = {mid - half, sill, mid + half, head, WINDOW, s};
            if (!s && f->has_door && b == f->door_bay) {
                o = (opening){mid - 0.52f, STEP, mid + 0.52f, head, DOOR, s};
            } else if (s == 1 && f->balcony && b == f->bays / 2) {
                o.y0 = floor + 0.12f; // a glazed door on to the balcony
            } else if (!s && f->has_shop) {
                o = (opening){mid - 0.42f * bay, 0.5f, mid + 0.42f * bay, head, SHOP, s};
            }
            openings[count++] = o;
        }
    }
    return count;
}

static void build_opening(prom_city *city, prom_solid *shape, const prom_facade *f,
                          const opening *o, bool awning, prom_random *random)
{
    const float rectangle[4] = {o->x0, o->y0, o->x1, o->y1};
    if (o->kind == DOOR) {
        build_door(city, shape, f, rectangle, random);
    } else if (o->kind == SHOP) {
        build_shop(city, shape, f, rectangle, awning, random);
    } else {
        prom_city_build_window(city, shape, f, rectangle, random);
        if (f->surrounds && f->detail > 1)
            build_surround(shape, f, rectangle, f->pediments && o->storey == 1);
        float leaf = (o->x1 - o->x0) / 2;
        if (f->shutters && o->storey) {
            build_shutter(shape, f, o->x0 - leaf - 0.02f, o->y0, o->x0 - 0.02f, o->y1);
            build_shutter(shape, f, o->x1 + 0.02f, o->y0, o->x1 + leaf + 0.02f, o->y1);
        }
    }
}

void prom_city_build_facade(prom_city *city, prom_solid *shape, const prom_facade *f,
                            prom_random *random)
{
    opening openings[OPENINGS_MAX];
    uint32_t count = place_openings(f, openings);
    bool awning = prom_random_unit(random) < 0.6f;
    prom_solid_use(shape, f->wall);
    build_wall(shape, f->width, f->floors[f->storeys], openings, count);
    for (uint32_t i = 0; i < count; i++)
        build_opening(city, shape, f, &openings[i], awning, random);
    for (uint32_t i = 0; f->balcony && i < count; i++)
        if (openings[i].storey == 1 && i % f->bays == f->bays / 2)
            build_balcony(shape, f, &openings[i]);
}
