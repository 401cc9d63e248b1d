// Charts grow from the largest faces over their edges, as long as the faces look about the same
// way.
#include "builder/atlas.h"

#include "builder/simplify/work.h"

#include <math.h>
#include <stdlib.h>

// Cosines between a face and the first one of its chart, and between a face and the chart's
// axis: by taste, so that no face is shown in less than a third of its area.
#define LEAST_ALIKE 0.64f // 50 degrees
#define LEAST_SEEN 0.34f  // 70 degrees
// Edges whose directions are tried for the chart's rectangle.
enum { MAX_TURNS = 128 };

typedef struct half_edge {
    uint32_t low, high; // places of its ends
    uint32_t corner;    // it goes from this corner of the index list to the next one
} half_edge;

typedef struct charting {
    const prom_mesh *mesh;
    uint32_t faces;
    uint32_t *place;   // per vertex: the first one at its position
    float (*cross)[3]; // per face: twice its area's vector
    uint32_t *across;  // per corner: the face at the edge that begins there, or PROM_NONE
    uint32_t *order;   // faces from large to small
    uint8_t *taken;    // per face
} charting;

static uint32_t next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

static const float *position(const charting *c, uint32_t corner)
{
    return c->mesh->vertices[c->mesh->indices[corner]].position;
}

static float cosine(const float a[3], const float b[3])
{
    float lengths = glm_vec3_norm((float *)a) * glm_vec3_norm((float *)b);
    return lengths > 0 ? glm_vec3_dot((float *)a, (float *)b) / lengths : 1;
}

static void find_places(charting *c)
{
    uint32_t count = c->mesh->vertex_count;
    float(*positions)[3] = prom_alloc(count, sizeof *positions);
    for (uint32_t i = 0; i < count; i++)
        glm_vec3_copy(c->mesh->vertices[i].position, positions[i]);
    c->place = prom_alloc(count, sizeof *c->place);
    prom_first_equal(positions, count, sizeof *positions, c->place);
    prom_free(positions);
}

// ---- which faces meet at an edge

static int by_ends(const void *a, const void *b)
{
    const half_edge *x = a, *y = b;
    if (x->low != y->low) return x->low < y->low ? -1 : 1;
    if (x->high != y->high) return x->high < y->high ? -1 : 1;
    return (x->corner > y->corner) - (x->corner < y->corner);
}

static uint32_t start_of(const charting *c, const half_edge *e)
{
    return c->place[c->mesh->indices[e->corner]];
}

// Pairs a half-edge with the free one of the opposite direction whose face goes on straightest:
// where the two sides of a sheet meet, each goes on with its own.
static void pair(charting *c, half_edge *edges, uint32_t i, uint32_t end)
{
    const half_edge *e = &edges[i];
    uint32_t best = PROM_NONE;
    float best_cosine = LEAST_ALIKE;
    if (c->across[e->corner] != PROM_NONE || e->low == e->high) return;
    for (uint32_t k = i + 1; k < end; k++) {
        if (c->across[edges[k].corner] != PROM_NONE) continue;
        if (start_of(c, &edges[k]) == start_of(c, e)) continue;
        float alike = cosine(c->cross[e->corner / 3], c->cross[edges[k].corner / 3]);
        if (alike <= best_cosine) continue;
        best = k;
        best_cosine = alike;
    }
    if (best == PROM_NONE) return;
    c->across[e->corner] = edges[best].corner / 3;
    c->across[edges[best].corner] = e->corner / 3;
}

static void find_neighbours(charting *c)
{
    uint32_t count = c->faces * 3;
    half_edge *edges = prom_alloc(count, sizeof *edges);
    c->across = prom_alloc(count, sizeof *c->across);
    for (uint32_t i = 0; i < count; i++) {
        uint32_t a = c->place[c->mesh->indices[i]];
        uint32_t b = c->place[c->mesh->indices[next_corner(i)]];
        edges[i] = (half_edge){a < b ? a : b, a < b ? b : a, i};
        c->across[i] = PROM_NONE;
    }
    qsort(edges, count, sizeof *edges, by_ends);
    for (uint32_t first = 0, end = 0; first < count; first = end) {
        while (end < count && edges[end].low == edges[first].low &&
               edges[end].high == edges[first].high)
            end++;
        for (uint32_t i = first; i < end; i++) pair(c, edges, i, end);
    }
    prom_free(edges);
}

// ---- growing

typedef struct ranked_face {
    float area;
    uint32_t face;
} ranked_face;

static int by_area(const void *a, const void *b)
{
    const ranked_face *x = a, *y = b;
    if (x->area != y->area) return x->area > y->area ? -1 : 1;
    return (x->face > y->face) - (x->face < y->face);
}

static void rank_faces(charting *c)
{
    ranked_face *ranked = prom_alloc(c->faces, sizeof *ranked);
    c->cross = prom_alloc(c->faces, sizeof *c->cross);
    c->order = prom_alloc(c->faces, sizeof *c->order);
    for (uint32_t f = 0; f < c->faces; f++) {
        prom_triangle_cross(position(c, f * 3), position(c, f * 3 + 1), position(c, f * 3 + 2),
                            c->cross[f]);
        ranked[f] = (ranked_face){glm_vec3_norm(c->cross[f]), f};
    }
    qsort(ranked, c->faces, sizeof *ranked, by_area);
    for (uint32_t f = 0; f < c->faces; f++) c->order[f] = ranked[f].face;
    prom_free(ranked);
}

// Appends the chart of `seed` to the faces; breadth first, so that it grows round.
static void grow(charting *c, uint32_t seed, prom_atlas *atlas, prom_chart *chart)
{
    uint32_t *faces = atlas->faces;
    chart->first = atlas->face_count;
    faces[atlas->face_count++] = seed;
    c->taken[seed] = 1;
    for (uint32_t i = chart->first; i < atlas->face_count; i++)
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t next = c->across[faces[i] * 3 + k];
            if (next == PROM_NONE || c->taken[next]) continue;
            if (cosine(c->cross[next], c->cross[seed]) < LEAST_ALIKE) continue;
            c->taken[next] = 1;
            faces[atlas->face_count++] = next;
        }
    chart->count = atlas->face_count - chart->first;
}

// ---- the frame of a chart

// The mean normal, or that of the first face where the mean would hide another.
static void find_axis(const charting *c, const prom_atlas *atlas, prom_chart *chart)
{
    const uint32_t *faces = atlas->faces + chart->first;
    float axis[3] = {0};
    for (uint32_t i = 0; i < chart->count; i++) glm_vec3_add(axis, c->cross[faces[i]], axis);
    for (uint32_t i = 0; i < chart->count; i++)
        if (cosine(c->cross[faces[i]], axis) < LEAST_SEEN) {
            glm_vec3_copy(c->cross[faces[0]], axis);
            break;
        }
    if (!(glm_vec3_norm2(axis) > 0)) glm_vec3_copy((vec3){0, 1, 0}, axis);
    glm_vec3_normalize_to(axis, chart->out);
}

static void set_right(prom_chart *chart, const float along[3])
{
    vec3 flat;
    glm_vec3_scale(chart->out, glm_vec3_dot(chart->out, (float *)along), flat);
    glm_vec3_sub((float *)along, flat, flat);
    if (!(glm_vec3_norm2(flat) > 1e-6f * glm_vec3_norm2((float *)along)))
        glm_vec3_ortho(chart->out, flat);
    glm_vec3_normalize_to(flat, chart->right);
    glm_vec3_crossn(chart->out, chart->right, chart->up);
}

static void measure(const charting *c, const prom_atlas *atlas, prom_chart *chart)
{
    const float *axes[3] = {chart->right, chart->up, chart->out};
    prom_box box = PROM_BOX_EMPTY;
    for (uint32_t i = 0; i < chart->count * 3; i++) {
        const float *p = position(c, atlas->faces[chart->first + i / 3] * 3 + i % 3);
        float at[3];
        for (int a = 0; a < 3; a++) at[a] = glm_vec3_dot((float *)axes[a], (float *)p);
        prom_box_add_point(&box, at);
    }
    memcpy(chart->min, box.min, sizeof chart->min);
    memcpy(chart->max, box.max, sizeof chart->max);
}

static float area_of(const prom_chart *chart)
{
    return (chart->max[0] - chart->min[0]) * (chart->max[1] - chart->min[1]);
}

// The smallest rectangle has a side along an edge of the hull (Freeman and Shapira 1975); tried
// are edges at the border of the chart.
static void find_rectangle(const charting *c, const prom_atlas *atlas, prom_chart *chart)
{
    const uint32_t *faces = atlas->faces + chart->first;
    prom_chart best = *chart;
    uint32_t stride = chart->count * 3 / MAX_TURNS + 1;
    bool any = false;
    for (uint32_t i = 0; i < chart->count * 3; i += stride) {
        uint32_t corner = faces[i / 3] * 3 + i % 3;
        if (c->across[corner] != PROM_NONE && any) continue;
        vec3 along;
        glm_vec3_sub((float *)position(c, next_corner(corner)), (float *)position(c, corner),
                     along);
        prom_chart turned = *chart;
        set_right(&turned, along);
        measure(c, atlas, &turned);
        if (any && area_of(&turned) >= area_of(&best)) continue;
        best = turned;
        any = true;
    }
    *chart = best;
}

void prom_atlas_chart(prom_atlas *atlas, const prom_mesh *mesh)
{
    charting c = {.mesh = mesh, .faces = mesh->index_count / 3};
    PROM_ARRAY(prom_chart) charts = {0};
    *atlas = (prom_atlas){.faces = prom_alloc(c.faces, sizeof *atlas->faces)};
    find_places(&c);
    rank_faces(&c);
    find_neighbours(&c);
    c.taken = prom_calloc(c.faces, 1);
    for (uint32_t i = 0; i < c.faces; i++) {
        if (c.taken[c.order[i]]) continue;
        prom_chart chart = {0};
        grow(&c, c.order[i], atlas, &chart);
        find_axis(&c, atlas, &chart);
        find_rectangle(&c, atlas, &chart);
        prom_array_push(&charts, chart);
    }
    atlas->charts = charts.data;
    atlas->chart_count = (uint32_t)charts.count;
    prom_free(c.place);
    prom_free(c.cross);
    prom_free(c.across);
    prom_free(c.order);
    prom_free(c.taken);
}
