#include "builder/simplify/keep.h"

#include "builder/simplify/cards.h"
#include "builder/simplify/corner.h"

#include <math.h>
#include <stdlib.h>

// By taste: which components must not vanish, what vanishing is, to how many triangles such a
// component is reduced, and how many of them and of the triangles are given away for it.
#define NOTABLE_EXTENT 0.07f // of the mesh's diagonal
#define LEAST_AREA 0.25f     // of what it had
enum { PART_TRIANGLES = 12, MAX_PARTS = 96, BUDGET_SHARE = 4 };

typedef struct part {
    float area;
    uint32_t component;
} part;

static int by_area(const void *a, const void *b)
{
    const part *x = a, *y = b;
    if (x->area != y->area) return x->area > y->area ? -1 : 1;
    return x->component < y->component ? -1 : x->component > y->component;
}

typedef struct parts {
    uint32_t *of; // per triangle
    prom_component *components;
    uint32_t count;
} parts;

// Area that the result has left of each component.
static float *areas_left(const prom_work *work, const parts *p, const prom_index_array *faces,
                         const prom_index_array *result)
{
    const prom_vertex *v = work->vertices.data;
    uint32_t *at_place = prom_alloc(work->place.count, sizeof *at_place);
    float *left = prom_calloc(p->count, sizeof *left);
    for (size_t i = 0; i < faces->count; i++)
        at_place[work->place.data[faces->data[i]]] = p->of[i / 3];
    for (size_t i = 0; i < result->count; i += 3) {
        const uint32_t *t = result->data + i;
        float cross[3];
        prom_triangle_cross(v[t[0]].position, v[t[1]].position, v[t[2]].position, cross);
        left[at_place[work->place.data[t[0]]]] += glm_vec3_norm(cross) / 2;
    }
    prom_free(at_place);
    return left;
}

static uint32_t cost_of(const prom_component *c)
{
    return c->triangles < PART_TRIANGLES ? c->triangles : PART_TRIANGLES;
}

// Marks the largest vanished components that can be paid for; returns their triangles.
static uint32_t choose_parts(const prom_work *work, const parts *p, const float *left,
                             uint32_t budget, uint8_t *chosen)
{
    part *lost = prom_alloc(p->count, sizeof *lost);
    uint32_t count = 0, spent = 0;
    for (uint32_t i = 0; i < p->count; i++) {
        const prom_component *c = &p->components[i];
        if (left[i] >= LEAST_AREA * c->area) continue;
        if (prom_box_diagonal(&c->box) < NOTABLE_EXTENT * work->diagonal) continue;
        lost[count++] = (part){c->area, i};
    }
    qsort(lost, count, sizeof *lost, by_area);
    for (uint32_t i = 0; i < count && i < MAX_PARTS; i++) {
        uint32_t cost = cost_of(&p->components[lost[i].component]);
        if (spent + cost > budget) continue;
        spent += cost;
        chosen[lost[i].component] = 1;
    }
    prom_free(lost);
    return spent;
}

// Reduces the chosen components one by one, by their shape alone.
static void add_parts(const prom_work *work, const prom_index_array *faces, const parts *p,
                      const uint8_t *chosen, const prom_collapse_options *options,
                      prom_index_array *out, float *error)
{
    size_t *at = prom_calloc((size_t)p->count + 1, sizeof *at);
    uint32_t *sorted = prom_alloc(faces->count, sizeof *sorted);
    for (size_t i = 0; i < faces->count; i++) at[p->of[i / 3] + 1]++;
    for (uint32_t c = 0; c < p->count; c++) at[c + 1] += at[c];
    for (size_t i = 0; i < faces->count; i++) sorted[at[p->of[i / 3]]++] = faces->data[i];
    uint32_t *reading = prom_alloc(work->base_count, sizeof *reading);
    prom_read_vertices(work, PROM_READ_POSITION, reading);
    prom_index_array reduced = {0};
    for (uint32_t c = 0; c < p->count; c++) {
        if (!chosen[c]) continue;
        size_t count = (size_t)p->components[c].triangles * 3;
        prom_collapse_options own = *options;
        own.target = cost_of(&p->components[c]);
        prom_work_collapse_run(work, sorted + at[c] - count, count, &own, reading, &reduced,
                               error);
    }
    prom_choose_corners(work, faces, reading, options->plain, &reduced);
    for (size_t i = 0; i < reduced.count; i++) prom_array_push(out, reduced.data[i]);
    prom_array_finish(&reduced);
    prom_free(reading);
    prom_free(sorted);
    prom_free(at);
}

void prom_work_collapse_keeping(const prom_work *work, const prom_index_array *faces,
                                const prom_collapse_options *options, prom_index_array *out,
                                float *error)
{
    prom_work_collapse(work, faces, options, out, error);
    if (options->lock_border || out->count == faces->count) return;
    parts p = {.of = prom_alloc(faces->count / 3, sizeof *p.of)};
    p.count = prom_work_components(work, faces, p.of, &p.components);
    uint8_t *chosen = prom_calloc(p.count, 1);
    float *left = areas_left(work, &p, faces, out);
    uint32_t spent = choose_parts(work, &p, left, options->target / BUDGET_SHARE, chosen);
    if (spent) {
        prom_index_array rest = {0};
        for (size_t i = 0; i < faces->count; i++)
            if (!chosen[p.of[i / 3]]) prom_array_push(&rest, faces->data[i]);
        prom_collapse_options rest_options = *options;
        rest_options.target -= spent;
        prom_work_collapse(work, &rest, &rest_options, out, error);
        add_parts(work, faces, &p, chosen, options, out, error);
        prom_array_finish(&rest);
    }
    prom_free(left);
    prom_free(chosen);
    prom_free(p.components);
    prom_free(p.of);
}
