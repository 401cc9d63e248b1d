#include "scenes/eyes.h"

#include "scenes/walk_map.h"

#include <float.h>
#include <math.h>

#define EYES_MAX 4000000.0
// What is smaller is nothing to walk on, square units; by taste.
#define LEAST_FLOOR 2.0
// A floor may lie on the box's bottom, whatever its coordinates were rounded to.
#define BOTTOM_SLACK 0.05

static void add_eye(prom_eyes *eyes, double x, double y, double z)
{
    double *eye = *prom_array_extend(eyes, 1);
    eye[0] = x;
    eye[1] = y;
    eye[2] = z;
}

// ---- along a path

static double distance(const double a[3], const double b[3])
{
    return sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                (a[2] - b[2]) * (a[2] - b[2]));
}

static double length_of(const prom_path *path)
{
    double sum = 0;
    for (size_t i = 1; i < path->keys.count; i++)
        sum += distance(path->keys.data[i - 1].position, path->keys.data[i].position);
    return sum;
}

prom_status prom_eyes_along(const prom_path *path, double spacing, prom_eyes *eyes,
                            prom_error *error)
{
    size_t count = path->keys.count;
    if (!count) return PROM_OK;
    double length = length_of(path), steps = ceil(length / spacing);
    if (!(steps <= EYES_MAX))
        return prom_fail(error, PROM_ERR_USAGE,
                         "a path of %.0f m cannot be sampled every %g m: ask for larger cells",
                         length, spacing);
    double step = steps > 0 ? length / steps : 0, walked = 0, next = 0;
    for (size_t i = 1; i < count; i++) {
        const double *a = path->keys.data[i - 1].position, *b = path->keys.data[i].position;
        double part = distance(a, b);
        for (; part > 0 && next <= walked + part; next += step) {
            double t = (next - walked) / part;
            add_eye(eyes, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                    a[2] + t * (b[2] - a[2]));
        }
        walked += part;
    }
    // The last one, which rounding may have left out.
    const double *end = path->keys.data[count - 1].position;
    if (step <= 0 || next < length + 0.5 * step) add_eye(eyes, end[0], end[1], end[2]);
    return PROM_OK;
}

// ---- in a box

// Per component, whether it is large enough to walk on.
static bool *find_walkable(const prom_walk_map *map)
{
    size_t *floors = prom_calloc(map->component_count, sizeof *floors), most = 0;
    bool *walkable = prom_calloc(map->component_count, sizeof *walkable);
    for (size_t i = 0; i < map->floors.count; i++) {
        size_t n = ++floors[map->floors.data[i].component];
        if (n > most) most = n;
    }
    for (uint32_t c = 0; c < map->component_count; c++)
        walkable[c] =
            floors[c] == most || (double)floors[c] * map->cell * map->cell >= LEAST_FLOOR;
    prom_free(floors);
    return walkable;
}

// The floors of one column that are within the heights; the others' go to found.
static void add_column(const prom_walk_map *map, size_t column, const bool *walkable,
                       const double heights[2], double found[2], prom_eyes *eyes)
{
    for (uint32_t i = map->first[column]; i < map->first[column + 1]; i++) {
        double p[3];
        if (!walkable[map->floors.data[i].component]) continue;
        prom_walk_map_point(map, i, p);
        found[0] = fmin(found[0], p[1]);
        found[1] = fmax(found[1], p[1]);
        if (p[1] < heights[0] - BOTTOM_SLACK || p[1] > heights[1]) continue;
        add_eye(eyes, p[0], p[1] + PROM_EYE_HEIGHT, p[2]);
    }
}

static prom_status no_floor(const double low[3], const double high[3], const double found[2],
                            prom_error *error)
{
    if (found[0] > found[1])
        return prom_fail(
            error, PROM_ERR_INPUT,
            "the box %g,%g,%g:%g,%g,%g stands over no floor that one could walk on", low[0],
            low[1], low[2], high[0], high[1], high[2]);
    return prom_fail(
        error, PROM_ERR_INPUT,
        "no floor that one could walk on lies between the heights %g and %g of the "
        "box; there are some from %.2f to %.2f",
        low[1], high[1], found[0], found[1]);
}

prom_status prom_eyes_in_box(prom_container *container, const prom_model *model,
                             const double low[3], const double high[3], double spacing,
                             prom_eyes *eyes, prom_error *error)
{
    const double from[2] = {low[0], low[2]}, to[2] = {high[0], high[2]};
    const double heights[2] = {low[1], high[1]};
    double found[2] = {DBL_MAX, -DBL_MAX};
    size_t before = eyes->count;
    prom_walk_map map;
    prom_status status =
        prom_walk_map_init(&map, container, model, from, to, PROM_EYE_HEIGHT, error);
    if (status) return status;
    bool *walkable = find_walkable(&map);
    double step = fmax(spacing / map.cell, 1); // in the map's cells
    for (double z = 0.5 * step; z < fmax(map.rows, step); z += step)
        for (double x = 0.5 * step; x < fmax(map.columns, step); x += step) {
            size_t column = (size_t)fmin(x, map.columns - 1),
                   row = (size_t)fmin(z, map.rows - 1);
            add_column(&map, row * map.columns + column, walkable, heights, found, eyes);
        }
    if (eyes->count == before) status = no_floor(low, high, found, error);
    prom_free(walkable);
    prom_walk_map_finish(&map);
    return status;
}
