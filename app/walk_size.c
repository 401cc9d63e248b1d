#include "app/walk_size.h"

#include "metaobj/base/alloc.h"

#include <math.h>
#include <stdlib.h>

// A disc that is filled evenly has half of its area within 0.707 of its radius.
#define DIAMETERS_PER_MEDIAN 2.83

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, compare);
    return values[count / 2];
}

static bool is_leaf(const prom_model *model, uint32_t node)
{
    return model->first_child[node] == PROM_NONE;
}

static double median_distance(const prom_model *m, double *values)
{
    double middle[3];
    size_t count = 0;
    for (int k = 0; k < 3; k++) {
        count = 0;
        for (uint32_t i = 0; i < m->tree_count; i++)
            if (is_leaf(m, i)) values[count++] = m->center[i][k];
        if (!count) return 0;
        middle[k] = median(values, count);
    }
    count = 0;
    for (uint32_t i = 0; i < m->tree_count; i++)
        if (is_leaf(m, i))
            values[count++] = hypot(m->center[i][0] - middle[0], m->center[i][2] - middle[2]);
    return median(values, count);
}

double prom_walk_size(const prom_model *model)
{
    double *values = prom_alloc(model->tree_count + 1, sizeof *values);
    double size = DIAMETERS_PER_MEDIAN * median_distance(model, values);
    prom_free(values);
    if (size > 0 && isfinite(size)) return size;
    size = 2 * (double)model->radius[0]; // a single leaf
    return size > 0 ? size : 1;
}
