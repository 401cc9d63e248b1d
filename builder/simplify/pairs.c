#include "builder/simplify/pairs.h"

#include <math.h>
#include <stdlib.h>

enum { NEAREST = 4 };

typedef struct cell_point {
    int32_t cell[3];
    uint32_t point;
} cell_point;

static int by_cell(const void *a, const void *b)
{
    const cell_point *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x->cell[k] != y->cell[k]) return x->cell[k] < y->cell[k] ? -1 : 1;
    return (x->point > y->point) - (x->point < y->point);
}

static uint32_t find(uint32_t *parent, uint32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

// Per point: one number for each connected piece; to be freed.
static uint32_t *find_pieces(const prom_collapse_mesh *mesh)
{
    uint32_t *piece = prom_alloc(mesh->points, sizeof *piece);
    for (uint32_t p = 0; p < mesh->points; p++) piece[p] = p;
    for (uint32_t c = 0; c < 3 * mesh->triangle_slots; c++) {
        if (mesh->corners[c] == PROM_NONE) continue;
        const uint32_t a = find(piece, prom_corner_point(mesh, c));
        const uint32_t b = find(piece, prom_corner_point(mesh, prom_corner_after(c)));
        piece[a > b ? a : b] = a > b ? b : a;
    }
    for (uint32_t p = 0; p < mesh->points; p++) piece[p] = find(piece, p);
    return piece;
}

// The present points, sorted by their cell. Cells are at least a 2^20th of the greatest
// coordinate, so that their numbers fit.
static cell_point *sort_points(const prom_collapse_mesh *mesh, float size, uint32_t *count)
{
    cell_point *cells = prom_alloc(mesh->points, sizeof *cells);
    uint32_t n = 0;
    for (uint32_t p = 0; p < mesh->points; p++) {
        if (mesh->first_corner[p] == PROM_NONE) continue;
        for (int k = 0; k < 3; k++)
            cells[n].cell[k] = (int32_t)floorf(mesh->position[p][k] / size);
        cells[n++].point = p;
    }
    qsort(cells, n, sizeof *cells, by_cell);
    *count = n;
    return cells;
}

// The first place in order that is not before the key.
static uint32_t lower_bound(const cell_point *cells, uint32_t count, const cell_point *key)
{
    uint32_t low = 0;
    while (low < count) {
        const uint32_t middle = low + (count - low) / 2;
        if (by_cell(&cells[middle], key) < 0)
            low = middle + 1;
        else
            count = middle;
    }
    return low;
}

static void link_to(prom_pairs *pairs, uint32_t point, uint32_t other)
{
    prom_array_push(&pairs->links, (prom_pair_link){other, pairs->first[point]});
    pairs->first[point] = (uint32_t)pairs->links.count - 1;
}

typedef struct near_points {
    uint32_t count, points[NEAREST];
    float squared[NEAREST];
} near_points;

static void insert(near_points *near, uint32_t point, float squared)
{
    uint32_t at = near->count < NEAREST ? near->count++ : NEAREST;
    for (; at > 0 && near->squared[at - 1] > squared; at--) {
        if (at == NEAREST) continue;
        near->points[at] = near->points[at - 1];
        near->squared[at] = near->squared[at - 1];
    }
    if (at == NEAREST) return;
    near->points[at] = point;
    near->squared[at] = squared;
}

static void gather_near(const prom_collapse_mesh *mesh, const cell_point *cells, uint32_t count,
                        const uint32_t *piece, const cell_point *own, float distance,
                        near_points *near)
{
    for (int dx = -1; dx <= 1; dx++)
        for (int dy = -1; dy <= 1; dy++) {
            const cell_point key = {{own->cell[0] + dx, own->cell[1] + dy, own->cell[2] - 1},
                                    0};
            for (uint32_t i = lower_bound(cells, count, &key); i < count; i++) {
                const cell_point *c = &cells[i];
                if (c->cell[0] != key.cell[0] || c->cell[1] != key.cell[1] ||
                    c->cell[2] > own->cell[2] + 1)
                    break;
                if (piece[c->point] == piece[own->point]) continue;
                const float squared =
                    glm_vec3_distance2(mesh->position[own->point], mesh->position[c->point]);
                if (squared <= distance * distance) insert(near, c->point, squared);
            }
        }
}

static float greatest_coordinate(const prom_collapse_mesh *mesh)
{
    float most = 0;
    for (uint32_t p = 0; p < mesh->points; p++)
        for (int k = 0; k < 3 && mesh->first_corner[p] != PROM_NONE; k++)
            most = fmaxf(most, fabsf(mesh->position[p][k]));
    return most;
}

void prom_pairs_init(prom_pairs *pairs, const prom_collapse_mesh *mesh, float distance)
{
    memset(pairs, 0, sizeof *pairs);
    if (!(distance > 0) || !mesh->points) return;
    pairs->first = prom_alloc(mesh->points, sizeof *pairs->first);
    pairs->moved = prom_alloc(mesh->points, sizeof *pairs->moved);
    memset(pairs->first, 0xff, mesh->points * sizeof *pairs->first);
    for (uint32_t p = 0; p < mesh->points; p++) pairs->moved[p] = p;
    uint32_t *piece = find_pieces(mesh), count = 0;
    const float size = fmaxf(distance, greatest_coordinate(mesh) * 0x1p-20f);
    cell_point *cells = sort_points(mesh, size, &count);
    for (uint32_t i = 0; i < count; i++) {
        near_points near = {0};
        gather_near(mesh, cells, count, piece, &cells[i], distance, &near);
        for (uint32_t k = 0; k < near.count; k++) {
            link_to(pairs, cells[i].point, near.points[k]);
            link_to(pairs, near.points[k], cells[i].point);
        }
    }
    prom_free(cells);
    prom_free(piece);
}

void prom_pairs_finish(prom_pairs *pairs)
{
    prom_array_finish(&pairs->links);
    prom_free(pairs->first);
    prom_free(pairs->moved);
    memset(pairs, 0, sizeof *pairs);
}

bool prom_pairs_any(const prom_pairs *pairs)
{
    return pairs->links.count > 0;
}

size_t prom_pairs_bytes(const prom_pairs *pairs, const prom_collapse_mesh *mesh)
{
    return pairs->links.capacity * sizeof *pairs->links.data +
           (pairs->first ? 2 * (size_t)mesh->points * sizeof *pairs->first : 0);
}

uint32_t prom_pairs_find(prom_pairs *pairs, uint32_t point)
{
    return find(pairs->moved, point);
}

void prom_pairs_merge(prom_pairs *pairs, uint32_t from, uint32_t to)
{
    pairs->moved[from] = to;
    uint32_t *end = &pairs->first[from];
    while (*end != PROM_NONE) end = &pairs->links.data[*end].next;
    *end = pairs->first[to];
    pairs->first[to] = pairs->first[from];
    pairs->first[from] = PROM_NONE;
}
