// An automatic walk: a loop around the middle of the layout, found by dynamic programming over
// angle and radius, near many objects and through none. It knows the objects' boxes only.
#include "scenes/path.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define ANGLES 180
#define RADII 32
#define FEW_OBJECTS 12 // fewer are looked at from around
#define CROWD 400u     // objects that a place's density is counted from, at most
#define NEIGHBOURS 12  // objects that tell the ground's height
#define SMOOTHING 60
#define WALL_COST 50.0 // of a place inside an object, in units of the density cost's full range

typedef struct object {
    double center[3], half[3];
} object;

typedef struct layout {
    PROM_ARRAY(object) objects;  // what stands on the ground
    PROM_ARRAY(object) surfaces; // chunks of the ground and of other large surfaces
    double middle[2], spread[2]; // robust centre and half extents in x and z
    double bottom, top;          // of all objects
    double size;                 // diagonal of the robust extents
    double eye;                  // height above the ground
} layout;

typedef struct place {
    double x, y, z;
} place;

// ---- the layout

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double percentile(double *values, size_t count, double share)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return values[(size_t)((double)(count - 1) * share + 0.5)];
}

static void collect(const prom_model *model, layout *l)
{
    for (uint32_t i = 0; i < model->tree_count; i++) {
        if (model->first_child[i] != PROM_NONE) continue;
        object o;
        bool finite = true;
        for (int k = 0; k < 3; k++) {
            o.center[k] = model->center[i][k];
            o.half[k] = (double)model->half[i][k];
            finite = finite && isfinite(o.center[k]) && isfinite(o.half[k]);
        }
        if (!finite) continue;
        if (model->prototypes[model->prototype[i]].flags & PROM_PROTO_SURFACE)
            prom_array_push(&l->surfaces, o);
        else
            prom_array_push(&l->objects, o);
    }
    if (l->objects.count) return;
    // Nothing but surfaces: walk among them.
    for (size_t i = 0; i < l->surfaces.count; i++)
        prom_array_push(&l->objects, l->surfaces.data[i]);
}

static void measure(layout *l)
{
    size_t n = l->objects.count;
    double *values = prom_alloc(n, sizeof *values);
    for (int axis = 0; axis < 2; axis++) {
        for (size_t i = 0; i < n; i++) values[i] = l->objects.data[i].center[2 * axis];
        double low = percentile(values, n, 0.05), high = percentile(values, n, 0.95);
        l->middle[axis] = (low + high) / 2;
        l->spread[axis] = (high - low) / 2;
    }
    l->bottom = DBL_MAX;
    l->top = -DBL_MAX;
    for (size_t i = 0; i < n; i++) {
        const object *o = &l->objects.data[i];
        l->bottom = fmin(l->bottom, o->center[1] - o->half[1]);
        l->top = fmax(l->top, o->center[1] + o->half[1]);
    }
    prom_free(values);
    l->size = 2 * hypot(l->spread[0], l->spread[1]);
    // Metres are assumed where the size is that of rooms to towns; else the eye is as high as
    // it would be in a layout at the near end of that range.
    l->eye = l->size < 20 ? 1.7 * l->size / 20 : l->size > 5000 ? 1.7 * l->size / 5000 : 1.7;
}

// ---- around a few objects

static void orbit(const layout *l, uint32_t frames, prom_path *path)
{
    double low[3] = {DBL_MAX, DBL_MAX, DBL_MAX}, high[3] = {-DBL_MAX, -DBL_MAX, -DBL_MAX};
    for (size_t i = 0; i < l->objects.count; i++) {
        const object *o = &l->objects.data[i];
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
static double ground_at(const layout *l, double x, double z)
{
    double nearest[NEIGHBOURS], bottoms[NEIGHBOURS];
    int n = 0;
    for (size_t i = 0; i < l->objects.count; i++) {
        const object *o = &l->objects.data[i];
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
    double ground = percentile(bottoms, (size_t)n, 0.3);
    // Surfaces under the place say between which heights it can be.
    double low = DBL_MAX, high = -DBL_MAX;
    for (size_t i = 0; i < l->surfaces.count; i++) {
        const object *o = &l->surfaces.data[i];
        if (fabs(o->center[0] - x) > o->half[0] || fabs(o->center[2] - z) > o->half[2])
            continue;
        low = fmin(low, o->center[1] - o->half[1]);
        high = fmax(high, o->center[1] + fmin(o->half[1], l->eye));
    }
    return low > high ? ground : fmin(fmax(ground, low), high);
}

// ---- the loop

static void to_plane(const layout *l, double angle, double radius, double *x, double *z)
{
    *x = l->middle[0] + radius * l->spread[0] * sin(angle);
    *z = l->middle[1] + radius * l->spread[1] * cos(angle);
}

// The share of the eye's way that a place lies inside objects: 0 when it is free. Objects
// wholly below the knee or above the head, and those as large as the layout itself, are no
// obstacle.
static double inside(const layout *l, double x, double y, double z)
{
    double margin = 0.6 * l->eye, worst = 0;
    for (size_t i = 0; i < l->objects.count; i++) {
        const object *o = &l->objects.data[i];
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

// How many objects are around, each counting less with distance.
static double density(const layout *l, double x, double z)
{
    double reach = 0.12 * l->size + 1e-9, sum = 0;
    size_t step = l->objects.count / CROWD + 1;
    for (size_t i = 0; i < l->objects.count; i += step) {
        double dx = (l->objects.data[i].center[0] - x) / reach;
        double dz = (l->objects.data[i].center[2] - z) / reach;
        sum += 1 / (1 + dx * dx + dz * dz);
    }
    return sum;
}

typedef struct field {
    double cost[ANGLES][RADII];
} field;

static double radius_of(int r)
{
    return 0.25 + 0.7 * r / (RADII - 1);
}

static void fill_field(const layout *l, field *f)
{
    double most = 0;
    for (int a = 0; a < ANGLES; a++) {
        for (int r = 0; r < RADII; r++) {
            double x, z;
            to_plane(l, 2 * M_PI * a / ANGLES, radius_of(r), &x, &z);
            f->cost[a][r] = density(l, x, z);
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
static void smooth_loop(const layout *l, place loop[ANGLES])
{
    for (int round = 0; round < SMOOTHING; round++) {
        place next[ANGLES];
        for (int i = 0; i < ANGLES; i++) {
            const place *a = &loop[(i + ANGLES - 1) % ANGLES], *b = &loop[i];
            const place *c = &loop[(i + 1) % ANGLES];
            next[i] = (place){(a->x + 2 * b->x + c->x) / 4, (a->y + 2 * b->y + c->y) / 4,
                              (a->z + 2 * b->z + c->z) / 4};
            if (inside(l, next[i].x, next[i].y, next[i].z) > inside(l, b->x, b->y, b->z))
                next[i] = *b;
        }
        memcpy(loop, next, sizeof next);
    }
}

// A point of the closed loop, `t` in [0,1): Catmull-Rom.
static place loop_point(const place loop[ANGLES], const double length[ANGLES + 1], double t)
{
    double s = (t - floor(t)) * length[ANGLES];
    int i = 0, high = ANGLES;
    while (high - i > 1) {
        int mid = (i + high) / 2;
        if (length[mid] <= s)
            i = mid;
        else
            high = mid;
    }
    double step = length[i + 1] - length[i], u = step > 0 ? (s - length[i]) / step : 0;
    const place *p[4];
    for (int k = 0; k < 4; k++) p[k] = &loop[(i + k - 1 + ANGLES) % ANGLES];
    double w[4] = {((2 - u) * u - 1) * u / 2, ((3 * u - 5) * u * u + 2) / 2,
                   ((4 - 3 * u) * u + 1) * u / 2, (u - 1) * u * u / 2};
    place q = {0, 0, 0};
    for (int k = 0; k < 4; k++) {
        q.x += w[k] * p[k]->x;
        q.y += w[k] * p[k]->y;
        q.z += w[k] * p[k]->z;
    }
    return q;
}

static void walk_loop(const place loop[ANGLES], uint32_t frames, prom_path *path)
{
    double length[ANGLES + 1] = {0};
    for (int i = 0; i < ANGLES; i++) {
        const place *a = &loop[i], *b = &loop[(i + 1) % ANGLES];
        length[i + 1] = length[i] + hypot(b->x - a->x, b->z - a->z);
    }
    for (uint32_t i = 0; i < frames; i++) {
        double t = (double)i / frames;
        place here = loop_point(loop, length, t), ahead = loop_point(loop, length, t + 0.04);
        double forward[3] = {ahead.x - here.x, ahead.y - here.y, ahead.z - here.z};
        // Hills are looked up and down only in part; the view falls by three degrees.
        double way = hypot(forward[0], forward[2]);
        forward[1] = fmax(fmin(0.5 * forward[1], 0.2 * way), -0.2 * way) - 0.05 * way;
        prom_path_add(path, (double[]){here.x, here.y, here.z}, forward);
    }
}

static void walk(const layout *l, uint32_t frames, prom_path *path)
{
    field *f = prom_alloc(1, sizeof *f);
    int radii[ANGLES];
    place loop[ANGLES];
    fill_field(l, f);
    find_loop(f, radii);
    prom_free(f);
    for (int a = 0; a < ANGLES; a++) {
        place *p = &loop[a];
        to_plane(l, 2 * M_PI * a / ANGLES, radius_of(radii[a]), &p->x, &p->z);
        p->y = ground_at(l, p->x, p->z) + l->eye;
    }
    smooth_loop(l, loop);
    walk_loop(loop, frames, path);
}

prom_status prom_path_auto(const prom_model *model, uint32_t frames, prom_path *path,
                           prom_error *error)
{
    layout l = {0};
    *path = (prom_path){0};
    if (!frames) return prom_fail(error, PROM_ERR_USAGE, "a path needs at least one frame");
    collect(model, &l);
    if (!l.objects.count)
        return prom_fail(error, PROM_ERR_INPUT, "the model has no object to walk among");
    measure(&l);
    if (l.objects.count < FEW_OBJECTS || l.size <= 0)
        orbit(&l, frames, path);
    else
        walk(&l, frames, path);
    prom_array_finish(&l.objects);
    prom_array_finish(&l.surfaces);
    return PROM_OK;
}
