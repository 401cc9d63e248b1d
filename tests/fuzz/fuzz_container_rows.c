// LINK: prom_metaobj PkgConfig::SQLITE
// MAX: 512
// The container's reader behind the checksums: the input is a list of edits on a sound file,
// as a hostile writer could make them: any value of any type in any place, rows gone or twice,
// chunks spoiled, and all hashes right.
#include "fuzz_read.h"

#include "metaobj/base/hash.h"
#include "metaobj/container_schema.h"

#include <sqlite3.h>

const unsigned fuzz_spoilings = 60;

#define EDITS_MAX 16
#define CHUNKS_MAX 64

typedef struct input {
    const uint8_t *bytes;
    size_t count;
} input;

// The next `n` bytes as a number; zeros where the input ends.
static uint64_t take(input *in, size_t n)
{
    uint64_t value = 0;
    for (size_t i = 0; i < n; i++) {
        value = value << 8 | (in->count ? *in->bytes : 0);
        if (in->count) in->bytes++, in->count--;
    }
    return value;
}

static void exec(sqlite3 *db, const char *sql)
{
    if (sqlite3_exec(db, sql, NULL, NULL, NULL) == SQLITE_OK) return;
    fprintf(stderr, "%s: %s\n", sql, sqlite3_errmsg(db));
    abort();
}

static sqlite3_stmt *prepare(sqlite3 *db, const char *sql)
{
    sqlite3_stmt *statement;
    if (sqlite3_prepare_v2(db, sql, -1, &statement, NULL) == SQLITE_OK) return statement;
    fprintf(stderr, "%s: %s\n", sql, sqlite3_errmsg(db));
    abort();
}

// A database in memory that starts from these bytes; close it with sqlite3_close.
static sqlite3 *load(const void *bytes, size_t count)
{
    sqlite3 *db;
    fuzz_check(sqlite3_open(":memory:", &db) == SQLITE_OK);
    uint8_t *copy = sqlite3_malloc64(count);
    memcpy(copy, bytes, count);
    fuzz_check(sqlite3_deserialize(db, "main", copy, (sqlite3_int64)count, (sqlite3_int64)count,
                                   SQLITE_DESERIALIZE_FREEONCLOSE |
                                       SQLITE_DESERIALIZE_RESIZEABLE) == SQLITE_OK);
    return db;
}

// The fixture's file with tables that take anything: the reader will see the strict text again.
static const uint8_t *loose_file(size_t *count)
{
    static uint8_t *bytes;
    static sqlite3_int64 size;
    if (!bytes) {
        size_t strict_count;
        uint8_t *strict = fuzz_fixture(2, 2, &strict_count);
        sqlite3 *db = load(strict, strict_count);
        exec(db, "PRAGMA writable_schema=ON;"
                 "UPDATE sqlite_schema SET sql=replace(replace(replace(sql,') STRICT',')'),"
                 "' NOT NULL',''),' UNIQUE','') WHERE type='table';"
                 "DELETE FROM sqlite_schema WHERE type='index'");
        bytes = sqlite3_serialize(db, "main", &size, 0);
        sqlite3_close(db);
        prom_free(strict);
    }
    *count = (size_t)size;
    return bytes;
}

static void bind_value(sqlite3_stmt *statement, int index, input *in)
{
    static const int64_t edges[] = {0,
                                    1,
                                    2,
                                    -1,
                                    255,
                                    256,
                                    65535,
                                    INT32_MAX,
                                    INT32_MIN,
                                    UINT32_MAX,
                                    UINT32_MAX - 1ll,
                                    INT64_MAX,
                                    INT64_MIN,
                                    INT64_MAX / 2};
    uint64_t bits;
    double real;
    size_t n;
    switch (take(in, 1) % 7) {
    case 0:
        sqlite3_bind_null(statement, index);
        break;
    case 1:
        sqlite3_bind_int64(statement, index,
                           edges[take(in, 1) % (sizeof edges / sizeof *edges)]);
        break;
    case 2:
        sqlite3_bind_int64(statement, index, (int64_t)take(in, 2));
        break;
    case 3:
        bits = take(in, 8);
        memcpy(&real, &bits, sizeof real);
        sqlite3_bind_double(statement, index, real);
        break;
    case 4:
        n = (size_t)take(in, 1) % 32;
        if (n > in->count) n = in->count;
        sqlite3_bind_text(statement, index, (const char *)in->bytes, (int)n, SQLITE_STATIC);
        in->bytes += n, in->count -= n;
        break;
    case 5:
        sqlite3_bind_zeroblob(statement, index, (int)take(in, 2));
        break;
    default:
        sqlite3_bind_double(statement, index, (double)(int16_t)take(in, 2) / 16);
    }
}

static uint64_t row_count(sqlite3 *db, const char *table)
{
    char sql[64];
    snprintf(sql, sizeof sql, "SELECT count(*) FROM %s", table);
    sqlite3_stmt *statement = prepare(db, sql);
    fuzz_check(sqlite3_step(statement) == SQLITE_ROW);
    uint64_t rows = (uint64_t)sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    return rows;
}

static void set_value(sqlite3 *db, const char *table, uint64_t row, input *in)
{
    char sql[128];
    snprintf(sql, sizeof sql, "SELECT * FROM %s", table);
    sqlite3_stmt *columns = prepare(db, sql);
    int column = (int)(take(in, 1) % (uint64_t)sqlite3_column_count(columns));
    snprintf(sql, sizeof sql, "UPDATE OR IGNORE %s SET %s=?1 WHERE rowid=?2", table,
             sqlite3_column_name(columns, column));
    sqlite3_finalize(columns);
    sqlite3_stmt *update = prepare(db, sql);
    bind_value(update, 1, in);
    sqlite3_bind_int64(update, 2, (int64_t)row);
    sqlite3_step(update); // an id that is no number stays as it was
    sqlite3_finalize(update);
}

static void copy_row(sqlite3 *db, const char *table, uint64_t row, uint64_t to)
{
    char sql[160];
    snprintf(sql, sizeof sql,
             "CREATE TEMP TABLE one AS SELECT * FROM %s WHERE id=%llu;"
             "UPDATE one SET id=%llu;",
             table, (unsigned long long)row, (unsigned long long)to);
    exec(db, sql);
    snprintf(sql, sizeof sql, "REPLACE INTO %s SELECT * FROM one; DROP TABLE one", table);
    exec(db, sql);
}

// Changes bytes in the middle of a blob, or its length.
static void spoil_blob(sqlite3 *db, const char *table, const char *column, uint64_t row,
                       input *in)
{
    char sql[128];
    snprintf(sql, sizeof sql, "SELECT %s FROM %s WHERE id=%llu", column, table,
             (unsigned long long)row);
    sqlite3_stmt *get = prepare(db, sql);
    if (sqlite3_step(get) == SQLITE_ROW && sqlite3_column_type(get, 0) == SQLITE_BLOB) {
        size_t count = (size_t)sqlite3_column_bytes(get, 0);
        uint8_t *data = prom_alloc(count, 1);
        if (count) memcpy(data, sqlite3_column_blob(get, 0), count);
        for (uint64_t k = take(in, 1) % 4 + 1; k && count; k--) {
            uint64_t at = take(in, 2);
            data[at % count] = (uint8_t)take(in, 1);
        }
        uint64_t cut = take(in, 2);
        if (cut & 0x8000 && count) count = (size_t)(cut & 0x7fff) % count;
        snprintf(sql, sizeof sql, "UPDATE %s SET %s=?1 WHERE id=%llu", table, column,
                 (unsigned long long)row);
        sqlite3_stmt *set = prepare(db, sql);
        sqlite3_bind_blob64(set, 1, data, count, SQLITE_TRANSIENT);
        sqlite3_step(set);
        sqlite3_finalize(set);
        prom_free(data);
    }
    sqlite3_finalize(get);
}

static void edit(sqlite3 *db, input *in)
{
    static const struct {
        prom_table table;
        const char *column;
    } blobs[] = {{PROM_TABLE_CHUNK, "data"},
                 {PROM_TABLE_PROTOTYPE, "coverage"},
                 {PROM_TABLE_PROTOTYPE, "shares"},
                 {PROM_TABLE_ACCURACY, "value"}};
    uint64_t kind = take(in, 1) % 8;
    prom_table table = (prom_table)(take(in, 1) % PROM_TABLE_COUNT);
    const char *name = prom_tables[table].name;
    uint64_t rows = row_count(db, name), row = take(in, 1) % (rows ? rows : 1);
    char sql[96];
    switch (kind) {
    case 0:
        snprintf(sql, sizeof sql, "DELETE FROM %s WHERE id=%llu", name,
                 (unsigned long long)row);
        exec(db, sql);
        break;
    case 1:
        copy_row(db, name, row, take(in, 1));
        break;
    case 2:
    case 3:
        kind = take(in, 1) % (sizeof blobs / sizeof *blobs);
        spoil_blob(db, prom_tables[blobs[kind].table].name, blobs[kind].column, row, in);
        break;
    default:
        set_value(db, name, row, in);
    }
}

static void mend_checksums(sqlite3 *db)
{
    sqlite3_stmt *get = prepare(db, "SELECT id,data FROM chunk LIMIT 64");
    sqlite3_stmt *set = prepare(db, "UPDATE chunk SET checksum=?1 WHERE id=?2");
    int64_t sums[CHUNKS_MAX], ids[CHUNKS_MAX];
    int count = 0;
    while (count < CHUNKS_MAX && sqlite3_step(get) == SQLITE_ROW) {
        const void *data = sqlite3_column_blob(get, 1);
        ids[count] = sqlite3_column_int64(get, 0);
        sums[count++] = (int64_t)prom_hash(data, (size_t)sqlite3_column_bytes(get, 1), 0);
    }
    sqlite3_finalize(get);
    while (count--) {
        sqlite3_bind_int64(set, 1, sums[count]);
        sqlite3_bind_int64(set, 2, ids[count]);
        sqlite3_step(set);
        sqlite3_reset(set);
    }
    sqlite3_finalize(set);
}

static void mend_hashes(sqlite3 *db)
{
    mend_checksums(db);
    sqlite3_stmt *set =
        prepare(db, "UPDATE table_rows SET row_count=?1, hash=?2 WHERE id=?3 AND name=?4");
    for (int t = 0; t < PROM_TABLE_HASHED; t++) {
        uint64_t rows, hash;
        fuzz_check(prom_table_hash(db, (prom_table)t, NULL, UINT64_MAX, &rows, &hash) ==
                   SQLITE_OK);
        sqlite3_bind_int64(set, 1, (int64_t)rows);
        sqlite3_bind_int64(set, 2, (int64_t)hash);
        sqlite3_bind_int(set, 3, t);
        sqlite3_bind_text(set, 4, prom_tables[t].name, -1, SQLITE_STATIC);
        sqlite3_step(set);
        sqlite3_reset(set);
    }
    sqlite3_finalize(set);
}

static void tighten_schema(sqlite3 *db)
{
    exec(db, "PRAGMA writable_schema=ON");
    sqlite3_stmt *set = prepare(db, "UPDATE sqlite_schema SET sql=?1 WHERE name=?2");
    for (int t = 0; t < PROM_TABLE_COUNT; t++) {
        sqlite3_bind_text(set, 1, prom_tables[t].create, -1, SQLITE_STATIC);
        sqlite3_bind_text(set, 2, prom_tables[t].name, -1, SQLITE_STATIC);
        fuzz_check(sqlite3_step(set) == SQLITE_DONE);
        sqlite3_reset(set);
    }
    sqlite3_finalize(set);
    // The unique columns' indices have to be named, though nobody reads them.
    exec(db, "INSERT INTO sqlite_schema SELECT 'index','sqlite_autoindex_'||name||'_1',name,"
             "rootpage,NULL FROM sqlite_schema WHERE name IN ('meta','cost_profile')");
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    input in = {bytes, count};
    size_t size;
    const uint8_t *base = loose_file(&size);
    sqlite3 *db = load(base, size);
    exec(db, "PRAGMA journal_mode=OFF; BEGIN");
    for (int k = 0; k < EDITS_MAX && in.count; k++) edit(db, &in);
    mend_hashes(db);
    tighten_schema(db);
    exec(db, "COMMIT");
    sqlite3_int64 edited_size;
    uint8_t *edited = sqlite3_serialize(db, "main", &edited_size, 0);
    sqlite3_close(db);
    fuzz_file file = fuzz_file_make(edited, (size_t)edited_size);
    bool good = fuzz_read_container(file.path);
    fuzz_check(good || count); // edits only are what it is refused for
    close(file.fd);
    sqlite3_free(edited);
    return 0;
}

void fuzz_seeds(void (*each)(void *user, const char *name, const void *bytes, size_t count),
                void *user)
{
    static const uint8_t seeds[][12] = {
        {0},                        // a meta row goes
        {1, PROM_TABLE_NODE, 1, 7}, // a node in another's place
        {2, PROM_TABLE_CHUNK, 0, 0, 1, 0, 9, 77, 0, 11, 5},
        {3, PROM_TABLE_ACCURACY, 2, 3, 0, 0, 1, 200, 0x80, 3},
        {4, PROM_TABLE_NODE, 2, 2, 2, 0, 1}, // a node's parent
        {5, PROM_TABLE_MESH, 0, 1, 1, 9},    // a mesh of 2^32 vertices
        {6, PROM_TABLE_REPRESENTATION, 2, 2, 2, 0, 7},
        {7, PROM_TABLE_TEXTURE, 0, 2, 2, 32, 0},
        {4, PROM_TABLE_ROWS, 3, 2, 1, 11},
        {5, PROM_TABLE_VIEW_CELL, 3, 4, 1, 9},     // a cell of 2^32 leaves
        {6, PROM_TABLE_VIEW_GRID, 0, 6, 2, 0, 1},  // the cells' first chunk
        {2, PROM_TABLE_CHUNK, 14, 0, 0, 0, 20, 1}, // a byte of the cells' leaves
    };
    each(user, "none", "", 0);
    for (size_t i = 0; i < sizeof seeds / sizeof *seeds; i++) {
        char name[16];
        snprintf(name, sizeof name, "%zu", i);
        each(user, name, seeds[i], sizeof seeds[i]);
    }
}
