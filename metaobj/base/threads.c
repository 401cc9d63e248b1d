#include "metaobj/base/threads.h"

#include "metaobj/base/alloc.h"

#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>

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

static unsigned wanted_count; // 0: all cores

void prom_thread_set_count(unsigned count)
{
    wanted_count = count > 64 ? 64 : count;
}

static void count_threads(void)
{
    cpu_set_t set;
    if (wanted_count) {
        thread_count = wanted_count;
        return;
    }
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

struct prom_pool {
    pthread_mutex_t lock;
    pthread_cond_t work, progress;
    prom_loop *first; // loops with steps to be taken, oldest first
    bool ending;
    unsigned workers;
    pthread_t threads[64];
};

typedef struct pool_worker {
    prom_pool *pool;
    unsigned thread;
} pool_worker;

// Takes one step of the oldest loop, with the lock held; false if there is none.
static bool take_step(prom_pool *pool, unsigned thread)
{
    prom_loop *loop = pool->first;
    if (!loop) return false;
    size_t i = loop->next++;
    if (loop->next == loop->count) pool->first = loop->after;
    pthread_mutex_unlock(&pool->lock);
    loop->body(loop->user, i, thread);
    pthread_mutex_lock(&pool->lock);
    if (++loop->done == loop->count) pthread_cond_broadcast(&pool->progress);
    return true;
}

static void *pool_work(void *argument)
{
    pool_worker w = *(pool_worker *)argument;
    prom_free(argument);
    pthread_mutex_lock(&w.pool->lock);
    while (!w.pool->ending)
        if (!take_step(w.pool, w.thread)) pthread_cond_wait(&w.pool->work, &w.pool->lock);
    pthread_mutex_unlock(&w.pool->lock);
    return NULL;
}

prom_pool *prom_pool_create(void)
{
    prom_pool *pool = prom_calloc(1, sizeof *pool);
    pthread_mutex_init(&pool->lock, NULL);
    pthread_cond_init(&pool->work, NULL);
    pthread_cond_init(&pool->progress, NULL);
    for (unsigned t = 1; t < prom_thread_count(); t++) {
        pool_worker *w = prom_alloc(1, sizeof *w);
        *w = (pool_worker){pool, t};
        if (pthread_create(&pool->threads[pool->workers], NULL, pool_work, w)) {
            prom_free(w);
            break;
        }
        pool->workers++;
    }
    return pool;
}

void prom_pool_destroy(prom_pool *pool)
{
    if (!pool) return;
    pthread_mutex_lock(&pool->lock);
    pool->ending = true;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);
    for (unsigned t = 0; t < pool->workers; t++) pthread_join(pool->threads[t], NULL);
    pthread_cond_destroy(&pool->progress);
    pthread_cond_destroy(&pool->work);
    pthread_mutex_destroy(&pool->lock);
    prom_free(pool);
}

void prom_pool_start(prom_pool *pool, prom_loop *loop)
{
    loop->next = loop->done = 0;
    loop->after = NULL;
    if (!loop->count) return;
    pthread_mutex_lock(&pool->lock);
    prom_loop **last = &pool->first;
    while (*last) last = &(*last)->after;
    *last = loop;
    pthread_cond_broadcast(&pool->work);
    pthread_mutex_unlock(&pool->lock);
}

void prom_pool_wait(prom_pool *pool, prom_loop *loop)
{
    pthread_mutex_lock(&pool->lock);
    while (loop->done < loop->count)
        if (!take_step(pool, 0)) pthread_cond_wait(&pool->progress, &pool->lock);
    pthread_mutex_unlock(&pool->lock);
}
