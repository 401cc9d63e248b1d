// Data-parallel loops over all cores.
#ifndef PROM_METAOBJ_BASE_THREADS_H
#define PROM_METAOBJ_BASE_THREADS_H

#include <stddef.h>

// Number of threads that prom_parallel_for uses: the cores this process might run on
// at the first call; the same ever after.
unsigned prom_thread_count(void);

// Calls body(user, i, thread) for i in [0, count), in no given order, on all cores; returns
// when all are done. `thread` is in [0, prom_thread_count()). Results must not depend on the
// order. Calls do not nest.
void prom_parallel_for(size_t count, void (*body)(void *user, size_t i, unsigned thread),
                       void *user);

#endif
