// An automatic walk over a map of floors: way-points in the sectors around the middle, joined
// by the cheapest ways, which keep off walls and near objects.
#include "scenes/auto_layout.h"
#include "scenes/walk_map.h"

#include <float.h>
#include <math.h>

#define DENSITY_CELLS 64
#define SECTORS 10
#define COVERED 0.25 // weight of a floor that has something above it, against one under the sky
#define SMOOTHING 24
#define FLOORS_MIN 50u

typedef struct candidate {
    float cost;
    uint32_t floor;
} candidate;

typedef struct walker {
    const prom_walk_map *map;
    const prom_layout *layout;
    double density[DENSITY_CELLS][DENSITY_CELLS]; // relative to the greatest
    uint32_t component;
    // Of the search for ways.
    float *cost;
    uint32_t *from;
    PROM_ARRAY(candidate) heap;
    PROM_ARRAY(uint32_t) route; // floors
} walker;

// ---- where to walk

static void fill_density(walker *w)
{
    const prom_walk_map *m = w->map;
    double most = 0, sx = m->columns * m->cell / DENSITY_CELLS;
    double sz = m->rows * m->cell / DENSITY_CELLS;
    for (int j = 0; j < DENSITY_CELLS; j++) {
        for (int i = 0; i < DENSITY_CELLS; i++) {
            w->density[j][i] = prom_layout_density(w->layout, m->origin[0] + (i + 0.5) * sx,
                                                   m->origin[1] + (j + 0.5) * sz);
            most = fmax(most, w->density[j][i]);
        }
    }
    for (int j = 0; j < DENSITY_CELLS; j++)
        for (int i = 0; i < DENSITY_CELLS; i++) w->density[j][i] /= most;
}

static double density_of(const walker *w, const prom_walk_floor *f)
{
    uint32_t x = f->column % w->map->columns, z = f->column / w->map->columns;
    return w->density[z * DENSITY_CELLS / w->map->rows][x * DENSITY_CELLS / w->map->columns];
}

// How much a floor is worth being on: among objects, off walls, under the sky, and below the
// tops of things rather than on a roof.
static double worth_of(const walker *w, const prom_walk_floor *f)
{
    double above = prom_layout_above(w->layout, (double)f->y + w->layout->eye);
    return density_of(w, f) * f->clear * (f->open ? 1 : COVERED) * above * above;
}

// The connected floors that are most, most open and most among objects.
static bool choose_component(walker *w)
{
    const prom_walk_map *m = w->map;
    if (!m->component_count) return false;
    double *worth = prom_calloc(m->component_count, sizeof *worth);
    uint32_t *size = prom_calloc(m->component_count, sizeof *size);
    for (size_t i = 0; i < m->floors.count; i++) {
        const prom_walk_floor *f = &m->floors.data[i];
        worth[f->component] += worth_of(w, f) * density_of(w, f);
        size[f->component]++;
    }
    w->component = 0;
    for (uint32_t i = 1; i < m->component_count; i++)
        if (worth[i] > worth[w->component]) w->component = i;
    bool enough = size[w->component] >= FLOORS_MIN && worth[w->component] > 0;
    prom_free(worth);
    prom_free(size);
    return enough;
}

// The best floor of each sector; the number of those worth going to.
static uint32_t choose_points(const walker *w, uint32_t points[SECTORS])
{
    double best[SECTORS] = {0}, most = 0;
    for (size_t i = 0; i < w->map->floors.count; i++) {
        const prom_walk_floor *f = &w->map->floors.data[i];
        double p[3];
        if (f->component != w->component) continue;
        prom_walk_map_point(w->map, (uint32_t)i, p);
        double x = (p[0] - w->layout->middle[0]) / fmax(w->layout->spread[0], 1e-9);
        double z = (p[2] - w->layout->middle[1]) / fmax(w->layout->spread[1], 1e-9);
        double off = (hypot(x, z) - 0.6) / 0.4;
        double worth = worth_of(w, f) * exp(-off * off);
        int sector = (int)((atan2(x, z) + M_PI) / (2 * M_PI) * SECTORS) % SECTORS;
        if (worth <= best[sector]) continue;
        best[sector] = worth;
        points[sector] = (uint32_t)i;
        most = fmax(most, worth);
    }
    uint32_t count = 0;
    for (int s = 0; s < SECTORS; s++)
        if (best[s] > 0.12 * most) points[count++] = points[s];
    return count;
}

// ---- ways

// Of a step on to a floor.
static float step_cost(const walker *w, uint32_t from, uint32_t to)
{
    const prom_walk_floor *a = &w->map->floors.data[from], *b = &w->map->floors.data[to];
    double wall = 1 - (double)b->clear / PROM_WALK_CLEAR_MAX;
    double climb = fabs((double)(a->y - b->y)) / w->map->step;
    return (float)(1 + 8 * wall * wall + 3 * (1 - density_of(w, b)) + (b->open ? 0 : 1) +
                   2 * climb);
}

static bool before(candidate a, candidate b)
{
    return a.cost != b.cost ? a.cost < b.cost : a.floor < b.floor;
}

static void heap_push(walker *w, candidate new)
{
    prom_array_push(&w->heap, new);
    candidate *h = w->heap.data;
    size_t i = w->heap.count - 1;
    for (; i && before(new, h[(i - 1) / 2]); i = (i - 1) / 2) h[i] = h[(i - 1) / 2];
    h[i] = new;
}

static candidate heap_pop(walker *w)
{
    candidate *h = w->heap.data, top = h[0], last = h[--w->heap.count];
    size_t i = 0;
    for (size_t child; (child = 2 * i + 1) < w->heap.count; i = child) {
        if (child + 1 < w->heap.count && before(h[child + 1], h[child])) child++;
        if (!before(h[child], last)) break;
        h[i] = h[child];
    }
    h[i] = last;
    return top;
}

static void relax(walker *w, uint32_t at)
{
    for (int side = 0; side < 4; side++) {
        uint32_t to = prom_walk_map_neighbour(w->map, at, side);
        if (to == PROM_NONE) continue;
        float cost = w->cost[at] + step_cost(w, at, to);
        if (cost >= w->cost[to]) continue;
        w->cost[to] = cost;
        w->from[to] = at;
        heap_push(w, (candidate){cost, to});
    }
}

// Adds the cheapest way between two floors to the route, without its end (Dijkstra 1959). A
// floor may stand in the heap several times; its cheapest entry comes out first.
static bool add_way(walker *w, uint32_t start, uint32_t end)
{
    for (size_t i = 0; i < w->map->floors.count; i++) w->cost[i] = FLT_MAX;
    // Searched from the end, so that the way comes out in order.
    w->heap.count = 0;
    w->cost[end] = 0;
    heap_push(w, (candidate){0, end});
    bool found = false;
    while (w->heap.count && !found) {
        candidate at = heap_pop(w);
        found = at.floor == start;
        if (at.cost <= w->cost[at.floor]) relax(w, at.floor);
    }
    for (uint32_t at = start; found && at != end; at = w->from[at])
        prom_array_push(&w->route, at);
    return found;
}

// ---- the line

static prom_place eye_at(const walker *w, uint32_t floor)
{
    double p[3];
    prom_walk_map_point(w->map, floor, p);
    return (prom_place){p[0], p[1] + w->layout->eye, p[2]};
}

// Rounds the route's corners, and its heights, but keeps it over floors.
static void smooth_route(const walker *w, prom_place *line, uint32_t count)
{
    prom_place *next = prom_alloc(count, sizeof *next);
    for (int round = 0; round < SMOOTHING; round++) {
        for (uint32_t i = 0; i < count; i++) {
            const prom_place *a = &line[(i + count - 1) % count], *b = &line[i];
            const prom_place *c = &line[(i + 1) % count];
            next[i] = (prom_place){(a->x + 2 * b->x + c->x) / 4, (a->y + 2 * b->y + c->y) / 4,
                                   (a->z + 2 * b->z + c->z) / 4};
            uint32_t floor =
                prom_walk_map_at(w->map, next[i].x, next[i].y - w->layout->eye, next[i].z);
            if (floor != PROM_NONE) continue;
            next[i].x = b->x;
            next[i].z = b->z;
        }
        memcpy(line, next, count * sizeof *line);
    }
    prom_free(next);
}

static void walk_route(const walker *w, uint32_t frames, prom_path *path)
{
    uint32_t count = (uint32_t)w->route.count;
    prom_place *line = prom_alloc(count, sizeof *line);
    for (uint32_t i = 0; i < count; i++) line[i] = eye_at(w, w->route.data[i]);
    smooth_route(w, line, count);
    prom_loop_walk(w->layout, line, count, frames, path);
    prom_free(line);
}

bool prom_map_walk(const prom_walk_map *map, const prom_layout *layout, uint32_t frames,
                   prom_path *path)
{
    walker *w = prom_calloc(1, sizeof *w);
    uint32_t points[SECTORS], count = 0;
    w->map = map;
    w->layout = layout;
    fill_density(w);
    bool found = choose_component(w) && (count = choose_points(w, points)) >= 3;
    w->cost = prom_alloc(map->floors.count, sizeof *w->cost);
    w->from = prom_alloc(map->floors.count, sizeof *w->from);
    for (uint32_t i = 0; i < count && found; i++)
        found = add_way(w, points[i], points[(i + 1) % count]);
    found = found && w->route.count >= 3;
    if (found) walk_route(w, frames, path);
    prom_free(w->cost);
    prom_free(w->from);
    prom_array_finish(&w->heap);
    prom_array_finish(&w->route);
    prom_free(w);
    return found;
}
