#include "metaobj/view_cells.h"

#include "metaobj/base/hash.h"

#include <assert.h>
#include <math.h>

static_assert(sizeof(prom_view_cell) == 20, "hashed as it is: no padding");

// As prom_model_check bounds the world.
#define EXTENT_MAX 1e18

void prom_view_cells_finish(prom_view_cells *cells)
{
    prom_free(cells->cells);
    prom_free(cells->leaves);
    prom_free(cells->shares);
    *cells = (prom_view_cells){0};
}

bool prom_view_cells_cube(const prom_view_cells *cells, const double point[3], int32_t at[3])
{
    for (int a = 0; a < 3; a++) {
        double index = floor((point[a] - cells->origin[a]) / cells->size);
        if (!(index >= INT32_MIN && index <= INT32_MAX)) return false; // what is no number too
        at[a] = (int32_t)index;
    }
    return true;
}

int prom_view_cube_order(const int32_t a[3], const int32_t b[3])
{
    for (int axis = 2; axis >= 0; axis--)
        if (a[axis] != b[axis]) return a[axis] < b[axis] ? -1 : 1;
    return 0;
}

const prom_view_cell *prom_view_cells_find(const prom_view_cells *cells, const int32_t at[3])
{
    uint32_t low = 0, high = cells->cell_count;
    while (low < high) {
        uint32_t middle = low + (high - low) / 2;
        int order = prom_view_cube_order(cells->cells[middle].at, at);
        if (!order) return &cells->cells[middle];
        if (order < 0)
            low = middle + 1;
        else
            high = middle;
    }
    return NULL;
}

const prom_view_cell *prom_view_cells_at(const prom_view_cells *cells, const double point[3])
{
    int32_t at[3];
    if (!cells->cell_count || !prom_view_cells_cube(cells, point, at)) return NULL;
    return prom_view_cells_find(cells, at);
}

uint8_t prom_view_share_encode(double share)
{
    if (!(share < 1.0)) return 255;
    double code = share > 0.0 ? 255.0 + floor(16.0 * log2(share)) : 0.0;
    uint8_t least = code > 0.0 ? (uint8_t)code : 0;
    while (prom_view_share_decode(least) < share) least++; // once: floor, and what is rounded
    return least;
}

float prom_view_share_decode(uint8_t code)
{
    return exp2f((float)(code - 255) / 16.0f);
}

uint64_t prom_view_cells_hash(const prom_view_cells *cells, uint64_t seed)
{
    double grid[4] = {0, 0, 0, cells->size};
    for (int a = 0; a < 3; a++) grid[a] += cells->origin[a]; // -0 becomes 0
    seed = prom_hash(grid, sizeof grid, seed);
    seed = prom_hash(cells->cells, cells->cell_count * sizeof *cells->cells, seed);
    seed = prom_hash(cells->leaves, cells->entry_count * sizeof *cells->leaves, seed);
    return prom_hash(cells->shares, cells->entry_count * sizeof *cells->shares, seed);
}

static const char *check_leaves(const prom_view_cells *cells, const prom_view_cell *cell,
                                const prom_model *model)
{
    const uint32_t *leaves = cells->leaves;
    for (uint32_t i = cell->first; i < cell->first + cell->count; i++) {
        if (leaves[i] >= model->tree_count) return "a view cell's leaf is no node of the tree";
        if (model->child_count[leaves[i]]) return "a view cell's leaf has children";
        if (i > cell->first && leaves[i] <= leaves[i - 1])
            return "a view cell's leaves do not ascend";
    }
    return NULL;
}

const char *prom_view_cells_check(const prom_view_cells *cells, const prom_model *model,
                                  uint64_t *cell)
{
    *cell = 0;
    if (!cells->cell_count) return cells->entry_count ? "leaves belong to no view cell" : NULL;
    if (!(cells->size > 0.0 && cells->size <= EXTENT_MAX))
        return "the view cells' size is out of range";
    for (int a = 0; a < 3; a++)
        if (!(fabs(cells->origin[a]) <= EXTENT_MAX))
            return "the view cells' origin is out of range";
    uint64_t next = 0;
    for (uint32_t i = 0; i < cells->cell_count; i++) {
        const prom_view_cell *c = &cells->cells[i];
        *cell = i;
        if (i && prom_view_cube_order(c[-1].at, c->at) >= 0)
            return "the view cells are not in order";
        if (c->first != next || c->count > cells->entry_count - next)
            return "a view cell's range is not where the one before ends";
        next += c->count;
        const char *wrong = check_leaves(cells, c, model);
        if (wrong) return wrong;
    }
    return next == cells->entry_count ? NULL : "leaves belong to no view cell";
}
