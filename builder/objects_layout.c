// The layout: where the scene proper is and how large, so that "far larger than the rest" has a
// measure. It must not be drawn out by a sky, nor drawn in by a bush of ten thousand leaves
// that are pieces of their own. So it is taken from the centres of objects and pieces, each
// weighted with its diagonal (a part's pieces together with no more than a few times the
// part's), between two percentiles; what is far larger than the result leaves, and it is taken
// again.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

#include <stdlib.h>

// Choices; the factor of the backdrop is that of the design.
#define BACKDROP_FACTOR 3.0
#define SURFACE_SHARE (1.0 / 8) // of the layout's diagonal
#define SURFACE_FACTOR 4.0      // times the median object
#define TAIL 0.05               // weight left out at either end of an axis
#define PIECES_WEIGHT 4.0
enum { MOST_ROUNDS = 16, LEAST_UNITS = 8 };
#define MOST_UNITS 1000000.0

typedef struct unit {
    double center[3];
    double diagonal, weight;
} unit;

typedef PROM_ARRAY(unit) units;

static void add_unit(units *list, const prom_wbox *bounds, double scale, const double by[3])
{
    unit u = {.diagonal = prom_wbox_diagonal(bounds)};
    prom_wbox_center(bounds, u.center);
    for (int k = 0; k < 3; k++) u.center[k] += by[k];
    u.weight = u.diagonal * scale;
    prom_array_push(list, u);
}

static void add_part(const prom_finder *finder, units *list, const prom_part *part,
                     size_t stride, const double by[3])
{
    if (!part->unique) {
        add_unit(list, &part->bounds, 1, by);
        return;
    }
    double sum = 0;
    for (uint32_t i = 0; i < part->item_count; i++)
        sum += prom_wbox_diagonal(&finder->items.data[part->first_item + i].bounds);
    double cap = PIECES_WEIGHT * prom_wbox_diagonal(&part->bounds);
    double scale = (double)stride * (sum > cap ? cap / sum : 1);
    for (size_t i = 0; i < part->item_count; i += stride)
        add_unit(list, &finder->items.data[part->first_item + i].bounds, scale, by);
}

static void add_scope(const prom_finder *finder, units *list, const prom_scope *scope)
{
    const prom_source_node *nodes = finder->source->nodes.data;
    size_t members = scope->roots.count ? scope->roots.count : 1;
    double pieces = 0;
    for (uint32_t i = 0; i < scope->part_count; i++)
        pieces += finder->parts.data[scope->first_part + i].item_count;
    size_t stride = 1 + (size_t)(pieces * (double)members / MOST_UNITS);
    for (size_t m = 0; m < members; m++) {
        double by[3] = {0};
        if (scope->roots.count)
            for (int k = 0; k < 3; k++)
                by[k] = nodes[scope->roots.data[m]].world[12 + k] -
                        nodes[scope->roots.data[0]].world[12 + k];
        for (uint32_t i = 0; i < scope->part_count; i++)
            add_part(finder, list, &finder->parts.data[scope->first_part + i], stride, by);
    }
}

typedef struct axis_key {
    double at;
    uint32_t unit;
} axis_key;

static int by_place(const void *pa, const void *pb)
{
    const axis_key *a = pa, *b = pb;
    if (a->at != b->at) return a->at < b->at ? -1 : 1;
    return a->unit < b->unit ? -1 : a->unit > b->unit;
}

// Where the weight of the units up to `limit` passes the share `at`.
static double weighted_percentile(const units *list, const axis_key *keys, double limit,
                                  double total, double at)
{
    double sum = 0, last = keys[0].at;
    for (size_t i = 0; i < list->count; i++) {
        const unit *u = &list->data[keys[i].unit];
        if (u->diagonal > limit) continue;
        last = keys[i].at;
        sum += u->weight;
        if (sum >= at * total) break;
    }
    return last;
}

static prom_wbox core_box(const units *list, axis_key *const keys[3], double limit,
                          double margin)
{
    double total = 0;
    for (size_t i = 0; i < list->count; i++)
        if (list->data[i].diagonal <= limit) total += list->data[i].weight;
    prom_wbox box;
    for (int k = 0; k < 3; k++) {
        double low = weighted_percentile(list, keys[k], limit, total, TAIL);
        double high = weighted_percentile(list, keys[k], limit, total, 1 - TAIL);
        double tail = (high - low) * TAIL / (1 - 2 * TAIL) + margin;
        box.min[k] = low - tail;
        box.max[k] = high + tail;
    }
    return box;
}

static int by_value(const void *pa, const void *pb)
{
    double a = *(const double *)pa, b = *(const double *)pb;
    return a < b ? -1 : a > b;
}

static double median_diagonal(const units *list)
{
    double *sorted = prom_alloc(list->count, sizeof *sorted);
    for (size_t i = 0; i < list->count; i++) sorted[i] = list->data[i].diagonal;
    qsort(sorted, list->count, sizeof *sorted, by_value);
    double median = sorted[list->count / 2];
    prom_free(sorted);
    return median;
}

static size_t count_within(const units *list, double limit)
{
    size_t count = 0;
    for (size_t i = 0; i < list->count; i++) count += list->data[i].diagonal <= limit;
    return count;
}

static void measure(prom_finder *finder, const units *list)
{
    axis_key *keys[3];
    for (int k = 0; k < 3; k++) {
        keys[k] = prom_alloc(list->count, sizeof *keys[k]);
        for (uint32_t i = 0; i < list->count; i++)
            keys[k][i] = (axis_key){list->data[i].center[k], i};
        qsort(keys[k], list->count, sizeof *keys[k], by_place);
    }
    finder->median_diagonal = median_diagonal(list);
    double margin = finder->median_diagonal / 2, limit = INFINITY;
    size_t within = list->count;
    finder->layout = core_box(list, keys, limit, margin);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        limit = BACKDROP_FACTOR * prom_wbox_diagonal(&finder->layout);
        size_t now = count_within(list, limit);
        if (now < LEAST_UNITS || now == within) break;
        within = now;
        finder->layout = core_box(list, keys, limit, margin);
    }
    finder->layout_diagonal = prom_wbox_diagonal(&finder->layout);
    for (int k = 0; k < 3; k++) prom_free(keys[k]);
}

bool prom_is_backdrop(const prom_finder *finder, const prom_wbox *bounds)
{
    return finder->backdrops_possible &&
           prom_wbox_diagonal(bounds) > BACKDROP_FACTOR * finder->layout_diagonal;
}

void prom_find_layout(prom_finder *finder)
{
    units list = {0};
    for (size_t i = 0; i < finder->scopes.count; i++)
        add_scope(finder, &list, &finder->scopes.data[i]);
    measure(finder, &list);
    double limit = BACKDROP_FACTOR * finder->layout_diagonal;
    finder->backdrops_possible =
        finder->parts.count > 1 && count_within(&list, limit) >= LEAST_UNITS;
    prom_array_finish(&list);
    double surface =
        fmax(SURFACE_SHARE * finder->layout_diagonal, SURFACE_FACTOR * finder->median_diagonal);
    for (size_t i = 0; i < finder->items.count; i++) {
        prom_item *item = &finder->items.data[i];
        item->backdrop = prom_is_backdrop(finder, &item->bounds);
        item->surface = !item->backdrop && prom_wbox_diagonal(&item->bounds) > surface;
    }
}
