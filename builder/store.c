#include "builder/store.h"

#include "metaobj/base/hash.h"
#include "metaobj/base/log.h"

#include <errno.h>
#include <pthread.h>
#include <sqlite3.h>
#include <stdio.h>
#include <unistd.h>
#include <zstd.h>

#define FORMAT 1
#define APPLICATION_ID 0x50524f57 // "PROW"
#define ZSTD_FAST 1
// SQLite's limit for a blob is 10^9 bytes. A unit beyond it is done again each time.
#define UNIT_BYTES_MAX ((size_t)900000000)

struct prom_store {
    sqlite3 *db;
    char *path;
    prom_unit_kind redo;
    pthread_mutex_t lock;
    sqlite3_stmt *get, *put, *touch;
};

char *prom_store_path(const char *model_path)
{
    return prom_format("%s.work", model_path);
}

static prom_status fail(prom_store *s, prom_error *error)
{
    int rc = s->db ? sqlite3_errcode(s->db) : SQLITE_NOMEM;
    const char *why = rc == SQLITE_FULL ? "the disk is full"
                      : s->db           ? sqlite3_errmsg(s->db)
                                        : "";
    const char *then = "start again, the build will go on";
    if (rc == SQLITE_FULL) then = "make room and start again, the build will go on";
    if (rc == SQLITE_BUSY) then = "another program works on it";
    if (rc == SQLITE_CANTOPEN) then = "see what stands there";
    return prom_fail(error, PROM_ERR_OUTPUT, "cannot write %s: %s; %s", s->path, why, then);
}

static void close_database(prom_store *s)
{
    sqlite3_finalize(s->get);
    sqlite3_finalize(s->put);
    sqlite3_finalize(s->touch);
    sqlite3_close(s->db);
    s->db = NULL;
    s->get = s->put = s->touch = NULL;
}

#define TEXT_(x) #x
#define TEXT(x) TEXT_(x)

#define MARKS                                                                                  \
    "PRAGMA application_id=" TEXT(APPLICATION_ID) "; PRAGMA user_version=" TEXT(FORMAT) ";"
// Losing the last units with the power is no harm, so nothing is synced; the rollback journal
// covers a killed process. The table comes with its marks, or not at all.
static const char schema[] =
    "PRAGMA page_size=16384; PRAGMA auto_vacuum=FULL; PRAGMA journal_mode=DELETE;"
    "PRAGMA synchronous=OFF; PRAGMA locking_mode=EXCLUSIVE; PRAGMA temp_store=MEMORY;"
    "BEGIN IMMEDIATE;" MARKS
    "CREATE TABLE IF NOT EXISTS unit(id INTEGER PRIMARY KEY, kind INTEGER NOT NULL,"
    " key INTEGER NOT NULL, bytes INTEGER NOT NULL, checksum INTEGER NOT NULL,"
    " data BLOB NOT NULL, UNIQUE(kind, key)) STRICT;"
    "COMMIT;"
    "CREATE TEMP TABLE used(kind INTEGER, key INTEGER, PRIMARY KEY(kind, key)) WITHOUT ROWID;";

static bool read_number(sqlite3 *db, const char *sql, int64_t *value)
{
    sqlite3_stmt *statement;
    bool good = sqlite3_prepare_v2(db, sql, -1, &statement, NULL) == SQLITE_OK &&
                sqlite3_step(statement) == SQLITE_ROW;
    if (good) *value = sqlite3_column_int64(statement, 0);
    sqlite3_finalize(statement);
    return good;
}

typedef enum owner { OURS, OF_ANOTHER_FORMAT, SOMEBODYS, UNREADABLE } owner;

// An empty file is ours too. Only what is ours is touched by SQL.
static owner owner_of(sqlite3 *db)
{
    int64_t id, format, tables;
    if (!read_number(db, "PRAGMA application_id", &id) ||
        !read_number(db, "PRAGMA user_version", &format) ||
        !read_number(db, "SELECT count(*) FROM sqlite_schema", &tables))
        return UNREADABLE;
    if (id == 0 && tables == 0) return OURS;
    if (id != APPLICATION_ID) return SOMEBODYS;
    return format == FORMAT ? OURS : OF_ANOTHER_FORMAT;
}

static bool prepare(prom_store *s, const char *sql, sqlite3_stmt **statement)
{
    return sqlite3_prepare_v2(s->db, sql, -1, statement, NULL) == SQLITE_OK;
}

static bool open_database(prom_store *s, owner *found)
{
    *found = UNREADABLE;
    char *name = s->path[0] == '/' ? prom_strdup(s->path) : prom_format("./%s", s->path);
    int rc = sqlite3_open_v2(
        name, &s->db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, NULL);
    prom_free(name);
    if (rc != SQLITE_OK) return false;
    sqlite3_db_config(s->db, SQLITE_DBCONFIG_DEFENSIVE, 1, NULL);
    sqlite3_db_config(s->db, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, NULL);
    *found = owner_of(s->db);
    return *found == OURS && sqlite3_exec(s->db, schema, NULL, NULL, NULL) == SQLITE_OK &&
           prepare(s, "SELECT bytes, checksum, data FROM unit WHERE kind=? AND key=?",
                   &s->get) &&
           prepare(s, "INSERT OR IGNORE INTO used VALUES(?,?)", &s->touch) &&
           prepare(s, "INSERT OR REPLACE INTO unit VALUES(NULL,?,?,?,?,?)", &s->put);
}

static void unlink_files(const char *path)
{
    char *journal = prom_format("%s-journal", path);
    unlink(path);
    unlink(journal);
    prom_free(journal);
}

// A database, or the beginning of one; anything else is somebody's file.
static bool looks_like_a_store(const char *path)
{
    static const char magic[16] = "SQLite format 3";
    char start[16];
    FILE *f = fopen(path, "rb");
    size_t n = f ? fread(start, 1, sizeof start, f) : 0;
    if (f) fclose(f);
    return f && !memcmp(start, magic, n);
}

// Damaged, of another format, or deleted by somebody while we work in it: what it held is lost,
// which costs time only.
static bool is_lost(sqlite3 *db)
{
    int rc = sqlite3_errcode(db);
    return rc == SQLITE_CORRUPT || rc == SQLITE_NOTADB || rc == SQLITE_ERROR ||
           sqlite3_extended_errcode(db) == SQLITE_READONLY_DBMOVED;
}

static bool start_over(prom_store *s)
{
    owner found;
    prom_log(PROM_LOG_WARNING, "%s: cannot be used, a new one is begun", s->path);
    close_database(s);
    unlink_files(s->path);
    return open_database(s, &found);
}

prom_store *prom_store_open(const char *model_path, prom_unit_kind redo, prom_error *error)
{
    prom_store *s = prom_calloc(1, sizeof *s);
    owner found;
    s->path = prom_store_path(model_path);
    s->redo = redo;
    pthread_mutex_init(&s->lock, NULL);
    if (open_database(s, &found)) return s;
    bool is_database = !s->db || sqlite3_errcode(s->db) != SQLITE_NOTADB;
    if (found == SOMEBODYS || (!is_database && !looks_like_a_store(s->path)))
        prom_fail(error, PROM_ERR_OUTPUT,
                  "%s: is not the work file of a build, which would stand there; rename it",
                  s->path);
    else if ((found == OF_ANOTHER_FORMAT || (s->db && is_lost(s->db))) && start_over(s))
        return s;
    else
        fail(s, error);
    prom_store_close(s);
    return NULL;
}

void prom_store_close(prom_store *store)
{
    if (!store) return;
    close_database(store);
    pthread_mutex_destroy(&store->lock);
    prom_free(store->path);
    prom_free(store);
}

prom_status prom_store_delete(const char *model_path, prom_error *error)
{
    char *path = prom_store_path(model_path);
    prom_status status = PROM_OK;
    if (unlink(path) && errno != ENOENT)
        status =
            prom_fail(error, PROM_ERR_OUTPUT, "cannot delete %s: %s", path, strerror(errno));
    else
        unlink_files(path);
    prom_free(path);
    return status;
}

prom_status prom_store_prune(prom_store *store, prom_unit_kind first, prom_unit_kind end,
                             prom_error *error)
{
    char sql[256];
    snprintf(sql, sizeof sql,
             "DELETE FROM unit WHERE kind>=%d AND kind<%d AND NOT EXISTS"
             " (SELECT 1 FROM used WHERE used.kind=unit.kind AND used.key=unit.key)",
             (int)first, (int)end);
    bool good = sqlite3_exec(store->db, sql, NULL, NULL, NULL) == SQLITE_OK;
    if (!good && is_lost(store->db)) good = start_over(store);
    return good ? PROM_OK : fail(store, error);
}

static void bind_key(sqlite3_stmt *statement, prom_unit_kind kind, uint64_t key)
{
    sqlite3_bind_int(statement, 1, kind);
    sqlite3_bind_int64(statement, 2, (int64_t)key);
}

static void note_use(prom_store *s, prom_unit_kind kind, uint64_t key)
{
    bind_key(s->touch, kind, key);
    sqlite3_step(s->touch);
    sqlite3_reset(s->touch);
}

// The compressed bytes of a unit, copied so that the lock can be given back; false if there is
// none or its checksum is wrong.
static bool fetch(prom_store *s, prom_unit_kind kind, uint64_t key, prom_pack *packed,
                  size_t *bytes)
{
    bind_key(s->get, kind, key);
    bool good = sqlite3_step(s->get) == SQLITE_ROW;
    if (good) {
        int64_t claimed = sqlite3_column_int64(s->get, 0);
        const void *data = sqlite3_column_blob(s->get, 2);
        size_t size = (size_t)sqlite3_column_bytes(s->get, 2);
        good = data && claimed > 0 && (uint64_t)claimed <= UNIT_BYTES_MAX &&
               (int64_t)prom_hash(data, size, (uint64_t)claimed) ==
                   sqlite3_column_int64(s->get, 1);
        if (good) prom_pack_bytes(packed, data, size);
        *bytes = (size_t)claimed;
    }
    sqlite3_reset(s->get);
    if (good) note_use(s, kind, key);
    return good;
}

bool prom_store_get(prom_store *store, prom_unit_kind kind, uint64_t key, prom_pack *pack)
{
    prom_pack packed = {0};
    size_t bytes = 0;
    if (kind >= store->redo) return false;
    pthread_mutex_lock(&store->lock);
    bool good = fetch(store, kind, key, &packed, &bytes);
    pthread_mutex_unlock(&store->lock);
    if (good) {
        pack->count = 0;
        prom_array_reserve(pack, bytes);
        good = ZSTD_decompress(pack->data, bytes, packed.data, packed.count) == bytes;
        pack->count = bytes;
    }
    prom_array_finish(&packed);
    return good;
}

void prom_store_touch(prom_store *store, prom_unit_kind kind, uint64_t key)
{
    pthread_mutex_lock(&store->lock);
    note_use(store, kind, key);
    pthread_mutex_unlock(&store->lock);
}

// With the lock held.
static bool insert(prom_store *s, prom_unit_kind kind, uint64_t key, size_t bytes,
                   const void *packed, size_t packed_bytes)
{
    bind_key(s->put, kind, key);
    sqlite3_bind_int64(s->put, 3, (int64_t)bytes);
    sqlite3_bind_int64(s->put, 4, (int64_t)prom_hash(packed, packed_bytes, bytes));
    sqlite3_bind_blob64(s->put, 5, packed, packed_bytes, SQLITE_STATIC);
    bool good = sqlite3_step(s->put) == SQLITE_DONE;
    sqlite3_reset(s->put); // what went wrong stays the connection's last error
    sqlite3_clear_bindings(s->put);
    if (good) note_use(s, kind, key);
    return good;
}

prom_status prom_store_put(prom_store *store, prom_unit_kind kind, uint64_t key,
                           const prom_pack *pack, prom_error *error)
{
    if (!pack->count || pack->count > UNIT_BYTES_MAX) return PROM_OK;
    prom_pack packed = {0};
    prom_array_reserve(&packed, ZSTD_compressBound(pack->count));
    size_t bytes =
        ZSTD_compress(packed.data, packed.capacity, pack->data, pack->count, ZSTD_FAST);
    prom_status status = PROM_OK;
    if (!ZSTD_isError(bytes)) {
        pthread_mutex_lock(&store->lock);
        bool good = insert(store, kind, key, pack->count, packed.data, bytes);
        if (!good && is_lost(store->db))
            good =
                start_over(store) && insert(store, kind, key, pack->count, packed.data, bytes);
        if (!good) status = fail(store, error);
        pthread_mutex_unlock(&store->lock);
    }
    prom_array_finish(&packed);
    return status;
}
