#include "builder/child.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "metaobj/base/stop.h"

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

// What parent and child share.
typedef struct channel {
    int result; // memfd: what it hands over
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

static void confine(const prom_child_task *task, const channel *c)
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
    limit(RLIMIT_FSIZE, task->result_bytes, task->result_bytes);
    limit(RLIMIT_CPU, task->time_s, (uint64_t)task->time_s + 2);
    limit_memory(task->memory_bytes);
}

// Ends without the parent's exit handlers, which would touch the parent's files and devices.
static _Noreturn void child(const prom_child_task *task, const channel *c)
{
    confine(task, c);
    FILE *file = fdopen(c->result, "wb");
    bool good = file && task->work(task->user, file, c->doing);
    _exit(good && !fflush(file) ? 0 : 3);
}

// ---- in the parent

static bool channel_init(channel *c)
{
    *c = (channel){-1, -1, -1, MAP_FAILED};
    int ends[2];
    c->result = memfd_create("promenade-child", MFD_CLOEXEC);
    c->doing =
        mmap(NULL, PROM_CHILD_DOING, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
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
    if (c->doing != MAP_FAILED) munmap(c->doing, PROM_CHILD_DOING);
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

static bool out_of_memory(const prom_child_task *task, const channel *c)
{
    char text[4096];
    ssize_t n = read(c->noise, text, sizeof text - 1);
    if (n <= 0) return false;
    text[n] = 0;
    prom_log(PROM_LOG_DEBUG, "the %s says: %s", task->who, text);
    return strstr(text, "out of memory") || strstr(text, "bad_alloc");
}

// Processor time stands still in a loader that waits: so much by the wall clock.
static uint32_t wall_limit_s(const prom_child_task *task)
{
    return task->time_s < UINT32_MAX / 2 - 2 ? task->time_s * 2 + 2 : UINT32_MAX;
}

static prom_status failed(const prom_child_task *task, const channel *c, int state,
                          bool in_time, prom_error *error)
{
    c->doing[PROM_CHILD_DOING - 1] = 0;
    const char *doing = *c->doing ? c->doing : "starting";
    int signal_number = WIFSIGNALED(state) ? WTERMSIG(state) : 0;
    if (!in_time || signal_number == SIGXCPU)
        return prom_fail(
            error, PROM_ERR_INPUT,
            "%s: the %s did not end within %u s%s while %s; the file is damaged or "
            "too large",
            task->path, task->who, in_time ? task->time_s : wall_limit_s(task),
            in_time ? " of processor time" : " by the clock", doing);
    if (out_of_memory(task, c))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the %s ran out of memory (limit %llu MiB) while %s; the file is "
                         "damaged or too large",
                         task->path, task->who, (unsigned long long)(task->memory_bytes >> 20),
                         doing);
    if (signal_number)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the %s crashed (signal %d, %s) while %s; the file is probably "
                         "damaged",
                         task->path, task->who, signal_number, strsignal(signal_number), doing);
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: the %s failed (code %d) while %s; the file is probably damaged",
                     task->path, task->who, WIFEXITED(state) ? WEXITSTATUS(state) : -1, doing);
}

static prom_status take(const prom_child_task *task, const channel *c,
                        prom_child_result *result, prom_error *error)
{
    struct stat info;
    if (fstat(c->result, &info) || info.st_size <= 0)
        return prom_fail(error, PROM_ERR_INPUT, "%s: the %s handed over nothing", task->path,
                         task->who);
    size_t bytes = (size_t)info.st_size;
    void *data = mmap(NULL, bytes, PROT_READ, MAP_PRIVATE, c->result, 0);
    if (data == MAP_FAILED)
        return prom_fail(error, PROM_ERR_INPUT, "%s: its content does not fit into memory: %s",
                         task->path, strerror(errno));
    *result = (prom_child_result){data, bytes};
    return PROM_OK;
}

prom_status prom_child_run(const prom_child_task *task, prom_child_result *result,
                           prom_error *error)
{
    channel c;
    *result = (prom_child_result){0};
    if (!channel_init(&c)) {
        channel_finish(&c);
        return prom_fail(error, PROM_ERR_UNSUPPORTED, "%s: no channel to a %s: %s", task->path,
                         task->who, strerror(errno));
    }
    fflush(NULL); // the child must not print what the parent has buffered
    pid_t pid = fork();
    if (pid == 0) child(task, &c);
    prom_status status;
    if (pid < 0) {
        status = prom_fail(error, PROM_ERR_UNSUPPORTED, "%s: no process for the %s: %s",
                           task->path, task->who, strerror(errno));
    } else {
        int state = 0;
        bool in_time = wait_for(pid, wall_limit_s(task), &state);
        bool good = in_time && WIFEXITED(state) && WEXITSTATUS(state) == 0;
        status = good ? take(task, &c, result, error) : failed(task, &c, state, in_time, error);
    }
    channel_finish(&c);
    return status;
}

void prom_child_result_finish(prom_child_result *result)
{
    if (result->data) munmap((void *)(uintptr_t)result->data, result->bytes);
    *result = (prom_child_result){0};
}
