// Gathering: small items become objects together with their neighbours. Items are halved in
// space again and again, where the widest gap near the middle is, until what is left is small
// enough to be one object.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"

#include <stdlib.h>

enum { MOST_MATERIALS = 8, WORTHWHILE = 64 }; // choices: draws, and triangles, of an object
// An object wider than this share of the layout is divided further, down to WORTHWHILE
// triangles.
#define WIDE_SHARE (1.0 / 16)

typedef struct speck {
    double at[3]; // centre
    double key;   // along the axis in turn
    uint32_t item, material;
} speck;

typedef struct gatherer {
    const prom_finder *finder;
    prom_face *faces; // where the next object goes
    prom_spans *objects;
} gatherer;

static int by_key(const void *pa, const void *pb)
{
    const speck *a = pa, *b = pb;
    if (a->key != b->key) return a->key < b->key ? -1 : 1;
    return a->item < b->item ? -1 : a->item > b->item;
}

static const prom_item *item_of(const gatherer *g, const speck *s)
{
    return &g->finder->items.data[s->item];
}

static size_t count_triangles(const gatherer *g, const speck *specks, size_t count)
{
    size_t sum = 0;
    for (size_t i = 0; i < count; i++) sum += item_of(g, &specks[i])->face_count;
    return sum;
}

// Counts different materials, up to one more than an object should have.
static size_t count_materials(const speck *specks, size_t count)
{
    uint32_t seen[MOST_MATERIALS + 1];
    size_t found = 0;
    for (size_t i = 0; i < count && found <= MOST_MATERIALS; i++) {
        size_t k = 0;
        while (k < found && seen[k] != specks[i].material) k++;
        if (k == found) seen[found++] = specks[i].material;
    }
    return found;
}

static bool fits(const gatherer *g, const speck *specks, size_t count, const prom_wbox *centers)
{
    const prom_finder *f = g->finder;
    size_t triangles = count_triangles(g, specks, count);
    size_t few = f->options.min_triangles;
    if (triangles > 2 * few) return false;
    if (triangles > WORTHWHILE &&
        prom_wbox_diagonal(centers) > WIDE_SHARE * f->scope->layout.diagonal)
        return false;
    return triangles <= few || count_materials(specks, count) <= MOST_MATERIALS;
}

static void emit(gatherer *g, const speck *specks, size_t count)
{
    prom_span span = {.faces = g->faces, .bounds = PROM_WBOX_EMPTY};
    for (size_t i = 0; i < count; i++) {
        const prom_item *item = item_of(g, &specks[i]);
        memcpy(g->faces, g->finder->faces.data + item->first_face,
               item->face_count * sizeof *g->faces);
        g->faces += item->face_count;
        span.count += item->face_count;
        prom_wbox_add(&span.bounds, &item->bounds);
    }
    prom_array_push(g->objects, span);
}

// Where to divide sorted specks: the widest gap that leaves at least a third of the triangles
// on either side; without such a place, the middle.
static size_t widest_gap(const gatherer *g, const speck *specks, size_t count)
{
    size_t total = count_triangles(g, specks, count), sum = 0, best = count / 2;
    double widest = 0;
    for (size_t i = 1; i < count; i++) {
        sum += item_of(g, &specks[i - 1])->face_count;
        double gap = specks[i].key - specks[i - 1].key;
        if (3 * sum >= total && 3 * sum <= 2 * total && gap > widest) {
            widest = gap;
            best = i;
        }
    }
    return best;
}

static void gather(gatherer *g, speck *specks, size_t count)
{
    prom_wbox centers = PROM_WBOX_EMPTY;
    for (size_t i = 0; i < count; i++) prom_wbox_add_point(&centers, specks[i].at);
    if (count < 2 || fits(g, specks, count, &centers)) {
        emit(g, specks, count);
        return;
    }
    int axis = prom_wbox_longest_axis(&centers);
    for (size_t i = 0; i < count; i++) specks[i].key = specks[i].at[axis];
    qsort(specks, count, sizeof *specks, by_key);
    size_t at = widest_gap(g, specks, count);
    gather(g, specks, at);
    gather(g, specks + at, count - at);
}

void prom_gather(const prom_finder *finder, const uint32_t *items, size_t count,
                 prom_face *faces, prom_spans *objects)
{
    if (!count) return;
    speck *specks = prom_alloc(count, sizeof *specks);
    for (size_t i = 0; i < count; i++) {
        const prom_item *item = &finder->items.data[items[i]];
        specks[i].item = items[i];
        specks[i].material = prom_face_material(finder, finder->faces.data[item->first_face]);
        prom_wbox_center(&item->bounds, specks[i].at);
    }
    gatherer g = {finder, faces, objects};
    gather(&g, specks, count);
    prom_free(specks);
}
