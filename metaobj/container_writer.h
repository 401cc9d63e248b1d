// Private to the container's writer: its state, and binding of values row by row.
#ifndef PROM_METAOBJ_CONTAINER_WRITER_H
#define PROM_METAOBJ_CONTAINER_WRITER_H

#include "metaobj/container_schema.h"

typedef struct prom_meta_entry {
    char *key, *value;
} prom_meta_entry;

struct prom_writer {
    sqlite3 *db;
    char *path, *part_path;
    int lock_fd; // open on the .part, holds an flock: one writer at a time
    bool finished, has_model, broken;
    sqlite3_stmt *insert[PROM_TABLE_COUNT];
    uint64_t rows[PROM_TABLE_COUNT];
    uint64_t uncommitted_bytes;
    uint32_t material_count; // least that the added meshes need
    PROM_ARRAY(prom_mesh_info) meshes;
    PROM_ARRAY(prom_texture_info) textures;
    PROM_ARRAY(prom_meta_entry) meta;
    prom_bytes encoded;
};

// Starts a row; the id comes first and is bound here. Each put_ binds the next column.
typedef struct prom_row_out {
    prom_writer *writer;
    sqlite3_stmt *statement;
    prom_table table;
    int column;
    int rc; // the first that was not SQLITE_OK
} prom_row_out;

prom_row_out prom_row_begin(prom_writer *writer, prom_table table);
void prom_put_int(prom_row_out *row, int64_t value);
void prom_put_index(prom_row_out *row, uint32_t value); // NULL for PROM_NONE
void prom_put_real(prom_row_out *row, double value);
void prom_put_limit(prom_row_out *row, float value); // NULL for INFINITY
void prom_put_floats(prom_row_out *row, const float *values, int count);
void prom_put_text(prom_row_out *row, const char *text);                 // kept until the end
void prom_put_blob(prom_row_out *row, const void *data, uint64_t bytes); // kept until the end
prom_status prom_row_end(prom_row_out *row, prom_error *error);

prom_status prom_writer_exec(prom_writer *writer, const char *sql, prom_error *error);
// Say what went wrong, SQLite's last error or an errno; nothing is written from then on.
prom_status prom_writer_fail(prom_writer *writer, prom_error *error);
prom_status prom_writer_fail_errno(prom_writer *writer, int number, prom_error *error);
// Locks PATH.part, empty, for a writer that has no database open yet; NULL with *error if it
// cannot.
prom_writer *prom_writer_start(const char *path, prom_error *error);
// Opens what PATH.part holds and begins a transaction.
prom_status prom_writer_open_database(prom_writer *writer, prom_error *error);
// Appends the chunks of a stream.
prom_status prom_writer_add_stream(prom_writer *writer, const prom_stream *stream,
                                   const void *data, prom_error *error);
// The first value of the first row that a query gives; `otherwise` where there is none.
prom_status prom_writer_query(prom_writer *writer, const char *sql, int64_t otherwise,
                              int64_t *value, prom_error *error);
// PROM_OK unless an earlier write failed.
prom_status prom_writer_ready(prom_writer *writer, prom_error *error);

#endif
