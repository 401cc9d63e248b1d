// Opening a .prom container, its meta data, stages and content hash.
#include "metaobj/container_reader.h"

#include "metaobj/base/hash.h"

#include <errno.h>
#include <stdio.h>
#include <sys/stat.h>

#define HEADER_BYTES 100 // of an SQLite file

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 |
           bytes[3];
}

// The header's fields stand at fixed places (sqlite.org/fileformat2.html, section 1.3).
static prom_status check_header(const uint8_t header[HEADER_BYTES], const char *path,
                                uint64_t file_bytes, prom_error *error)
{
    if (memcmp(header, "SQLite format 3", 16) ||
        big_endian(header + 68) != PROM_CONTAINER_APPLICATION_ID)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s is not a .prom container; make one with 'promenade build'", path);
    uint32_t version = big_endian(header + 60);
    if (version != PROM_CONTAINER_VERSION)
        return prom_fail(
            error, PROM_ERR_INPUT, "%s has container format %u, this program reads %u; %s",
            path, version, PROM_CONTAINER_VERSION,
            version > PROM_CONTAINER_VERSION ? "use a newer promenade" : "build it again");
    uint32_t page_bytes = (uint32_t)header[16] << 8 | header[17];
    if (page_bytes == 1) page_bytes = 65536;
    uint64_t expected = (uint64_t)page_bytes * big_endian(header + 28);
    if (expected > file_bytes)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s is cut short at byte %llu of %llu; copy or build it again", path,
                         (unsigned long long)file_bytes, (unsigned long long)expected);
    return PROM_OK;
}

static prom_status check_file(prom_container *c, prom_error *error)
{
    struct stat info;
    if (stat(c->path, &info))
        return prom_fail(error, PROM_ERR_INPUT, "cannot open %s: %s", c->path, strerror(errno));
    if (!S_ISREG(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s is no file; name a .prom container",
                         c->path);
    FILE *file = fopen(c->path, "rb");
    if (!file)
        return prom_fail(error, PROM_ERR_INPUT, "cannot open %s: %s", c->path, strerror(errno));
    uint8_t header[HEADER_BYTES] = {0};
    size_t n = fread(header, 1, sizeof header, file);
    fclose(file);
    if (n < sizeof header) memset(header, 0, sizeof header);
    c->file_bytes = (uint64_t)info.st_size;
    return check_header(header, c->path, c->file_bytes, error);
}

static prom_status open_database(prom_container *c, prom_error *error)
{
    char *name = prom_sqlite_path(c->path);
    int rc = sqlite3_open_v2(name, &c->db, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX, NULL);
    prom_free(name);
    if (rc == SQLITE_OK) {
        sqlite3_db_config(c->db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
        sqlite3_db_config(c->db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
        sqlite3_db_config(c->db, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, NULL);
        sqlite3_db_config(c->db, SQLITE_DBCONFIG_ENABLE_VIEW, 0, NULL);
        sqlite3_limit(c->db, SQLITE_LIMIT_LENGTH, (int)PROM_CONTAINER_CHUNK_BYTES + (1 << 20));
        sqlite3_limit(c->db, SQLITE_LIMIT_ATTACHED, 0);
        rc = sqlite3_exec(c->db, "PRAGMA cell_size_check=ON; PRAGMA mmap_size=1099511627776;",
                          NULL, NULL, NULL);
    }
    if (rc == SQLITE_OK) return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT, "cannot open %s: %s", c->path,
                     sqlite3_errmsg(c->db));
}

// Only the very tables that the writer makes are read: no views, generated columns, or other
// code of a foreign schema.
static prom_status check_schema(prom_container *c, prom_error *error)
{
    sqlite3_stmt *find;
    const char *sql = "SELECT sql FROM sqlite_schema WHERE type='table' AND name=?";
    if (sqlite3_prepare_v2(c->db, sql, -1, &find, NULL) != SQLITE_OK)
        return prom_container_fail_sqlite(c, "sqlite_schema", 0, error);
    prom_status status = PROM_OK;
    for (int t = 0; t < PROM_TABLE_COUNT && !status; t++) {
        sqlite3_bind_text(find, 1, prom_tables[t].name, -1, SQLITE_STATIC);
        int rc = sqlite3_step(find);
        const char *found =
            rc == SQLITE_ROW ? (const char *)sqlite3_column_text(find, 0) : NULL;
        if (rc != SQLITE_ROW && rc != SQLITE_DONE)
            status = prom_container_fail_sqlite(c, "sqlite_schema", (uint64_t)t, error);
        else if (!found || strcmp(found, prom_tables[t].create))
            status = prom_fail(error, PROM_ERR_INPUT,
                               "%s: table %s is missing or not of this format; build the file "
                               "again",
                               c->path, prom_tables[t].name);
        sqlite3_reset(find);
    }
    sqlite3_finalize(find);
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
        // A row takes at least 8 bytes of the file; this bounds what is allocated for it.
        int64_t most = (int64_t)(c->file_bytes / 8);
        if (most >= PROM_NONE) most = (int64_t)PROM_NONE - 1;
        c->rows[row.id] = (uint64_t)prom_take_int(&row, 0, most);
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
    prom_status status = check_file(c, error);
    if (!status) status = open_database(c, error);
    if (!status) status = check_schema(c, error);
    if (!status) status = read_row_hashes(c, error);
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
        if (prom_table_hash(container->db, (prom_table)t, prom_tables[t].content, &rows,
                            &table_hash) != SQLITE_OK)
            return prom_container_fail_sqlite(container, prom_tables[t].name, rows, error);
        uint64_t both[2] = {rows, table_hash};
        *hash = prom_hash(both, sizeof both, *hash);
    }
    return PROM_OK;
}
