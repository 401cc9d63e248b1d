// An automatic walk: around a few objects, looking at them; else through the model's geometry
// (auto_walk.c); where that is not at hand, on a loop around the middle of the layout, found by
// dynamic programming over angle and radius, near many objects and through none of their boxes.
#include "scenes/auto_layout.h"
#include "scenes/walk_map.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define ANGLES 180
#define RADII 32
#define FEW_OBJECTS 12 // fewer are looked at from around
#define NEIGHBOURS 12  // objects that tell the ground's height
#define SMOOTHING 60
#define WALK_OBJECTS 2500u // in the part of a large world that is walked in
#define WALL_COST 50.0 // of a place inside an object, in units of the density cost's full range

// ---- around a few objects

static void orbit(const prom_layout *l, uint32_t frames, prom_path *path)
{
    double low[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, high[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (size_t i = 0; i < l->objects.count; i++) {
        const prom_layout_box *o = &l->objects.data[i];
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], o->center[k] - o->half[k]);
            high[k] = fmax(high[k], o->center[k] + o->half[k]);
        }
    }
    double center[3], radius = 0;
    for (int k = 0; k < 3; k++) {
        center[k] = (low[k] + high[k]) / 2;
        radius += (high[k] - low[k]) * (high[k] - low[k]) / 4;
    }
    // At 2.2 radii a sphere fills about nine tenths of a 60 degree view.
    double distance = 2.2 * fmax(sqrt(radius), 1e-6);
    for (uint32_t i = 0; i < frames; i++) {
        double a = 2 * M_PI * i / frames;
        double p[3] = {center[0] + distance * sin(a), center[1] + 0.35 * distance,
                       center[2] + distance * cos(a)};
        prom_path_add(path, p,
                      (double[]){center[0] - p[0], center[1] - p[1], center[2] - p[2]});
    }
}

// ---- the ground

// The bottoms of the nearest objects, low ones preferred: objects stand on the ground, and some
// stand on others.
static double ground_at(const prom_layout *l, double x, double z)
{
    double nearest[NEIGHBOURS], bottoms[NEIGHBOURS];
    int n = 0;
    for (size_t i = 0; i < l->objects.count; i++) {
        const prom_layout_box *o = &l->objects.data[i];
        double dx = fmax(fabs(o->center[0] - x) - o->half[0], 0);
        double dz = fmax(fabs(o->center[2] - z) - o->half[2], 0), d = dx * dx + dz * dz;
        if (n == NEIGHBOURS && d >= nearest[n - 1]) continue;
        int at = n < NEIGHBOURS ? n++ : n - 1;
        for (; at > 0 && nearest[at - 1] > d; at--) {
            nearest[at] = nearest[at - 1];
            bottoms[at] = bottoms[at - 1];
        }
        nearest[at] = d;
        bottoms[at] = o->center[1] - o->half[1];
    }
    double ground = prom_layout_percentile(bottoms, (size_t)n, 0.3);
    // Surfaces under the place say between which heights it can be.
    double low = DBL_MAX, high = -DBL_MAX;
    for (size_t i = 0; i < l->surfaces.count; i++) {
        const prom_layout_box *o = &l->surfaces.data[i];
        if (fabs(o->center[0] - x) > o->half[0] || fabs(o->center[2] - z) > o->half[2])
            continue;
        low = fmin(low, o->center[1] - o->half[1]);
        high = fmax(high, o->center[1] + fmin(o->half[1], l->eye));
    }
    return low > high ? ground : fmin(fmax(ground, low), high);
}

// ---- the loop

static void to_plane(const prom_layout *l, double angle, double radius, double *x, double *z)
{
    *x = l->middle[0] + radius * l->spread[0] * sin(angle);
    *z = l->middle[1] + radius * l->spread[1] * cos(angle);
}

// The share of the eye's way that a place lies inside objects: 0 when it is free. Objects
// wholly below the knee or above the head, and those as large as the layout itself, are no
// obstacle.
static double inside(const prom_layout *l, double x, double y, double z)
{
    double margin = 0.6 * l->eye, worst = 0;
    for (size_t i = 0; i < l->objects.count; i++) {
        const prom_layout_box *o = &l->objects.data[i];
        if (o->center[1] + o->half[1] < y - 0.7 * l->eye) continue;
        if (o->center[1] - o->half[1] > y + 0.3 * l->eye) continue;
        if (o->half[0] > 0.5 * l->spread[0] || o->half[2] > 0.5 * l->spread[1]) continue;
        double dx = o->half[0] + margin - fabs(o->center[0] - x);
        double dz = o->half[2] + margin - fabs(o->center[2] - z);
        if (dx <= 0 || dz <= 0) continue;
        worst = fmax(worst, fmin(dx, dz) / (fmin(o->half[0], o->half[2]) + margin));
    }
    return worst;
}

typedef struct field {
    double cost[ANGLES][RADII];
} field;

static double radius_of(int r)
{
    return 0.25 + 0.7 * r / (RADII - 1);
}

static void fill_field(const prom_layout *l, field *f)
{
    double most = 0;
    for (int a = 0; a < ANGLES; a++) {
        for (int r = 0; r < RADII; r++) {
            double x, z;
            to_plane(l, 2 * M_PI * a / ANGLES, radius_of(r), &x, &z);
            f->cost[a][r] = prom_layout_density(l, x, z);
            most = fmax(most, f->cost[a][r]);
        }
    }
    for (int a = 0; a < ANGLES; a++) {
        for (int r = 0; r < RADII; r++) {
            double x, z, radius = radius_of(r);
            to_plane(l, 2 * M_PI * a / ANGLES, radius, &x, &z);
            // Dense places, the middle half of the layout, free places.
            double cost = 1 - f->cost[a][r] / most + 2 * (radius - 0.55) * (radius - 0.55);
            double in = inside(l, x, ground_at(l, x, z) + l->eye, z);
            f->cost[a][r] = cost + (in > 0 ? WALL_COST * (0.2 + in) : 0);
        }
    }
}

// The cheapest way around: three rounds of dynamic programming, of which the middle one, free
// of the arbitrary start and end, is taken.
static void find_loop(const field *f, int loop[ANGLES])
{
    enum { STEPS = 3 * ANGLES };
    double(*best)[RADII] = prom_alloc(STEPS, sizeof *best);
    int(*from)[RADII] = prom_alloc(STEPS, sizeof *from);
    for (int s = 0; s < STEPS; s++) {
        for (int r = 0; r < RADII; r++) {
            best[s][r] = s ? DBL_MAX : 0;
            from[s][r] = r;
            for (int d = -1; s && d <= 1; d++) {
                if (r + d < 0 || r + d >= RADII) continue;
                double way = best[s - 1][r + d] + 0.15 * d * d;
                if (way < best[s][r]) {
                    best[s][r] = way;
                    from[s][r] = r + d;
                }
            }
            best[s][r] += f->cost[s % ANGLES][r];
        }
    }
    int at = 0;
    for (int r = 1; r < RADII; r++)
        if (best[STEPS - 1][r] < best[STEPS - 1][at]) at = r;
    for (int s = STEPS - 1; s >= ANGLES; s--) {
        if (s < 2 * ANGLES) loop[s - ANGLES] = at;
        at = from[s][at];
    }
    prom_free(best);
    prom_free(from);
}

// Rounds the corners, but not into an object.
static void smooth_loop(const prom_layout *l, prom_place loop[ANGLES])
{
    for (int round = 0; round < SMOOTHING; round++) {
        prom_place next[ANGLES];
        for (int i = 0; i < ANGLES; i++) {
            const prom_place *a = &loop[(i + ANGLES - 1) % ANGLES], *b = &loop[i];
            const prom_place *c = &loop[(i + 1) % ANGLES];
            next[i] = (prom_place){(a->x + 2 * b->x + c->x) / 4, (a->y + 2 * b->y + c->y) / 4,
                                   (a->z + 2 * b->z + c->z) / 4};
            if (inside(l, next[i].x, next[i].y, next[i].z) > inside(l, b->x, b->y, b->z))
                next[i] = *b;
        }
        memcpy(loop, next, sizeof next);
    }
}

void prom_layout_walk(const prom_layout *l, uint32_t frames, prom_path *path)
{
    field *f = prom_alloc(1, sizeof *f);
    int radii[ANGLES];
    prom_place loop[ANGLES];
    fill_field(l, f);
    find_loop(f, radii);
    prom_free(f);
    for (int a = 0; a < ANGLES; a++) {
        prom_place *p = &loop[a];
        to_plane(l, 2 * M_PI * a / ANGLES, radius_of(radii[a]), &p->x, &p->z);
        p->y = ground_at(l, p->x, p->z) + l->eye;
    }
    smooth_loop(l, loop);
    prom_loop_walk(l, loop, ANGLES, frames, path);
}

// The middle of a very large world: as many objects as a walk can pass.
static void shrink(prom_layout *l)
{
    size_t n = l->objects.count;
    if (n <= WALK_OBJECTS) return;
    double *distance = prom_alloc(n, sizeof *distance);
    for (size_t i = 0; i < n; i++) {
        const prom_layout_box *o = &l->objects.data[i];
        distance[i] =
            fmax(fabs(o->center[0] - l->middle[0]), fabs(o->center[2] - l->middle[1]));
    }
    double reach = prom_layout_percentile(distance, n, (double)WALK_OBJECTS / (double)n);
    prom_free(distance);
    for (int axis = 0; axis < 2; axis++) l->spread[axis] = fmin(l->spread[axis], reach);
    l->size = 2 * hypot(l->spread[0], l->spread[1]);
}

static prom_status walk(prom_container *container, const prom_model *model, prom_layout *l,
                        uint32_t frames, prom_path *path, prom_error *error)
{
    double low[2], high[2];
    prom_walk_map map;
    shrink(l);
    for (int axis = 0; axis < 2; axis++) {
        // Never a line: a row of things has a way beside it.
        double half = fmax(1.1 * l->spread[axis], 0.1 * l->size);
        low[axis] = l->middle[axis] - half;
        high[axis] = l->middle[axis] + half;
    }
    prom_status status = prom_walk_map_init(&map, container, model, low, high, l->eye, error);
    if (status) return status;
    if (!prom_map_walk(&map, l, frames, path)) prom_layout_walk(l, frames, path);
    prom_walk_map_finish(&map);
    return PROM_OK;
}

prom_status prom_path_auto(prom_container *container, const prom_model *model, uint32_t frames,
                           prom_path *path, prom_error *error)
{
    prom_layout l;
    prom_status status = PROM_OK;
    *path = (prom_path){0};
    if (!frames) return prom_fail(error, PROM_ERR_USAGE, "a path needs at least one frame");
    prom_layout_init(&l, model);
    if (!l.objects.count)
        status = prom_fail(error, PROM_ERR_INPUT, "the model has no object to walk among");
    else if (l.objects.count < FEW_OBJECTS || l.size <= 0)
        orbit(&l, frames, path);
    else if (container)
        status = walk(container, model, &l, frames, path, error);
    else
        prom_layout_walk(&l, frames, path);
    prom_layout_finish(&l);
    return status;
}
