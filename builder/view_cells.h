// View cells, offline: from eyes where the viewer may be to the leaves that each cell shows.
//
// Of a finished model, id pictures in all directions are drawn from several eyes of each cell.
// A leaf belongs to the cell if it shows a pixel from one of them; its share is the greatest
// part of its footprint that shows. What the cells around show counts half. A leaf that nobody
// has seen may still show from elsewhere in a cell: that costs quality for a frame.
#ifndef PROM_BUILDER_VIEW_CELLS_H
#define PROM_BUILDER_VIEW_CELLS_H

#include "metaobj/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

// By default; cells are larger where so small ones would be more than about 400.
#define PROM_VIEW_CELL_SIZE 2.0
#define PROM_VIEW_CELL_FACE_PX 512

typedef struct prom_view_cells_options {
    double cell_size; // side of the cells, scene units; 0: PROM_VIEW_CELL_SIZE or larger
    uint32_t face_px; // side of the six pictures of an eye; 0: PROM_VIEW_CELL_FACE_PX
    bool anew;        // nothing is taken from earlier builds
    bool drop_work;   // the work file is deleted at the end
} prom_view_cells_options;

typedef struct prom_view_cells_report {
    double cell_size;
    uint32_t cells, cells_taken; // all, and those taken from earlier builds
    uint64_t eyes;               // looked from, those of the taken cells too
    double mean_share;           // of the leaves, that a cell shows
    double seconds;
    uint64_t bytes;                  // of the cells in the file
    uint64_t file_bytes, work_bytes; // of the model and its work file
} prom_view_cells_report;

// Puts view cells around `eyes` (count * 3, scene units) into the finished model at
// `model_path`, which is replaced when all is done. On failure it stays as it is, and the cells
// done so far are kept in its work file, as by prom_build: the next call goes on from there.
// Uses prom_thread_count() cores and a headless context.
prom_status prom_view_cells_build(const char *model_path, const double (*eyes)[3], size_t count,
                                  const prom_view_cells_options *options,
                                  prom_view_cells_report *report, prom_error *error);

#endif
