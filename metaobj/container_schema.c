#include "metaobj/container_schema.h"

#include "metaobj/base/hash.h"

#include <stdio.h>

// Indices are NULL where the model has PROM_NONE. Hashes are 64-bit patterns as signed
// integers.
const prom_table_schema prom_tables[PROM_TABLE_COUNT] = {
    [PROM_TABLE_META] = {"meta",
                         "CREATE TABLE meta(\n"
                         "  id INTEGER PRIMARY KEY, key TEXT NOT NULL UNIQUE,\n"
                         "  value TEXT NOT NULL) STRICT",
                         NULL},
    [PROM_TABLE_NODE] =
        {"node",
         "CREATE TABLE node(\n"
         "  id INTEGER PRIMARY KEY, parent INTEGER, first_child INTEGER,\n"
         "  child_count INTEGER NOT NULL, prototype INTEGER NOT NULL,\n"
         "  background INTEGER NOT NULL, name TEXT NOT NULL,\n"
         "  origin_x REAL NOT NULL, origin_y REAL NOT NULL, origin_z REAL NOT NULL,\n"
         "  basis_xx REAL NOT NULL, basis_xy REAL NOT NULL, basis_xz REAL NOT NULL,\n"
         "  basis_yx REAL NOT NULL, basis_yy REAL NOT NULL, basis_yz REAL NOT NULL,\n"
         "  basis_zx REAL NOT NULL, basis_zy REAL NOT NULL, basis_zz REAL NOT NULL,\n"
         "  center_x REAL NOT NULL, center_y REAL NOT NULL, center_z REAL NOT NULL,\n"
         "  half_x REAL NOT NULL, half_y REAL NOT NULL, half_z REAL NOT NULL,\n"
         "  radius REAL NOT NULL, weight REAL NOT NULL) STRICT",
         NULL},
    [PROM_TABLE_PROTOTYPE] =
        {"prototype",
         "CREATE TABLE prototype(\n"
         "  id INTEGER PRIMARY KEY, flags INTEGER NOT NULL, child_count INTEGER NOT NULL,\n"
         "  center_x REAL NOT NULL, center_y REAL NOT NULL, center_z REAL NOT NULL,\n"
         "  half_x REAL NOT NULL, half_y REAL NOT NULL, half_z REAL NOT NULL,\n"
         "  radius REAL NOT NULL, triangles INTEGER NOT NULL,\n"
         "  coverage BLOB NOT NULL, shares BLOB NOT NULL) STRICT",
         NULL},
    [PROM_TABLE_REPRESENTATION] =
        {"representation",
         "CREATE TABLE representation(\n"
         "  id INTEGER PRIMARY KEY, prototype INTEGER NOT NULL, kind INTEGER NOT NULL,\n"
         "  mesh INTEGER NOT NULL, texture INTEGER, flags INTEGER NOT NULL,\n"
         "  shading INTEGER NOT NULL, level INTEGER NOT NULL, error REAL NOT NULL,\n"
         "  max_size_px REAL, near_k REAL NOT NULL, switch_distance REAL,\n"
         "  draws INTEGER NOT NULL, vertices INTEGER NOT NULL,\n"
         "  triangles INTEGER NOT NULL, layers REAL NOT NULL) STRICT",
         NULL},
    [PROM_TABLE_ACCURACY] = {"accuracy",
                             "CREATE TABLE accuracy(\n"
                             "  id INTEGER PRIMARY KEY, value BLOB NOT NULL) STRICT",
                             NULL},
    [PROM_TABLE_MESH] =
        {"mesh",
         "CREATE TABLE mesh(\n"
         "  id INTEGER PRIMARY KEY, vertex_count INTEGER NOT NULL,\n"
         "  index_count INTEGER NOT NULL, submesh_count INTEGER NOT NULL,\n"
         "  content_hash INTEGER NOT NULL, first_chunk INTEGER NOT NULL) STRICT",
         "id,vertex_count,index_count,submesh_count,content_hash"},
    [PROM_TABLE_TEXTURE] =
        {"texture",
         "CREATE TABLE texture(\n"
         "  id INTEGER PRIMARY KEY, kind INTEGER NOT NULL, width INTEGER NOT NULL,\n"
         "  height INTEGER NOT NULL, layers INTEGER NOT NULL, levels INTEGER NOT NULL,\n"
         "  content_hash INTEGER NOT NULL, first_chunk INTEGER NOT NULL) STRICT",
         "id,kind,width,height,layers,levels,content_hash"},
    [PROM_TABLE_MATERIAL] =
        {"material",
         "CREATE TABLE material(\n"
         "  id INTEGER PRIMARY KEY, red REAL NOT NULL, green REAL NOT NULL,\n"
         "  blue REAL NOT NULL, alpha REAL NOT NULL, texture INTEGER,\n"
         "  alpha_mode INTEGER NOT NULL, alpha_cutoff REAL NOT NULL,\n"
         "  double_sided INTEGER NOT NULL) STRICT",
         NULL},
    [PROM_TABLE_COST_PROFILE] = {"cost_profile",
                                 "CREATE TABLE cost_profile(\n"
                                 "  id INTEGER PRIMARY KEY, device TEXT NOT NULL UNIQUE,\n"
                                 "  profile TEXT NOT NULL) STRICT",
                                 NULL},
    [PROM_TABLE_STAGE] = {"stage",
                          "CREATE TABLE stage(\n"
                          "  id INTEGER PRIMARY KEY, name TEXT NOT NULL,\n"
                          "  content_hash INTEGER NOT NULL, ms REAL NOT NULL) STRICT",
                          "id,name,content_hash"},
    [PROM_TABLE_VIEW_GRID] =
        {"view_grid",
         "CREATE TABLE view_grid(\n"
         "  id INTEGER PRIMARY KEY, origin_x REAL NOT NULL, origin_y REAL NOT NULL,\n"
         "  origin_z REAL NOT NULL, size REAL NOT NULL, content_hash INTEGER NOT NULL,\n"
         "  first_chunk INTEGER NOT NULL) STRICT",
         "id,origin_x,origin_y,origin_z,size,content_hash"},
    [PROM_TABLE_VIEW_CELL] =
        {"view_cell",
         "CREATE TABLE view_cell(\n"
         "  id INTEGER PRIMARY KEY, x INTEGER NOT NULL, y INTEGER NOT NULL,\n"
         "  z INTEGER NOT NULL, leaf_count INTEGER NOT NULL) STRICT",
         NULL},
    [PROM_TABLE_ROWS] = {"table_rows",
                         "CREATE TABLE table_rows(\n"
                         "  id INTEGER PRIMARY KEY, name TEXT NOT NULL,\n"
                         "  row_count INTEGER NOT NULL, hash INTEGER NOT NULL) STRICT",
                         NULL},
    [PROM_TABLE_CHUNK] = {"chunk",
                          "CREATE TABLE chunk(\n"
                          "  id INTEGER PRIMARY KEY, codec INTEGER NOT NULL,\n"
                          "  checksum INTEGER NOT NULL, data BLOB NOT NULL) STRICT",
                          NULL},
};

uint64_t prom_row_hash(sqlite3_stmt *row, uint64_t seed)
{
    struct {
        int64_t type, bits;
    } values[32];
    int columns = sqlite3_column_count(row), used = 0;
    for (int c = 0; c < columns; c++) {
        const void *data = NULL;
        int64_t bits = 0;
        double real;
        int type = sqlite3_column_type(row, c);
        if (type == SQLITE_INTEGER) {
            bits = sqlite3_column_int64(row, c);
        } else if (type == SQLITE_FLOAT) {
            real = sqlite3_column_double(row, c);
            memcpy(&bits, &real, sizeof bits);
        } else if (type != SQLITE_NULL) {
            data = type == SQLITE_TEXT ? (const void *)sqlite3_column_text(row, c)
                                       : sqlite3_column_blob(row, c);
            bits = sqlite3_column_bytes(row, c);
        }
        values[used].type = type;
        values[used++].bits = bits;
        if (!data && used < 32) continue;
        seed = prom_hash(values, (size_t)used * sizeof *values, seed);
        if (data) seed = prom_hash(data, (size_t)bits, seed);
        used = 0;
    }
    return prom_hash(values, (size_t)used * sizeof *values, seed);
}

uint64_t prom_row_bytes(sqlite3_stmt *row)
{
    uint64_t bytes = 0;
    for (int c = sqlite3_column_count(row); c-- > 0;) {
        int type = sqlite3_column_type(row, c);
        if (type == SQLITE_TEXT || type == SQLITE_BLOB)
            bytes += (uint64_t)sqlite3_column_bytes(row, c);
    }
    return bytes;
}

int prom_table_hash(sqlite3 *db, prom_table table, const char *columns, uint64_t most_bytes,
                    uint64_t *rows, uint64_t *hash)
{
    uint64_t bytes = 0;
    char sql[256];
    snprintf(sql, sizeof sql, "SELECT %s FROM %s ORDER BY id", columns ? columns : "*",
             prom_tables[table].name);
    sqlite3_stmt *statement;
    int rc = sqlite3_prepare_v2(db, sql, -1, &statement, NULL);
    *rows = *hash = 0;
    if (rc != SQLITE_OK) return rc;
    while ((rc = sqlite3_step(statement)) == SQLITE_ROW) {
        bytes += prom_row_bytes(statement);
        if (bytes > most_bytes) break;
        *hash = prom_row_hash(statement, *hash);
        ++*rows;
    }
    sqlite3_finalize(statement);
    return rc == SQLITE_DONE ? SQLITE_OK : rc == SQLITE_ROW ? SQLITE_TOOBIG : rc;
}

char *prom_sqlite_path(const char *path)
{
    return path[0] == '/' ? prom_strdup(path) : prom_format("./%s", path);
}
