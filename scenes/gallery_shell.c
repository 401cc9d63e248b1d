// Floors, walls, mouldings, doors and windows of a room.
#include "scenes/gallery_parts.h"

#include <math.h>

#define HOLES_MAX 48
#define DADO 0.90f
#define FRIEZE 0.62f // below the top of the wall

typedef struct look {
    prom_paint skirting, dado, wall, frieze, trim, floor, frame, leaf;
    bool stone; // no skirting board, dado or frieze
} look;

static look look_of(prom_gallery *g, const prom_gallery_room *room)
{
    static const uint32_t cloths[] = {0xc8695c, 0x9fb894, 0x86a5c4, 0xe0bc78, 0xd8a58c,
                                      0xc9c19a, 0xa8b8b4, 0xb98a9a, 0xe4d6b8, 0x93b0a8};
    static const uint32_t papers[] = {0xe8dcc0, 0xcfdccb, 0xd5dde8, 0xecd0bc, 0xe9e2d4};
    prom_paint white = prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xfbf6ea, 2.0f);
    prom_paint oak = prom_gallery_paint(g, PROM_GALLERY_WOOD, 0xb48a5c, 1.2f);
    prom_paint walnut = prom_gallery_paint(g, PROM_GALLERY_WOOD, 0x8c6142, 1.2f);
    look l = {.skirting = white, .dado = white, .frieze = white, .trim = white, .frame = white};
    l.leaf = room->color & 64 ? oak : white;
    switch (room->kind) {
    case PROM_GALLERY_LIBRARY:
        l.wall = prom_gallery_paint(g, PROM_GALLERY_STRIPES, papers[room->color % 5], 0.8f);
        l.skirting = l.dado = l.frame = walnut;
        break;
    case PROM_GALLERY_SALON:
        l.wall =
            room->color & 128
                ? prom_gallery_paint(g, PROM_GALLERY_STRIPES, papers[room->color % 5], 0.8f)
                : prom_gallery_paint(g, PROM_GALLERY_DAMASK, papers[room->color % 5], 1.0f);
        break;
    case PROM_GALLERY_MODERN:
    case PROM_GALLERY_SCULPTURES:
        l.wall =
            prom_gallery_paint(g, PROM_GALLERY_PLASTER,
                               room->color & 32 ? 0xf6f0e4 : papers[room->color % 5], 2.0f);
        l.dado = l.wall;
        break;
    case PROM_GALLERY_CORRIDOR:
        l.wall = prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xf0e6cf, 2.0f);
        l.dado = prom_gallery_paint(g, PROM_GALLERY_PLASTER, 0xc9c2a8, 2.0f);
        break;
    case PROM_GALLERY_HALL:
    case PROM_GALLERY_STAIRS:
        l.stone = true;
        l.wall = l.dado = l.frieze = prom_gallery_paint(g, PROM_GALLERY_ASHLAR, 0xfff8ea, 2.4f);
        l.wall =
            prom_gallery_paint(g, PROM_GALLERY_PLASTER,
                               room->kind == PROM_GALLERY_HALL ? 0xf6e0b8 : 0xfaf0e2, 2.0f);
        l.frieze = white;
        l.skirting = prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xa8a29a, 1.0f);
        l.frame = prom_gallery_paint(g, PROM_GALLERY_MARBLE, 0xe6dccb, 1.0f);
        l.leaf = oak;
        break;
    case PROM_GALLERY_COURT:
        l.stone = true;
        l.wall = l.dado = l.frieze = prom_gallery_paint(g, PROM_GALLERY_ASHLAR, 0xf6e8cc, 2.4f);
        l.skirting = prom_gallery_paint(g, PROM_GALLERY_ASHLAR, 0xd0c4b0, 2.4f);
        break;
    default:
        l.wall = prom_gallery_paint(g, PROM_GALLERY_DAMASK, cloths[room->color % 10], 1.1f);
        l.skirting = l.dado = room->color & 256 ? oak : white;
    }
    static const struct {
        prom_gallery_texture texture;
        float repeat;
    } floors[] = {{PROM_GALLERY_HERRINGBONE, 1.6f}, {PROM_GALLERY_PANELS, 2.0f},
                  {PROM_GALLERY_BOARDS, 1.6f},      {PROM_GALLERY_CHECKER, 2.4f},
                  {PROM_GALLERY_HEXAGONS, 1.6f},    {PROM_GALLERY_TERRAZZO, 2.0f}};
    uint32_t floor = room->storey ? room->floor % 3 : room->floor % 6;
    l.floor = prom_gallery_paint(g, floors[floor].texture, 0xffffff, floors[floor].repeat);
    if (room->kind == PROM_GALLERY_HALL || room->kind == PROM_GALLERY_STAIRS ||
        room->kind == PROM_GALLERY_ROTUNDA)
        l.floor = prom_gallery_paint(g, PROM_GALLERY_CHECKER, 0xffffff, 4.0f);
    if (room->kind == PROM_GALLERY_CORRIDOR)
        l.floor = prom_gallery_paint(g, PROM_GALLERY_SLABS, 0xffffff, 2.4f);
    return l;
}

// ---- one wall, in its frame

typedef struct wall {
    prom_gallery *g;
    const prom_gallery_room *room;
    const look *look;
    prom_solid *walls, *trim;
    float length;
    prom_gallery_hole holes[HOLES_MAX];
    bool window[HOLES_MAX];
    int count;
} wall;

static void find_holes(wall *w, uint32_t room, prom_gallery_side side)
{
    const prom_gallery_plan *plan = &w->g->plan;
    w->count = 0;
    for (size_t i = 0; i < plan->openings.count && w->count < HOLES_MAX; i++) {
        const prom_gallery_opening *o = &plan->openings.data[i];
        float u;
        if (!prom_gallery_in_face(plan, o, room, side, &u)) continue;
        w->window[w->count] = o->window;
        w->holes[w->count++] =
            (prom_gallery_hole){u - o->width / 2, o->y0, u + o->width / 2, o->y1};
    }
}

// A moulding along the wall, but not through doors and windows that it would cross.
static void run_moulding(const wall *w, const float (*profile)[2], int points)
{
    float low = profile[0][0], high = profile[points - 1][0], at = 0;
    for (;;) {
        int next = -1;
        for (int i = 0; i < w->count; i++) {
            const prom_gallery_hole *h = &w->holes[i];
            if (h->v0 < high - 1e-3f && h->v1 > low + 1e-3f && h->u0 >= at - 0.2f &&
                (next < 0 || h->u0 < w->holes[next].u0))
                next = i;
        }
        // Up to the frame of the door.
        float end = next < 0 ? w->length : w->holes[next].u0 - 0.13f;
        if (end > at + 0.01f) prom_solid_moulding(w->trim, profile, points, at, end);
        if (next < 0) return;
        at = w->holes[next].u1 + 0.13f;
    }
}

static void build_skirting(const wall *w, float y)
{
    float h = w->look->stone ? 0.30f : 0.17f;
    const float profile[][2] = {{y, 0.030f},
                                {y + h - 0.04f, 0.030f},
                                {y + h - 0.02f, 0.018f},
                                {y + h, 0.016f},
                                {y + h + 0.005f, 0}};
    prom_solid_use(w->trim, w->look->skirting);
    run_moulding(w, profile, 5);
}

static void build_rail(const wall *w, float y)
{
    const float profile[][2] = {
        {y - 0.05f, 0}, {y - 0.04f, 0.018f}, {y - 0.01f, 0.022f}, {y, 0.04f}, {y + 0.02f, 0}};
    run_moulding(w, profile, 5);
}

static void build_dentils(const wall *w, float y, float size)
{
    int n = (int)(w->length / (2 * size));
    for (int i = 0; i < n; i++) {
        float x = w->length * ((float)i + 0.5f) / (float)n;
        prom_solid_box(w->trim, x - size / 2, y, 0.02f, x + size / 2, y + size * 1.2f,
                       0.05f + size * 0.6f, PROM_FACE_ALL & ~(PROM_FACE_BACK | PROM_FACE_TOP));
    }
}

// Raised fields on the dado, between doors and windows.
static void build_fields(const wall *w, float y)
{
    float at = 0.1f;
    prom_solid_use(w->trim, w->look->dado);
    while (at < w->length - 0.5f) {
        float end = w->length - 0.1f, next = w->length;
        for (int i = 0; i < w->count; i++) {
            const prom_gallery_hole *h = &w->holes[i];
            if (w->window[i] || h->v0 > y + 1 || h->v1 < y || h->u1 < at) continue;
            end = fminf(end, h->u0 - 0.2f);
            next = fminf(next, h->u1 + 0.2f);
        }
        int n = (int)roundf((end - at) / 0.95f);
        for (int i = 0; i < n; i++) {
            float step = (end - at) / (float)n, u = at + step * (float)i;
            prom_solid_box(w->trim, u + 0.07f, y + 0.26f, 0, u + step - 0.07f, y + DADO - 0.14f,
                           0.014f, PROM_FACE_NO_BACK);
        }
        at = next;
    }
}

// The cornice; its profile gets rounder with the detail.
static void build_cornice(const wall *w, float top, float size)
{
    float profile[40][2] = {{top - size, 0},
                            {top - 0.93f * size, 0.12f * size},
                            {top - 0.72f * size, 0.14f * size}};
    int n = 3, steps = prom_gallery_steps(w->g, 16);
    for (int i = 0; i <= steps; i++) { // a quarter hollow, then the lip
        float a = 1.5707963f * (float)i / (float)steps;
        profile[n][0] = top - (0.72f - 0.52f * sinf(a)) * size;
        profile[n++][1] = (0.18f + 0.55f * (1 - cosf(a))) * size;
    }
    profile[n][0] = top - 0.10f * size;
    profile[n++][1] = 0.85f * size;
    profile[n][0] = top;
    profile[n++][1] = 0.88f * size;
    prom_solid_use(w->trim, w->look->trim);
    prom_solid_moulding(w->trim, (const float(*)[2])profile, n, 0, w->length);
    if (w->g->options.detail > 2) build_dentils(w, top - 0.72f * size, 0.18f * size);
}

static void build_architrave(const wall *w, const prom_gallery_hole *h, bool window)
{
    prom_solid *s = w->trim;
    float b = 0.14f, d = 0.045f, low = window ? h->v0 - b : h->v0;
    prom_solid_use(s, w->look->frame);
    for (int k = 0; k < 2; k++, b -= 0.05f, d += 0.02f) {
        prom_solid_box(s, h->u0 - b, low, 0, h->u0, h->v1 + b, d, PROM_FACE_NO_BACK);
        prom_solid_box(s, h->u1, low, 0, h->u1 + b, h->v1 + b, d, PROM_FACE_NO_BACK);
        prom_solid_box(s, h->u0, h->v1, 0, h->u1, h->v1 + b, d, PROM_FACE_NO_BACK);
    }
    if (window) {
        prom_solid_box(s, h->u0 - 0.18f, h->v0 - 0.05f, 0, h->u1 + 0.18f, h->v0, 0.12f,
                       PROM_FACE_NO_BACK);
        return;
    }
    // A cornice over the door.
    float y = h->v1 + 0.14f;
    prom_solid_box(s, h->u0 - 0.14f, y, 0, h->u1 + 0.14f, y + 0.10f, 0.05f, PROM_FACE_NO_BACK);
    const float profile[][2] = {{y + 0.10f, 0.05f}, {y + 0.13f, 0.08f}, {y + 0.17f, 0.13f},
                                {y + 0.19f, 0.14f}, {y + 0.21f, 0.14f}, {y + 0.22f, 0}};
    prom_solid_moulding(s, profile, 6, h->u0 - 0.22f, h->u1 + 0.22f);
}

// ---- openings

static void build_reveal(prom_solid *s, float h, float y0, float y1, float depth)
{
    prom_solid_quad(s, (float[]){-h, y0, depth}, (float[]){-h, y0, 0}, (float[]){-h, y1, 0},
                    (float[]){-h, y1, depth});
    prom_solid_quad(s, (float[]){h, y0, 0}, (float[]){h, y0, depth}, (float[]){h, y1, depth},
                    (float[]){h, y1, 0});
    prom_solid_quad(s, (float[]){-h, y1, 0}, (float[]){h, y1, 0}, (float[]){h, y1, depth},
                    (float[]){-h, y1, depth});
    prom_solid_quad(s, (float[]){-h, y0, depth}, (float[]){h, y0, depth}, (float[]){h, y0, 0},
                    (float[]){-h, y0, 0});
}

static void build_panes(prom_gallery *g, prom_solid *s, float h, float y0, float y1)
{
    float z = 0.5f * PROM_GALLERY_WALL, b = 0.06f, d = 0.035f, high = y0 + 0.68f * (y1 - y0);
    prom_solid_use(s, prom_gallery_paint(g, PROM_GALLERY_WOOD, 0xf6f0e2, 1.2f));
    prom_solid_box(s, -h, y0, z - d, -h + b, y1, z + d, PROM_FACE_SIDES);
    prom_solid_box(s, h - b, y0, z - d, h, y1, z + d, PROM_FACE_SIDES);
    prom_solid_box(s, -h + b, y0, z - d, h - b, y0 + b, z + d, PROM_FACE_ALL);
    prom_solid_box(s, -h + b, y1 - b, z - d, h - b, y1, z + d, PROM_FACE_ALL);
    prom_solid_box(s, -0.03f, y0 + b, z - d, 0.03f, y1 - b, z + d, PROM_FACE_SIDES);
    prom_solid_box(s, -h + b, high, z - d, h - b, high + 0.07f, z + d, PROM_FACE_ALL);
    for (int k = 1; k < 3; k++) {
        float y = y0 + (high - y0) * (float)k / 3;
        prom_solid_box(s, -h + b, y, z - 0.015f, h - b, y + 0.03f, z + 0.015f, PROM_FACE_ALL);
    }
    prom_solid_use(s, prom_gallery_glass(g));
    prom_solid_quad(s, (float[]){-h, y0, z}, (float[]){h, y0, z}, (float[]){h, y1, z},
                    (float[]){-h, y1, z});
}

// A pair of leaves, open at right angles into the room beyond the wall.
static void build_leaves(const look *l, prom_solid *s, float h, float y0, float y1)
{
    float width = fminf(h, 0.95f) - 0.02f, z0 = PROM_GALLERY_WALL - 0.10f, z1 = z0 + width;
    for (int k = -1; k <= 1; k += 2) {
        float a = k < 0 ? -h + 0.01f : h - 0.06f, b = a + 0.05f;
        prom_solid_use(s, l->leaf);
        prom_solid_box(s, a, y0 + 0.01f, z0, b, y1 - 0.03f, z1, PROM_FACE_ALL);
        for (int panel = 0; panel < 3; panel++) { // raised fields on the visible side
            static const float fields[3][2] = {{0.07f, 0.34f}, {0.38f, 0.76f}, {0.80f, 0.96f}};
            float low = y0 + fields[panel][0] * (y1 - y0),
                  high = y0 + fields[panel][1] * (y1 - y0);
            float x0 = k < 0 ? b : a - 0.015f;
            prom_solid_box(s, x0, low, z0 + 0.10f, x0 + 0.015f, high, z1 - 0.10f,
                           PROM_FACE_ALL);
        }
    }
}

static bool owns(const prom_gallery *g, const prom_gallery_opening *o, uint32_t room)
{
    uint32_t first = o->rooms[0];
    if (first == PROM_GALLERY_OUTSIDE || g->plan.rooms.data[first].kind == PROM_GALLERY_COURT)
        first = o->rooms[1];
    return first == room;
}

static bool leaves_fit(const prom_gallery *g, const prom_gallery_opening *o)
{
    const prom_gallery_room *to = &g->plan.rooms.data[o->rooms[1]];
    return to->kind != PROM_GALLERY_HALL && to->kind != PROM_GALLERY_ROTUNDA &&
           to->kind != PROM_GALLERY_CORRIDOR && to->kind != PROM_GALLERY_STAIRS &&
           o->width < 1.5f;
}

static void build_opening(prom_gallery *g, const look *l, prom_solid *s, prom_solid *glass,
                          const prom_gallery_opening *o)
{
    float x = o->along_x ? o->from : o->middle, z = o->along_x ? o->middle : o->from;
    float yaw = o->along_x ? 1.57079633f : 0, h = o->width / 2;
    prom_solid_frame old = prom_solid_enter(s, x, 0, z, yaw);
    prom_solid_use(s, l->frame);
    build_reveal(s, h, o->y0, o->y1, PROM_GALLERY_WALL);
    prom_solid_leave(s, old);
    if (o->window) {
        old = prom_solid_enter(glass, x, 0, z, yaw);
        build_panes(g, glass, h, o->y0, o->y1);
        prom_solid_leave(glass, old);
    } else if (leaves_fit(g, o)) {
        old = prom_solid_enter(s, x, 0, z, yaw);
        build_leaves(l, s, h, o->y0, o->y1);
        prom_solid_leave(s, old);
    }
}

// ---- the room

static void build_wall(wall *w, uint32_t room, prom_gallery_side side)
{
    prom_gallery_face face = prom_gallery_room_face(w->room, side);
    const look *l = w->look;
    const prom_gallery_room *r = w->room;
    float bands[2] = {r->y0 + DADO, r->y1 - FRIEZE};
    if (r->kind == PROM_GALLERY_HALL) bands[0] = PROM_GALLERY_UPPER - 0.1f;
    if (r->kind == PROM_GALLERY_STAIRS) bands[0] = r->y0 + 1.2f;
    prom_paint paints[3] = {l->dado, l->wall, l->frieze};
    prom_solid_frame a = prom_solid_enter(w->walls, face.x, 0, face.z, face.yaw);
    prom_solid_frame b = prom_solid_enter(w->trim, face.x, 0, face.z, face.yaw);
    w->length = face.length;
    find_holes(w, room, side);
    prom_gallery_wall(w->walls, face.length, r->y0, r->y1, w->holes, w->count, bands, 2,
                      paints);
    build_skirting(w, r->y0);
    if (!l->stone && r->kind != PROM_GALLERY_MODERN && r->kind != PROM_GALLERY_SCULPTURES) {
        build_rail(w, r->y0 + DADO);
        build_fields(w, r->y0);
        prom_solid_use(w->trim, l->trim);
        build_rail(w, r->y1 - FRIEZE);
    }
    build_cornice(w, r->y1, r->kind == PROM_GALLERY_HALL ? 0.7f : 0.34f);
    for (int i = 0; i < w->count; i++) build_architrave(w, &w->holes[i], w->window[i]);
    prom_solid_leave(w->walls, a);
    prom_solid_leave(w->trim, b);
}

void prom_gallery_build_shell(prom_gallery *g, uint32_t id, uint32_t parent)
{
    const prom_gallery_room *room = &g->plan.rooms.data[id];
    prom_solid floor, walls, trim, openings, glass;
    look l = look_of(g, room);
    prom_solid_init(&floor);
    prom_solid_init(&walls);
    prom_solid_init(&trim);
    prom_solid_init(&openings);
    prom_solid_init(&glass);
    if (room->kind != PROM_GALLERY_COURT) {
        prom_solid_use(&floor, l.floor);
        prom_gallery_slab(&floor, room->x0, room->z0, room->x1, room->z1, room->y0, NULL, 0,
                          true);
    }
    wall w = {.g = g, .room = room, .look = &l, .walls = &walls, .trim = &trim};
    for (int side = 0; side < 4 && room->kind != PROM_GALLERY_ROTUNDA; side++)
        build_wall(&w, id, (prom_gallery_side)side);
    for (size_t i = 0; i < g->plan.openings.count; i++)
        if (owns(g, &g->plan.openings.data[i], id))
            build_opening(g, &l, &openings, &glass, &g->plan.openings.data[i]);
    prom_gallery_add(g, parent, "floor", &floor);
    prom_gallery_add(g, parent, "walls", &walls);
    prom_gallery_add(g, parent, "mouldings", &trim);
    prom_gallery_add(g, parent, "openings", &openings);
    prom_gallery_add(g, parent, "windows", &glass);
}
