// The loose octree (Ulrich 2000): a cell of edge e takes what has its centre inside and a
// radius of at most e, so that size and place alone say where a thing belongs. Cells become
// branches from the leaves up; a cell with a single thing hands it on, one with very few hands
// them on when there is room.
#include "builder/tree_private.h"

#include <stdlib.h>

// Choices: a cell with so few buds is divided no further; a child so small is dissolved while
// its parent stays below the room; the depth only stops what stands in one and the same point.
enum { LEAF_BUDS = 8, SMALL_CHILD = 3, ROOM = 12, MOST_DEPTH = 48, PARTS = 8 };

static int by_key(const void *pa, const void *pb)
{
    const prom_bud *a = pa, *b = pb;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return a->order < b->order ? -1 : a->order > b->order;
}

static void append(prom_buds *to, const prom_bud *buds, size_t count)
{
    prom_array_reserve(to, to->count + count);
    if (count) memcpy(to->data + to->count, buds, count * sizeof *buds);
    to->count += count;
}

static void push_branch(prom_grower *grower, const prom_buds *buds, prom_layer layer,
                        prom_buds *out)
{
    // Ties are broken by the first bud's order: later ones of equal key stay behind it.
    prom_bud bud = buds->data[0];
    uint32_t order = bud.order;
    if (buds->count > 1) bud = prom_bud_bind(grower, buds->data, buds->count, layer, false);
    bud.order = order;
    prom_array_push(out, bud);
}

static void limit(prom_grower *grower, prom_buds *buds, prom_layer layer);

// Divides buds into parts of about equal number, each along the then longest axis, and appends
// a branch for each.
static void divide(prom_grower *grower, prom_bud *buds, size_t count, size_t parts,
                   prom_layer layer, prom_buds *out)
{
    if (parts == 1) {
        prom_buds part = {0};
        append(&part, buds, count);
        limit(grower, &part, layer);
        push_branch(grower, &part, layer, out);
        prom_array_finish(&part);
        return;
    }
    prom_wbox box = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < count; i++) prom_wbox_add_point(&box, buds[i].center);
    int axis = prom_wbox_longest_axis(&box);
    for (size_t i = 0; i < count; i++) buds[i].key = buds[i].center[axis];
    qsort(buds, count, sizeof *buds, by_key);
    size_t left = count * (parts / 2) / parts;
    divide(grower, buds, left, parts / 2, layer, out);
    divide(grower, buds + left, count - left, parts - parts / 2, layer, out);
}

// Leaves at most max_children buds, by putting a level of branches between.
static void limit(prom_grower *grower, prom_buds *buds, prom_layer layer)
{
    size_t most = grower->options.max_children;
    if (buds->count <= most) return;
    size_t parts = (buds->count + PARTS - 1) / PARTS, least = (buds->count + most - 1) / most;
    if (parts > PARTS) parts = PARTS;
    if (parts < least) parts = least;
    if (parts > most) parts = most;
    prom_buds out = {0};
    divide(grower, buds->data, buds->count, parts, layer, &out);
    prom_array_finish(buds);
    *buds = out;
}

typedef struct cell {
    double corner[3], edge;
    int depth;
} cell;

static cell octant_of(const cell *c, unsigned o)
{
    cell child = {.edge = c->edge / 2, .depth = c->depth + 1};
    for (int k = 0; k < 3; k++) child.corner[k] = c->corner[k] + (o >> k & 1 ? child.edge : 0);
    return child;
}

// 8: too large for any octant.
static unsigned find_octant(const cell *c, const prom_bud *bud)
{
    if (bud->radius > c->edge / 2) return 8;
    unsigned o = 0;
    for (int k = 0; k < 3; k++)
        o |= (unsigned)(bud->center[k] >= c->corner[k] + c->edge / 2) << k;
    return o;
}

// Sorts buds by octant, each octant's in their order; start[o]..start[o + 1] is octant o's
// share, the ninth what stays.
static void sort_octants(const cell *c, prom_bud *buds, size_t count, size_t start[10])
{
    prom_bud *copy = prom_alloc(count, sizeof *copy);
    memcpy(copy, buds, count * sizeof *copy);
    memset(start, 0, 10 * sizeof *start);
    for (size_t i = 0; i < count; i++) start[find_octant(c, &copy[i]) + 1]++;
    for (int o = 0; o < 9; o++) start[o + 1] += start[o];
    size_t at[9];
    memcpy(at, start, sizeof at);
    for (size_t i = 0; i < count; i++) buds[at[find_octant(c, &copy[i])]++] = copy[i];
    prom_free(copy);
}

static void grow_cell(prom_grower *grower, prom_bud *buds, size_t count, const cell *c,
                      prom_layer layer, prom_buds *out)
{
    size_t start[10];
    if (count <= LEAF_BUDS || c->depth >= MOST_DEPTH) {
        append(out, buds, count);
        limit(grower, out, layer);
        return;
    }
    sort_octants(c, buds, count, start);
    prom_buds grown[8] = {0};
    size_t room = count - start[8];
    for (unsigned o = 0; o < 8; o++) {
        size_t n = start[o + 1] - start[o];
        cell child = octant_of(c, o);
        if (n) grow_cell(grower, buds + start[o], n, &child, layer, &grown[o]);
        room += n > 0;
        if (n == count) { // nothing beside it: the octant stands for the cell
            *out = grown[o];
            return;
        }
    }
    append(out, buds + start[8], count - start[8]);
    for (unsigned o = 0; o < 8; o++) {
        size_t n = grown[o].count, most = grower->options.max_children;
        if (!n) continue;
        bool dissolve = n <= SMALL_CHILD && room + n - 1 <= (most < ROOM ? most : ROOM);
        if (dissolve) {
            append(out, grown[o].data, n);
            room += n - 1;
        } else {
            push_branch(grower, &grown[o], layer, out);
        }
        prom_array_finish(&grown[o]);
    }
    limit(grower, out, layer);
}

void prom_grow_loose(prom_grower *grower, prom_bud *buds, size_t count, prom_layer layer,
                     prom_buds *out)
{
    prom_wbox box = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < count; i++) prom_wbox_add_point(&box, buds[i].center);
    cell root = {.depth = 0};
    for (int k = 0; k < 3; k++) {
        root.corner[k] = box.min[k];
        root.edge = fmax(root.edge, box.max[k] - box.min[k]);
    }
    grow_cell(grower, buds, count, &root, layer, out);
}
