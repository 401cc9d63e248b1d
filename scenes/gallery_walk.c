// A walk through the core: through the rotunda into the hall, up its stairs, along its gallery
// floor, down the other stairs and back into the hall.
#include "scenes/gallery_parts.h"

#include <math.h>

#define EYE 1.65
#define SPEED 1.6   // m/s
#define STEP 0.05   // metres from point to point of the way
#define ROUND 13    // points to either side that round a corner, twice
#define TURN 16     // keys to either side that smooth the look, twice
#define HOLD 60     // keys that a sight is looked at
#define PAUSE 30    // keys of looking ahead between
#define REACH 7.0   // metres
#define WIDEST 1.25 // radians to the side

typedef struct point {
    double p[3];
} point;

typedef struct way {
    PROM_ARRAY(point) points;
} way;

static void go(way *w, float x, float y, float z)
{
    point to = {{(double)x, (double)y, (double)z}};
    if (w->points.count) {
        point from = w->points.data[w->points.count - 1];
        double d = hypot(to.p[0] - from.p[0], to.p[2] - from.p[2]);
        int n = (int)(d / STEP);
        for (int i = 1; i < n; i++) {
            double t = (double)i / n;
            point between;
            for (int k = 0; k < 3; k++) between.p[k] = from.p[k] + (to.p[k] - from.p[k]) * t;
            prom_array_push(&w->points, between);
        }
    }
    prom_array_push(&w->points, to);
}

static void lay_out(const prom_gallery *g, way *w)
{
    const prom_gallery_plan *plan = &g->plan;
    const uint32_t c = plan->core, r = plan->core_row;
    const prom_gallery_room *rooms = plan->rooms.data;
    const prom_gallery_room *hall = &rooms[prom_gallery_room_at(plan, 0, c + 2, r)];
    const prom_gallery_room *stairs = &rooms[prom_gallery_room_at(plan, 0, c + 3, r + 2)];
    prom_gallery_flight f[3];
    prom_gallery_flights(plan, f);
    float axis = prom_gallery_row_middle(plan, r + 1),
          east = prom_gallery_column_middle(plan, c + 3);
    float up = PROM_GALLERY_UPPER, half = 0.5f * up;
    float round = prom_gallery_column_middle(plan, c + 1), middle = f[0].x;
    go(w, plan->column_x[c][1] - 1.0f, 0, axis);
    go(w, round - 2.7f, 0, axis);
    for (int i = 1; i < 8; i++) { // around the statue
        float a = 3.14159265f * (1 - (float)i / 8);
        go(w, round + 2.0f * cosf(a), 0, axis + 2.0f * sinf(a));
    }
    go(w, round + 2.7f, 0, axis);
    go(w, middle, 0, axis);
    go(w, middle, 0, f[0].z0);
    go(w, middle, up, f[0].z1);
    float north = hall->z0 + 1.15f, along = hall->x1 - 1.15f;
    go(w, middle, up, north);
    go(w, along, up, north);
    go(w, along, up, axis);
    go(w, east, up, axis);
    float landing = stairs->z0 + 0.75f, turn = stairs->z1 - 0.75f;
    go(w, east, up, landing);
    go(w, f[1].x, up, landing);
    go(w, f[1].x, up, f[1].z1);
    go(w, f[1].x, half, f[1].z0);
    go(w, f[1].x, half, turn);
    go(w, f[2].x, half, turn);
    go(w, f[2].x, half, f[2].z1);
    go(w, f[2].x, 0, f[2].z0);
    go(w, f[2].x, 0, landing);
    go(w, east, 0, landing);
    go(w, east, 0, axis);
    go(w, hall->x1 - 0.6f, 0, axis);
}

// Means over a window that is cut at both ends, so that corners become round; a straight way
// stays straight, and a mean of places that can be walked lies between them.
static void smooth(double *values, size_t count, size_t stride, size_t radius)
{
    double *sums = prom_alloc(count + 1, sizeof *sums);
    sums[0] = 0;
    for (size_t i = 0; i < count; i++) sums[i + 1] = sums[i] + values[i * stride];
    for (size_t i = 0; i < count; i++) {
        size_t reach = radius;
        if (i < reach) reach = i;
        if (count - 1 - i < reach) reach = count - 1 - i;
        values[i * stride] = (sums[i + reach + 1] - sums[i - reach]) / (double)(2 * reach + 1);
    }
    prom_free(sums);
}

// ---- keys at even steps

typedef struct look {
    point at;
    double yaw, pitch; // yaw: atan2(x, z) of the way's direction, without jumps
} look;

typedef struct looks {
    PROM_ARRAY(look) keys;
} looks;

static double unwrap(double yaw, double near)
{
    while (yaw > near + M_PI) yaw -= 2 * M_PI;
    while (yaw < near - M_PI) yaw += 2 * M_PI;
    return yaw;
}

static void set_out(const way *w, looks *out)
{
    double left = 0, step = SPEED / PROM_PATH_RATE, yaw = M_PI / 2;
    for (size_t i = 0; i + 1 < w->points.count; i++) {
        const double *a = w->points.data[i].p, *b = w->points.data[i + 1].p;
        double d[3], length = 0;
        for (int k = 0; k < 3; k++) {
            d[k] = b[k] - a[k];
            length += d[k] * d[k];
        }
        length = sqrt(length);
        if (hypot(d[0], d[2]) > 1e-9) yaw = unwrap(atan2(d[0], d[2]), yaw);
        for (; left < length; left += step) {
            look key = {.yaw = yaw, .pitch = -0.02};
            for (int k = 0; k < 3; k++) key.at.p[k] = a[k] + d[k] * (left / length);
            key.at.p[1] += EYE;
            prom_array_push(&out->keys, key);
        }
        left -= length;
    }
}

// One looks ahead along the way, up and down stairs too.
static void look_ahead(looks *l)
{
    size_t n = l->keys.count;
    double before = l->keys.data[0].yaw;
    for (size_t i = 0; i < n; i++) {
        size_t j = i + 40 < n ? i + 40 : n - 1;
        look *key = &l->keys.data[i];
        const double *a = key->at.p, *b = l->keys.data[j].at.p;
        double dx = b[0] - a[0], dz = b[2] - a[2], d = hypot(dx, dz);
        if (d > 0.5) {
            key->yaw = unwrap(atan2(dx, dz), before);
            key->pitch = 0.6 * atan2(b[1] - a[1], d) - 0.02;
        } else {
            key->yaw = before;
        }
        before = key->yaw;
    }
}

// ---- looking at things

static uint32_t room_at(const prom_gallery_plan *plan, const double p[3])
{
    for (uint32_t i = 0; i < plan->rooms.count; i++) {
        const prom_gallery_room *r = &plan->rooms.data[i];
        double floor = p[1] - EYE;
        if (p[0] >= (double)r->x0 && p[0] <= (double)r->x1 && p[2] >= (double)r->z0 &&
            p[2] <= (double)r->z1 && floor > (double)r->y0 - 1 && floor < (double)r->y1 - 2)
            return i;
    }
    return PROM_GALLERY_OUTSIDE;
}

// How good a sight is from a key: near and somewhat to the side is best. Below 0: not to be
// seen.
static double appeal(const look *key, const prom_gallery_sight *s, double *yaw, double *pitch)
{
    double d[3];
    for (int k = 0; k < 3; k++) d[k] = (double)s->position[k] - key->at.p[k];
    double flat = hypot(d[0], d[2]);
    *yaw = unwrap(atan2(d[0], d[2]), key->yaw);
    *pitch = atan2(d[1], flat);
    double side = fabs(*yaw - key->yaw);
    if (flat < 1.2 || flat > REACH || side > WIDEST || fabs(d[1]) > 2.2) return -1;
    return 2 - flat / REACH - fabs(side - 0.6);
}

static const prom_gallery_sight *choose(const prom_gallery *g, const look *key, size_t *seen)
{
    uint32_t room = room_at(&g->plan, key->at.p);
    const prom_gallery_sight *best = NULL;
    double most = 0, yaw, pitch;
    for (size_t i = 0; i < g->sights.count; i++) {
        const prom_gallery_sight *s = &g->sights.data[i];
        if (s->room != room || i + 1 == *seen) continue;
        double value = appeal(key, s, &yaw, &pitch);
        if (value > most) {
            most = value;
            best = s;
        }
    }
    if (best) *seen = (size_t)(best - g->sights.data) + 1;
    return best;
}

static void look_around(const prom_gallery *g, looks *l)
{
    size_t n = l->keys.count, seen = 0;
    for (size_t i = PAUSE; i < n;) {
        const prom_gallery_sight *s = choose(g, &l->keys.data[i], &seen);
        if (!s) {
            i += 10;
            continue;
        }
        size_t end = i + HOLD < n ? i + HOLD : n;
        for (; i < end; i++) {
            double yaw, pitch;
            look *key = &l->keys.data[i];
            if (appeal(key, s, &yaw, &pitch) < 0) break;
            key->yaw += 0.8 * (yaw - key->yaw);
            key->pitch = 0.8 * pitch;
        }
        i += PAUSE;
    }
}

void prom_gallery_walk(const prom_gallery *g, prom_path *path)
{
    way w = {0};
    looks l = {0};
    lay_out(g, &w);
    for (int pass = 0; pass < 2; pass++)
        for (int k = 0; k < 3; k++)
            smooth(&w.points.data[0].p[k], w.points.count, 3, k == 1 ? ROUND / 2 : ROUND);
    set_out(&w, &l);
    look_ahead(&l);
    look_around(g, &l);
    size_t stride = sizeof(look) / sizeof(double);
    for (int pass = 0; pass < 2; pass++) {
        smooth(&l.keys.data[0].yaw, l.keys.count, stride, TURN);
        smooth(&l.keys.data[0].pitch, l.keys.count, stride, TURN);
    }
    for (size_t i = 0; i < l.keys.count; i++) {
        const look *key = &l.keys.data[i];
        double c = cos(key->pitch);
        double forward[3] = {c * sin(key->yaw), sin(key->pitch), c * cos(key->yaw)};
        prom_path_add(path, key->at.p, forward);
    }
    prom_array_finish(&w.points);
    prom_array_finish(&l.keys);
}
