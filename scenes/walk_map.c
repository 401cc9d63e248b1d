#include "scenes/walk_map.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

#define CELLS_MAX 448.0  // along the longer side
#define FLOOR_SLOPE 0.6  // least vertical part of a floor's normal
#define HEADROOM_LOW 0.3 // of the eye's height: what is lower is stepped over
#define HEADROOM_HIGH 1.25

// What a triangle occupies of a column.
typedef struct span {
    uint32_t column;
    float low, high;
    bool floor;
} span;

typedef struct raster {
    prom_walk_map *map;
    PROM_ARRAY(span) spans;
    float *low, *high; // of the present triangle in each column
    uint64_t columns;  // looked at so far
} raster;

// Columns to look at in all: some seconds. A scene of a million triangles needs a hundredth of
// it; only a damaged one, whose triangles all cover the whole map, is cut short.
#define COLUMNS_MAX 400000000u

// ---- triangles into columns

static int clamp_cell(double at, uint32_t count)
{
    return at < 0 ? 0 : at >= count ? (int)count - 1 : (int)at;
}

static void touch(raster *r, double x, double y, double z)
{
    const prom_walk_map *m = r->map;
    if (x < 0 || z < 0 || x >= m->columns || z >= m->rows) return;
    size_t i = (size_t)z * m->columns + (size_t)x;
    r->low[i] = fminf(r->low[i], (float)y);
    r->high[i] = fmaxf(r->high[i], (float)y);
}

static void touch_edge(raster *r, const double a[3], const double b[3])
{
    double steps = ceil(2 * fmax(fabs(b[0] - a[0]), fabs(b[2] - a[2])));
    int n = (int)fmin(fmax(steps, 1), 4 * CELLS_MAX);
    for (int i = 0; i <= n; i++) {
        double t = (double)i / n;
        touch(r, a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]));
    }
}

// The columns whose middle lies under the triangle; x and z in cells.
static void touch_inside(raster *r, const double v[3][3], const int box[4])
{
    double det =
        (v[1][0] - v[0][0]) * (v[2][2] - v[0][2]) - (v[2][0] - v[0][0]) * (v[1][2] - v[0][2]);
    if (fabs(det) < 1e-9) return;
    for (int j = box[2]; j <= box[3]; j++) {
        for (int i = box[0]; i <= box[1]; i++) {
            double x = i + 0.5 - v[0][0], z = j + 0.5 - v[0][2];
            double b = (x * (v[2][2] - v[0][2]) - (v[2][0] - v[0][0]) * z) / det;
            double c = ((v[1][0] - v[0][0]) * z - x * (v[1][2] - v[0][2])) / det;
            if (b < 0 || c < 0 || b + c > 1) continue;
            touch(r, i + 0.5, v[0][1] + b * (v[1][1] - v[0][1]) + c * (v[2][1] - v[0][1]),
                  j + 0.5);
        }
    }
}

// Vertices with x and z in cells, y in scene units.
static void add_triangle(raster *r, const double v[3][3])
{
    const prom_walk_map *m = r->map;
    double low[3], high[3], n[3];
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(v[0][k], fmin(v[1][k], v[2][k]));
        high[k] = fmax(v[0][k], fmax(v[1][k], v[2][k]));
        if (!isfinite(low[k]) || !isfinite(high[k])) return;
    }
    if (high[0] < 0 || high[2] < 0 || low[0] >= m->columns || low[2] >= m->rows) return;
    const int box[4] = {clamp_cell(low[0], m->columns), clamp_cell(high[0], m->columns),
                        clamp_cell(low[2], m->rows), clamp_cell(high[2], m->rows)};
    r->columns += (uint64_t)(box[1] - box[0] + 1) * (uint64_t)(box[3] - box[2] + 1);
    if (r->columns > COLUMNS_MAX) return;
    for (int k = 0; k < 3; k++) {
        int x = (k + 1) % 3, y = (k + 2) % 3;
        n[k] = (v[1][x] - v[0][x]) * (v[2][y] - v[0][y]) -
               (v[1][y] - v[0][y]) * (v[2][x] - v[0][x]);
    }
    // x and z are in cells: the normal's parts along them come out smaller by the cell.
    n[1] *= m->cell;
    bool floor = fabs(n[1]) > FLOOR_SLOPE * sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    for (int k = 0; k < 3; k++) touch_edge(r, v[k], v[(k + 1) % 3]);
    touch_inside(r, v, box);
    for (int j = box[2]; j <= box[3]; j++) {
        for (int i = box[0]; i <= box[1]; i++) {
            size_t at = (size_t)j * m->columns + (size_t)i;
            if (r->low[at] > r->high[at]) continue;
            prom_array_push(&r->spans, (span){(uint32_t)at, r->low[at], r->high[at], floor});
            r->low[at] = FLT_MAX;
            r->high[at] = -FLT_MAX;
        }
    }
}

static void add_leaf(raster *r, const prom_model *model, uint32_t node, const prom_mesh *mesh)
{
    const prom_walk_map *m = r->map;
    for (uint32_t i = 0; i + 2 < mesh->index_count; i += 3) {
        double v[3][3];
        for (uint32_t k = 0; k < 3; k++) {
            prom_placement_apply(&model->placement[node],
                                 mesh->vertices[mesh->indices[i + k]].position, v[k]);
            v[k][0] = (v[k][0] - m->origin[0]) / m->cell;
            v[k][2] = (v[k][2] - m->origin[1]) / m->cell;
        }
        add_triangle(r, (const double(*)[3])v);
    }
}

// The coarsest mesh of a prototype that errs by no more than a part of a cell; PROM_NONE: none.
static uint32_t mesh_of(const prom_model *model, const prom_prototype *p, double scale,
                        double tolerance)
{
    uint32_t mesh = PROM_NONE;
    for (uint32_t i = p->first_rep; i < p->first_rep + p->rep_count; i++) {
        const prom_representation *rep = &model->reps[i];
        if (rep->kind != PROM_REP_MESH) continue;
        if (mesh == PROM_NONE || (double)rep->error * scale <= tolerance) mesh = rep->mesh;
    }
    return mesh;
}

static bool touches(const prom_walk_map *m, const prom_model *model, uint32_t node)
{
    double x = model->center[node][0] - m->origin[0], hx = (double)model->half[node][0];
    double z = model->center[node][2] - m->origin[1], hz = (double)model->half[node][2];
    return x + hx >= 0 && z + hz >= 0 && x - hx <= m->columns * m->cell &&
           z - hz <= m->rows * m->cell;
}

typedef struct placed_mesh {
    uint32_t mesh, node;
} placed_mesh;

static int compare_leaves(const void *a, const void *b)
{
    const placed_mesh *x = a, *y = b;
    if (x->mesh != y->mesh) return x->mesh < y->mesh ? -1 : 1;
    return x->node < y->node ? -1 : x->node > y->node;
}

// Each mesh is read once and put where its instances stand.
static prom_status add_leaves(raster *r, prom_container *container, const prom_model *model,
                              prom_error *error)
{
    PROM_ARRAY(placed_mesh) leaves = {0};
    for (uint32_t i = 0; i < model->tree_count; i++) {
        if (model->first_child[i] != PROM_NONE || !touches(r->map, model, i)) continue;
        const prom_prototype *p = &model->prototypes[model->prototype[i]];
        double scale = (double)prom_basis_scale(model->placement[i].basis);
        uint32_t mesh = mesh_of(model, p, scale, 0.1 * r->map->cell);
        if (mesh == PROM_NONE) continue;
        prom_array_push(&leaves, (placed_mesh){mesh, i});
    }
    if (leaves.count) qsort(leaves.data, leaves.count, sizeof *leaves.data, compare_leaves);
    prom_status status = PROM_OK;
    for (size_t i = 0; i < leaves.count && !status;) {
        prom_mesh mesh = {0};
        uint32_t id = leaves.data[i].mesh;
        status = prom_container_read_mesh(container, model, id, &mesh, error);
        for (; !status && i < leaves.count && leaves.data[i].mesh == id; i++)
            add_leaf(r, model, leaves.data[i].node, &mesh);
        prom_mesh_finish(&mesh);
    }
    prom_array_finish(&leaves);
    return status;
}

// ---- floors

static int compare_spans(const void *a, const void *b)
{
    const span *x = a, *y = b;
    return (x->high > y->high) - (x->high < y->high);
}

// The floors of one column, from its spans.
static void find_floors(prom_walk_map *map, span *spans, size_t count, double eye)
{
    qsort(spans, count, sizeof *spans, compare_spans);
    for (size_t i = 0; i < count; i++) {
        if (!spans[i].floor) continue;
        float y = spans[i].high, from = y + (float)(HEADROOM_LOW * eye);
        float to = y + (float)(HEADROOM_HIGH * eye);
        bool free = true, open = true;
        for (size_t k = 0; k < count && free; k++) {
            if (spans[k].high <= from) continue;
            open = false;
            free = spans[k].low >= to;
        }
        // Of floors a little above one another the highest is the one to stand on.
        for (size_t k = i + 1; k < count && free && spans[k].high <= from; k++)
            free = !spans[k].floor;
        if (!free) continue;
        prom_walk_floor f = {.y = y, .column = spans[i].column, .open = open};
        prom_array_push(&map->floors, f);
    }
}

static void collect_floors(prom_walk_map *map, raster *r, double eye)
{
    size_t cells = (size_t)map->columns * map->rows;
    uint32_t *start = prom_calloc(cells + 1, sizeof *start);
    span *sorted = prom_alloc(r->spans.count, sizeof *sorted);
    for (size_t i = 0; i < r->spans.count; i++) start[r->spans.data[i].column + 1]++;
    for (size_t i = 0; i < cells; i++) start[i + 1] += start[i];
    for (size_t i = 0; i < r->spans.count; i++)
        sorted[start[r->spans.data[i].column]++] = r->spans.data[i];
    // Each start has moved on to the next one's.
    for (size_t i = 0; i < cells; i++) {
        size_t from = i ? start[i - 1] : 0;
        map->first[i] = (uint32_t)map->floors.count;
        find_floors(map, sorted + from, start[i] - from, eye);
    }
    map->first[cells] = (uint32_t)map->floors.count;
    prom_free(sorted);
    prom_free(start);
}

static uint32_t nearest_floor(const prom_walk_map *m, size_t column, double y)
{
    uint32_t best = PROM_NONE;
    double nearest = m->step;
    for (uint32_t i = m->first[column]; i < m->first[column + 1]; i++) {
        double d = fabs((double)m->floors.data[i].y - y);
        if (d <= nearest) {
            nearest = d;
            best = i;
        }
    }
    return best;
}

uint32_t prom_walk_map_neighbour(const prom_walk_map *m, uint32_t floor, int side)
{
    const prom_walk_floor *f = &m->floors.data[floor];
    uint32_t x = f->column % m->columns, z = f->column / m->columns;
    if (side == 0 ? x + 1 >= m->columns : side == 1 && x == 0) return PROM_NONE;
    if (side == 2 ? z + 1 >= m->rows : side == 3 && z == 0) return PROM_NONE;
    size_t to = side == 0   ? f->column + 1
                : side == 1 ? f->column - 1
                : side == 2 ? f->column + m->columns
                            : f->column - m->columns;
    return nearest_floor(m, to, (double)f->y);
}

uint32_t prom_walk_map_at(const prom_walk_map *m, double x, double y, double z)
{
    double i = (x - m->origin[0]) / m->cell, j = (z - m->origin[1]) / m->cell;
    if (!(i >= 0 && j >= 0 && i < m->columns && j < m->rows)) return PROM_NONE;
    return nearest_floor(m, (size_t)j * m->columns + (size_t)i, y);
}

void prom_walk_map_point(const prom_walk_map *m, uint32_t floor, double point[3])
{
    const prom_walk_floor *f = &m->floors.data[floor];
    point[0] = m->origin[0] + (f->column % m->columns + 0.5) * m->cell;
    point[1] = (double)f->y;
    point[2] = m->origin[1] + (f->column / m->columns + 0.5) * m->cell;
}

// Numbers the connected floors. Floors of a column are a head's height apart, so that
// connection is mutual.
static void find_components(prom_walk_map *m)
{
    PROM_ARRAY(uint32_t) stack = {0};
    for (size_t i = 0; i < m->floors.count; i++) m->floors.data[i].component = PROM_NONE;
    for (size_t i = 0; i < m->floors.count; i++) {
        if (m->floors.data[i].component != PROM_NONE) continue;
        m->floors.data[i].component = m->component_count;
        prom_array_push(&stack, (uint32_t)i);
        while (stack.count) {
            uint32_t at = stack.data[--stack.count];
            for (int side = 0; side < 4; side++) {
                uint32_t n = prom_walk_map_neighbour(m, at, side);
                if (n == PROM_NONE || m->floors.data[n].component != PROM_NONE) continue;
                m->floors.data[n].component = m->component_count;
                prom_array_push(&stack, n);
            }
        }
        m->component_count++;
    }
    prom_array_finish(&stack);
}

// Steps to the nearest floor that lacks a neighbour.
static void find_clearance(prom_walk_map *m)
{
    for (size_t i = 0; i < m->floors.count; i++) m->floors.data[i].clear = PROM_WALK_CLEAR_MAX;
    for (uint8_t step = 0; step < PROM_WALK_CLEAR_MAX; step++) {
        for (size_t i = 0; i < m->floors.count; i++) {
            if (m->floors.data[i].clear <= step) continue;
            bool edge = false;
            for (int side = 0; side < 4 && !edge; side++) {
                uint32_t n = prom_walk_map_neighbour(m, (uint32_t)i, side);
                edge = n == PROM_NONE || (step && m->floors.data[n].clear < step);
            }
            if (edge) m->floors.data[i].clear = step;
        }
    }
}

prom_status prom_walk_map_init(prom_walk_map *map, prom_container *container,
                               const prom_model *model, const double low[2],
                               const double high[2], double eye, prom_error *error)
{
    double width = high[0] - low[0], depth = high[1] - low[1];
    *map = (prom_walk_map){.origin = {low[0], low[1]}};
    map->cell = fmax(fmax(width, depth) / CELLS_MAX, 0.2 * eye);
    map->columns = (uint32_t)fmin(fmax(ceil(width / map->cell), 1), CELLS_MAX + 1);
    map->rows = (uint32_t)fmin(fmax(ceil(depth / map->cell), 1), CELLS_MAX + 1);
    // A stair, or a slope of 35 degrees.
    map->step = fmax(HEADROOM_LOW * eye, 0.7 * map->cell);
    size_t cells = (size_t)map->columns * map->rows;
    map->first = prom_calloc(cells + 1, sizeof *map->first);
    raster r = {.map = map,
                .low = prom_alloc(cells, sizeof *r.low),
                .high = prom_alloc(cells, sizeof *r.high)};
    for (size_t i = 0; i < cells; i++) {
        r.low[i] = FLT_MAX;
        r.high[i] = -FLT_MAX;
    }
    prom_status status = add_leaves(&r, container, model, error);
    if (!status) {
        collect_floors(map, &r, eye);
        find_components(map);
        find_clearance(map);
    }
    prom_array_finish(&r.spans);
    prom_free(r.low);
    prom_free(r.high);
    if (status) prom_walk_map_finish(map);
    return status;
}

void prom_walk_map_finish(prom_walk_map *map)
{
    prom_free(map->first);
    prom_array_finish(&map->floors);
    *map = (prom_walk_map){0};
}
