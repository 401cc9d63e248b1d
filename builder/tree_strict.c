// The classic octree (Maciel and Shirley 1995): from the finest division to the coarsest, two
// or more things that lie wholly inside a cell become a cluster, which takes their place; a
// thing across a border, or alone in its cell, waits for the next division. What is left when
// one cell is the whole scene hangs on the root, whatever its number.
#include "builder/tree_private.h"

#include <stdlib.h>

static int by_key(const void *pa, const void *pb)
{
    const prom_bud *a = pa, *b = pb;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

static int by_order(const void *pa, const void *pb)
{
    const prom_bud *a = pa, *b = pb;
    return a->order < b->order ? -1 : a->order > b->order;
}

// A cluster stands in the list where its first member stood.
static void push_cluster(prom_grower *grower, const prom_bud *buds, size_t count,
                         prom_layer layer, prom_buds *out)
{
    prom_bud bud = prom_bud_bind(grower, buds, count, layer, false);
    bud.order = buds[0].order;
    prom_array_push(out, bud);
}

// The cell along an axis that holds [low, high] wholly, or -1.
static double find_cell(double low, double high, const prom_wbox *bounds, int axis,
                        uint32_t divisions)
{
    double extent = bounds->max[axis] - bounds->min[axis];
    if (!(extent > 0) || divisions == 1) return 0;
    double scale = divisions / extent, slack = 1e-9 * divisions;
    double first = floor((low - bounds->min[axis]) * scale + slack);
    double last = ceil((high - bounds->min[axis]) * scale - slack) - 1;
    first = fmin(fmax(first, 0), divisions - 1.0);
    last = fmax(last, first); // flat things
    return first == last ? first : -1;
}

// Cells are numbered from 0; -1: wholly inside none.
static double find_cell_number(const prom_bud *bud, const prom_wbox *bounds,
                               const uint32_t divisions[3])
{
    double number = 0;
    for (int k = 0; k < 3; k++) {
        double c = find_cell(bud->bounds.min[k], bud->bounds.max[k], bounds, k, divisions[k]);
        if (c < 0) return -1;
        number = number * divisions[k] + c;
    }
    return number;
}

static void cluster_cells(prom_grower *grower, prom_buds *buds, prom_layer layer,
                          const prom_wbox *bounds, const uint32_t divisions[3])
{
    prom_buds out = {0};
    for (size_t i = 0; i < buds->count; i++)
        buds->data[i].key = find_cell_number(&buds->data[i], bounds, divisions);
    qsort(buds->data, buds->count, sizeof *buds->data, by_key);
    for (size_t i = 0, end; i < buds->count; i = end) {
        double key = buds->data[i].key;
        for (end = i + 1; end < buds->count && key >= 0 && buds->data[end].key == key;) end++;
        if (end - i > 1)
            push_cluster(grower, buds->data + i, end - i, layer, &out);
        else
            prom_array_push(&out, buds->data[i]);
    }
    qsort(out.data, out.count, sizeof *out.data, by_order);
    prom_array_finish(buds);
    *buds = out;
}

// Things within the radius of one that is not taken yet become a cluster with it.
static void cluster_neighbours(prom_grower *grower, prom_buds *buds, prom_layer layer)
{
    double radius = grower->options.group_radius;
    size_t n = buds->count;
    for (size_t i = 0; i < n; i++) buds->data[i].key = buds->data[i].center[0];
    qsort(buds->data, n, sizeof *buds->data, by_key);
    uint32_t *place = prom_alloc(n, sizeof *place); // along x, by order
    for (uint32_t i = 0; i < n; i++) place[buds->data[i].order] = i;
    bool *taken = prom_calloc(n, sizeof *taken);
    prom_buds out = {0}, group = {0};
    for (size_t order = 0; order < n; order++) {
        size_t self = place[order], low = self;
        if (taken[self]) continue;
        const prom_bud *seed = &buds->data[self];
        while (low > 0 && seed->key - buds->data[low - 1].key <= radius) low--;
        group.count = 0;
        for (size_t i = low; i < n && buds->data[i].key - seed->key <= radius; i++) {
            const prom_bud *other = &buds->data[i];
            double square = 0;
            for (int k = 0; k < 3; k++)
                square +=
                    (other->center[k] - seed->center[k]) * (other->center[k] - seed->center[k]);
            if (taken[i] || square > radius * radius) continue;
            taken[i] = true;
            prom_array_push(&group, *other);
        }
        qsort(group.data, group.count, sizeof *group.data, by_order);
        if (group.count > 1)
            push_cluster(grower, group.data, group.count, layer, &out);
        else
            prom_array_push(&out, *seed);
    }
    prom_free(place);
    prom_free(taken);
    prom_array_finish(&group);
    prom_array_finish(buds);
    *buds = out;
}

void prom_grow_strict(prom_grower *grower, prom_bud *buds, size_t count, prom_layer layer,
                      const prom_wbox *bounds, prom_buds *out)
{
    prom_buds list = {0};
    prom_array_reserve(&list, count);
    memcpy(list.data, buds, count * sizeof *buds);
    list.count = count;
    if (grower->options.group_radius > 0) cluster_neighbours(grower, &list, layer);
    uint32_t divisions[3];
    memcpy(divisions, grower->options.divisions, sizeof divisions);
    while (divisions[0] > 1 || divisions[1] > 1 || divisions[2] > 1) {
        cluster_cells(grower, &list, layer, bounds, divisions);
        for (int k = 0; k < 3; k++) divisions[k] = (divisions[k] + 1) / 2;
    }
    *out = (prom_buds){list.data, list.count, list.capacity};
}
