// Eyes gathered into cubes, and from which of them each cube is looked out of. Private to
// builder/.
#ifndef PROM_BUILDER_EYE_CELLS_H
#define PROM_BUILDER_EYE_CELLS_H

#include "metaobj/base/alloc.h"
#include "metaobj/base/status.h"
#include "metaobj/view_cells.h"

#define PROM_EYES_OF_CELL 8 // at most; at least 2, where a second one is near

// A cube that holds eyes, and those to look from: spread out in it.
typedef struct prom_eye_cell {
    int32_t at[3];
    uint32_t eyes[PROM_EYES_OF_CELL], eye_count;
} prom_eye_cell;

typedef struct prom_eye_cells {
    prom_view_cells grid;            // origin and size only
    PROM_ARRAY(prom_eye_cell) cells; // in the order of prom_view_cells
    uint64_t eye_count;              // of all cells
} prom_eye_cells;                    // {0} is empty

// size: side of the cubes, or 0: the default, or what makes no more than 400 of them. Fails
// without eyes, for eyes that are no numbers, and for cubes too small for how far the eyes
// reach.
prom_status prom_eye_cells_gather(const double (*eyes)[3], size_t count, double size,
                                  prom_eye_cells *cells, prom_error *error);
void prom_eye_cells_finish(prom_eye_cells *cells); // {0} is allowed

#endif
