#include "builder/simplify/reduce.h"

#include "builder/simplify/cards.h"
#include "builder/simplify/collapse.h"
#include "builder/simplify/distance.h"
#include "builder/simplify/keep.h"

#include <math.h>

// Up to here every vertex and centroid is measured (MAX_SAMPLES of simplify_distance.c).
enum { MEASURED_TRIANGLES = 10000 };
// Cards of many triangles lose those first that cost no more than this share of a card's
// extent.
#define CARD_DETAIL 0.04f

static float triangle_area(const prom_work *work, const uint32_t *t)
{
    const prom_vertex *v = work->vertices.data;
    float cross[3];
    prom_triangle_cross(v[t[0]].position, v[t[1]].position, v[t[2]].position, cross);
    return glm_vec3_norm(cross) / 2;
}

// A submesh that has lost its last triangle gets its largest one back, so that its material
// stays in sight.
static void restore_vanished(const prom_work *work, prom_index_array *out)
{
    uint32_t submeshes = work->submesh_count;
    uint8_t *present = prom_calloc(submeshes, 1);
    float *largest = prom_calloc(submeshes, sizeof *largest);
    size_t *at = prom_alloc(submeshes, sizeof *at);
    for (size_t i = 0; i < out->count; i += 3)
        present[prom_owner_submesh(work->owners.data[out->data[i]])] = 1;
    for (size_t i = 0; i < work->indices.count; i += 3) {
        const uint32_t *t = work->indices.data + i;
        uint32_t s = prom_owner_submesh(work->owners.data[t[0]]);
        if (present[s]) continue;
        float area = triangle_area(work, t);
        if (area > largest[s]) largest[s] = area, at[s] = i;
    }
    for (uint32_t s = 0; s < submeshes; s++)
        for (int k = 0; largest[s] > 0 && k < 3; k++)
            prom_array_push(out, work->indices.data[at[s] + k]);
    prom_free(at);
    prom_free(largest);
    prom_free(present);
}

static float area_of(const prom_work *work, const prom_index_array *faces)
{
    double area = 0;
    for (size_t i = 0; i < faces->count; i += 3) area += triangle_area(work, faces->data + i);
    return (float)area;
}

static void reduce_cards(prom_work *work, const prom_index_array *cards, uint32_t target,
                         float extent, bool plain, prom_index_array *out)
{
    prom_index_array flat = {0}, thinned = {0};
    prom_collapse_options detail = {target, CARD_DETAIL * extent, false, plain};
    float ignored; // the deviation is measured
    prom_work_collapse(work, cards, &detail, &flat, &ignored);
    float area = area_of(work, &flat);
    float growth = area > 0 ? area_of(work, cards) / area : 1;
    prom_work_thin_cards(work, &flat, target, growth, &thinned);
    for (size_t i = 0; i < thinned.count; i++) prom_array_push(out, thinned.data[i]);
    prom_array_finish(&flat);
    prom_array_finish(&thinned);
}

float prom_work_reduce(prom_work *work, const prom_reduce_options *options,
                       prom_index_array *out)
{
    prom_index_array solid = {0}, cards = {0};
    float card_extent = 0;
    size_t fronts = work->indices.count / 3;
    double ratio = fronts ? (double)options->target / work->triangles : 0;
    if (options->lock_border || options->keep_cards) {
        prom_array_reserve(&solid, work->indices.count);
        memcpy(solid.data, work->indices.data, work->indices.count * sizeof *solid.data);
        solid.count = work->indices.count;
    } else {
        card_extent = prom_work_split_cards(work, !options->plain, &solid, &cards);
    }
    // In proportion, but an eighth at least for what holds the leaves: a trunk of few triangles
    // is seen more than its number says (by taste).
    uint32_t target = (uint32_t)(ratio * (double)fronts);
    uint32_t solid_target = (uint32_t)(ratio * (double)(solid.count / 3));
    if (solid_target < target / 8) solid_target = target / 8;
    if (solid_target > solid.count / 3) solid_target = (uint32_t)(solid.count / 3);
    if (solid_target < 1) solid_target = 1;
    float estimate;
    if (options->sloppy) {
        prom_work_sloppy(work, &solid, solid_target, options->max_error, out, &estimate);
    } else {
        prom_collapse_options collapse = {solid_target, options->max_error,
                                          options->lock_border, options->plain};
        prom_work_collapse_keeping(work, &solid, &collapse, out, &estimate);
    }
    uint32_t card_target = target > solid_target ? target - solid_target : 0;
    if (cards.count) reduce_cards(work, &cards, card_target, card_extent, options->plain, out);
    if (!options->sloppy && !options->plain) restore_vanished(work, out);
    prom_array_finish(&cards);
    prom_array_finish(&solid);
    float error = prom_work_deviation(work, out);
    return fronts > MEASURED_TRIANGLES ? fmaxf(error, estimate) : error;
}
