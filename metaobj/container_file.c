// The reader's way to its file: opened once, checked to be a regular file with a sound header,
// then given to SQLite through a file system of our own that knows nothing but this one file.
// So nothing beside it is ever looked at (a planted journal or write-ahead log), no lock is
// taken, no temporary file made, and what was checked is what is read, whatever happens to the
// name meanwhile. There is no memory map on purpose: pages that change under SQLite's hands, or
// a file that shrinks (SIGBUS), would be a crash; read pages are copies.
#include "metaobj/container_reader.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#define PAGE_BYTES 65536
#define HEADER_BYTES 100 // of an SQLite file

// ---- SQLite's view of the file

typedef struct open_file {
    sqlite3_file base;
    int fd;
    int64_t bytes; // when it was opened
} open_file;

// The descriptor stays the container's.
static int file_close(sqlite3_file *file)
{
    (void)file;
    return SQLITE_OK;
}

static int file_read(sqlite3_file *file, void *out, int count, sqlite3_int64 offset)
{
    const open_file *f = (const open_file *)file;
    char *to = out;
    while (count > 0) {
        ssize_t n = pread(f->fd, to, (size_t)count, offset);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return SQLITE_IOERR_READ;
        if (n == 0) break;
        to += n;
        offset += n;
        count -= (int)n;
    }
    if (count == 0) return SQLITE_OK;
    if (offset < f->bytes) return SQLITE_IOERR_READ; // cut short since it was opened
    memset(to, 0, (size_t)count);
    return SQLITE_IOERR_SHORT_READ;
}

static int file_write(sqlite3_file *file, const void *data, int count, sqlite3_int64 offset)
{
    (void)file, (void)data, (void)count, (void)offset;
    return SQLITE_READONLY;
}

static int file_truncate(sqlite3_file *file, sqlite3_int64 bytes)
{
    (void)file, (void)bytes;
    return SQLITE_READONLY;
}

static int file_sync(sqlite3_file *file, int flags)
{
    (void)file, (void)flags;
    return SQLITE_OK;
}

static int file_size(sqlite3_file *file, sqlite3_int64 *bytes)
{
    *bytes = ((const open_file *)file)->bytes;
    return SQLITE_OK;
}

static int file_lock(sqlite3_file *file, int level)
{
    (void)file, (void)level;
    return SQLITE_OK;
}

static int file_is_reserved(sqlite3_file *file, int *reserved)
{
    (void)file;
    *reserved = 0;
    return SQLITE_OK;
}

static int file_control(sqlite3_file *file, int operation, void *argument)
{
    (void)file, (void)operation, (void)argument;
    return SQLITE_NOTFOUND;
}

static int file_sector_bytes(sqlite3_file *file)
{
    (void)file;
    return PAGE_BYTES;
}

// Then SQLite asks for no locks and no journal.
static int file_characteristics(sqlite3_file *file)
{
    (void)file;
    return SQLITE_IOCAP_IMMUTABLE;
}

static const sqlite3_io_methods file_methods = {
    .iVersion = 1, // no memory map, no shared memory
    .xClose = file_close,
    .xRead = file_read,
    .xWrite = file_write,
    .xTruncate = file_truncate,
    .xSync = file_sync,
    .xFileSize = file_size,
    .xLock = file_lock,
    .xUnlock = file_lock,
    .xCheckReservedLock = file_is_reserved,
    .xFileControl = file_control,
    .xSectorSize = file_sector_bytes,
    .xDeviceCharacteristics = file_characteristics,
};

// The name is "/" and the number of the descriptor.
static int system_open(sqlite3_vfs *vfs, const char *name, sqlite3_file *file, int flags,
                       int *out_flags)
{
    (void)vfs;
    open_file *f = (open_file *)file;
    *f = (open_file){0};
    struct stat info;
    if (!name || !(flags & SQLITE_OPEN_MAIN_DB)) return SQLITE_CANTOPEN;
    f->fd = (int)strtol(name + 1, NULL, 10);
    if (fstat(f->fd, &info)) return SQLITE_CANTOPEN;
    f->bytes = info.st_size;
    f->base.pMethods = &file_methods;
    if (out_flags) *out_flags = SQLITE_OPEN_READONLY | SQLITE_OPEN_MAIN_DB;
    return SQLITE_OK;
}

static int system_delete(sqlite3_vfs *vfs, const char *name, int sync)
{
    (void)vfs, (void)name, (void)sync;
    return SQLITE_IOERR_DELETE;
}

static int system_access(sqlite3_vfs *vfs, const char *name, int flags, int *result)
{
    (void)vfs, (void)name, (void)flags;
    *result = 0;
    return SQLITE_OK;
}

static int system_full_path(sqlite3_vfs *vfs, const char *name, int size, char *out)
{
    (void)vfs;
    return snprintf(out, (size_t)size, "%s", name) < size ? SQLITE_OK : SQLITE_CANTOPEN;
}

static int system_randomness(sqlite3_vfs *vfs, int count, char *out)
{
    (void)vfs;
    memset(out, 0, (size_t)count);
    return count;
}

static int system_sleep(sqlite3_vfs *vfs, int microseconds)
{
    (void)vfs;
    return microseconds;
}

static int system_time(sqlite3_vfs *vfs, double *day)
{
    (void)vfs;
    *day = 0;
    return SQLITE_OK;
}

static int system_last_error(sqlite3_vfs *vfs, int size, char *text)
{
    (void)vfs, (void)size, (void)text;
    return errno;
}

// SQLite links it into its list under its own mutex: the one global of the reader.
static sqlite3_vfs file_system = {
    .iVersion = 1,
    .szOsFile = sizeof(open_file),
    .mxPathname = 32,
    .zName = "promenade-reader",
    .xOpen = system_open,
    .xDelete = system_delete,
    .xAccess = system_access,
    .xFullPathname = system_full_path,
    .xRandomness = system_randomness,
    .xSleep = system_sleep,
    .xCurrentTime = system_time,
    .xGetLastError = system_last_error,
};

// ---- the file itself

static uint32_t big_endian(const uint8_t *bytes)
{
    return (uint32_t)bytes[0] << 24 | (uint32_t)bytes[1] << 16 | (uint32_t)bytes[2] << 8 |
           bytes[3];
}

// What the writer leaves at fixed places (sqlite.org/fileformat2.html, section 1.3). Anything
// else is another layout of pages, which no container has.
static bool has_our_layout(const uint8_t *header)
{
    static const uint8_t fixed[8] = {
        PAGE_BYTES >> 8 & 255, PAGE_BYTES >> 16, 1, 1, 0, 64, 32, 32};
    if (memcmp(header + 16, fixed, sizeof fixed)) return false;
    if (big_endian(header + 44) != 4 || big_endian(header + 56) != 1) return false; // UTF-8
    if (big_endian(header + 48) || big_endian(header + 52) || big_endian(header + 64))
        return false; // suggested cache, pages that point back
    for (int i = 72; i < 92; i++)
        if (header[i]) return false;
    return big_endian(header + 24) == big_endian(header + 92); // the page count is of now
}

static prom_status check_header(const prom_container *c, const uint8_t header[HEADER_BYTES],
                                prom_error *error)
{
    if (memcmp(header, "SQLite format 3", 16) ||
        big_endian(header + 68) != PROM_CONTAINER_APPLICATION_ID)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s is not a .prom container; make one with 'promenade build'",
                         c->path);
    uint32_t version = big_endian(header + 60);
    if (version != PROM_CONTAINER_VERSION)
        return prom_fail(
            error, PROM_ERR_INPUT, "%s has container format %u, this program reads %u; %s",
            c->path, version, PROM_CONTAINER_VERSION,
            version > PROM_CONTAINER_VERSION ? "use a newer promenade" : "build it again");
    if (header[18] == 2 && header[19] == 2)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s has a write-ahead log, which no finished container has; run "
                         "sqlite3 FILE 'PRAGMA journal_mode=DELETE', or build it again",
                         c->path);
    if (!has_our_layout(header))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: its header is damaged; copy or build it again", c->path);
    uint64_t expected = (uint64_t)PAGE_BYTES * big_endian(header + 28);
    if (expected != c->file_bytes)
        return prom_fail(error, PROM_ERR_INPUT,
                         expected > c->file_bytes
                             ? "%s is cut short at byte %llu of %llu; copy or build it again"
                             : "%s has %llu bytes, %llu belong to it; copy or build it again",
                         c->path, (unsigned long long)c->file_bytes,
                         (unsigned long long)expected);
    return PROM_OK;
}

static prom_status fail_open(const prom_container *c, prom_error *error)
{
    return prom_fail(error, PROM_ERR_INPUT, "cannot open %s: %s", c->path, strerror(errno));
}

static prom_status open_and_check(prom_container *c, prom_error *error)
{
    // Not to wait for the other end of a pipe.
    c->fd = open(c->path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    struct stat info;
    if (c->fd < 0 || fstat(c->fd, &info)) return fail_open(c, error);
    if (!S_ISREG(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s is no file; name a .prom container",
                         c->path);
    if (!info.st_size)
        return prom_fail(error, PROM_ERR_INPUT, "%s is empty; copy or build it again", c->path);
    c->file_bytes = (uint64_t)info.st_size;
    uint8_t header[HEADER_BYTES] = {0};
    ssize_t n;
    while ((n = pread(c->fd, header, sizeof header, 0)) < 0 && errno == EINTR)
        ;
    if (n < 0) return fail_open(c, error);
    return check_header(c, header, error);
}

// No more of SQLite than the reader's own few statements need.
static void confine(sqlite3 *db)
{
    static const int switches[][2] = {
        {SQLITE_DBCONFIG_DEFENSIVE, 1},
        {SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0},
        {SQLITE_DBCONFIG_ENABLE_TRIGGER, 0},
        {SQLITE_DBCONFIG_ENABLE_VIEW, 0},
        {SQLITE_DBCONFIG_ENABLE_LOAD_EXTENSION, 0},
        {SQLITE_DBCONFIG_ENABLE_FTS3_TOKENIZER, 0},
        {SQLITE_DBCONFIG_WRITABLE_SCHEMA, 0},
        {SQLITE_DBCONFIG_DQS_DML, 0},
        {SQLITE_DBCONFIG_DQS_DDL, 0},
    };
    static const int limits[][2] = {
        {SQLITE_LIMIT_LENGTH, (int)PROM_CONTAINER_CHUNK_BYTES + (1 << 20)},
        {SQLITE_LIMIT_SQL_LENGTH, 4096},
        {SQLITE_LIMIT_COLUMN, 32},
        {SQLITE_LIMIT_EXPR_DEPTH, 8},
        {SQLITE_LIMIT_COMPOUND_SELECT, 2},
        {SQLITE_LIMIT_VDBE_OP, 1000},
        {SQLITE_LIMIT_FUNCTION_ARG, 4},
        {SQLITE_LIMIT_ATTACHED, 0},
        {SQLITE_LIMIT_LIKE_PATTERN_LENGTH, 8},
        {SQLITE_LIMIT_VARIABLE_NUMBER, 4},
        {SQLITE_LIMIT_TRIGGER_DEPTH, 1},
        {SQLITE_LIMIT_WORKER_THREADS, 0},
    };
    for (size_t i = 0; i < sizeof switches / sizeof *switches; i++)
        sqlite3_db_config(db, switches[i][0], switches[i][1], NULL);
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        sqlite3_limit(db, limits[i][0], limits[i][1]);
}

prom_status prom_container_open_file(prom_container *container, prom_error *error)
{
    prom_container *c = container;
    prom_status status = open_and_check(c, error);
    if (status) return status;
    char name[16];
    snprintf(name, sizeof name, "/%d", c->fd);
    int rc = sqlite3_vfs_register(&file_system, 0);
    if (rc == SQLITE_OK)
        rc = sqlite3_open_v2(
            name, &c->db, SQLITE_OPEN_READONLY | SQLITE_OPEN_NOMUTEX | SQLITE_OPEN_PRIVATECACHE,
            file_system.zName);
    if (rc == SQLITE_OK) {
        confine(c->db);
        rc = sqlite3_exec(c->db, "PRAGMA cell_size_check=ON; PRAGMA temp_store=MEMORY", NULL,
                          NULL, NULL);
    }
    if (rc == SQLITE_OK) return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT, "cannot open %s: %s", c->path, sqlite3_errstr(rc));
}
