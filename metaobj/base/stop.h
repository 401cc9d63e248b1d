// A wish from outside (Ctrl-C) that long work end early. The work looks for it between its
// units and ends as after an error: cleanly, and with what it has done so far kept.
#ifndef PROM_METAOBJ_BASE_STOP_H
#define PROM_METAOBJ_BASE_STOP_H

#include <stdbool.h>

void prom_stop_request(void); // from a signal handler too
bool prom_stop_requested(void);

#endif
