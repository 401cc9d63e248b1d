// Axis-aligned boxes of doubles, for bounds in the world while objects and tree are found.
#ifndef PROM_BUILDER_OBJECTS_BOX_H
#define PROM_BUILDER_OBJECTS_BOX_H

#include "metaobj/base/math.h"

#include <math.h>

typedef struct prom_wbox {
    double min[3], max[3];
} prom_wbox;

#define PROM_WBOX_EMPTY                                                                        \
    ((prom_wbox){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})

static inline void prom_wbox_add_point(prom_wbox *box, const double p[3])
{
    for (int k = 0; k < 3; k++) {
        if (p[k] < box->min[k]) box->min[k] = p[k];
        if (p[k] > box->max[k]) box->max[k] = p[k];
    }
}

static inline void prom_wbox_add(prom_wbox *box, const prom_wbox *other)
{
    for (int k = 0; k < 3; k++) {
        if (other->min[k] < box->min[k]) box->min[k] = other->min[k];
        if (other->max[k] > box->max[k]) box->max[k] = other->max[k];
    }
}

static inline void prom_wbox_move(prom_wbox *box, const double by[3])
{
    for (int k = 0; k < 3; k++) {
        box->min[k] += by[k];
        box->max[k] += by[k];
    }
}

static inline double prom_wbox_diagonal(const prom_wbox *box)
{
    double x = box->max[0] - box->min[0];
    double y = box->max[1] - box->min[1];
    double z = box->max[2] - box->min[2];
    return x >= 0 ? sqrt(x * x + y * y + z * z) : 0;
}

static inline void prom_wbox_center(const prom_wbox *box, double center[3])
{
    for (int k = 0; k < 3; k++) center[k] = 0.5 * (box->min[k] + box->max[k]);
}

static inline int prom_wbox_longest_axis(const prom_wbox *box)
{
    int axis = 0;
    for (int k = 1; k < 3; k++)
        if (box->max[k] - box->min[k] > box->max[axis] - box->min[axis]) axis = k;
    return axis;
}

// Bounds in the world of a box in the frame of a placement.
static inline prom_wbox prom_wbox_of_placed(const prom_box *box, const prom_placement *at)
{
    prom_wbox out;
    for (int r = 0; r < 3; r++) {
        double c = at->origin[r], h = 0;
        for (int k = 0; k < 3; k++) {
            double m = at->basis[k * 3 + r];
            c += m * 0.5 * ((double)box->min[k] + (double)box->max[k]);
            h += fabs(m) * 0.5 * ((double)box->max[k] - (double)box->min[k]);
        }
        out.min[r] = c - h;
        out.max[r] = c + h;
    }
    return out;
}

#endif
