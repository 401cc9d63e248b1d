// Rows of the container, written through one prepared statement per table.
#include "metaobj/container_writer.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>

prom_status prom_writer_fail_errno(prom_writer *writer, int number, prom_error *error)
{
    const char *advice = "";
    writer->broken = true;
    if (number == ENOSPC)
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "cannot write %s: the disk is full; free some space and build again",
                         writer->part_path);
    if (number == EDQUOT) advice = "; free some space and build again";
    if (number == ELOOP) advice = " (it is a symbolic link; remove it)";
    return prom_fail(error, PROM_ERR_OUTPUT, "cannot write %s: %s%s", writer->part_path,
                     strerror(number), advice);
}

// SQLite's own texts speak of databases and statements, of which the user knows nothing.
static const char *why_sqlite_failed(int rc)
{
    if (rc == SQLITE_READONLY_DBMOVED) return "another program has removed or renamed it";
    switch (rc & 0xff) {
    case SQLITE_IOERR:
        return "the disk reports an error";
    case SQLITE_CANTOPEN:
        return "its journal cannot be made; is the folder writable?";
    case SQLITE_PERM:
    case SQLITE_READONLY:
        return "it may not be written";
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
        return "another program has it open";
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
        return "another program has changed it";
    case SQLITE_NOMEM:
        return "there is not enough memory";
    case SQLITE_TOOBIG:
        return "a row is larger than the format allows";
    default:
        return "an unexpected error";
    }
}

prom_status prom_writer_fail(prom_writer *writer, prom_error *error)
{
    int rc = sqlite3_extended_errcode(writer->db), number = 0;
    if ((rc & 0xff) == SQLITE_FULL) return prom_writer_fail_errno(writer, ENOSPC, error);
    if ((rc & 0xff) == SQLITE_IOERR || (rc & 0xff) == SQLITE_CANTOPEN)
        number = sqlite3_system_errno(writer->db);
    if (number) return prom_writer_fail_errno(writer, number, error);
    writer->broken = true;
    return prom_fail(error, PROM_ERR_OUTPUT, "cannot write %s: %s (%d)", writer->part_path,
                     why_sqlite_failed(rc), rc);
}

prom_status prom_writer_ready(prom_writer *writer, prom_error *error)
{
    if (!writer->broken) return PROM_OK;
    return prom_fail(error, PROM_ERR_OUTPUT, "cannot write %s: an earlier write failed",
                     writer->part_path);
}

prom_status prom_writer_exec(prom_writer *writer, const char *sql, prom_error *error)
{
    if (sqlite3_exec(writer->db, sql, NULL, NULL, NULL) != SQLITE_OK)
        return prom_writer_fail(writer, error);
    return PROM_OK;
}

prom_status prom_writer_query(prom_writer *writer, const char *sql, int64_t otherwise,
                              int64_t *value, prom_error *error)
{
    sqlite3_stmt *statement;
    *value = otherwise;
    if (sqlite3_prepare_v2(writer->db, sql, -1, &statement, NULL) != SQLITE_OK)
        return prom_writer_fail(writer, error);
    int rc = sqlite3_step(statement);
    if (rc == SQLITE_ROW) *value = sqlite3_column_int64(statement, 0);
    prom_status status = PROM_OK;
    if (rc != SQLITE_ROW && rc != SQLITE_DONE) status = prom_writer_fail(writer, error);
    sqlite3_finalize(statement);
    return status;
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
