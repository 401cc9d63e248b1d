// View cells: from-region visibility. Space where the viewer may be is divided into cubes; of
// each cell it is known which leaves show anything to an eye inside, looking anywhere.
#ifndef PROM_METAOBJ_VIEW_CELLS_H
#define PROM_METAOBJ_VIEW_CELLS_H

#include "metaobj/base/status.h"
#include "metaobj/model.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct prom_view_cell {
    int32_t at[3];         // the cube origin + size * [at, at + 1)
    uint32_t first, count; // into leaves and shares; first is where the cell before ends
} prom_view_cell;

typedef struct prom_view_cells {
    double origin[3];
    double size; // side of the cubes, scene units, above 0; 0 where there are no cells
    uint32_t cell_count;
    prom_view_cell *cells; // ascending by at[2], at[1], at[0]
    uint32_t entry_count;
    uint32_t *leaves; // nodes, ascending within a cell
    uint8_t *shares;  // greatest part of the leaf's footprint that shows from the cell: see
                      // prom_view_share_decode
} prom_view_cells;

void prom_view_cells_finish(prom_view_cells *cells); // {0} is allowed; frees with prom_free
// The cube that a point is in, from origin and size alone; false: it is none that can be named.
bool prom_view_cells_cube(const prom_view_cells *cells, const double point[3], int32_t at[3]);
// Order of two cubes, as cells stand: below, above or equal to 0.
int prom_view_cube_order(const int32_t a[3], const int32_t b[3]);
// The cell of a cube; NULL: there is none. Of the cells only where they are.
const prom_view_cell *prom_view_cells_find(const prom_view_cells *cells, const int32_t at[3]);
// The cell that holds a point; NULL: none does.
const prom_view_cell *prom_view_cells_at(const prom_view_cells *cells, const double point[3]);

// Shares are kept on a logarithmic scale: 2^((code - 255) / 16), so 255 is 1 and 0 about 2^-16.
// Encoding gives the least code that is not below what was seen; what is no number counts as 1.
uint8_t prom_view_share_encode(double share);
float prom_view_share_decode(uint8_t code);

// Hash of all that the cells say, chained from `seed`.
uint64_t prom_view_cells_hash(const prom_view_cells *cells, uint64_t seed);
// NULL if size and origin are finite, cells in order, their ranges without gaps up to
// entry_count, and each cell's leaves ascending and leaves of the tree; else a literal. The
// index of the offending cell goes to *cell. Of the model: tree_count and child_count.
const char *prom_view_cells_check(const prom_view_cells *cells, const prom_model *model,
                                  uint64_t *cell);

#endif
