#include "scenes/city_parts.h"

#include <math.h>

#define PI 3.14159265358979
#define FRAMES 600
#define EYE 1.7
#define STEP 0.1 // between the points of a way, metres
#define POINTS_MAX 4096
#define LOOK_AHEAD 6.0 // metres along the way
#define KERB_RAMP 0.6  // a kerb is taken over this distance

// ---- a way: a line with rounded corners, as points at equal steps

typedef struct corner {
    double x, z, radius; // how far before and after the corner the turn is
} corner;

typedef struct way {
    double points[POINTS_MAX][2];
    int count;
    double rest; // of a step, not yet walked
} way;

static void walk_to(way *w, double x, double z)
{
    if (!w->count) {
        w->points[0][0] = x;
        w->points[0][1] = z;
        w->count = 1;
        return;
    }
    for (;;) {
        double *p = w->points[w->count - 1], length = hypot(x - p[0], z - p[1]);
        if (length < STEP || w->count == POINTS_MAX) return;
        double *q = w->points[w->count++];
        q[0] = p[0] + (x - p[0]) * STEP / length;
        q[1] = p[1] + (z - p[1]) * STEP / length;
    }
}

// Turns are curves of the second degree (Bezier), which begin and end along the legs.
static void make_way(way *w, const corner *corners, int count)
{
    *w = (way){0};
    walk_to(w, corners[0].x, corners[0].z);
    for (int i = 1; i + 1 < count; i++) {
        const corner *a = &corners[i - 1], *b = &corners[i], *c = &corners[i + 1];
        double before = hypot(b->x - a->x, b->z - a->z),
               after = hypot(c->x - b->x, c->z - b->z);
        double r = fmin(b->radius, fmin(before, after) / 2);
        double p[2] = {b->x + (a->x - b->x) * r / before, b->z + (a->z - b->z) * r / before};
        double q[2] = {b->x + (c->x - b->x) * r / after, b->z + (c->z - b->z) * r / after};
        walk_to(w, p[0], p[1]);
        for (int k = 1; k <= 40; k++) {
            double t = k / 40.0, u = 1 - t;
            walk_to(w, u * u * p[0] + 2 * u * t * b->x + t * t * q[0],
                    u * u * p[1] + 2 * u * t * b->z + t * t * q[1]);
        }
    }
    walk_to(w, corners[count - 1].x, corners[count - 1].z);
}

// `s` metres along; past the end it goes straight on.
static void way_point(const way *w, double s, double p[2])
{
    int last = w->count - 2;
    double at = fmax(s / STEP, 0);
    int i = at < last ? (int)at : last;
    const double *a = w->points[i], *b = w->points[i + 1];
    p[0] = a[0] + (b[0] - a[0]) * (at - i);
    p[1] = a[1] + (b[1] - a[1]) * (at - i);
}

static double way_length(const way *w)
{
    return STEP * (w->count - 1);
}

// ---- on the ground

// Along the right lane of the street to the bridge, over it on its right pavement, along the
// quay, and over the road into the square.
static int river_corners(const prom_city_plan *plan, corner *c)
{
    double x = (double)plan->street_x[plan->middle], half = PROM_CITY_ROAD_WIDTH / 2;
    double north = (double)plan->street_z[plan->river],
           to = (double)plan->street_z[plan->river + 1];
    double west = (double)plan->street_x[plan->middle - 1], square = (west + x) / 2;
    double quay = to - half - 3.2, side = x - half - 1.3;
    int n = 0;
    c[n++] = (corner){x - 0.5, north - 24, 0};
    c[n++] = (corner){x - 0.5, north - 2, 5};
    c[n++] = (corner){side, north + 7, 5};
    c[n++] = (corner){side, quay, 3};
    c[n++] = (corner){square, quay, 5};
    c[n++] = (corner){square, to + half + 17, 0};
    return n;
}

// Without a river: along a street, round the crossing and on.
static int street_corners(const prom_city_plan *plan, corner *c)
{
    double x = (double)plan->street_x[plan->middle], z = (double)plan->street_z[plan->middle];
    c[0] = (corner){x + 30, z + 0.6, 0};
    c[1] = (corner){x + 0.6, z + 0.6, 4};
    c[2] = (corner){x + 0.6, z + 30, 0};
    return 3;
}

static double ground_near(const prom_city_plan *plan, const way *w, double s)
{
    // A wheel's way over a kerb: the mean of the heights just before and behind.
    double sum = 0;
    for (int i = -3; i <= 3; i++) {
        double p[2];
        way_point(w, s + KERB_RAMP * i / 3, p);
        sum += (double)prom_city_ground_height(plan, (float)p[0], (float)p[1]);
    }
    return sum / 7;
}

void prom_city_walk(const prom_city_plan *plan, prom_path *path)
{
    way *w = prom_alloc(1, sizeof *w);
    corner corners[8];
    bool river = plan->river != PROM_GLB_NONE;
    make_way(w, corners, river ? river_corners(plan, corners) : street_corners(plan, corners));
    double speed = way_length(w) / (FRAMES - 1);
    for (int i = 0; i < FRAMES; i++) {
        double s = speed * i, here[2], ahead[2];
        way_point(w, s, here);
        way_point(w, s + LOOK_AHEAD, ahead);
        // The walker looks about a little.
        double sway = 0.14 * sin(2 * PI * i / 240), nod = 0.035 + 0.02 * sin(2 * PI * i / 170);
        double dx = ahead[0] - here[0], dz = ahead[1] - here[1], length = hypot(dx, dz);
        double position[3] = {here[0], EYE + ground_near(plan, w, s), here[1]};
        double forward[3] = {dx * cos(sway) + dz * sin(sway), nod * length,
                             dz * cos(sway) - dx * sin(sway)};
        prom_path_add(path, position, forward);
    }
    prom_free(w);
}

// ---- in the air

void prom_city_flight(const prom_city_plan *plan, prom_path *path)
{
    double x0 = (double)plan->street_x[0], x1 = (double)plan->street_x[plan->columns];
    double z0 = (double)plan->street_z[0], z1 = (double)plan->street_z[plan->rows];
    double cx = (x0 + x1) / 2, cz = (z0 + z1) / 2;
    // Not faster than a bird over a large city: it sees a part of it.
    double rx = fmin(0.42 * (x1 - x0), 160), rz = fmin(0.42 * (z1 - z0), 160);
    for (int i = 0; i < FRAMES; i++) {
        double a = 2 * PI * i / FRAMES + 0.6, down = 0.32 + 0.06 * sin(2 * a);
        double position[3] = {cx + rx * sin(a), 46 + 10 * cos(3 * a), cz + rz * cos(a)};
        // Along the circle and somewhat inwards.
        double turned = a + PI / 2 + 0.9;
        double forward[3] = {sin(turned), -down, cos(turned)};
        prom_path_add(path, position, forward);
    }
}
