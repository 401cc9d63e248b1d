// A wall with openings, and what belongs to windows.
#include "scenes/city_wall.h"

#include <math.h>

// ---- the wall around the openings

typedef struct cuts {
    float at[2 * PROM_OPENINGS_MAX + 2];
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

static bool in_opening(const prom_opening *openings, uint32_t count, float x, float y)
{
    for (uint32_t i = 0; i < count; i++)
        if (x > openings[i].x0 && x < openings[i].x1 && y > openings[i].y0 &&
            y < openings[i].y1)
            return true;
    return false;
}

// One connected grid with the openings left out: no edge ends in the middle of another.
void prom_wall_build(prom_solid *shape, float width, float bottom, float top,
                     const prom_opening *openings, uint32_t count)
{
    static const float out[3] = {0, 0, 1};
    cuts x = {0}, y = {0};
    uint32_t first = 0;
    add_cut(&x, 0);
    add_cut(&x, width);
    add_cut(&y, bottom);
    add_cut(&y, top);
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
void prom_wall_reveal(prom_solid *shape, const float o[4], float depth, bool bottom)
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
void prom_wall_ring(prom_solid *shape, const float o[4], float t, float z0, float z1)
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

static prom_paint glass_paint(prom_city *city, bool wide, prom_random *random)
{
    static const prom_city_texture kinds[] = {
        PROM_CITY_WINDOW_DARK, PROM_CITY_WINDOW_CURTAIN, PROM_CITY_WINDOW_CURTAIN,
        PROM_CITY_WINDOW_DARK, PROM_CITY_WINDOW_CURTAIN, PROM_CITY_WINDOW_WARM};
    if (wide) return prom_city_paint(city, PROM_CITY_WINDOW_WIDE, 0xffffff, 1);
    return prom_city_paint(city, kinds[prom_random_below(random, 6)], 0xffffff, 1);
}

void prom_wall_glass(prom_city *city, prom_solid *shape, const float o[4], float z, bool wide,
                     prom_random *random)
{
    prom_solid_use(shape, glass_paint(city, wide, random));
    prom_solid_picture(shape, (float[]){o[0], o[1], z}, (float[]){o[2], o[1], z},
                       (float[]){o[2], o[3], z}, (float[]){o[0], o[3], z});
}

void prom_wall_bars(prom_solid *shape, const float o[4], int across, int up, float z)
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
    prom_wall_ring(shape, o, t, z, z + 0.07f);
    float inner[4] = {o[0] + t, o[1] + t, o[2] - t, o[3] - t};
    for (int i = 3; i <= f->detail; i++) { // a moulded frame: rings behind one another
        prom_wall_ring(shape, inner, 0.03f, z, z + 0.05f - 0.012f * (float)(i - 3));
        for (int k = 0; k < 4; k++) inner[k] += k < 2 ? 0.03f : -0.03f;
    }
    prom_wall_bars(shape, inner, f->bars_across, f->bars_up, z);
}

void prom_wall_shutter(prom_solid *shape, const prom_facade *f, float x0, float y0, float x1,
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
    prom_wall_ring(shape, o, 0.055f, 0.02f, 0.055f);
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

void prom_wall_surround(prom_solid *shape, const prom_facade *f, const float o[4],
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
    prom_wall_reveal(shape, o, PROM_REVEAL, false);
    prom_wall_glass(city, shape, o, -PROM_REVEAL, f->wide, random);
    build_sash(shape, f, o, PROM_REVEAL);
    prom_solid_use(shape, f->trim);
    prom_solid_box(shape, o[0] - 0.07f, o[1] - 0.08f, -PROM_REVEAL, o[2] + 0.07f, o[1], 0.11f,
                   f->detail > 1 ? PROM_FACE_NO_BACK : PROM_FACE_FRONT | PROM_FACE_TOP);
}
