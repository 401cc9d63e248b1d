// For tests of what happens when a disk fails: a file system for SQLite that passes everything
// on to the usual one, counts the calls that write, and lets the n-th of them fail.
//
//     failing_vfs_install();                              // before the first sqlite3_open
//     failing_vfs_arm(FAILING_ANY, SQLITE_FULL, 0, false); // 0: count only
//     run(); long calls = failing_vfs_calls();
//     for (long n = 1; n <= calls; n++) { failing_vfs_arm(FAILING_ANY, SQLITE_FULL, n, true);
//     ... }
//
// It is SQLite's default from then on, so whatever opens a database without naming a file
// system is under test. Counters are atomic: any thread may write.
#ifndef PROM_TESTS_FAILING_VFS_H
#define PROM_TESTS_FAILING_VFS_H

#include <sqlite3.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stddef.h>

typedef enum failing_calls {
    FAILING_WRITE = 1,
    FAILING_TRUNCATE = 2,
    FAILING_SYNC = 4,
    FAILING_OPEN = 8, // for writing, journals and temporary files included
    FAILING_DELETE = 16,
    FAILING_ANY = 31,
} failing_calls;

static struct failing_state {
    sqlite3_vfs vfs, *real;
    atomic_uint mask;
    atomic_int code; // SQLITE_FULL, or SQLITE_IOERR: the code of its kind for each call
    atomic_long fail_at, calls, failed;
    atomic_bool for_good; // all later calls fail too, as on a disk that stays full
} failing;

typedef struct failing_file {
    sqlite3_file base;
    sqlite3_file *real; // behind this struct
} failing_file;

// From now on the n-th call (from 1) of the kinds in `mask` fails with `code`, and if
// `for_good` those after it; n = 0: none does.
static inline void failing_vfs_arm(unsigned mask, int code, long n, bool for_good)
{
    atomic_store(&failing.mask, mask);
    atomic_store(&failing.code, code);
    atomic_store(&failing.fail_at, n);
    atomic_store(&failing.for_good, for_good);
    atomic_store(&failing.calls, 0);
    atomic_store(&failing.failed, 0);
}

// Calls of the armed kinds since failing_vfs_arm, and how many of them failed.
static inline long failing_vfs_calls(void)
{
    return atomic_load(&failing.calls);
}

static inline long failing_vfs_failed(void)
{
    return atomic_load(&failing.failed);
}

// SQLITE_OK, or what the call is to return instead of doing its work.
static inline int failing_gate(failing_calls kind, int io_error)
{
    if (!(atomic_load(&failing.mask) & (unsigned)kind)) return SQLITE_OK;
    long n = atomic_fetch_add(&failing.calls, 1) + 1, at = atomic_load(&failing.fail_at);
    if (!at || (atomic_load(&failing.for_good) ? n < at : n != at)) return SQLITE_OK;
    atomic_fetch_add(&failing.failed, 1);
    int code = atomic_load(&failing.code);
    return code == SQLITE_IOERR ? io_error : code;
}

static inline sqlite3_file *failing_real(sqlite3_file *file)
{
    return ((failing_file *)file)->real;
}

static inline int failing_close(sqlite3_file *file)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods ? real->pMethods->xClose(real) : SQLITE_OK;
}

static inline int failing_read(sqlite3_file *file, void *out, int count, sqlite3_int64 offset)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xRead(real, out, count, offset);
}

static inline int failing_write(sqlite3_file *file, const void *data, int count,
                                sqlite3_int64 offset)
{
    sqlite3_file *real = failing_real(file);
    int rc = failing_gate(FAILING_WRITE, SQLITE_IOERR_WRITE);
    return rc ? rc : real->pMethods->xWrite(real, data, count, offset);
}

static inline int failing_truncate(sqlite3_file *file, sqlite3_int64 bytes)
{
    sqlite3_file *real = failing_real(file);
    int rc = failing_gate(FAILING_TRUNCATE, SQLITE_IOERR_TRUNCATE);
    return rc ? rc : real->pMethods->xTruncate(real, bytes);
}

static inline int failing_sync(sqlite3_file *file, int flags)
{
    sqlite3_file *real = failing_real(file);
    int rc = failing_gate(FAILING_SYNC, SQLITE_IOERR_FSYNC);
    return rc ? rc : real->pMethods->xSync(real, flags);
}

static inline int failing_size(sqlite3_file *file, sqlite3_int64 *bytes)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xFileSize(real, bytes);
}

static inline int failing_lock(sqlite3_file *file, int level)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xLock(real, level);
}

static inline int failing_unlock(sqlite3_file *file, int level)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xUnlock(real, level);
}

static inline int failing_is_reserved(sqlite3_file *file, int *reserved)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xCheckReservedLock(real, reserved);
}

static inline int failing_control(sqlite3_file *file, int operation, void *argument)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xFileControl(real, operation, argument);
}

static inline int failing_sector_bytes(sqlite3_file *file)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xSectorSize(real);
}

static inline int failing_characteristics(sqlite3_file *file)
{
    sqlite3_file *real = failing_real(file);
    return real->pMethods->xDeviceCharacteristics(real);
}

static const sqlite3_io_methods failing_methods = {
    .iVersion = 1, // no memory map, no shared memory: every byte passes here
    .xClose = failing_close,
    .xRead = failing_read,
    .xWrite = failing_write,
    .xTruncate = failing_truncate,
    .xSync = failing_sync,
    .xFileSize = failing_size,
    .xLock = failing_lock,
    .xUnlock = failing_unlock,
    .xCheckReservedLock = failing_is_reserved,
    .xFileControl = failing_control,
    .xSectorSize = failing_sector_bytes,
    .xDeviceCharacteristics = failing_characteristics,
};

static inline int failing_open(sqlite3_vfs *vfs, const char *name, sqlite3_file *file,
                               int flags, int *out_flags)
{
    (void)vfs;
    failing_file *f = (failing_file *)file;
    f->base.pMethods = NULL;
    f->real = (sqlite3_file *)(f + 1);
    int rc =
        flags & SQLITE_OPEN_READONLY ? SQLITE_OK : failing_gate(FAILING_OPEN, SQLITE_CANTOPEN);
    if (rc == SQLITE_OK)
        rc = failing.real->xOpen(failing.real, name, f->real, flags, out_flags);
    if (rc == SQLITE_OK) f->base.pMethods = &failing_methods;
    return rc;
}

static inline int failing_delete(sqlite3_vfs *vfs, const char *name, int sync)
{
    (void)vfs;
    int rc = failing_gate(FAILING_DELETE, SQLITE_IOERR_DELETE);
    return rc ? rc : failing.real->xDelete(failing.real, name, sync);
}

// Makes it SQLite's default file system; nothing fails until it is armed.
static inline void failing_vfs_install(void)
{
    if (failing.real) return;
    failing.real = sqlite3_vfs_find(NULL);
    failing.vfs = *failing.real; // what is not about writing goes to the real one's functions,
                                 // which ask their argument for nothing but its sizes
    failing.vfs.zName = "failing";
    failing.vfs.pNext = NULL;
    failing.vfs.szOsFile = (int)sizeof(failing_file) + failing.real->szOsFile;
    failing.vfs.xOpen = failing_open;
    failing.vfs.xDelete = failing_delete;
    sqlite3_vfs_register(&failing.vfs, 1);
}

#endif
