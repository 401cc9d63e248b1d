// Monotonic wall clock.
#ifndef PROM_METAOBJ_BASE_CLOCK_H
#define PROM_METAOBJ_BASE_CLOCK_H

// Milliseconds since an arbitrary start; never goes back.
double prom_clock_ms(void);

#endif
