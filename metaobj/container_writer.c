// Writing a .prom container: the file's life from .part to its name, bulk data, meta and
// stages.
#include "metaobj/container_writer.h"

#include "metaobj/base/log.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

// Whether the .part's name still leads to the file that we hold.
static bool is_ours(const prom_writer *w)
{
    struct stat held, named;
    return !fstat(w->lock_fd, &held) && !lstat(w->part_path, &named) &&
           held.st_ino == named.st_ino && held.st_dev == named.st_dev;
}

static prom_status try_lock(prom_writer *w, prom_error *error)
{
    // A pipe under this name must not make us wait.
    w->lock_fd =
        open(w->part_path, O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK, 0666);
    struct stat info;
    if (w->lock_fd < 0 || fstat(w->lock_fd, &info))
        return prom_writer_fail_errno(w, errno, error);
    if (!S_ISREG(info.st_mode))
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "cannot write %s: it is no plain file; remove it", w->part_path);
    if (flock(w->lock_fd, LOCK_EX | LOCK_NB))
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "another build is writing %s; wait for it or choose another output",
                         w->part_path);
    return PROM_OK;
}

static void unlock(prom_writer *w)
{
    if (w->lock_fd >= 0) close(w->lock_fd);
    w->lock_fd = -1;
}

// Opens and locks the .part. Another build may finish and rename its .part between our open and
// our lock; then the lock is on a file that has left the name, and we try again.
static prom_status lock_part(prom_writer *w, prom_error *error)
{
    prom_status status = PROM_OK;
    for (int attempt = 0; attempt < 100 && !status; attempt++) {
        status = try_lock(w, error);
        if (!status && is_ours(w)) return PROM_OK;
        unlock(w);
    }
    return status ? status
                  : prom_fail(error, PROM_ERR_OUTPUT,
                              "cannot lock %s; is another build writing it?", w->part_path);
}

static void unlink_journal(const char *part_path)
{
    char *journal = prom_format("%s-journal", part_path);
    unlink(journal);
    prom_free(journal);
}

prom_status prom_writer_open_database(prom_writer *writer, prom_error *error)
{
    prom_writer *w = writer;
    char *name = prom_sqlite_path(w->part_path);
    int rc = sqlite3_open_v2(name, &w->db, SQLITE_OPEN_READWRITE | SQLITE_OPEN_NOMUTEX, NULL);
    prom_free(name);
    if (rc != SQLITE_OK) return prom_writer_fail(w, error);
    char setup[256];
    snprintf(setup, sizeof setup,
             "PRAGMA page_size=65536; PRAGMA journal_mode=DELETE; PRAGMA synchronous=OFF;"
             "PRAGMA application_id=%d; PRAGMA user_version=%d;",
             PROM_CONTAINER_APPLICATION_ID, PROM_CONTAINER_VERSION);
    prom_status status = prom_writer_exec(w, setup, error);
    return status ? status : prom_writer_exec(w, "BEGIN", error);
}

static prom_status create_tables(prom_writer *w, prom_error *error)
{
    prom_status status = PROM_OK;
    for (int t = 0; t < PROM_TABLE_COUNT && !status; t++)
        status = prom_writer_exec(w, prom_tables[t].create, error);
    return status;
}

prom_writer *prom_writer_start(const char *path, prom_error *error)
{
    struct stat existing;
    if (!*path || (!stat(path, &existing) && !S_ISREG(existing.st_mode))) {
        prom_fail(error, PROM_ERR_OUTPUT, "cannot write '%s': it is no plain file", path);
        return NULL;
    }
    prom_writer *w = prom_calloc(1, sizeof *w);
    w->path = prom_strdup(path);
    w->part_path = prom_format("%s.part", path);
    w->lock_fd = -1;
    prom_status status = lock_part(w, error);
    // Only now, under the lock, is a leftover known to belong to nobody.
    if (!status) unlink_journal(w->part_path);
    if (!status && ftruncate(w->lock_fd, 0)) status = prom_writer_fail_errno(w, errno, error);
    if (!status) return w;
    prom_writer_destroy(w);
    return NULL;
}

prom_writer *prom_writer_create(const char *path, prom_error *error)
{
    prom_writer *w = prom_writer_start(path, error);
    if (w && !prom_writer_open_database(w, error) && !create_tables(w, error)) return w;
    prom_writer_destroy(w);
    return NULL;
}

static void close_database(prom_writer *w)
{
    for (int t = 0; t < PROM_TABLE_COUNT; t++) sqlite3_finalize(w->insert[t]);
    memset(w->insert, 0, sizeof w->insert);
    sqlite3_close(w->db);
    w->db = NULL;
}

void prom_writer_destroy(prom_writer *writer)
{
    if (!writer) return;
    close_database(writer);
    if (writer->lock_fd >= 0) {
        if (!writer->finished && is_ours(writer)) {
            unlink(writer->part_path);
            unlink_journal(writer->part_path);
        }
        unlock(writer);
    }
    for (size_t i = 0; i < writer->meta.count; i++) {
        prom_free(writer->meta.data[i].key);
        prom_free(writer->meta.data[i].value);
    }
    prom_array_finish(&writer->meta);
    prom_array_finish(&writer->meshes);
    prom_array_finish(&writer->textures);
    prom_array_finish(&writer->encoded);
    prom_free(writer->path);
    prom_free(writer->part_path);
    prom_free(writer);
}

prom_status prom_writer_set_meta(prom_writer *writer, const char *key, const char *value,
                                 prom_error *error)
{
    (void)error;
    for (size_t i = 0; i < writer->meta.count; i++) {
        prom_meta_entry *m = &writer->meta.data[i];
        if (strcmp(m->key, key)) continue;
        prom_free(m->value);
        m->value = prom_strdup(value);
        return PROM_OK;
    }
    prom_array_push(&writer->meta, (prom_meta_entry){prom_strdup(key), prom_strdup(value)});
    return PROM_OK;
}

static prom_status replace_stage(prom_writer *w, const char *name, uint64_t content_hash,
                                 double ms, bool *replaced, prom_error *error)
{
    sqlite3_stmt *update;
    const char *sql = "UPDATE stage SET content_hash=?2,ms=?3 WHERE name=?1";
    *replaced = false;
    if (sqlite3_prepare_v2(w->db, sql, -1, &update, NULL) != SQLITE_OK)
        return prom_writer_fail(w, error);
    sqlite3_bind_text(update, 1, name, -1, SQLITE_STATIC);
    sqlite3_bind_int64(update, 2, (int64_t)content_hash);
    sqlite3_bind_double(update, 3, ms);
    prom_status status =
        sqlite3_step(update) == SQLITE_DONE ? PROM_OK : prom_writer_fail(w, error);
    *replaced = sqlite3_changes(w->db) > 0;
    sqlite3_finalize(update);
    return status;
}

prom_status prom_writer_add_stage(prom_writer *writer, const char *name, uint64_t content_hash,
                                  double ms, prom_error *error)
{
    if (prom_writer_ready(writer, error)) return PROM_ERR_OUTPUT;
    if (!isfinite(ms)) ms = 0;
    bool replaced;
    prom_status status = replace_stage(writer, name, content_hash, ms, &replaced, error);
    if (!status && !replaced) {
        prom_row_out row = prom_row_begin(writer, PROM_TABLE_STAGE);
        prom_put_text(&row, name);
        prom_put_int(&row, (int64_t)content_hash);
        prom_put_real(&row, ms);
        status = prom_row_end(&row, error);
    }
    return status ? status : prom_writer_exec(writer, "COMMIT; BEGIN", error);
}

static prom_status write_meta(prom_writer *w, prom_error *error)
{
    for (size_t i = 0; i < w->meta.count; i++) {
        prom_row_out row = prom_row_begin(w, PROM_TABLE_META);
        prom_put_text(&row, w->meta.data[i].key);
        prom_put_text(&row, w->meta.data[i].value);
        prom_status status = prom_row_end(&row, error);
        if (status) return status;
    }
    return PROM_OK;
}

static prom_status write_row_hashes(prom_writer *w, prom_error *error)
{
    for (int t = 0; t < PROM_TABLE_HASHED; t++) {
        uint64_t rows, hash;
        if (prom_table_hash(w->db, (prom_table)t, NULL, UINT64_MAX, &rows, &hash) != SQLITE_OK)
            return prom_writer_fail(w, error);
        prom_row_out row = prom_row_begin(w, PROM_TABLE_ROWS);
        prom_put_text(&row, prom_tables[t].name);
        prom_put_int(&row, (int64_t)rows);
        prom_put_int(&row, (int64_t)hash);
        prom_status status = prom_row_end(&row, error);
        if (status) return status;
    }
    return PROM_OK;
}

// The name in the folder should survive a power cut too. Too late to call the build off: the
// finished file is in place.
static void sync_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    char *folder = slash ? prom_format("%.*s/", (int)(slash - path), path) : prom_strdup(".");
    int fd = open(folder, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    // Some file systems cannot sync folders and say EINVAL: nothing more can be done there.
    if (fd < 0 || (fsync(fd) && errno != EINVAL))
        prom_log(PROM_LOG_WARNING, "%s: the folder cannot be synced: %s", folder,
                 strerror(errno));
    if (fd >= 0) close(fd);
    prom_free(folder);
}

static prom_status fail_removed(prom_writer *w, prom_error *error)
{
    w->broken = true;
    return prom_fail(error, PROM_ERR_OUTPUT,
                     "cannot write %s: another program has removed %s meanwhile; build again",
                     w->path, w->part_path);
}

prom_status prom_writer_finish(prom_writer *writer, prom_error *error)
{
    if (prom_writer_ready(writer, error)) return PROM_ERR_OUTPUT;
    if (!writer->has_model)
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "%s: cannot be finished: it holds no model yet", writer->path);
    if (!is_ours(writer)) return fail_removed(writer, error);
    prom_status status =
        prom_writer_exec(writer, "COMMIT; PRAGMA synchronous=FULL; BEGIN", error);
    if (!status) status = write_meta(writer, error);
    if (!status) status = write_row_hashes(writer, error);
    if (!status) status = prom_writer_exec(writer, "COMMIT", error);
    if (status) return status;
    close_database(writer);
    if (fsync(writer->lock_fd)) return prom_writer_fail_errno(writer, errno, error);
    if (!is_ours(writer)) return fail_removed(writer, error);
    if (rename(writer->part_path, writer->path))
        return prom_writer_fail_errno(writer, errno, error);
    writer->finished = true;
    sync_folder(writer->path);
    return PROM_OK;
}
