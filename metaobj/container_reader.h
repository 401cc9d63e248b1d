// Private to the container's reader: its state, and values taken row by row with checks.
#ifndef PROM_METAOBJ_CONTAINER_READER_H
#define PROM_METAOBJ_CONTAINER_READER_H

#include "metaobj/container_schema.h"

typedef struct prom_bulk_ref {
    uint64_t first_chunk, content_hash;
} prom_bulk_ref;

struct prom_container {
    int fd; // open on the file, all that SQLite reads comes through it
    sqlite3 *db;
    char *path;
    uint64_t file_bytes; // bounds all claims of the file
    uint64_t rows[PROM_TABLE_HASHED], hash[PROM_TABLE_HASHED];
    sqlite3_stmt *chunk;
    prom_arena arena; // meta
    uint32_t meta_count;
    const char *(*meta)[2];
    // Filled by prom_container_load_model.
    uint32_t mesh_count, texture_count;
    uint64_t bulk_bytes; // that all bulk data take in the file at least
    prom_bulk_ref *meshes, *textures;
    uint64_t view_cell_bytes; // by prom_container_read_view_cells
};

// Opens container->path: fd, file_bytes, db.
prom_status prom_container_open_file(prom_container *container, prom_error *error);

// A row being read. Each take_ gives the next column; the first that is not as it should be
// fills *error, and from then on all give 0.
typedef struct prom_row_in {
    prom_container *container;
    sqlite3_stmt *statement;
    prom_table table;
    uint32_t id;
    int column;
    bool failed;
    prom_error *error;
} prom_row_in;

int64_t prom_take_int(prom_row_in *row, int64_t least, int64_t most);
uint32_t prom_take_u32(prom_row_in *row);
uint32_t prom_take_index(prom_row_in *row); // PROM_NONE for NULL
double prom_take_real(prom_row_in *row);
void prom_take_reals(prom_row_in *row, double *values, int count);
void prom_take_floats(prom_row_in *row, float *values, int count);
float prom_take_limit(prom_row_in *row); // INFINITY for NULL
// Valid until the row ends.
const char *prom_take_text(prom_row_in *row);
const void *prom_take_blob(prom_row_in *row, uint64_t bytes);
// Marks the row as failed with a reason of the caller's.
void prom_row_refuse(prom_row_in *row, const char *why);

// Whether a table has as many rows as the writer noted, with ids that count from 0: then memory
// for them is no more than a small multiple of the file.
prom_status prom_container_check_ids(prom_container *container, prom_table table,
                                     prom_error *error);
// Calls take(user, row) for every row of a table by id; checks that ids count from 0 and that
// number and hash of the rows are those that the writer noted.
prom_status prom_container_scan(prom_container *container, prom_table table,
                                void (*take)(void *user, prom_row_in *row), void *user,
                                prom_error *error);
// Says that a row is damaged.
prom_status prom_container_refuse(prom_container *container, const char *table, uint64_t row,
                                  const char *why, prom_error *error);
prom_status prom_container_fail_sqlite(prom_container *container, const char *table,
                                       uint64_t row, prom_error *error);

// Streams of bulk data, one after the other from a chunk on, that a row of a table claims.
// Before memory is taken for them: whether their chunks are there and large enough, and the
// machine's memory too. stored_bytes: of the chunks, or NULL.
prom_status prom_container_check_streams(prom_container *container, const char *table,
                                         uint32_t id, const prom_stream *streams, int count,
                                         uint64_t first_chunk, uint64_t *stored_bytes,
                                         prom_error *error);
// Decodes stream i into out[i].
prom_status prom_container_decode_streams(prom_container *container, const prom_stream *streams,
                                          int count, uint64_t first_chunk, void *const *out,
                                          prom_error *error);

#endif
