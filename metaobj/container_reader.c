// Opening a .prom container, its meta data, stages and content hash.
#include "metaobj/container_reader.h"

#include "metaobj/base/hash.h"

#include <unistd.h>

// Which of the reader's tables a row of the schema makes; PROM_TABLE_COUNT: none. The indices
// that SQLite makes for unique columns have no text.
static prom_table table_of(sqlite3_stmt *row)
{
    const char *type = (const char *)sqlite3_column_text(row, 0);
    const char *table = (const char *)sqlite3_column_text(row, 1);
    const char *create = (const char *)sqlite3_column_text(row, 2);
    for (int t = 0; type && table && t < PROM_TABLE_COUNT; t++) {
        const prom_table_schema *schema = &prom_tables[t];
        if (strcmp(table, schema->name)) continue;
        bool ours = strcmp(type, "table") ? !strcmp(type, "index") && !create
                                          : create && !strcmp(create, schema->create);
        if (ours) return (prom_table)t;
    }
    return PROM_TABLE_COUNT;
}

// Only the very tables that the writer makes are read: no views, generated columns, indices or
// other code of a foreign schema.
static prom_status check_schema(prom_container *c, prom_error *error)
{
    sqlite3_stmt *rows;
    const char *sql = "SELECT type,tbl_name,sql FROM sqlite_schema";
    if (sqlite3_prepare_v2(c->db, sql, -1, &rows, NULL) != SQLITE_OK)
        return prom_container_fail_sqlite(c, "sqlite_schema", 0, error);
    bool found[PROM_TABLE_COUNT + 1] = {false};
    int rc, count = 0;
    // Each of our tables may have an index; a longer schema cannot be ours.
    while ((rc = sqlite3_step(rows)) == SQLITE_ROW && count++ < 2 * PROM_TABLE_COUNT)
        found[table_of(rows)] = true;
    prom_status status = PROM_OK;
    if (rc == SQLITE_ROW) found[PROM_TABLE_COUNT] = true;
    if (rc != SQLITE_ROW && rc != SQLITE_DONE)
        status = prom_container_fail_sqlite(c, "sqlite_schema", (uint64_t)count, error);
    for (int t = 0; t < PROM_TABLE_COUNT && !status; t++)
        if (!found[t])
            status = prom_fail(error, PROM_ERR_INPUT,
                               "%s: table %s is missing or not of this format; build the file "
                               "again",
                               c->path, prom_tables[t].name);
    if (!status && found[PROM_TABLE_COUNT])
        status = prom_fail(error, PROM_ERR_INPUT,
                           "%s: it holds tables, views or triggers that are not of this "
                           "format; build the file again",
                           c->path);
    sqlite3_finalize(rows);
    return status;
}

static prom_status read_row_hashes(prom_container *c, prom_error *error)
{
    const char *name = prom_tables[PROM_TABLE_ROWS].name;
    prom_row_in row = {.container = c, .table = PROM_TABLE_ROWS, .error = error};
    if (sqlite3_prepare_v2(c->db, "SELECT * FROM table_rows ORDER BY id", -1, &row.statement,
                           NULL) != SQLITE_OK)
        return prom_container_fail_sqlite(c, name, 0, error);
    int rc = SQLITE_ROW;
    for (; row.id < PROM_TABLE_HASHED && !row.failed; row.id++) {
        if ((rc = sqlite3_step(row.statement)) != SQLITE_ROW) break;
        row.column = 0;
        prom_take_int(&row, row.id, row.id);
        if (strcmp(prom_take_text(&row), prom_tables[row.id].name))
            prom_row_refuse(&row, "the table's name is wrong");
        c->rows[row.id] = (uint64_t)prom_take_int(&row, 0, (int64_t)PROM_NONE - 1);
        c->hash[row.id] = (uint64_t)prom_take_int(&row, INT64_MIN, INT64_MAX);
    }
    prom_status status = row.failed ? PROM_ERR_INPUT : PROM_OK;
    if (!status && rc == SQLITE_DONE) {
        prom_row_refuse(&row, "the row is missing");
        status = PROM_ERR_INPUT;
    } else if (!status && rc != SQLITE_ROW) {
        status = prom_container_fail_sqlite(c, name, row.id, error);
    }
    sqlite3_finalize(row.statement);
    return status;
}

static void take_meta(void *user, prom_row_in *row)
{
    prom_container *c = user;
    const char *key = prom_take_text(row);
    c->meta[row->id][0] = prom_arena_strdup(&c->arena, key);
    const char *value = prom_take_text(row);
    c->meta[row->id][1] = prom_arena_strdup(&c->arena, value);
    c->meta_count = row->id + 1;
}

static prom_status read_meta(prom_container *c, prom_error *error)
{
    c->meta = prom_arena_alloc(&c->arena, c->rows[PROM_TABLE_META], sizeof *c->meta);
    return prom_container_scan(c, PROM_TABLE_META, take_meta, c, error);
}

prom_container *prom_container_open(const char *path, prom_error *error)
{
    prom_container *c = prom_calloc(1, sizeof *c);
    c->path = prom_strdup(path);
    c->fd = -1;
    prom_status status = prom_container_open_file(c, error);
    if (!status) status = check_schema(c, error);
    if (!status) status = read_row_hashes(c, error);
    for (int t = 0; t < PROM_TABLE_HASHED && !status; t++)
        status = prom_container_check_ids(c, (prom_table)t, error);
    if (!status) status = read_meta(c, error);
    if (!status) return c;
    prom_container_close(c);
    return NULL;
}

void prom_container_close(prom_container *container)
{
    if (!container) return;
    sqlite3_finalize(container->chunk);
    sqlite3_close(container->db);
    if (container->fd >= 0) close(container->fd);
    prom_arena_finish(&container->arena);
    prom_free(container->meshes);
    prom_free(container->textures);
    prom_free(container->path);
    prom_free(container);
}

const char *prom_container_meta(prom_container *container, const char *key)
{
    for (uint32_t i = 0; i < container->meta_count; i++)
        if (!strcmp(container->meta[i][0], key)) return container->meta[i][1];
    return NULL;
}

typedef struct stage_reader {
    void (*each)(void *user, const char *name, uint64_t content_hash, double ms);
    void *user;
} stage_reader;

static void take_stage(void *user, prom_row_in *row)
{
    stage_reader *reader = user;
    const char *name = prom_take_text(row);
    uint64_t content_hash = (uint64_t)prom_take_int(row, INT64_MIN, INT64_MAX);
    double ms = prom_take_real(row);
    if (!row->failed) reader->each(reader->user, name, content_hash, ms);
}

prom_status prom_container_stages(prom_container *container,
                                  void (*each)(void *user, const char *name,
                                               uint64_t content_hash, double ms),
                                  void *user, prom_error *error)
{
    stage_reader reader = {each, user};
    return prom_container_scan(container, PROM_TABLE_STAGE, take_stage, &reader, error);
}

prom_status prom_container_content_hash(prom_container *container, uint64_t *hash,
                                        prom_error *error)
{
    *hash = 0;
    for (int t = 0; t < PROM_TABLE_HASHED; t++) {
        uint64_t rows, table_hash;
        if (prom_table_hash(container->db, (prom_table)t, prom_tables[t].content,
                            container->file_bytes, &rows, &table_hash) != SQLITE_OK)
            return prom_container_fail_sqlite(container, prom_tables[t].name, rows, error);
        uint64_t both[2] = {rows, table_hash};
        *hash = prom_hash(both, sizeof both, *hash);
    }
    return PROM_OK;
}
