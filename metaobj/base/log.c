#include "metaobj/base/log.h"

#include "metaobj/base/clock.h"
#include "metaobj/base/status.h"

#include <pthread.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <unistd.h>

// The only mutable globals of the base: the log is one per process.
static struct {
    prom_log_level level;
    bool line_open; // a progress line is on the terminal
    pthread_mutex_t lock;
} state = {.level = PROM_LOG_INFO, .lock = PTHREAD_MUTEX_INITIALIZER};

static void clear_line(void)
{
    if (state.line_open) fputs("\r\033[K", stderr);
    state.line_open = false;
}

void prom_log_set_level(prom_log_level level)
{
    state.level = level;
}

void prom_log(prom_log_level level, const char *format, ...)
{
    static const char *const prefix[] = {"error: ", "warning: ", "", "debug: "};
    if (level > state.level) return;
    pthread_mutex_lock(&state.lock);
    char text[2048];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    prom_text_make_plain(text);
    clear_line();
    fprintf(stderr, "%s%s\n", prefix[level], text);
    pthread_mutex_unlock(&state.lock);
}

void prom_progress_begin(prom_progress *progress, const char *stage, uint64_t total)
{
    double now = prom_clock_ms();
    *progress =
        (prom_progress){.stage = stage, .total = total, .start_ms = now, .shown_ms = now};
}

// How often progress is shown: on a terminal, and in a log file.
#define TERMINAL_MS 100.0
#define FILE_MS 30000.0

static void show(const prom_progress *p, double now, bool terminal)
{
    double seconds = (now - p->start_ms) / 1000.0;
    // What an earlier run has done says nothing of the time that the rest takes.
    double rate = seconds > 0 ? (double)(p->done - p->reused) / seconds : 0;
    clear_line();
    fprintf(stderr, "%s: %llu", p->stage, (unsigned long long)p->done);
    if (p->total) fprintf(stderr, "/%llu", (unsigned long long)p->total);
    fprintf(stderr, ", %.1f/s", rate);
    if (p->total > p->done && rate > 0)
        fprintf(stderr, ", %.0f s left", (double)(p->total - p->done) / rate);
    if (!terminal) fputc('\n', stderr);
    fflush(stderr);
    state.line_open = terminal;
}

void prom_progress_step(prom_progress *progress, uint64_t units)
{
    pthread_mutex_lock(&state.lock);
    progress->done += units;
    double now = prom_clock_ms();
    bool terminal = isatty(STDERR_FILENO);
    if (now - progress->shown_ms > (terminal ? TERMINAL_MS : FILE_MS)) {
        progress->shown_ms = now;
        if (state.level >= PROM_LOG_INFO) show(progress, now, terminal);
    }
    pthread_mutex_unlock(&state.lock);
}

void prom_progress_reused(prom_progress *progress, uint64_t units)
{
    pthread_mutex_lock(&state.lock);
    progress->reused += units;
    pthread_mutex_unlock(&state.lock);
}

void prom_progress_end(prom_progress *progress)
{
    double seconds = (prom_clock_ms() - progress->start_ms) / 1000.0;
    char reused[64] = "";
    if (progress->reused)
        snprintf(reused, sizeof reused, ", %llu of them from the last build",
                 (unsigned long long)progress->reused);
    prom_log(PROM_LOG_INFO, "%s: %llu in %.1f s%s", progress->stage,
             (unsigned long long)progress->done, seconds, reused);
}
