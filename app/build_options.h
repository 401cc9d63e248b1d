// The options of `build`.
#ifndef PROM_APP_BUILD_OPTIONS_H
#define PROM_APP_BUILD_OPTIONS_H

#include "app/where.h"
#include "builder/pipeline.h"
#include "builder/view_cells.h"

typedef struct prom_build_command {
    prom_build_options build;
    const char *scene, *output;
    prom_where where; // the viewer may be
    prom_view_cells_options cells;
    unsigned jobs; // 0: all cores
} prom_build_command;

// Input: prom_build_command, {0} before.
extern const struct argp prom_argp_build;

#endif
