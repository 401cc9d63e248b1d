// What shows from a cell of eyes: as a unit of work, and joined to view cells. Private to
// builder/.
#ifndef PROM_BUILDER_CELL_VIEW_H
#define PROM_BUILDER_CELL_VIEW_H

#include "builder/eye_cells.h"
#include "builder/pack.h"
#include "metaobj/model.h"

// Before its neighbours are looked at.
typedef struct prom_cell_view {
    uint32_t count;
    uint32_t *leaves; // ascending
    uint8_t *codes;   // of their shares, as in prom_view_cells
} prom_cell_view;

// The leaves with a share above 0, of a number for each node of the tree.
void prom_cell_view_set(prom_cell_view *view, const prom_model *model, const float *shares);
void prom_cell_view_finish(prom_cell_view *view); // {0} is allowed

void prom_cell_view_pack(const prom_cell_view *view, prom_pack *pack);
// False, and {0}, if the bytes are no view of this model.
bool prom_cell_view_unpack(prom_cell_view *view, const prom_model *model,
                           const prom_pack *pack);

// View cells from the views of all cells: each has what it shows, and what the 26 cells around
// it show at half the share, for the eyes near its border. Free with prom_view_cells_finish.
void prom_cell_views_join(const prom_cell_view *views, const prom_eye_cells *cells,
                          const prom_model *model, prom_view_cells *joined);

#endif
