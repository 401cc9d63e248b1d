#include "builder/import_parts.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "metaobj/base/stop.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#define DEFAULT_TEXTURE_PX 1024u
#define DEFAULT_MEMORY_BYTES ((uint64_t)8 << 30)
#define DEFAULT_TIME_S 300u
// What the child may hand over, so that a runaway loader cannot fill the machine's memory.
#define RESULT_LIMIT_BYTES ((uint64_t)16 << 30)

void (*prom_import_child_hook)(void);

// What parent and child share.
typedef struct channel {
    int result; // memfd: the packed scene
    int noise;  // parent's end: what the child's libraries print on stderr
    int noise_in;
    char *doing; // shared page
} channel;

// ---- in the child

static void limit(int resource, uint64_t soft, uint64_t hard)
{
    struct rlimit now, wanted = {soft, hard};
    if (!getrlimit(resource, &now) && now.rlim_max != RLIM_INFINITY) {
        if (wanted.rlim_max > now.rlim_max) wanted.rlim_max = now.rlim_max;
        if (wanted.rlim_cur > now.rlim_max) wanted.rlim_cur = now.rlim_max;
    }
    setrlimit(resource, &wanted);
}

// Sanitizers reserve terabytes of addresses: no limit of that kind there.
static void limit_memory(uint64_t bytes)
{
#ifndef PROM_SANITIZE
    // The child starts with a copy of what the parent has mapped; that does not count.
    uint64_t mapped, resident;
    prom_memory_use(&mapped, &resident);
    limit(RLIMIT_AS, bytes + mapped, bytes + mapped);
#else
    (void)bytes;
#endif
}

static void confine(const prom_import_options *options, const channel *c)
{
    static const int fatal[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGINT, SIGTERM};
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    for (size_t i = 0; i < sizeof fatal / sizeof *fatal; i++) signal(fatal[i], SIG_DFL);
    int null = open("/dev/null", O_RDWR);
    if (null >= 0) {
        dup2(null, STDIN_FILENO);
        dup2(null, STDOUT_FILENO);
    }
    dup2(c->noise_in, STDERR_FILENO);
    limit(RLIMIT_CORE, 0, 0);
    limit(RLIMIT_FSIZE, RESULT_LIMIT_BYTES, RESULT_LIMIT_BYTES);
    limit(RLIMIT_CPU, options->time_s, (uint64_t)options->time_s + 2);
    limit_memory(options->memory_bytes);
}

// Ends without the parent's exit handlers, which would touch the parent's files and devices.
static _Noreturn void child(const char *path, const prom_import_options *options,
                            const channel *c)
{
    confine(options, c);
    if (prom_import_child_hook) prom_import_child_hook();
    prom_source source = {0};
    prom_import import = {
        .path = path, .options = *options, .source = &source, .doing = c->doing};
    prom_error error = {0};
    error.status = prom_import_run(&import, &error);
    prom_import_doing(&import, "handing it over");
    FILE *file = fdopen(c->result, "wb");
    bool good = file && prom_import_pack(file, &source, import.warnings.data,
                                         import.warnings.count, &error);
    _exit(good ? 0 : 3);
}

// ---- in the parent

static bool channel_init(channel *c)
{
    *c = (channel){-1, -1, -1, MAP_FAILED};
    int ends[2];
    c->result = memfd_create("promenade-import", MFD_CLOEXEC);
    c->doing = mmap(NULL, PROM_IMPORT_DOING, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                    -1, 0);
    // Non-blocking: a chatty library must not wait for a reader.
    if (!pipe2(ends, O_CLOEXEC | O_NONBLOCK)) {
        c->noise = ends[0];
        c->noise_in = ends[1];
    }
    return c->result >= 0 && c->noise >= 0 && c->doing != MAP_FAILED;
}

static void channel_finish(channel *c)
{
    if (c->result >= 0) close(c->result);
    if (c->noise >= 0) close(c->noise);
    if (c->noise_in >= 0) close(c->noise_in);
    if (c->doing != MAP_FAILED) munmap(c->doing, PROM_IMPORT_DOING);
}

// Waits for the child, at most limit_s seconds or until all is to stop; then ends it. False: it
// was ended.
static bool wait_for(pid_t pid, double limit_s, int *state)
{
    double start = prom_clock_ms();
    long pause_ns = 500000;
    for (;;) {
        pid_t got = waitpid(pid, state, WNOHANG);
        if (got == pid || (got < 0 && errno != EINTR)) return true;
        if (prom_stop_requested() || prom_clock_ms() - start > limit_s * 1000.0) break;
        nanosleep(&(struct timespec){0, pause_ns}, NULL);
        if (pause_ns < 20000000) pause_ns *= 2;
    }
    kill(pid, SIGKILL);
    while (waitpid(pid, state, 0) < 0 && errno == EINTR) {
    }
    return false;
}

static bool out_of_memory(const channel *c)
{
    char text[4096];
    ssize_t n = read(c->noise, text, sizeof text - 1);
    if (n <= 0) return false;
    text[n] = 0;
    prom_log(PROM_LOG_DEBUG, "the loader says: %s", text);
    return strstr(text, "out of memory") || strstr(text, "bad_alloc");
}

// Processor time stands still in a loader that waits: so much by the wall clock.
static uint32_t wall_limit_s(const prom_import_options *options)
{
    return options->time_s < UINT32_MAX / 2 - 2 ? options->time_s * 2 + 2 : UINT32_MAX;
}

static prom_status failed(const char *path, const prom_import_options *options,
                          const channel *c, int state, bool in_time, prom_error *error)
{
    c->doing[PROM_IMPORT_DOING - 1] = 0;
    const char *doing = *c->doing ? c->doing : "starting";
    int signal_number = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
    if (!in_time || signal_number == SIGXCPU)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the loader did not end within %u s%s while %s; the file is "
                         "damaged or too large",
                         path, in_time ? options->time_s : wall_limit_s(options),
                         in_time ? " of processor time" : " by the clock", doing);
    if (out_of_memory(c))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the loader ran out of memory (limit %llu MiB) while %s; the file "
                         "is damaged or too large",
                         path, (unsigned long long)(options->memory_bytes >> 20), doing);
    if (signal_number)
        return prom_fail(
            error, PROM_ERR_INPUT,
            "%s: the loader crashed (signal %d, %s) while %s; the file is probably "
            "damaged",
            path, signal_number, strsignal(signal_number), doing);
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: the loader failed (code %d) while %s; the file is probably damaged",
                     path, WIFEXITED(state) ? WEXITSTATUS(state) : -1, doing);
}

static prom_status unpack(const char *path, const channel *c, prom_source *source,
                          prom_error *error)
{
    struct stat info;
    if (fstat(c->result, &info) || info.st_size <= 0)
        return prom_fail(error, PROM_ERR_INPUT, "%s: the loader handed over nothing", path);
    size_t bytes = (size_t)info.st_size;
    void *data = mmap(NULL, bytes, PROT_READ, MAP_PRIVATE, c->result, 0);
    if (data == MAP_FAILED)
        return prom_fail(error, PROM_ERR_INPUT, "%s: the scene does not fit into memory: %s",
                         path, strerror(errno));
    prom_status status = prom_import_unpack(data, bytes, path, source, error);
    munmap(data, bytes);
    return status;
}

static prom_status run(const char *path, const prom_import_options *options,
                       prom_source *source, prom_error *error)
{
    channel c;
    if (!channel_init(&c)) {
        channel_finish(&c);
        return prom_fail(error, PROM_ERR_UNSUPPORTED, "%s: no channel to a loader: %s", path,
                         strerror(errno));
    }
    fflush(NULL); // the child must not print what the parent has buffered
    pid_t pid = fork();
    if (pid == 0) child(path, options, &c);
    prom_status status;
    if (pid < 0) {
        status = prom_fail(error, PROM_ERR_UNSUPPORTED, "%s: no process for the loader: %s",
                           path, strerror(errno));
    } else {
        int state = 0;
        bool in_time = wait_for(pid, wall_limit_s(options), &state);
        bool good = in_time && WIFEXITED(state) && WEXITSTATUS(state) == 0;
        status = good ? unpack(path, &c, source, error)
                      : failed(path, options, &c, state, in_time, error);
    }
    channel_finish(&c);
    return status;
}

prom_status prom_source_import(const char *path, const prom_import_options *options,
                               prom_source *source, prom_error *error)
{
    static const prom_import_options none = {0};
    prom_import_options o = options ? *options : none;
    if (!o.max_texture_px) o.max_texture_px = DEFAULT_TEXTURE_PX;
    if (!o.memory_bytes) o.memory_bytes = DEFAULT_MEMORY_BYTES;
    if (!o.time_s) o.time_s = DEFAULT_TIME_S;
    if (o.max_texture_px > PROM_TEXTURE_MAX) o.max_texture_px = PROM_TEXTURE_MAX;
    *source = (prom_source){0};
    if (o.unit_m < 0 || !(o.unit_m < 1e9) || (o.unit_m > 0 && o.unit_m < 1e-9))
        return prom_fail(error, PROM_ERR_USAGE,
                         "import: a unit of %g m is no length; give metres, say 0.0254",
                         o.unit_m);
    if (o.up > PROM_UP_Z)
        return prom_fail(error, PROM_ERR_USAGE, "import: %u is no axis", (unsigned)o.up);
    struct stat info;
    if (stat(path, &info))
        return prom_fail(error, PROM_ERR_INPUT, "%s: %s", path, strerror(errno));
    if (S_ISDIR(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s: is a folder; name a scene file in it",
                         path);
    if (!S_ISREG(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s: is no regular file", path);
    if (!info.st_size) return prom_fail(error, PROM_ERR_INPUT, "%s: is empty", path);
    if (access(path, R_OK))
        return prom_fail(error, PROM_ERR_INPUT, "%s: %s", path, strerror(errno));
    prom_status status = run(path, &o, source, error);
    if (!status) source->file_bytes = (uint64_t)info.st_size;
    return status;
}
