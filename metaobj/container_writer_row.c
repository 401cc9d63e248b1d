// Rows of the container, written through one prepared statement per table.
#include "metaobj/container_writer.h"

#include <math.h>
#include <stdio.h>

prom_status prom_writer_fail(prom_writer *writer, prom_error *error)
{
    writer->broken = true;
    if ((sqlite3_errcode(writer->db) & 0xff) == SQLITE_FULL)
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "cannot write %s: the disk is full; free some space and build again",
                         writer->part_path);
    return prom_fail(error, PROM_ERR_OUTPUT, "cannot write %s: %s", writer->part_path,
                     sqlite3_errmsg(writer->db));
}

prom_status prom_writer_exec(prom_writer *writer, const char *sql, prom_error *error)
{
    if (sqlite3_exec(writer->db, sql, NULL, NULL, NULL) != SQLITE_OK)
        return prom_writer_fail(writer, error);
    return PROM_OK;
}

static int column_count(const char *create)
{
    int commas = 0;
    for (; *create; create++) commas += *create == ',';
    return commas + 1;
}

static int prepare_insert(prom_writer *writer, prom_table table)
{
    char sql[256];
    const prom_table_schema *t = &prom_tables[table];
    int n = snprintf(sql, sizeof sql, "INSERT INTO %s VALUES(?", t->name);
    for (int c = column_count(t->create); c > 1; c--)
        n += snprintf(sql + n, sizeof sql - (size_t)n, ",?");
    snprintf(sql + n, sizeof sql - (size_t)n, ")");
    return sqlite3_prepare_v3(writer->db, sql, -1, SQLITE_PREPARE_PERSISTENT,
                              &writer->insert[table], NULL);
}

prom_row_out prom_row_begin(prom_writer *writer, prom_table table)
{
    prom_row_out row = {.writer = writer, .table = table};
    if (!writer->insert[table]) row.rc = prepare_insert(writer, table);
    row.statement = writer->insert[table];
    prom_put_int(&row, (int64_t)writer->rows[table]);
    return row;
}

static void note(prom_row_out *row, int rc)
{
    if (row->rc == SQLITE_OK) row->rc = rc;
}

void prom_put_int(prom_row_out *row, int64_t value)
{
    note(row, sqlite3_bind_int64(row->statement, ++row->column, value));
}

void prom_put_index(prom_row_out *row, uint32_t value)
{
    if (value != PROM_NONE)
        prom_put_int(row, value);
    else
        note(row, sqlite3_bind_null(row->statement, ++row->column));
}

void prom_put_real(prom_row_out *row, double value)
{
    note(row, sqlite3_bind_double(row->statement, ++row->column, value));
}

void prom_put_limit(prom_row_out *row, float value)
{
    if (isfinite(value))
        prom_put_real(row, value);
    else
        note(row, sqlite3_bind_null(row->statement, ++row->column));
}

void prom_put_floats(prom_row_out *row, const float *values, int count)
{
    for (int i = 0; i < count; i++) prom_put_real(row, values[i]);
}

void prom_put_text(prom_row_out *row, const char *text)
{
    note(row, sqlite3_bind_text(row->statement, ++row->column, text, -1, SQLITE_STATIC));
}

void prom_put_blob(prom_row_out *row, const void *data, uint64_t bytes)
{
    // A null pointer would bind NULL, not an empty blob.
    note(row, sqlite3_bind_blob64(row->statement, ++row->column, data ? data : "", bytes,
                                  SQLITE_STATIC));
}

prom_status prom_row_end(prom_row_out *row, prom_error *error)
{
    int rc = row->rc;
    if (rc == SQLITE_OK) rc = sqlite3_step(row->statement);
    prom_status status = PROM_OK;
    if (rc != SQLITE_DONE) status = prom_writer_fail(row->writer, error);
    if (row->statement) sqlite3_reset(row->statement);
    row->writer->rows[row->table]++;
    return status;
}
