#include "scenes/auto_layout.h"

#include <math.h>
#include <stdlib.h>

// A layout's diagonal takes at least this long, by taste: a town of a kilometre is crossed at
// the speed of a car, a room at that of a walker.
#define CROSSING_S 30.0
#define YAW_SMOOTHING 12 // frames to both sides

typedef struct loop {
    const prom_place *places;
    const double *length; // up to each place, and the whole
    uint32_t count;
} loop;

// A point of the closed line, `s` units along it: Catmull-Rom.
static prom_place point_at(const loop *l, double s)
{
    double whole = l->length[l->count];
    s -= floor(s / whole) * whole;
    uint32_t i = 0, high = l->count;
    while (high - i > 1) {
        uint32_t mid = i + (high - i) / 2;
        if (l->length[mid] <= s)
            i = mid;
        else
            high = mid;
    }
    double step = l->length[i + 1] - l->length[i], u = step > 0 ? (s - l->length[i]) / step : 0;
    double w[4] = {((2 - u) * u - 1) * u / 2, ((3 * u - 5) * u * u + 2) / 2,
                   ((4 - 3 * u) * u + 1) * u / 2, (u - 1) * u * u / 2};
    prom_place q = {0, 0, 0};
    for (uint32_t k = 0; k < 4; k++) {
        const prom_place *p = &l->places[(i + k + l->count - 1) % l->count];
        q.x += w[k] * p->x;
        q.y += w[k] * p->y;
        q.z += w[k] * p->z;
    }
    return q;
}

typedef struct look {
    prom_place at;
    double yaw, rise; // the view's height per way
} look;

static void look_ahead(const loop *l, double s, double ahead, look *out)
{
    prom_place there = point_at(l, s + ahead);
    out->at = point_at(l, s);
    double dx = there.x - out->at.x, dz = there.z - out->at.z, way = hypot(dx, dz);
    out->yaw = atan2(dx, dz);
    // Hills are looked up and down only in part; the view falls by three degrees.
    out->rise = way > 0 ? 0.5 * (there.y - out->at.y) / way : 0;
    out->rise = fmax(fmin(out->rise, 0.2), -0.2) - 0.05;
}

static void add_keys(const look *looks, uint32_t frames, prom_path *path)
{
    for (uint32_t i = 0; i < frames; i++) {
        double yaw = 0, rise = 0, sum = 0;
        for (int d = -YAW_SMOOTHING; d <= YAW_SMOOTHING; d++) {
            int64_t k = (int64_t)i + d;
            if (k < 0 || k >= frames) continue;
            double w = YAW_SMOOTHING + 1 - abs(d);
            yaw += w * looks[k].yaw;
            rise += w * looks[k].rise;
            sum += w;
        }
        yaw /= sum;
        const prom_place *p = &looks[i].at;
        prom_path_add(path, (double[]){p->x, p->y, p->z},
                      (double[]){sin(yaw), rise / sum, cos(yaw)});
    }
}

void prom_loop_walk(const prom_layout *layout, const prom_place *places, uint32_t count,
                    uint32_t frames, prom_path *path)
{
    double *length = prom_calloc(count + 1, sizeof *length);
    for (uint32_t i = 0; i < count; i++) {
        const prom_place *a = &places[i], *b = &places[(i + 1) % count];
        length[i + 1] = length[i] + hypot(b->x - a->x, b->z - a->z);
    }
    const loop l = {places, length, count};
    double way = fmin(length[count], layout->size / CROSSING_S * frames / PROM_PATH_RATE);
    look *looks = prom_alloc(frames, sizeof *looks);
    for (uint32_t i = 0; i < frames && length[count] > 0; i++) {
        look_ahead(&l, way * i / frames, 0.03 * layout->size, &looks[i]);
        // Angles go on past half a turn, so that their mean means something.
        if (i) looks[i].yaw -= 2 * M_PI * round((looks[i].yaw - looks[i - 1].yaw) / (2 * M_PI));
    }
    if (length[count] > 0) add_keys(looks, frames, path);
    prom_free(looks);
    prom_free(length);
}
