// Messages to the person who runs the program, on stderr: warnings always, information unless
// quiet, debug when asked for. Results go to stdout and not through here.
#ifndef PROM_METAOBJ_BASE_LOG_H
#define PROM_METAOBJ_BASE_LOG_H

#include <stdint.h>

typedef enum prom_log_level {
    PROM_LOG_ERROR,
    PROM_LOG_WARNING,
    PROM_LOG_INFO,
    PROM_LOG_DEBUG,
} prom_log_level;

// Messages above this level are dropped. Default PROM_LOG_INFO. Set it before threads start.
void prom_log_set_level(prom_log_level level);
void prom_log(prom_log_level level, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// Progress of long work: on a terminal one line that rewrites itself with rate and time left,
// elsewhere a line every half minute; a line when the work ends. Calls are cheap (redrawn at
// most ten times a second) and safe from several threads.
typedef struct prom_progress {
    const char *stage; // literal, kept
    uint64_t total;    // 0 when unknown
    uint64_t done, reused;
    double start_ms, shown_ms;
} prom_progress;

void prom_progress_begin(prom_progress *progress, const char *stage, uint64_t total);
void prom_progress_step(prom_progress *progress, uint64_t units);
// Of the units, so many needed no work since an earlier run had done them.
void prom_progress_reused(prom_progress *progress, uint64_t units);
void prom_progress_end(prom_progress *progress);

#endif
