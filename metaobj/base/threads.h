// Data-parallel loops over all cores.
#ifndef PROM_METAOBJ_BASE_THREADS_H
#define PROM_METAOBJ_BASE_THREADS_H

#include <stddef.h>

// Number of threads that prom_parallel_for and a pool use: the cores this process might run on
// at the first call, or what was set before it; the same ever after.
unsigned prom_thread_count(void);
// At most this many from the first call of any other function here on (1 to 64); has no effect
// later.
void prom_thread_set_count(unsigned count);

// Calls body(user, i, thread) for i in [0, count), in no given order, on all cores; returns
// when all are done. `thread` is in [0, prom_thread_count()). Results must not depend on the
// order. Calls do not nest.
void prom_parallel_for(size_t count, void (*body)(void *user, size_t i, unsigned thread),
                       void *user);

// A pool runs loops beside its owner: start some, do something else, wait for each. The owner
// works along while it waits, so that a pool of one thread has no thread of its own. One owner
// at a time.
typedef struct prom_pool prom_pool;

// A loop of a pool. The caller keeps it in place from start to wait.
typedef struct prom_loop {
    void (*body)(void *user, size_t i, unsigned thread);
    void *user;
    size_t count;
    size_t next, done;       // the pool's
    struct prom_loop *after; // the pool's
} prom_loop;

prom_pool *prom_pool_create(void);
void prom_pool_destroy(prom_pool *pool); // after all loops have ended; NULL is allowed
// Starts body(user, i, thread) for i in [0, count). Loops started earlier go first.
void prom_pool_start(prom_pool *pool, prom_loop *loop);
// Returns when the loop has ended.
void prom_pool_wait(prom_pool *pool, prom_loop *loop);

#endif
