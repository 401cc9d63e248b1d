// The .prom container: one SQLite database (docs/FORMAT.md gives the schema).
//
// Writing works in PATH.part and renames at the end: either a complete file appears or none.
// Reading trusts nothing: read-only, defensive flags, checksums, every count, offset and index
// checked; a damaged file gives one error that names table and row.
#ifndef PROM_METAOBJ_CONTAINER_H
#define PROM_METAOBJ_CONTAINER_H

#include "metaobj/base/status.h"
#include "metaobj/mesh.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"
#include "metaobj/view_cells.h"

#include <stdbool.h>
#include <stdint.h>

#define PROM_CONTAINER_VERSION 4
#define PROM_CONTAINER_APPLICATION_ID 0x50524f4d // "PROM"
#define PROM_CONTAINER_CHUNK_BYTES (64u << 20)

// A writer or container serves one thread at a time.

// ---- writing

typedef struct prom_writer prom_writer;

// Starts PATH.part (replacing a leftover). NULL with *error if it cannot be written or another
// process is writing it.
prom_writer *prom_writer_create(const char *path, prom_error *error);
// Closes and, unless finished, deletes PATH.part. NULL is allowed.
void prom_writer_destroy(prom_writer *writer);

// Appends a mesh or texture as compressed, checksummed chunks; ids count from 0 in call order.
prom_status prom_writer_add_mesh(prom_writer *writer, const prom_mesh *mesh, uint32_t *id,
                                 prom_error *error);
prom_status prom_writer_add_texture(prom_writer *writer, const prom_texture *texture,
                                    uint32_t *id, prom_error *error);
// Free-form facts about the build ("source", "settings", ...): text by key; the last one wins.
prom_status prom_writer_set_meta(prom_writer *writer, const char *key, const char *value,
                                 prom_error *error);
// A finished stage of the build: content hash of what it made, and its duration. One of the
// same name is replaced.
prom_status prom_writer_add_stage(prom_writer *writer, const char *name, uint64_t content_hash,
                                  double ms, prom_error *error);
// The tree and its tables; once, after all meshes and textures, whose counts and sizes must be
// those of model->meshes and model->textures. `model` must pass prom_model_check.
prom_status prom_writer_put_model(prom_writer *writer, const prom_model *model,
                                  prom_error *error);
// The model's view cells, after the model, in the place of those that are there; without a cell
// none stay. `cells` must pass prom_view_cells_check.
prom_status prom_writer_put_view_cells(prom_writer *writer, const prom_view_cells *cells,
                                       prom_error *error);
// Syncs, closes and renames PATH.part to PATH.
prom_status prom_writer_finish(prom_writer *writer, prom_error *error);

// Starts PATH.part as a copy of PATH, a finished container, to change what may change later:
// view cells (prom_writer_put_view_cells), facts (prom_writer_set_meta) and stages
// (prom_writer_add_stage). PATH stays as it is until prom_writer_finish puts the new file in
// its place. NULL with *error if PATH is not sound (PROM_ERR_INPUT), or as prom_writer_create.
prom_writer *prom_writer_reopen(const char *path, prom_error *error);

// ---- reading

typedef struct prom_container prom_container;

prom_container *prom_container_open(const char *path, prom_error *error);
void prom_container_close(prom_container *container); // NULL is allowed

// Loads the tree and its tables. Free with prom_model_finish. Representations of an unknown
// kind are left out with a warning.
prom_status prom_container_load_model(prom_container *container, prom_model *model,
                                      prom_error *error);
// Load bulk data; `id` is an index into model->meshes or model->textures. The result is checked
// against its info and its checksum. Free with prom_mesh_finish / prom_texture_finish.
prom_status prom_container_read_mesh(prom_container *container, const prom_model *model,
                                     uint32_t id, prom_mesh *mesh, prom_error *error);
prom_status prom_container_read_texture(prom_container *container, const prom_model *model,
                                        uint32_t id, prom_texture *texture, prom_error *error);
// The model's view cells, checked against it; size 0 where it has none. Free with
// prom_view_cells_finish.
prom_status prom_container_read_view_cells(prom_container *container, const prom_model *model,
                                           prom_view_cells *cells, prom_error *error);
// Bytes that the view cells take in the file, without their rows' few; after they were read.
uint64_t prom_container_view_cell_bytes(prom_container *container);
// The value of a meta key in memory of the container, or NULL.
const char *prom_container_meta(prom_container *container, const char *key);
// Calls `each` for the stages in order.
prom_status prom_container_stages(prom_container *container,
                                  void (*each)(void *user, const char *name,
                                               uint64_t content_hash, double ms),
                                  void *user, prom_error *error);
// Hash over all content that the build determines (not durations, not the file's layout).
prom_status prom_container_content_hash(prom_container *container, uint64_t *hash,
                                        prom_error *error);

#endif
