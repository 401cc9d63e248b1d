#include "scenes/auto_layout.h"

#include <math.h>
#include <stdlib.h>

#define CROWD 400u // objects that a place's density is counted from, at most

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

double prom_layout_percentile(double *values, size_t count, double share)
{
    qsort(values, count, sizeof *values, compare_doubles);
    return values[(size_t)((double)(count - 1) * share + 0.5)];
}

static void collect(const prom_model *model, prom_layout *l)
{
    for (uint32_t i = 0; i < model->tree_count; i++) {
        if (model->first_child[i] != PROM_NONE) continue;
        prom_layout_box o;
        bool finite = true;
        for (int k = 0; k < 3; k++) {
            o.center[k] = model->center[i][k];
            o.half[k] = (double)model->half[i][k];
            finite = finite && isfinite(o.center[k]) && isfinite(o.half[k]);
        }
        if (!finite) continue;
        if (model->prototypes[model->prototype[i]].flags & PROM_PROTO_SURFACE)
            prom_array_push(&l->surfaces, o);
        else
            prom_array_push(&l->objects, o);
    }
    if (l->objects.count) return;
    // Nothing but surfaces: walk among them.
    for (size_t i = 0; i < l->surfaces.count; i++)
        prom_array_push(&l->objects, l->surfaces.data[i]);
}

static void measure(prom_layout *l)
{
    size_t n = l->objects.count;
    double *values = prom_alloc(n, sizeof *values);
    for (int axis = 0; axis < 2; axis++) {
        for (size_t i = 0; i < n; i++) values[i] = l->objects.data[i].center[2 * axis];
        double low = prom_layout_percentile(values, n, 0.05),
               high = prom_layout_percentile(values, n, 0.95);
        l->middle[axis] = (low + high) / 2;
        l->spread[axis] = (high - low) / 2;
    }
    for (size_t i = 0; i < n; i++)
        values[i] = l->objects.data[i].center[1] + l->objects.data[i].half[1];
    qsort(values, n, sizeof *values, compare_doubles);
    l->tops = values;
    l->size = 2 * hypot(l->spread[0], l->spread[1]);
    // Metres are assumed where the size is that of rooms to towns; else the eye is as high as
    // it would be in a layout at the near end of that range.
    l->eye = l->size < 20 ? 1.7 * l->size / 20 : l->size > 5000 ? 1.7 * l->size / 5000 : 1.7;
}

void prom_layout_init(prom_layout *layout, const prom_model *model)
{
    *layout = (prom_layout){0};
    collect(model, layout);
    if (layout->objects.count) measure(layout);
}

void prom_layout_finish(prom_layout *layout)
{
    prom_array_finish(&layout->objects);
    prom_array_finish(&layout->surfaces);
    prom_free(layout->tops);
}

double prom_layout_density(const prom_layout *l, double x, double z)
{
    double reach = 0.12 * l->size + 1e-9, sum = 0;
    size_t step = l->objects.count / CROWD + 1;
    for (size_t i = 0; i < l->objects.count; i += step) {
        double dx = (l->objects.data[i].center[0] - x) / reach;
        double dz = (l->objects.data[i].center[2] - z) / reach;
        sum += 1 / (1 + dx * dx + dz * dz);
    }
    return sum;
}

double prom_layout_above(const prom_layout *l, double y)
{
    size_t low = 0, high = l->objects.count;
    while (low < high) {
        size_t mid = low + (high - low) / 2;
        if (l->tops[mid] > y)
            high = mid;
        else
            low = mid + 1;
    }
    return (double)(l->objects.count - low) / (double)l->objects.count;
}
