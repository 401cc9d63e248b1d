// A contact sheet of an object: how its representations look, and where they err.
#ifndef PROM_APP_INFO_SHEET_H
#define PROM_APP_INFO_SHEET_H

#include "metaobj/container.h"

typedef struct prom_sheet_options {
    float size_px; // diameter of the object in the pictures: the nearest size bin is taken
    uint32_t directions; // 1 to PROM_DIRS; of the large sizes PROM_DIRS_LARGE at most
} prom_sheet_options;

// Draws a node's true look and below it, a row each, the representations of its prototype from
// some directions, well spread; beside each picture the error of every pixel (by the model's
// own metric and pixels per degree, over its first background), below it the accuracy that the
// model holds. Where the accuracy that is measured here, over both backgrounds, differs by more
// than PROM_SHEET_TOLERANCE, it stands beside it. Writes a PNG to `path`, which has been
// checked. Where the builder disqualified a look (prom_measured), that is said.
#define PROM_SHEET_TOLERANCE 0.02
prom_status prom_info_write_sheet(prom_container *container, const prom_model *model,
                                  uint32_t node, const prom_sheet_options *options,
                                  const char *path, prom_error *error);

#endif
