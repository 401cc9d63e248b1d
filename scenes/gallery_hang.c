// What stands and hangs along the walls: pictures in frames with their labels, busts, consoles,
// bookcases, chairs, radiators, sconces.
#include "scenes/gallery_parts.h"

#include <math.h>

#define PI 3.14159265f
#define FREE_MAX 24
#define DOOR_MARGIN 0.35f
#define CORNER 0.45f

// ---- paintings

static prom_paint frame_paint(prom_gallery *g, uint32_t number, bool inner)
{
    if (number % 4 == 3)
        return inner ? prom_gallery_paint(g, PROM_GALLERY_METAL, 0xd8b060, 0.5f)
                     : prom_gallery_paint(g, PROM_GALLERY_WOOD, 0x5a3c2c, 0.6f);
    return prom_gallery_paint(g, PROM_GALLERY_METAL, inner ? 0xf2d080 : 0xdcae50, 0.5f);
}

// One side of a frame: the lower one of a canvas of width w and height h, cut to mitres.
static void build_side(prom_solid *s, const float (*profile)[2], int points, float w, float h)
{
    for (int i = 0; i + 1 < points; i++) {
        // profile: (outwards from the canvas, towards the viewer), from the canvas outwards.
        const float *in = profile[i], *out = profile[i + 1];
        prom_solid_quad(s, (float[]){-w / 2 - out[0], -h / 2 - out[0], out[1]},
                        (float[]){w / 2 + out[0], -h / 2 - out[0], out[1]},
                        (float[]){w / 2 + in[0], -h / 2 - in[0], in[1]},
                        (float[]){-w / 2 - in[0], -h / 2 - in[0], in[1]});
    }
}

// The canvas is upright, its middle at the origin, in the plane z = 0.02. A side is built
// lying below and turned about z by its own corners.
static void build_frame(prom_gallery *g, prom_solid *s, uint32_t number, float w, float h)
{
    float profile[40][2] = {{0, 0.015f}, {0.012f, 0.028f}, {0.024f, 0.026f}};
    int n = 3, steps = prom_gallery_steps(g, 24);
    float b = 0.05f + 0.05f * fminf(w, h);
    for (int i = 0; i <= steps; i++) { // a hollow, then the outer edge
        float t = (float)i / (float)steps;
        profile[n][0] = 0.026f + b * t;
        profile[n++][1] =
            0.024f + 0.045f * (1 - cosf(0.5f * PI * t)) + 0.006f * sinf(2 * PI * t);
    }
    if (g->options.detail > 1) {
        profile[n][0] = 0.04f + b;
        profile[n++][1] = 0.060f;
    } else { // a slope between the inner and the outer edge
        memcpy(profile[1], profile[2 + 1 + steps], sizeof profile[1]);
        n = 2;
    }
    profile[n][0] = 0.042f + b;
    profile[n++][1] = 0;
    for (int k = 0; k < 4; k++) {
        prom_solid side;
        prom_solid_init(&side);
        prom_solid_use(&side, frame_paint(g, number, false));
        bool upright = k % 2 == 1;
        build_side(&side, (const float(*)[2])profile, n, upright ? h : w, upright ? w : h);
        // Turn by k quarters about z and add.
        prom_solid_use(s, frame_paint(g, number, false));
        const prom_solid_part *part = &side.parts.data[side.part];
        uint32_t first = 0;
        for (size_t i = 0; i < part->vertices.count; i++) {
            const prom_glb_vertex *v = &part->vertices.data[i];
            float c = k == 0   ? 1.0f
                      : k == 2 ? -1.0f
                               : 0,
                  d = k == 1   ? 1.0f
                      : k == 3 ? -1.0f
                               : 0;
            uint32_t id = prom_solid_vertex(
                s,
                (float[]){c * v->position[0] - d * v->position[1],
                          d * v->position[0] + c * v->position[1], v->position[2]},
                (float[]){c * v->normal[0] - d * v->normal[1],
                          d * v->normal[0] + c * v->normal[1], v->normal[2]},
                v->uv[0], v->uv[1]);
            if (!i) first = id;
        }
        for (size_t i = 0; i + 2 < part->indices.count; i += 3)
            prom_solid_triangle(s, first + part->indices.data[i],
                                first + part->indices.data[i + 1],
                                first + part->indices.data[i + 2]);
        prom_solid_finish(&side);
    }
    prom_solid_use(s, frame_paint(g, number, true));
    for (int k = 0; k < 4 && g->options.detail > 1; k++) { // ornaments on the corners
        float x = (k & 1 ? 1.0f : -1.0f) * (w / 2 + 0.5f * b),
              y = (k & 2 ? 1.0f : -1.0f) * (h / 2 + 0.5f * b);
        prom_gallery_ball(s, x, y, 0.05f, 0.5f * b, 0.5f * b, 0.03f, prom_gallery_sides(g, 48),
                          0);
    }
}

static prom_gallery_painting make_painting(prom_gallery *g, uint32_t number)
{
    static const float sizes[][2] = {{1.10f, 0.82f}, {0.72f, 0.92f}, {0.85f, 0.85f},
                                     {1.45f, 0.95f}, {0.55f, 0.70f}, {1.90f, 1.30f},
                                     {1.00f, 1.35f}, {0.60f, 0.48f}, {1.25f, 1.25f},
                                     {2.40f, 1.50f}, {0.80f, 1.05f}};
    const float *size = sizes[(number * 7) % 11];
    prom_gallery_painting p = {.width = size[0], .height = size[1]};
    char *name = prom_format("painting_%03u", number);
    prom_solid s;
    prom_solid_init(&s);
    uint32_t pixels = g->options.detail == 1                    ? 128
                      : g->options.detail > 2 && p.width > 1.4f ? 512
                                                                : 256;
    prom_solid_use(&s, prom_gallery_canvas(g, number, p.width / p.height, pixels));
    float x = p.width / 2 + 0.002f, y = p.height / 2 + 0.002f, z = 0.02f;
    prom_solid_picture(&s, (float[]){-x, -y, z}, (float[]){x, -y, z}, (float[]){x, y, z},
                       (float[]){-x, y, z});
    build_frame(g, &s, number, p.width, p.height);
    p.mesh = prom_solid_write(&s, g->glb, name);
    prom_solid_finish(&s);
    prom_free(name);
    return p;
}

// The next painting that is at most so wide and high (with its frame), if there is one.
static bool next_painting(prom_gallery *g, float width, float height,
                          prom_gallery_painting *out)
{
    for (int tries = 0; tries < 11; tries++) {
        if (g->paintings.count < g->painting_limit) {
            prom_gallery_painting made = make_painting(g, (uint32_t)g->paintings.count);
            prom_array_push(&g->paintings, made);
        }
        uint32_t n = g->next_painting++ % (uint32_t)g->paintings.count;
        *out = g->paintings.data[n];
        if (out->width + 0.3f <= width && out->height + 0.3f <= height) return true;
    }
    return false;
}

// ---- a wall

typedef struct free_span {
    float u0, u1;
    bool window; // below a window
} free_span;

typedef struct side {
    prom_gallery *g;
    uint32_t room, parent;
    prom_gallery_face face;
    float floor, top;
    prom_random *random;
} side;

static void to_world(const side *w, float u, float y, float out, float p[3])
{
    float c = cosf(w->face.yaw), s = sinf(w->face.yaw);
    p[0] = w->face.x + c * u + s * out;
    p[1] = y;
    p[2] = w->face.z - s * u + c * out;
}

static void put(const side *w, prom_gallery_thing thing, uint32_t variant, float u, float y,
                float out, float turn, float scale)
{
    float p[3];
    to_world(w, u, y, out, p);
    prom_gallery_place(w->g, w->parent, thing, variant, p, w->face.yaw + turn, scale);
}

static void put_label(const side *w, prom_solid *labels, float u)
{
    float y = w->floor + 1.25f;
    prom_solid_frame old = prom_solid_enter(labels, w->face.x, 0, w->face.z, w->face.yaw);
    prom_solid_use(labels, prom_gallery_paint(w->g, PROM_GALLERY_LABEL, 0xffffff, 1));
    prom_solid_picture(labels, (float[]){u - 0.08f, y, 0.012f}, (float[]){u + 0.08f, y, 0.012f},
                       (float[]){u + 0.08f, y + 0.12f, 0.012f},
                       (float[]){u - 0.08f, y + 0.12f, 0.012f});
    prom_solid_leave(labels, old);
}

static void put_painting(const side *w, const prom_gallery_painting *p, float u, float y)
{
    float at[3];
    to_world(w, u, y, 0.004f, at);
    char *name = prom_format("picture_%u", w->g->count++);
    prom_glb_add_node(w->g->glb,
                      &(prom_glb_node){
                          .name = name,
                          .parent = w->parent,
                          .mesh = p->mesh,
                          .translation = {(double)at[0], (double)at[1], (double)at[2]},
                          .yaw = (double)w->face.yaw,
                          .scale = 1,
                      });
    prom_free(name);
    prom_gallery_see(w->g, w->room, at[0], at[1], at[2]);
}

// A row of pictures over [u0,u1], evenly spaced; a second one above where the wall is high.
static void hang_row(const side *w, prom_solid *labels, float u0, float u1, float low,
                     float high, bool close)
{
    prom_gallery_painting row[12];
    float width = 0, most = u1 - u0, middle = 0.5f * (low + high);
    int n = 0;
    while (n < 12) {
        float room = most - width;
        if (room < 0.8f || !next_painting(w->g, fminf(room, n ? 2.2f : 3), high - low, &row[n]))
            break;
        width += row[n++].width + 0.3f + (close ? 0.1f : 0.7f);
    }
    float gap = (most - width) / (float)(n + 1), u = u0 + gap;
    for (int i = 0; i < n; i++) {
        float span = row[i].width + 0.3f + (close ? 0.1f : 0.7f);
        put_painting(w, &row[i], u + span / 2, middle);
        if (labels) put_label(w, labels, u + span - 0.12f);
        u += span + gap;
    }
}

static void put_bust(const side *w, float u)
{
    uint32_t v = (uint32_t)prom_random_next(w->random) & 255;
    float p[3];
    put(w, PROM_GALLERY_PEDESTAL, v / 8, u, w->floor, 0.34f, 0, 1);
    put(w, PROM_GALLERY_BUST, v, u, w->floor + 1.0f, 0.34f, 0, 1);
    to_world(w, u, w->floor + 1.55f, 0.34f, p);
    prom_gallery_see(w->g, w->room, p[0], p[1], p[2]);
}

static void put_console(const side *w, prom_solid *labels, float u)
{
    uint32_t v = (uint32_t)prom_random_next(w->random) & 255;
    put(w, PROM_GALLERY_CONSOLE, v, u, w->floor, 0.03f, 0, 1);
    for (int k = -1; k <= 1; k++)
        put(w, k ? PROM_GALLERY_VASE : PROM_GALLERY_BOWL, v + (uint32_t)(k ? 0 : 3),
            u + 0.34f * (float)k, w->floor + 0.87f, 0.22f, 0, 1);
    hang_row(w, NULL, u - 0.65f, u + 0.65f, w->floor + 1.3f, w->floor + 2.8f, true);
    (void)labels;
}

static void furnish_span(const side *w, prom_solid *labels, prom_gallery_kind kind,
                         const free_span *f)
{
    float span = f->u1 - f->u0, middle = 0.5f * (f->u0 + f->u1), h = w->top - w->floor;
    float pick = prom_random_unit(w->random);
    bool low = h < 4.2f;
    if (f->window) {
        put(w, PROM_GALLERY_RADIATOR, 0, middle, w->floor, 0.02f, 0, 1);
        return;
    }
    if (span < 0.7f) return;
    switch (kind) {
    case PROM_GALLERY_LIBRARY: {
        int n = (int)(span / 1.34f);
        for (int i = 0; i < n; i++)
            put(w, PROM_GALLERY_BOOKCASE, (uint32_t)prom_random_next(w->random) & 15,
                f->u0 + span * ((float)i + 0.5f) / (float)n, w->floor, 0.02f, 0, 1);
        if (!n) put_bust(w, middle);
        return;
    }
    case PROM_GALLERY_CORRIDOR:
        for (int i = 0, n = (int)fmaxf(span / 2.8f, 1); i < n; i++) {
            float u = f->u0 + span * ((float)i + 0.5f) / (float)n;
            if (i % 2)
                hang_row(w, NULL, u - 1.1f, u + 1.1f, w->floor + 1.1f, w->floor + 2.7f, true);
            else
                put_bust(w, u);
        }
        return;
    case PROM_GALLERY_SCULPTURES:
        if (span < 2.6f) {
            put_bust(w, middle);
        } else {
            put_bust(w, f->u0 + 0.4f);
            put_bust(w, f->u1 - 0.4f);
            hang_row(w, labels, f->u0 + 0.9f, f->u1 - 0.9f, w->floor + 1.1f, w->floor + 2.9f,
                     false);
        }
        return;
    case PROM_GALLERY_SALON:
        if (span > 1.5f && pick < 0.55f) {
            put_console(w, labels, middle);
            if (span > 3.2f) {
                put(w, PROM_GALLERY_CHAIR, (uint32_t)(pick * 50), middle - 1.1f, w->floor,
                    0.30f, 0, 1);
                put(w, PROM_GALLERY_CHAIR, (uint32_t)(pick * 50), middle + 1.1f, w->floor,
                    0.30f, 0, 1);
            }
            put(w, PROM_GALLERY_SCONCE, 0, middle - 0.85f, w->floor + 1.9f, 0, 0, 1);
            put(w, PROM_GALLERY_SCONCE, 0, middle + 0.85f, w->floor + 1.9f, 0, 0, 1);
            return;
        }
        hang_row(w, NULL, f->u0, f->u1, w->floor + 1.15f, w->floor + 2.7f, true);
        return;
    case PROM_GALLERY_VITRINES:
        if (span > 1.2f && pick < 0.35f) {
            put(w, PROM_GALLERY_PLANT, (uint32_t)(pick * 90), f->u0 + 0.4f, w->floor, 0.35f, 0,
                1);
            hang_row(w, labels, f->u0 + 0.8f, f->u1, w->floor + 1.1f, w->floor + 2.8f, false);
            return;
        }
        hang_row(w, labels, f->u0, f->u1, w->floor + 1.1f, w->floor + 2.8f, false);
        return;
    default:
        hang_row(w, labels, f->u0, f->u1, w->floor + 0.95f, w->floor + (low ? 2.6f : 2.75f),
                 kind == PROM_GALLERY_CABINET);
        if (kind == PROM_GALLERY_CABINET && h > 4.3f)
            hang_row(w, NULL, f->u0, f->u1, w->floor + 2.8f, w->floor + h - 0.75f, true);
    }
}

// The stretches of a wall without doors; windows are stretches of their own.
static int find_spans(const side *w, prom_gallery_side which, float floor, free_span *spans)
{
    float u, holes[FREE_MAX][2];
    bool window[FREE_MAX];
    int n = 0, count = 0;
    const prom_gallery_plan *plan = &w->g->plan;
    for (size_t i = 0; i < plan->openings.count && n < FREE_MAX / 2 - 1; i++) {
        const prom_gallery_opening *o = &plan->openings.data[i];
        if (!prom_gallery_in_face(plan, o, w->room, which, &u) || o->y0 < floor - 0.1f ||
            o->y0 > floor + 2)
            continue;
        int at = n++;
        for (; at > 0 && holes[at - 1][0] > u - o->width / 2; at--) {
            memcpy(holes[at], holes[at - 1], sizeof holes[at]);
            window[at] = window[at - 1];
        }
        holes[at][0] = u - o->width / 2;
        holes[at][1] = u + o->width / 2;
        window[at] = o->window;
    }
    float from = CORNER;
    for (int i = 0; i < n; i++) {
        float margin = window[i] ? 0.2f : DOOR_MARGIN;
        spans[count++] = (free_span){from, holes[i][0] - margin, false};
        if (window[i]) spans[count++] = (free_span){holes[i][0], holes[i][1], true};
        from = holes[i][1] + margin;
    }
    spans[count++] = (free_span){from, w->face.length - CORNER, false};
    return count;
}

static void hang_side(side *w, prom_gallery_side which, prom_gallery_kind kind,
                      prom_solid *labels)
{
    free_span spans[FREE_MAX];
    int n = find_spans(w, which, w->floor, spans);
    for (int i = 0; i < n; i++) furnish_span(w, labels, kind, &spans[i]);
}

// Pictures to be seen from the flights and landings of the stairs.
static void hang_stairs(const side *w, prom_gallery_side which)
{
    float end = w->face.length - CORNER, half = 0.5f * PROM_GALLERY_UPPER;
    float door = 0.5f * w->face.length - 1.1f;
    switch (which) {
    case PROM_GALLERY_EAST:
        hang_row(w, NULL, 1.3f, end - 0.8f, half + 2.6f, half + 5.2f, true);
        break;
    case PROM_GALLERY_WEST:
        hang_row(w, NULL, 1.3f, end - 0.8f, 2.2f, 4.6f, true);
        break;
    case PROM_GALLERY_SOUTH:
        hang_row(w, NULL, CORNER, door - 0.2f, half + 1, half + 2.9f, true);
        hang_row(w, NULL, w->face.length - door + 0.2f, end, half + 1, half + 2.9f, true);
        break;
    default:
        for (int k = 0; k < 2; k++) {
            float y = k ? PROM_GALLERY_UPPER : 0;
            hang_row(w, NULL, CORNER, door, y + 0.9f, y + 2.7f, true);
            hang_row(w, NULL, w->face.length - door, end, y + 0.9f, y + 2.7f, true);
        }
    }
}

void prom_gallery_hang(prom_gallery *g, uint32_t room, uint32_t parent, prom_random *random)
{
    const prom_gallery_room *r = &g->plan.rooms.data[room];
    prom_solid labels;
    prom_solid_init(&labels);
    for (int k = 0; k < 4; k++) {
        side w = {g,     room,  parent, prom_gallery_room_face(r, (prom_gallery_side)k),
                  r->y0, r->y1, random};
        if (r->kind == PROM_GALLERY_STAIRS) {
            hang_stairs(&w, (prom_gallery_side)k);
        } else if (r->kind == PROM_GALLERY_HALL) {
            // Its ground floor is low under the gallery; large pictures hang on that above.
            w.top = 5;
            hang_side(&w, (prom_gallery_side)k, PROM_GALLERY_SCULPTURES, &labels);
            w.floor = PROM_GALLERY_UPPER;
            w.top = r->y1;
            hang_side(&w, (prom_gallery_side)k, PROM_GALLERY_MODERN, &labels);
        } else {
            hang_side(&w, (prom_gallery_side)k, r->kind, &labels);
        }
    }
    prom_gallery_add(g, parent, "labels", &labels);
}
