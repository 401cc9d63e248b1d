// The accuracy tables of a model as a text table.
#ifndef PROM_APP_INFO_TABLES_H
#define PROM_APP_INFO_TABLES_H

#include "app/info_object.h"
#include "metaobj/base/status.h"

// Writes comma-separated values to `path`, which has been checked: a header, then a row for
// each representation, direction and size, the large sizes of meshes included:
//   prototype, object (the name of the first that uses it), representation (index),
//   of ("object" or "cluster"), kind, level, triangles, direction (bin), x, y, z (towards the
//   eye, prototype's frame), size_px, accuracy, coverage (of the disc around the prototype).
// nodes: of the prototypes that are wanted; NULL: of all. *rows gets the rows under the header.
prom_status prom_info_write_tables(const prom_model *model, const prom_node_list *nodes,
                                   const char *path, uint64_t *rows, prom_error *error);

#endif
