// Rows of the container, read with a check of every value.
#include "metaobj/container_reader.h"

#include <float.h>
#include <math.h>
#include <stdio.h>

#define ADVICE "the file is damaged: build it again"

// SQLite's own texts speak of disk images, and may quote a hostile schema.
static const char *why_sqlite_failed(sqlite3 *db)
{
    switch (sqlite3_errcode(db) & 0xff) {
    case SQLITE_IOERR:
        return "it cannot be read; if the file did not change meanwhile, the disk fails";
    case SQLITE_TOOBIG:
        return "it claims more data than a row can hold; " ADVICE;
    case SQLITE_NOMEM:
        return "there is not enough memory to read it";
    default:
        return "its pages are damaged; copy or build the file again";
    }
}

prom_status prom_container_fail_sqlite(prom_container *container, const char *table,
                                       uint64_t row, prom_error *error)
{
    return prom_fail(error, PROM_ERR_INPUT, "%s: table %s, row %llu: %s", container->path,
                     table, (unsigned long long)row, why_sqlite_failed(container->db));
}

void prom_row_refuse(prom_row_in *row, const char *why)
{
    if (row->failed) return;
    row->failed = true;
    prom_fail(row->error, PROM_ERR_INPUT, "%s: table %s, row %u: %s; " ADVICE,
              row->container->path, prom_tables[row->table].name, row->id, why);
}

static void refuse_value(prom_row_in *row, int column, const char *why)
{
    char text[128];
    const char *name = sqlite3_column_name(row->statement, column);
    snprintf(text, sizeof text, "%s %s", name ? name : "a column", why);
    prom_row_refuse(row, text);
}

int64_t prom_take_int(prom_row_in *row, int64_t least, int64_t most)
{
    int c = row->column++;
    if (row->failed) return 0;
    int64_t value = sqlite3_column_int64(row->statement, c);
    if (sqlite3_column_type(row->statement, c) != SQLITE_INTEGER)
        refuse_value(row, c, "is no whole number");
    else if (value < least || value > most)
        refuse_value(row, c, "is out of range");
    return row->failed ? 0 : value;
}

uint32_t prom_take_u32(prom_row_in *row)
{
    return (uint32_t)prom_take_int(row, 0, UINT32_MAX);
}

uint32_t prom_take_index(prom_row_in *row)
{
    if (!row->failed && sqlite3_column_type(row->statement, row->column) == SQLITE_NULL) {
        row->column++;
        return PROM_NONE;
    }
    return (uint32_t)prom_take_int(row, 0, (int64_t)PROM_NONE - 1);
}

double prom_take_real(prom_row_in *row)
{
    int c = row->column++;
    if (row->failed) return 0;
    int type = sqlite3_column_type(row->statement, c);
    double value = sqlite3_column_double(row->statement, c);
    if (type != SQLITE_FLOAT && type != SQLITE_INTEGER)
        refuse_value(row, c, "is no number");
    else if (!isfinite(value))
        refuse_value(row, c, "is not finite");
    return row->failed ? 0 : value;
}

void prom_take_reals(prom_row_in *row, double *values, int count)
{
    for (int i = 0; i < count; i++) values[i] = prom_take_real(row);
}

static float take_float(prom_row_in *row)
{
    int c = row->column;
    double value = prom_take_real(row);
    if (fabs(value) <= FLT_MAX) return (float)value;
    refuse_value(row, c, "is out of range");
    return 0;
}

void prom_take_floats(prom_row_in *row, float *values, int count)
{
    for (int i = 0; i < count; i++) values[i] = take_float(row);
}

float prom_take_limit(prom_row_in *row)
{
    if (!row->failed && sqlite3_column_type(row->statement, row->column) == SQLITE_NULL) {
        row->column++;
        return INFINITY;
    }
    return take_float(row);
}

const char *prom_take_text(prom_row_in *row)
{
    int c = row->column++;
    if (row->failed) return "";
    const char *text = NULL;
    if (sqlite3_column_type(row->statement, c) == SQLITE_TEXT)
        text = (const char *)sqlite3_column_text(row->statement, c);
    if (!text || strlen(text) != (size_t)sqlite3_column_bytes(row->statement, c)) {
        refuse_value(row, c, "is no text");
        return "";
    }
    return text;
}

const void *prom_take_blob(prom_row_in *row, uint64_t bytes)
{
    int c = row->column++;
    if (row->failed) return NULL;
    const void *blob = NULL;
    if (sqlite3_column_type(row->statement, c) == SQLITE_BLOB)
        blob = sqlite3_column_blob(row->statement, c); // NULL when empty
    else
        refuse_value(row, c, "is no blob");
    if (!row->failed && (uint64_t)sqlite3_column_bytes(row->statement, c) != bytes)
        refuse_value(row, c, "has the wrong length");
    else if (!row->failed && bytes && !blob)
        refuse_value(row, c, "cannot be read");
    return row->failed ? NULL : blob;
}

// Steps to the next row and checks its number.
static int next_row(prom_row_in *row, uint64_t index)
{
    int rc = sqlite3_step(row->statement);
    if (rc != SQLITE_ROW) return rc;
    row->id = (uint32_t)index;
    row->column = 0;
    if (index >= row->container->rows[row->table])
        prom_row_refuse(row, "there is a row too many");
    prom_take_int(row, row->id, row->id);
    return rc;
}

prom_status prom_container_check_ids(prom_container *container, prom_table table,
                                     prom_error *error)
{
    const char *name = prom_tables[table].name;
    char *sql = prom_format("SELECT id FROM %s ORDER BY id", name);
    prom_row_in row = {.container = container, .table = table, .error = error};
    int rc = sqlite3_prepare_v2(container->db, sql, -1, &row.statement, NULL);
    prom_free(sql);
    if (rc != SQLITE_OK) return prom_container_fail_sqlite(container, name, 0, error);
    uint64_t rows = 0;
    while ((rc = next_row(&row, rows)) == SQLITE_ROW && !row.failed) rows++;
    prom_status status = row.failed ? PROM_ERR_INPUT : PROM_OK;
    if (!status && rc != SQLITE_DONE)
        status = prom_container_fail_sqlite(container, name, rows, error);
    if (!status && rows != container->rows[table])
        status = prom_fail(error, PROM_ERR_INPUT, "%s: table %s has %llu rows of %llu; " ADVICE,
                           container->path, name, (unsigned long long)rows,
                           (unsigned long long)container->rows[table]);
    sqlite3_finalize(row.statement);
    return status;
}

prom_status prom_container_scan(prom_container *container, prom_table table,
                                void (*take)(void *user, prom_row_in *row), void *user,
                                prom_error *error)
{
    const char *name = prom_tables[table].name;
    char *sql = prom_format("SELECT * FROM %s ORDER BY id", name);
    prom_row_in row = {.container = container, .table = table, .error = error};
    int rc = sqlite3_prepare_v2(container->db, sql, -1, &row.statement, NULL);
    prom_free(sql);
    if (rc != SQLITE_OK) return prom_container_fail_sqlite(container, name, 0, error);
    uint64_t hash = 0, rows = 0, bytes = 0;
    while (!row.failed && (rc = next_row(&row, rows)) == SQLITE_ROW) {
        bytes += prom_row_bytes(row.statement);
        if (bytes > container->file_bytes)
            prom_row_refuse(&row, "the rows hold more data than the file");
        if (!row.failed) take(user, &row);
        hash = prom_row_hash(row.statement, hash);
        rows++;
    }
    prom_status status = row.failed ? PROM_ERR_INPUT : PROM_OK;
    if (!status && rc != SQLITE_DONE)
        status = prom_container_fail_sqlite(container, name, rows, error);
    if (!status && (rows != container->rows[table] || hash != container->hash[table]))
        status = prom_fail(
            error, PROM_ERR_INPUT,
            "%s: table %s, rows 0 to %llu: they do not match the table's hash; " ADVICE,
            container->path, name, (unsigned long long)rows);
    sqlite3_finalize(row.statement);
    return status;
}
