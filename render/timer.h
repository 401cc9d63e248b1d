// Times GPU work with the clock that can be trusted on this device: timer queries where a
// self-test finds them to agree with a wall clock around glFinish, else that wall clock.
#ifndef PROM_RENDER_TIMER_H
#define PROM_RENDER_TIMER_H

#include "render/renderer.h"

#include <stdbool.h>

typedef struct prom_timer prom_timer;

// Runs the self-test (tens of milliseconds).
prom_timer *prom_timer_create(prom_renderer *renderer);
void prom_timer_destroy(prom_timer *timer);
bool prom_timer_uses_queries(const prom_timer *timer);
void prom_timer_begin(prom_timer *timer);
// Waits for the work since begin and returns its milliseconds.
double prom_timer_end(prom_timer *timer);

#endif
