// The layout: where the scene proper is and how large, so that "far larger than the rest" has a
// measure. A sky must not draw it out, nor may a bush of ten thousand leaves, each a piece of
// its own, draw it in. So it is taken from the centres of objects and pieces between two
// percentiles, each weighted with its diagonal (up to a few times the median, and a part's
// pieces together up to a few times the part's), and widened by half of a common diagonal; then
// what is far larger leaves, and it is taken again.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

#include <stdlib.h>

// Choices; the factor of the backdrop is that of the design.
#define BACKDROP_FACTOR 3.0
#define SURFACE_SHARE (1.0 / 8) // of the layout's diagonal
#define SURFACE_FACTOR 4.0      // times the median object
#define TAIL 0.1                // weight left out at either end of an axis
#define PIECES_WEIGHT 4.0
#define MEDIAN_WEIGHT 4.0
enum { MOST_ROUNDS = 16, LEAST_UNITS = 8, HEAVY_FACTOR = 4 };
#define MOST_UNITS 1000000.0

typedef struct unit {
    double center[3];
    double diagonal;
    double votes; // how many objects it stands for
} unit;

typedef PROM_ARRAY(unit) units;

static void add_unit(units *list, const prom_wbox *bounds, double votes, const double by[3])
{
    unit u = {.diagonal = prom_wbox_diagonal(bounds), .votes = votes};
    prom_wbox_center(bounds, u.center);
    for (int k = 0; k < 3; k++) u.center[k] += by[k];
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
    double votes = (double)stride * (sum > cap ? cap / sum : 1);
    for (size_t i = 0; i < part->item_count; i += stride)
        add_unit(list, &finder->items.data[part->first_item + i].bounds, votes, by);
}

static void add_scope(const prom_finder *finder, units *list, const prom_scope *scope,
                      bool all_members)
{
    const prom_source_node *nodes = finder->source->nodes.data;
    size_t members = all_members && scope->roots.count ? scope->roots.count : 1;
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

typedef struct sort_key {
    double at;
    uint32_t unit;
} sort_key;

static int by_place(const void *pa, const void *pb)
{
    const sort_key *a = pa, *b = pb;
    if (a->at != b->at) return a->at < b->at ? -1 : 1;
    return a->unit < b->unit ? -1 : a->unit > b->unit;
}

// Units sorted along an axis, or by diagonal (axis 3).
static sort_key *sort_units(const units *list, int axis)
{
    sort_key *keys = prom_alloc(list->count, sizeof *keys);
    for (uint32_t i = 0; i < list->count; i++) {
        const unit *u = &list->data[i];
        keys[i] = (sort_key){axis < 3 ? u->center[axis] : u->diagonal, i};
    }
    qsort(keys, list->count, sizeof *keys, by_place);
    return keys;
}

typedef struct measure {
    const units *list;
    sort_key *keys[4];
    double limit; // diagonals above it do not count
    double most;  // diagonals above it count as this
} measure;

static double weight(const measure *m, const unit *u)
{
    return u->diagonal > m->limit ? 0 : u->votes * fmin(u->diagonal, m->most);
}

// Where the weight of the units along an axis passes the share `at`.
static double percentile(const measure *m, int axis, double at)
{
    double total = 0, sum = 0, last = m->keys[axis][0].at;
    for (size_t i = 0; i < m->list->count; i++) total += weight(m, &m->list->data[i]);
    for (size_t i = 0; i < m->list->count; i++) {
        double w = weight(m, &m->list->data[m->keys[axis][i].unit]);
        if (!(w > 0)) continue;
        last = m->keys[axis][i].at;
        sum += w;
        if (sum >= at * total) break;
    }
    return last;
}

static double median_by_votes(const measure *m)
{
    double total = 0, sum = 0;
    for (size_t i = 0; i < m->list->count; i++) total += m->list->data[i].votes;
    size_t i = 0;
    for (; i + 1 < m->list->count; i++) {
        sum += m->list->data[m->keys[3][i].unit].votes;
        if (sum >= total / 2) break;
    }
    return m->keys[3][i].at;
}

static prom_wbox core_box(const measure *m)
{
    double margin = percentile(m, 3, 0.5) / 2;
    prom_wbox box;
    for (int k = 0; k < 3; k++) {
        double low = percentile(m, k, TAIL), high = percentile(m, k, 1 - TAIL);
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

// Of a scene of few large parts, specks beside them must not be all.
static double median_part(const prom_finder *finder, const prom_scope *scope)
{
    uint32_t n = scope->part_count;
    double *diagonals = prom_alloc(n, sizeof *diagonals);
    for (uint32_t i = 0; i < n; i++)
        diagonals[i] = prom_wbox_diagonal(&finder->parts.data[scope->first_part + i].bounds);
    qsort(diagonals, n, sizeof *diagonals, by_value);
    double median = n ? diagonals[(n - 1) / 2] : 0;
    prom_free(diagonals);
    return median;
}

static size_t count_within(const units *list, double limit)
{
    size_t count = 0;
    for (size_t i = 0; i < list->count; i++) count += list->data[i].diagonal <= limit;
    return count;
}

static prom_layout find_core(const units *list)
{
    prom_layout layout = {.box = PROM_WBOX_EMPTY};
    if (!list->count) return layout;
    measure m = {.list = list, .limit = INFINITY};
    for (int k = 0; k < 4; k++) m.keys[k] = sort_units(list, k);
    layout.median = median_by_votes(&m);
    m.most = MEDIAN_WEIGHT * layout.median;
    layout.objects = list->count;
    layout.box = core_box(&m);
    for (int round = 0; round < MOST_ROUNDS; round++) {
        double limit = BACKDROP_FACTOR * prom_wbox_diagonal(&layout.box);
        size_t now = count_within(list, limit);
        if (now < LEAST_UNITS || now == layout.objects) break;
        m.limit = limit;
        layout.objects = now;
        layout.box = core_box(&m);
    }
    layout.diagonal = prom_wbox_diagonal(&layout.box);
    for (int k = 0; k < 4; k++) prom_free(m.keys[k]);
    return layout;
}

// A backdrop is one to the whole scene, and is always drawn in full, which heavy geometry
// cannot be.
bool prom_is_backdrop(const prom_finder *finder, const prom_wbox *bounds, uint32_t triangles)
{
    const prom_layout *layout = &finder->scopes.data[0].layout;
    return layout->objects >= LEAST_UNITS &&
           triangles / HEAVY_FACTOR <= finder->options.max_triangles &&
           prom_wbox_diagonal(bounds) > BACKDROP_FACTOR * layout->diagonal;
}

// A ring of hills or a painted skyline may come in pieces, or stand on one side: large things
// beside the layout, of a mesh that reaches as far from it as a backdrop does.
static bool is_skyline(const prom_finder *finder, const prom_item *item)
{
    const prom_use *use = &finder->uses.data[finder->faces.data[item->first_face].use];
    prom_wbox reach = finder->scopes.data[0].layout.box;
    double center[3];
    prom_wbox_center(&item->bounds, center);
    bool inside = true;
    for (int k = 0; k < 3; k += 2)
        inside &= center[k] >= reach.min[k] && center[k] <= reach.max[k];
    prom_wbox_add(&reach, &use->bounds);
    return !inside && prom_is_backdrop(finder, &reach, item->face_count);
}

static void mark_item(prom_finder *finder, prom_item *item)
{
    const prom_scope *scope = &finder->scopes.data[finder->parts.data[item->part].scope];
    bool large =
        prom_wbox_diagonal(&item->bounds) >
        fmax(SURFACE_SHARE * scope->layout.diagonal, SURFACE_FACTOR * scope->layout.median);
    item->backdrop = prom_is_backdrop(finder, &item->bounds, item->face_count) ||
                     (large && is_skyline(finder, item));
    item->surface = large && !item->backdrop && !scope->one_thing;
}

static bool is_one_thing(const prom_finder *finder, const prom_scope *scope)
{
    bool rest = scope->group_kind == PROM_NONE && finder->scopes.count > 1;
    uint64_t triangles = 0;
    for (uint32_t i = 0; i < scope->part_count; i++)
        triangles += finder->parts.data[scope->first_part + i].triangles;
    return !rest && scope->part_count <= PROM_FEW_PARTS &&
           triangles / PROM_ALONE_FACTOR <= finder->options.max_triangles;
}

void prom_find_layout(prom_finder *finder)
{
    units list = {0};
    for (size_t i = 0; i < finder->scopes.count; i++)
        add_scope(finder, &list, &finder->scopes.data[i], true);
    for (size_t i = 0; i < finder->scopes.count; i++) {
        prom_scope *scope = &finder->scopes.data[i];
        if (i) {
            list.count = 0;
            add_scope(finder, &list, scope, false);
        }
        scope->layout = find_core(&list);
        scope->layout.diagonal = fmax(scope->layout.diagonal, median_part(finder, scope));
        scope->one_thing = is_one_thing(finder, scope);
    }
    prom_array_finish(&list);
    for (size_t i = 0; i < finder->items.count; i++) mark_item(finder, &finder->items.data[i]);
}
