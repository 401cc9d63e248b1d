// A scatter plot as SVG: two quantities that should be equal, in groups of a colour and a
// marker each. Both axes have one scale, on which small values of either sign can be seen
// beside large ones: asinh(x / linear), linear up to there, then logarithmic. Equal values lie
// on the diagonal, which is drawn.
#ifndef PROM_APP_SCATTER_H
#define PROM_APP_SCATTER_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#define PROM_SCATTER_GROUPS 9 // at most

typedef struct prom_scatter_point {
    double x, y; // finite
    uint32_t group;
} prom_scatter_point;

typedef struct prom_scatter {
    const char *title, *subtitle, *x_label, *y_label;
    double linear;                           // a power of ten
    const char *groups[PROM_SCATTER_GROUPS]; // for the legend
    uint32_t group_count;
    const prom_scatter_point *points;
    size_t count;
} prom_scatter;

void prom_scatter_write(const prom_scatter *plot, FILE *out);

#endif
