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
// What that work kept the processors busy for on a software device, as milliseconds of all of
// them together: the time of the calling thread, and that of the others divided by the
// processors. Near what it takes where nothing disturbs it, and the same where something does.
// 0 on hardware.
double prom_timer_busy_ms(const prom_timer *timer);

#endif
