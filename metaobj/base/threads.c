#include "metaobj/base/threads.h"

#include "metaobj/base/alloc.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>

typedef struct job {
    atomic_size_t next;
    size_t count;
    void (*body)(void *, size_t, unsigned);
    void *user;
} job;

typedef struct worker {
    job *job;
    unsigned index;
    pthread_t thread;
} worker;

static pthread_once_t count_once = PTHREAD_ONCE_INIT;
static unsigned thread_count = 1;

static void count_threads(void)
{
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set)) return;
    int n = CPU_COUNT(&set);
    thread_count = n < 1 ? 1 : n > 64 ? 64 : (unsigned)n;
}

// The affinity may change from outside; scratch memory that callers made per thread may not.
unsigned prom_thread_count(void)
{
    pthread_once(&count_once, count_threads);
    return thread_count;
}

static void *work(void *argument)
{
    worker *w = argument;
    for (size_t i; (i = atomic_fetch_add(&w->job->next, 1)) < w->job->count;)
        w->job->body(w->job->user, i, w->index);
    return NULL;
}

void prom_parallel_for(size_t count, void (*body)(void *user, size_t i, unsigned thread),
                       void *user)
{
    job j = {.count = count, .body = body, .user = user};
    unsigned threads = prom_thread_count();
    if (threads > count) threads = count ? (unsigned)count : 1;
    worker *workers = prom_calloc(threads, sizeof *workers);
    for (unsigned t = 0; t < threads; t++) workers[t] = (worker){.job = &j, .index = t};
    unsigned started = 0;
    for (unsigned t = 1; t < threads; t++, started++)
        if (pthread_create(&workers[t].thread, NULL, work, &workers[t])) break;
    work(&workers[0]);
    for (unsigned t = 1; t <= started; t++) pthread_join(workers[t].thread, NULL);
    prom_free(workers);
}
