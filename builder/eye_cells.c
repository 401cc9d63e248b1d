#include "builder/eye_cells.h"

#include "builder/view_cells.h"

#include <float.h>
#include <math.h>
#include <stdlib.h>

// What a build of minutes can look out of.
#define CELLS 400u
#define SIZE_STEP 1.25
#define CELLS_MAX 100000u

typedef struct placed_eye {
    int32_t at[3];
    uint32_t eye;
} placed_eye;

static int compare_placed(const void *a, const void *b)
{
    const placed_eye *x = a, *y = b;
    int order = prom_view_cube_order(x->at, y->at);
    return order ? order : (x->eye > y->eye) - (x->eye < y->eye);
}

static double distance2(const double a[3], const double b[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += (a[k] - b[k]) * (a[k] - b[k]);
    return sum;
}

static int compare_numbers(const void *a, const void *b)
{
    const double *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

// The median eye is in the middle of its cube: of eyes at one height none is near a border.
static bool set_grid(const double (*eyes)[3], uint32_t count, prom_view_cells *grid)
{
    double *along = prom_alloc(count, sizeof *along);
    bool good = true;
    for (int k = 0; k < 3; k++) {
        for (uint32_t i = 0; i < count && good; i++) {
            along[i] = eyes[i][k];
            good = isfinite(along[i]);
        }
        if (!good) break;
        qsort(along, count, sizeof *along, compare_numbers);
        grid->origin[k] = along[count / 2] - 0.5 * grid->size;
    }
    prom_free(along);
    return good;
}

// Puts the eyes into their cubes and gives the number of these; 0: some have none.
static uint32_t place(const double (*eyes)[3], uint32_t count, double size, placed_eye *placed,
                      prom_view_cells *grid)
{
    uint32_t cubes = 0;
    *grid = (prom_view_cells){.size = size};
    if (!set_grid(eyes, count, grid)) return 0;
    for (uint32_t i = 0; i < count; i++) {
        placed[i].eye = i;
        if (!prom_view_cells_cube(grid, eyes[i], placed[i].at)) return 0;
        for (int k = 0; k < 3; k++) // each has neighbours
            if (placed[i].at[k] == INT32_MIN || placed[i].at[k] == INT32_MAX) return 0;
    }
    qsort(placed, count, sizeof *placed, compare_placed);
    for (uint32_t i = 0; i < count; i++)
        cubes += !i || prom_view_cube_order(placed[i - 1].at, placed[i].at) != 0;
    return cubes;
}

// ---- the eyes of one cube

// How far an eye is from those that are chosen; from none, how close it is to the middle.
static double merit_of(const double (*eyes)[3], const prom_eye_cell *cell,
                       const double middle[3], uint32_t eye)
{
    if (!cell->eye_count) return -distance2(eyes[eye], middle);
    double nearest = DBL_MAX;
    for (uint32_t i = 0; i < cell->eye_count; i++)
        nearest = fmin(nearest, distance2(eyes[eye], eyes[cell->eyes[i]]));
    return nearest;
}

// The one in the middle, then always the one farthest from all so far (Gonzalez 1985), as long
// as these are half a cube apart.
static void choose(const double (*eyes)[3], const placed_eye *placed, uint32_t count,
                   const double middle[3], double size, prom_eye_cell *cell)
{
    while (cell->eye_count < PROM_EYES_OF_CELL) {
        double best = -DBL_MAX;
        uint32_t chosen = 0;
        for (uint32_t i = 0; i < count; i++) {
            double merit = merit_of(eyes, cell, middle, placed[i].eye);
            if (merit <= best) continue;
            best = merit;
            chosen = placed[i].eye;
        }
        double least = cell->eye_count >= 2 ? 0.25 * size * size : 0;
        if (cell->eye_count && (best <= 0 || best < least)) break;
        cell->eyes[cell->eye_count++] = chosen;
    }
}

// A cube of which a path cuts only a corner: the next eye outside of it is looked from too.
static void add_neighbour(const double (*eyes)[3], uint32_t count, double size,
                          prom_eye_cell *cell)
{
    double nearest = size * size;
    uint32_t chosen = PROM_NONE;
    for (uint32_t i = 0; i < count; i++) {
        double d = distance2(eyes[i], eyes[cell->eyes[0]]);
        if (d <= 0 || d >= nearest) continue;
        nearest = d;
        chosen = i;
    }
    if (chosen != PROM_NONE) cell->eyes[cell->eye_count++] = chosen;
}

static void make_cells(const double (*eyes)[3], uint32_t count, const placed_eye *placed,
                       prom_eye_cells *cells)
{
    const prom_view_cells *grid = &cells->grid;
    for (uint32_t first = 0, last; first < count; first = last) {
        prom_eye_cell *cell = prom_array_extend(&cells->cells, 1);
        double middle[3];
        memcpy(cell->at, placed[first].at, sizeof cell->at);
        for (int k = 0; k < 3; k++)
            middle[k] = grid->origin[k] + (cell->at[k] + 0.5) * grid->size;
        for (last = first + 1; last < count; last++)
            if (prom_view_cube_order(placed[last].at, cell->at)) break;
        choose(eyes, placed + first, last - first, middle, grid->size, cell);
        if (cell->eye_count < 2) add_neighbour(eyes, count, grid->size, cell);
        cells->eye_count += cell->eye_count;
    }
}

prom_status prom_eye_cells_gather(const double (*eyes)[3], size_t count, double size,
                                  prom_eye_cells *cells, prom_error *error)
{
    *cells = (prom_eye_cells){0};
    if (!count || count > UINT32_MAX / 2)
        return prom_fail(error, PROM_ERR_INPUT,
                         "view cells need eyes to look from; there are %zu", count);
    const uint32_t n = (uint32_t)count;
    placed_eye *placed = prom_alloc(n, sizeof *placed);
    double tried = size > 0 ? size : PROM_VIEW_CELL_SIZE;
    uint32_t cubes = place(eyes, n, tried, placed, &cells->grid);
    for (; !(size > 0) && cubes > CELLS; tried *= SIZE_STEP)
        cubes = place(eyes, n, tried * SIZE_STEP, placed, &cells->grid);
    if (cubes && cubes <= CELLS_MAX) make_cells(eyes, n, placed, cells);
    prom_free(placed);
    if (cubes > CELLS_MAX)
        return prom_fail(error, PROM_ERR_USAGE,
                         "view cells of %g m would be %u, more than %u: ask for larger ones",
                         size, cubes, CELLS_MAX);
    if (!cubes)
        return prom_fail(error, PROM_ERR_INPUT,
                         "the eyes are too far apart for view cells of %g m", tried);
    return PROM_OK;
}

void prom_eye_cells_finish(prom_eye_cells *cells)
{
    prom_array_finish(&cells->cells);
    *cells = (prom_eye_cells){0};
}
