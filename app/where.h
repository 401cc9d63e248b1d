// Where the viewer may be: the WHERE of `build --view-cells`.
#ifndef PROM_APP_WHERE_H
#define PROM_APP_WHERE_H

#include "scenes/eyes.h"

#include <argp.h>

typedef enum prom_where_kind {
    PROM_WHERE_NOT_GIVEN = 0,
    PROM_WHERE_PATHS, // camera paths from files
    PROM_WHERE_AUTO,  // the automatic walk
    PROM_WHERE_BOX,   // the floors in a box
} prom_where_kind;

typedef struct prom_where {
    prom_where_kind kind;
    PROM_ARRAY(char *) files;
    double low[3], high[3];
    prom_eyes eyes;
} prom_where;

// FILE[,FILE...], `auto` or X0,Y0,Z0:X1,Y1,Z1. A box that is none is a usage error.
void prom_where_parse(prom_where *where, const char *text, const struct argp_state *state);
void prom_where_finish(prom_where *where); // {0} is allowed
// Adds the eyes, for cells of `cell_size` scene units: those of paths can be had before there
// is a model, all others after.
prom_status prom_where_eyes_of_paths(prom_where *where, double cell_size, prom_error *error);
prom_status prom_where_eyes_of_model(prom_where *where, const char *model_path,
                                     double cell_size, prom_error *error);

#endif
