#include "builder/simplify/reduce.h"

#include "builder/simplify/cards.h"
#include "builder/simplify/mesh_collapse.h"

#include <math.h>

// Cards of many triangles lose those first that cost no more than this share of a card's
// extent.
#define CARD_DETAIL 0.04f
// By taste: of all triangles what holds the leaves gets this part at least. A trunk of few
// triangles is seen more than its number says.
enum { SOLID_SHARE = 8 };

// Faces that are collapsed together.
typedef struct part {
    prom_collapse_mesh mesh;
    prom_collapser *collapser;
    uint32_t triangles; // at first
} part;

struct prom_reduction {
    prom_work *work;
    prom_reduce_options options;
    part solid, cards;
    float card_extent, card_area; // mean of one, sum of all
};

static float triangle_area(const prom_work *work, const uint32_t *t)
{
    const prom_vertex *v = work->vertices.data;
    float cross[3];
    prom_triangle_cross(v[t[0]].position, v[t[1]].position, v[t[2]].position, cross);
    return glm_vec3_norm(cross) / 2;
}

static float area_of(const prom_work *work, const prom_index_array *faces)
{
    double area = 0;
    for (size_t i = 0; i < faces->count; i += 3)
        area += (double)triangle_area(work, faces->data + i);
    return (float)area;
}

static void part_init(part *p, const prom_reduction *r, const prom_index_array *faces,
                      float pair_distance)
{
    const prom_work *work = r->work;
    const prom_collapse_options options = {.lock_border = r->options.lock_border,
                                           .pair_distance = pair_distance,
                                           .loose = r->options.loose};
    p->triangles = (uint32_t)(faces->count / 3);
    if (!p->triangles) return;
    prom_collapse_mesh_init(&p->mesh, work->vertices.data, work->base_count, work->owners.data,
                            faces->data, faces->count);
    p->collapser = prom_collapser_create(&p->mesh, &options);
}

static void part_finish(part *p)
{
    if (!p->collapser) return;
    prom_collapser_destroy(p->collapser);
    prom_collapse_mesh_finish(&p->mesh);
}

prom_reduction *prom_reduction_create(prom_work *work, const prom_reduce_options *options)
{
    prom_reduction *r = prom_calloc(1, sizeof *r);
    r->work = work;
    r->options = *options;
    prom_index_array solid = {0}, cards = {0};
    if (options->lock_border || options->keep_cards) {
        part_init(&r->solid, r, &work->indices, options->pair_distance);
    } else {
        r->card_extent = prom_work_split_cards(work, !options->merged, &solid, &cards);
        r->card_area = area_of(work, &cards);
        part_init(&r->solid, r, &solid, options->pair_distance);
        part_init(&r->cards, r, &cards, 0);
    }
    prom_array_finish(&solid);
    prom_array_finish(&cards);
    return r;
}

void prom_reduction_destroy(prom_reduction *r)
{
    if (!r) return;
    part_finish(&r->solid);
    part_finish(&r->cards);
    prom_free(r);
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

// The part of the cards that stays where each may grow by `error` on each side.
static float share_left(float extent, float error)
{
    const float grown = extent + 2 * error;
    return extent * extent / (grown * grown);
}

static void run_cards(prom_reduction *r, uint32_t target, float max_error,
                      prom_index_array *out)
{
    prom_index_array flat = {0}, thinned = {0};
    const float left = share_left(r->card_extent, max_error) * (float)r->cards.triangles;
    if (target < (uint32_t)left) target = (uint32_t)left;
    prom_collapser_run(r->cards.collapser, target,
                       fminf(max_error, CARD_DETAIL * r->card_extent));
    prom_collapse_mesh_faces(&r->cards.mesh, r->work, &flat);
    const float area = area_of(r->work, &flat);
    prom_work_thin_cards(r->work, &flat, target, area > 0 ? r->card_area / area : 1, &thinned);
    for (size_t i = 0; i < thinned.count; i++) prom_array_push(out, thinned.data[i]);
    prom_array_finish(&flat);
    prom_array_finish(&thinned);
}

// What goes where connections change must be small against the error allowed, so this grows
// step by step where there is no limit.
static void run_solid(prom_reduction *r, uint32_t target, float max_error)
{
    const float most = r->work->diagonal;
    for (float e = most / 4096; r->options.loose && e < fminf(max_error, most); e *= 2)
        prom_collapser_run(r->solid.collapser, target, e);
    prom_collapser_run(r->solid.collapser, target, max_error);
}

void prom_reduction_run(prom_reduction *r, uint32_t target, float max_error,
                        prom_index_array *out)
{
    prom_work *work = r->work;
    const size_t fronts = work->indices.count / 3;
    const double ratio = work->triangles ? (double)target / work->triangles : 0;
    target = (uint32_t)(ratio * (double)fronts);
    uint32_t solid_target = (uint32_t)(ratio * r->solid.triangles);
    if (solid_target < target / SOLID_SHARE) solid_target = target / SOLID_SHARE;
    if (solid_target > r->solid.triangles) solid_target = r->solid.triangles;
    out->count = 0;
    if (r->solid.collapser) {
        run_solid(r, solid_target, max_error);
        prom_collapse_mesh_faces(&r->solid.mesh, work, out);
    }
    if (r->cards.collapser)
        run_cards(r, target > solid_target ? target - solid_target : 0, max_error, out);
    prom_work_find_places(work);
    if (!r->options.merged) restore_vanished(work, out);
}
