// A contact sheet of two meshes where they differ most.
#ifndef PROM_APP_MESH_SHEET_H
#define PROM_APP_MESH_SHEET_H

#include "app/mesh_report.h"

// Columns: the views that differ most by flip, worst first. Rows: A, B, and the error of each
// pixel. Writes a PNG to `path`, which has been checked. There are views.
#define PROM_MESH_SHEET_VIEWS 6
prom_status prom_mesh_sheet_write(prom_mesh_pictures *pictures,
                                  const prom_mesh_comparison *comparison, const char *path,
                                  prom_error *error);

#endif
