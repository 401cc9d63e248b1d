// Pictures are decoded in children of the import child: decoders crash, loop and ask for too
// much memory more often than scene loaders do, and a scene without one of its pictures is
// still a scene.
//
// Workers take pictures from a shared counter, write the texels into one file in memory, and
// note what came of it in shared rows. The import child watches: when a worker dies or takes
// too long, the picture it was at is lost, and a new worker goes on with the next.
#include "builder/import_parts.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/threads.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdatomic.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define WARNING_BYTES 512u
#define SIDE_LIMIT 16384u
#define NOTHING SIZE_MAX
// A picture gets this part of the scene's time, at least a second (by taste).
#define TIME_SHARE 10u

void (*prom_import_picture_hook)(const char *name);

enum { ROW_OPEN, ROW_BEGUN, ROW_DONE, ROW_LOST };

typedef struct row {
    uint32_t state;
    uint32_t width, height;
    uint64_t offset; // of its texels
    uint8_t min_alpha, missing;
    char warning[WARNING_BYTES];
} row;

// A worker's part of the shared memory.
typedef struct desk {
    _Atomic size_t at; // the picture it is at, or NOTHING
    _Atomic double since_ms;
} desk;

typedef struct shared {
    atomic_size_t next; // picture
    atomic_ullong end;  // of the texels
    desk desks[64];
} shared;

typedef struct shop {
    const prom_import *import;
    prom_import_picture *pictures;
    size_t count, bytes; // of the shared memory
    shared *shared;
    row *rows;
    int texels;
    pid_t pids[64]; // 0: none
    unsigned workers, futile;
} shop;

// ---- in a worker

static bool write_texels(const shop *s, const prom_import_picture *p, uint64_t *offset)
{
    size_t bytes = (size_t)p->width * p->height * 4, done = 0;
    *offset = atomic_fetch_add(&s->shared->end, bytes);
    while (done < bytes) {
        ssize_t n = pwrite(s->texels, p->rgba + done, bytes - done, (off_t)(*offset + done));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        done += (size_t)n;
    }
    return true;
}

static void decode_one(const shop *s, size_t i)
{
    prom_import_picture p = s->pictures[i];
    row *r = &s->rows[i];
    r->state = ROW_BEGUN;
    if (prom_import_picture_hook) prom_import_picture_hook(p.color ? p.color : p.mask);
    prom_import_picture_decode(s->import, &p);
    if (!write_texels(s, &p, &r->offset)) _exit(4);
    r->width = p.width;
    r->height = p.height;
    r->min_alpha = p.min_alpha;
    r->missing = p.missing;
    if (p.warning) snprintf(r->warning, sizeof r->warning, "%s", p.warning);
    prom_free(p.warning);
    prom_free(p.rgba);
    r->state = ROW_DONE;
}

static _Noreturn void work(const shop *s, unsigned index, pid_t parent)
{
    desk *d = &s->shared->desks[index];
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(5);
    int null = open("/dev/null", O_WRONLY); // a lost picture gets one line, not its library's
    if (null >= 0) dup2(null, STDERR_FILENO);
    // A worker that has used much of its processor time makes room for a fresh one.
    clock_t enough = (clock_t)(s->import->options.time_s / 2 + 1) * CLOCKS_PER_SEC;
    while (clock() < enough) {
        size_t i = atomic_fetch_add(&s->shared->next, 1);
        if (i >= s->count) break;
        atomic_store(&d->since_ms, prom_clock_ms());
        atomic_store(&d->at, i);
        decode_one(s, i);
        atomic_store(&d->at, NOTHING);
    }
    _exit(0);
}

// ---- in the import child

static bool shop_open(shop *s)
{
    size_t rows;
    if (__builtin_mul_overflow(s->count, sizeof(row), &rows)) return false;
    s->bytes = sizeof(shared) + rows;
    s->texels = memfd_create("promenade-pictures", MFD_CLOEXEC);
    if (s->texels < 0) return false;
    void *memory =
        mmap(NULL, s->bytes, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) {
        close(s->texels);
        return false;
    }
    s->shared = memory;
    s->rows = (row *)(void *)((uint8_t *)memory + sizeof(shared));
    s->workers = prom_thread_count();
    if (s->workers > s->count) s->workers = (unsigned)s->count;
    return true;
}

static bool hire(shop *s, unsigned index)
{
    pid_t parent = getpid();
    atomic_store(&s->shared->desks[index].at, NOTHING);
    s->pids[index] = fork();
    if (s->pids[index] == 0) work(s, index, parent);
    if (s->pids[index] < 0) s->pids[index] = 0;
    return s->pids[index] > 0;
}

static void lose(const shop *s, size_t i, const char *why)
{
    row *r = &s->rows[i];
    r->state = ROW_LOST;
    snprintf(r->warning, sizeof r->warning, "%s", why);
}

// What became of a worker that has ended.
static void judge(shop *s, unsigned index, int state, bool late)
{
    size_t at = atomic_load(&s->shared->desks[index].at);
    char why[128];
    s->pids[index] = 0;
    if (at >= s->count || s->rows[at].state == ROW_DONE) {
        s->futile += !(WIFEXITED(state) && WEXITSTATUS(state) == 0);
        return;
    }
    if (late)
        snprintf(why, sizeof why, "its decoder did not end");
    else if (WIFSIGNALED(state) && WTERMSIG(state) != SIGABRT)
        snprintf(why, sizeof why, "its decoder crashed (signal %d, %s)", WTERMSIG(state),
                 strsignal(WTERMSIG(state)));
    else
        snprintf(why, sizeof why, "its decoder gave up, probably for lack of memory");
    lose(s, at, why);
}

static uint32_t picture_time_s(const shop *s)
{
    uint32_t share = s->import->options.time_s / TIME_SHARE;
    return share ? share : 1;
}

// Looks after one worker; true while it works.
static bool watch(shop *s, unsigned index)
{
    int state = 0;
    if (!s->pids[index]) return false;
    desk *d = &s->shared->desks[index];
    bool late = atomic_load(&d->at) != NOTHING &&
                prom_clock_ms() - atomic_load(&d->since_ms) > 1000.0 * picture_time_s(s);
    if (late) kill(s->pids[index], SIGKILL);
    pid_t got = waitpid(s->pids[index], &state, late ? 0 : WNOHANG);
    if (got == 0 || (got < 0 && errno == EINTR)) return true;
    judge(s, index, state, late);
    bool more = atomic_load(&s->shared->next) < s->count;
    return more && s->futile < 8 && hire(s, index);
}

static void run(shop *s)
{
    long pause_ns = 200000;
    for (unsigned i = 0; i < s->workers; i++) hire(s, i);
    for (bool busy = true; busy;) {
        busy = false;
        for (unsigned i = 0; i < s->workers; i++) busy |= watch(s, i);
        if (busy) nanosleep(&(struct timespec){0, pause_ns}, NULL);
        if (pause_ns < 10000000) pause_ns *= 2;
    }
}

static bool read_texels(const shop *s, const row *r, prom_import_picture *p)
{
    size_t bytes = (size_t)r->width * r->height * 4, done = 0;
    if (!bytes || r->width > SIDE_LIMIT || r->height > SIDE_LIMIT) return false;
    p->rgba = prom_alloc(bytes, 1);
    while (done < bytes) {
        ssize_t n = pread(s->texels, p->rgba + done, bytes - done, (off_t)(r->offset + done));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) break;
        done += (size_t)n;
    }
    if (done == bytes) return true;
    prom_free(p->rgba);
    p->rgba = NULL;
    return false;
}

static void collect(const shop *s, size_t i)
{
    prom_import_picture *p = &s->pictures[i];
    row *r = &s->rows[i];
    prom_error error;
    r->warning[sizeof r->warning - 1] = 0;
    if (r->state == ROW_DONE && read_texels(s, r, p)) {
        p->width = r->width;
        p->height = r->height;
        p->min_alpha = r->min_alpha;
        p->missing = r->missing;
        if (*r->warning) p->warning = prom_strdup(r->warning);
        return;
    }
    prom_fail(&error, PROM_ERR_INPUT, "%s: %s", p->color ? p->color : p->mask,
              r->state == ROW_LOST ? r->warning : "no process could decode it");
    prom_import_picture_lost(p, &error);
}

void prom_import_pictures(prom_import *import, prom_import_picture *pictures, size_t count)
{
    shop s = {.import = import, .pictures = pictures, .count = count};
    prom_import_doing(import, "decoding its pictures");
    if (!count) return;
    if (shop_open(&s)) {
        run(&s);
        for (size_t i = 0; i < count; i++) collect(&s, i);
        munmap(s.shared, s.bytes);
        close(s.texels);
    } else {
        for (size_t i = 0; i < count; i++) prom_import_picture_decode(import, &pictures[i]);
    }
    for (size_t i = 0; i < count; i++)
        if (pictures[i].warning) prom_import_warn(import, "%s", pictures[i].warning);
}
