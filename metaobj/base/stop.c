#include "metaobj/base/stop.h"

#include <stdatomic.h>

// One per process, like the signals that set it.
static atomic_bool requested;

void prom_stop_request(void)
{
    requested = true;
}

bool prom_stop_requested(void)
{
    return requested;
}
