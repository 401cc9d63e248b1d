// Hoppe 1999, "New quadric metric for simplifying meshes with appearance attributes": over a
// face an attribute s is a linear function of place, s(d) = g . d + s0, and the error of a
// vertex at d with attribute s is (g . d + s0 - s)^2, weighted by area. For a given place the
// best s is a mean, so that the attributes are eliminated (a Schur complement) and the place is
// found from 3 x 3 numbers. Vertices of several sides of a seam keep attributes of their own
// and share the place: their eliminated quadrics are added.
//
// Here the geometry is kept by point and the attributes by vertex, about the point's position
// and the vertex's own attributes. Attributes are in radii, by their weights.
#include "builder/simplify/point_quadrics.h"

#include "builder/simplify/work.h"

#include <assert.h>
#include <math.h>

// By the measured accuracy of levels of 15 textured models from candela_city and black_forest.
#define NORMAL_WEIGHT 0.1f
#define UV_WEIGHT 0.3f
#define COLOR_WEIGHT 0.5f
#define COLOR_LENGTH 0.02f // of the radius
// Steeper ones come from slivers and tell nothing; those of textures are about 1.
#define STEEPEST 16.0f

// Attributes of one vertex: the quadric, and of each attribute the sums of weighted g and s0.
typedef struct side {
    prom_quadric q;
    float g[PROM_ATTRIBUTES][4];
} side;

struct prom_collapse_metric {
    prom_point_quadrics points;
    uint32_t count;                      // of attributes
    bool normals, uvs, colors;           // which there are
    float normal_scale, color_scale;     // radii per unit
    float *uv_scale;                     // per group
    float *sides;                        // per original vertex: 11 + 4 count numbers
    PROM_ARRAY(uint32_t) side_of_vertex; // new vertices take over an old one's
};

static size_t side_floats(const prom_collapse_metric *metric)
{
    return sizeof(prom_quadric) / sizeof(float) + 4 * (size_t)metric->count;
}

static float *side_at(const prom_collapse_metric *metric, uint32_t vertex)
{
    return metric->sides + metric->side_of_vertex.data[vertex] * side_floats(metric);
}

static void load_side(const prom_collapse_metric *metric, uint32_t vertex, side *out)
{
    const float *from = side_at(metric, vertex);
    memcpy(&out->q, from, sizeof out->q);
    from += sizeof out->q / sizeof *from;
    for (uint32_t j = 0; j < metric->count; j++)
        memcpy(out->g[j], from + 4 * (size_t)j, sizeof out->g[j]);
}

static void store_side(prom_collapse_metric *metric, uint32_t vertex, const side *in)
{
    memcpy(side_at(metric, vertex), in, side_floats(metric) * sizeof(float));
}

static void clear_side(side *s, uint32_t count)
{
    memset(&s->q, 0, sizeof s->q);
    for (uint32_t j = 0; j < count; j++) memset(s->g[j], 0, sizeof s->g[j]);
}

static float finite_or_zero(float x)
{
    return isfinite(x) ? x : 0;
}

// A vertex's attributes in radii.
static void attributes_of(const prom_collapse_metric *metric, uint32_t vertex, float *out)
{
    const prom_vertex *v = &metric->points.mesh->vertices.data[vertex];
    if (metric->normals)
        for (int k = 0; k < 3; k++) *out++ = (float)v->normal[k] * (metric->normal_scale / 127);
    if (metric->uvs)
        for (int k = 0; k < 2; k++)
            *out++ = finite_or_zero(v->uv[k]) *
                     metric->uv_scale[metric->points.mesh->group.data[vertex]];
    if (metric->colors)
        for (int k = 0; k < 4; k++)
            *out++ = metric->color_scale *
                     (k < 3 ? prom_srgb8_to_linear(v->color[k]) : (float)v->color[k] / 255);
}

// ---- what a collapse adds up

// About a place that is `d` away.
static void shift_place(side *s, uint32_t count, const float d[3])
{
    for (uint32_t j = 0; j < count; j++) s->g[j][3] += glm_vec3_dot(s->g[j], (float *)d);
    prom_quadric_shift(&s->q, d);
}

// About attributes that are `e` away.
static void shift_attributes(side *s, uint32_t count, const float *e)
{
    for (uint32_t j = 0; j < count; j++) {
        for (int k = 0; k < 3; k++) s->q.b[k] -= e[j] * s->g[j][k];
        s->q.c += e[j] * (s->q.w * e[j] - 2 * s->g[j][3]);
        s->g[j][3] -= s->q.w * e[j];
    }
}

static void add_side(side *sum, uint32_t count, const side *other)
{
    prom_quadric_add(&sum->q, &other->q);
    for (uint32_t j = 0; j < count; j++)
        for (int k = 0; k < 4; k++) sum->g[j][k] += other->g[j][k];
}

// A slot's vertices together, about `to` and `reference`.
static void sum_slot(const prom_collapse_metric *metric, const prom_collapse *collapse,
                     uint32_t slot, const float *reference, side *sum)
{
    const prom_collapse_mesh *mesh = metric->points.mesh;
    float offset[3];
    prom_point_quadrics_offset(&metric->points, mesh->position[collapse->from],
                               mesh->position[collapse->to], offset);
    clear_side(sum, metric->count);
    for (uint32_t i = 0; i < collapse->count; i++) {
        if (collapse->slots[i] != slot) continue;
        side s;
        float shift[PROM_ATTRIBUTES];
        const uint32_t vertex = collapse->vertices[i];
        load_side(metric, vertex, &s);
        if (mesh->point.data[vertex] == collapse->from) shift_place(&s, metric->count, offset);
        attributes_of(metric, vertex, shift);
        for (uint32_t j = 0; j < metric->count; j++) shift[j] = reference[j] - shift[j];
        shift_attributes(&s, metric->count, shift);
        add_side(sum, metric->count, &s);
    }
}

// The attributes that a slot's sums are about: those it keeps, or its first vertex's.
static void slot_reference(const prom_collapse_metric *metric, const prom_collapse *collapse,
                           uint32_t slot, float *reference)
{
    uint32_t vertex = collapse->kept[slot];
    for (uint32_t i = 0; i < collapse->count && vertex == PROM_NONE; i++)
        if (collapse->slots[i] == slot) vertex = collapse->vertices[i];
    assert(vertex != PROM_NONE);
    attributes_of(metric, vertex, reference);
}

// The quadric of place alone, with the best attributes for each place.
static void eliminate(side *s, uint32_t count)
{
    const float part = s->q.w > 0 ? 1 / s->q.w : 0;
    for (uint32_t j = 0; j < count; j++) {
        const float *g = s->g[j];
        prom_quadric_add_form(&s->q, g, -part);
        for (int k = 0; k < 3; k++) s->q.b[k] -= part * g[3] * g[k];
        s->q.c -= part * g[3] * g[3];
    }
}

static void evaluate(prom_collapse_metric *metric, const prom_collapse *collapse,
                     prom_collapse_result *result)
{
    prom_quadric sum = prom_point_quadrics_sum(&metric->points, collapse);
    for (uint32_t slot = 0; slot < collapse->slot_count; slot++) {
        float reference[PROM_ATTRIBUTES];
        side s;
        slot_reference(metric, collapse, slot, reference);
        sum_slot(metric, collapse, slot, reference, &s);
        if (collapse->kept[slot] == PROM_NONE) eliminate(&s, metric->count);
        prom_quadric_add(&sum, &s.q);
    }
    prom_point_quadrics_choose(&metric->points, collapse, &sum, result);
}

static void set_attributes(const prom_collapse_metric *metric, uint32_t group, const float *s,
                           prom_vertex *out)
{
    if (metric->normals) {
        if (glm_vec3_norm((float *)s) > 0.1f * metric->normal_scale)
            prom_pack_normal(s, out->normal);
        s += 3;
    }
    if (metric->uvs) {
        const float scale = metric->uv_scale[group];
        for (int k = 0; k < 2 && scale > 0; k++) out->uv[k] = s[k] / scale;
        s += 2;
    }
    for (int k = 0; k < 4 && metric->colors; k++) {
        const float value = glm_clamp(s[k] / metric->color_scale, 0, 1);
        out->color[k] = k < 3 ? prom_linear_to_srgb8(value) : (uint8_t)lroundf(255 * value);
    }
}

static uint32_t slot_group(const prom_collapse_metric *metric, const prom_collapse *collapse,
                           uint32_t slot)
{
    for (uint32_t i = 0; i < collapse->count; i++)
        if (collapse->slots[i] == slot)
            return metric->points.mesh->group.data[collapse->vertices[i]];
    return 0;
}

static void best_attributes(prom_collapse_metric *metric, const prom_collapse *collapse,
                            const float place[3], prom_vertex *made)
{
    float offset[3];
    prom_point_quadrics_offset(&metric->points, metric->points.mesh->position[collapse->to],
                               place, offset);
    for (uint32_t slot = 0; slot < collapse->slot_count; slot++) {
        if (collapse->kept[slot] != PROM_NONE) continue;
        float values[PROM_ATTRIBUTES];
        side s;
        slot_reference(metric, collapse, slot, values);
        sum_slot(metric, collapse, slot, values, &s);
        if (!(s.q.w > 0)) continue;
        for (uint32_t j = 0; j < metric->count; j++)
            values[j] += (glm_vec3_dot(s.g[j], offset) + s.g[j][3]) / s.q.w;
        set_attributes(metric, slot_group(metric, collapse, slot), values, &made[slot]);
    }
}

static void merge(prom_collapse_metric *metric, const prom_collapse *collapse,
                  const float place[3], const uint32_t *vertices)
{
    float offset[3];
    prom_point_quadrics_offset(&metric->points, metric->points.mesh->position[collapse->to],
                               place, offset);
    for (uint32_t slot = 0; slot < collapse->slot_count; slot++) {
        float reference[PROM_ATTRIBUTES];
        side s;
        attributes_of(metric, vertices[slot], reference);
        sum_slot(metric, collapse, slot, reference, &s);
        shift_place(&s, metric->count, offset);
        uint32_t first = 0;
        while (collapse->slots[first] != slot) first++;
        const uint32_t taken = metric->side_of_vertex.data[collapse->vertices[first]];
        while (metric->side_of_vertex.count <= vertices[slot])
            prom_array_push(&metric->side_of_vertex, taken);
        store_side(metric, vertices[slot], &s);
    }
    prom_point_quadrics_merge(&metric->points, collapse, place);
}

// ---- the original

// Which attributes say anything, and by how much.
static void find_attributes(prom_collapse_metric *metric)
{
    const prom_collapse_mesh *mesh = metric->points.mesh;
    const uint32_t corners = 3 * mesh->triangle_slots;
    if (!corners || mesh->corners[0] == PROM_NONE) return;
    const prom_vertex *first = &mesh->vertices.data[mesh->corners[0]];
    for (uint32_t c = 0; c < corners; c++) {
        const prom_vertex *v = &mesh->vertices.data[mesh->corners[c]];
        metric->normals |= v->normal[0] || v->normal[1] || v->normal[2];
        metric->uvs |= v->uv[0] != first->uv[0] || v->uv[1] != first->uv[1];
        metric->colors |= memcmp(v->color, first->color, sizeof v->color) != 0;
    }
}

static float weight_or(float weight, float fallback)
{
    return weight == 0 ? fallback : fmaxf(weight, 0);
}

static float mean_edge(const prom_collapse_mesh *mesh)
{
    double sum = 0, n = 0;
    for (uint32_t c = 0; c < 3 * mesh->triangle_slots; c++) {
        const float *a = mesh->position[prom_corner_point(mesh, c)];
        const float *b = mesh->position[prom_corner_point(mesh, prom_corner_after(c))];
        sum += (double)glm_vec3_distance((float *)a, (float *)b);
        n++;
    }
    return n > 0 ? (float)(sum / n) : 0;
}

// Radii per unit of texture coordinates: roots of the groups' areas in both.
static void find_stretch(prom_collapse_metric *metric, float weight)
{
    const prom_collapse_mesh *mesh = metric->points.mesh;
    uint32_t groups = 1;
    for (uint32_t i = 0; i < mesh->base_vertices; i++)
        if (mesh->group.data[i] >= groups) groups = mesh->group.data[i] + 1;
    double(*areas)[2] = prom_calloc(groups, sizeof *areas);
    for (uint32_t t = 0; t < mesh->triangle_slots; t++) {
        const uint32_t *corner = mesh->corners + 3 * (size_t)t;
        const prom_vertex *v[3];
        float e[3], f[3], cross[3];
        for (int k = 0; k < 3; k++) v[k] = &mesh->vertices.data[corner[k]];
        prom_point_quadrics_offset(&metric->points, v[0]->position, v[1]->position, e);
        prom_point_quadrics_offset(&metric->points, v[0]->position, v[2]->position, f);
        glm_vec3_cross(e, f, cross);
        const float uv = (v[1]->uv[0] - v[0]->uv[0]) * (v[2]->uv[1] - v[0]->uv[1]) -
                         (v[1]->uv[1] - v[0]->uv[1]) * (v[2]->uv[0] - v[0]->uv[0]);
        if (!isfinite(uv)) continue;
        areas[mesh->group.data[corner[0]]][0] += (double)glm_vec3_norm(cross);
        areas[mesh->group.data[corner[0]]][1] += fabs((double)uv);
    }
    metric->uv_scale = prom_calloc(groups, sizeof *metric->uv_scale);
    for (uint32_t g = 0; g < groups; g++)
        if (areas[g][1] > 0)
            metric->uv_scale[g] =
                finite_or_zero(weight * (float)sqrt(areas[g][0] / areas[g][1]));
    prom_free(areas);
}

// The gradient over a triangle of a value that grows by de and df along its edges e and f.
static void gradient(const float e[3], const float f[3], const float normal[3], float de,
                     float df, float g[3])
{
    float a[3], b[3];
    const float squared = glm_vec3_norm2((float *)normal);
    glm_vec3_cross((float *)f, (float *)normal, a);
    glm_vec3_cross((float *)normal, (float *)e, b);
    for (int k = 0; k < 3; k++) g[k] = (de * a[k] + df * b[k]) / squared;
    const float steepness = glm_vec3_norm(g);
    if (!isfinite(steepness))
        glm_vec3_zero(g);
    else if (steepness > STEEPEST)
        glm_vec3_scale(g, STEEPEST / steepness, g);
}

static void add_face(prom_collapse_metric *metric, uint32_t triangle)
{
    const prom_collapse_mesh *mesh = metric->points.mesh;
    const uint32_t *corner = mesh->corners + 3 * (size_t)triangle;
    float e[3], f[3], normal[3], s[3][PROM_ATTRIBUTES];
    const float *p = mesh->vertices.data[corner[0]].position;
    prom_point_quadrics_offset(&metric->points, p, mesh->vertices.data[corner[1]].position, e);
    prom_point_quadrics_offset(&metric->points, p, mesh->vertices.data[corner[2]].position, f);
    glm_vec3_cross(e, f, normal);
    const float area = glm_vec3_norm(normal) / 2;
    if (!(area > 0)) return;
    for (int k = 0; k < 3; k++) attributes_of(metric, corner[k], s[k]);
    side own = {.q.w = area};
    for (uint32_t j = 0; j < metric->count; j++) {
        gradient(e, f, normal, s[1][j] - s[0][j], s[2][j] - s[0][j], own.g[j]);
        prom_quadric_add_form(&own.q, own.g[j], area);
        glm_vec3_scale(own.g[j], area, own.g[j]);
    }
    for (int k = 0; k < 3; k++) {
        side sum;
        load_side(metric, corner[k], &sum);
        add_side(&sum, metric->count, &own);
        store_side(metric, corner[k], &sum);
    }
}

static prom_collapse_metric *create(const prom_collapse_mesh *mesh,
                                    const prom_metric_weights *weights)
{
    prom_collapse_metric *metric = prom_calloc(1, sizeof *metric);
    prom_point_quadrics_init(&metric->points, mesh, weights);
    find_attributes(metric);
    metric->normal_scale =
        weight_or(weights->normal, NORMAL_WEIGHT) * mean_edge(mesh) * metric->points.inverse;
    metric->color_scale = weight_or(weights->color, COLOR_WEIGHT) * COLOR_LENGTH;
    find_stretch(metric, weight_or(weights->uv, UV_WEIGHT));
    metric->normals &= metric->normal_scale > 0;
    metric->uvs &= weights->uv >= 0;
    metric->colors &= metric->color_scale > 0;
    metric->count = 3 * metric->normals + 2 * metric->uvs + 4 * metric->colors;

    const uint32_t n = (uint32_t)mesh->vertices.count;
    metric->sides = prom_calloc(n, side_floats(metric) * sizeof(float));
    if (n) (void)prom_array_extend(&metric->side_of_vertex, n);
    for (uint32_t i = 0; i < n; i++) metric->side_of_vertex.data[i] = i;
    for (uint32_t t = 0; t < mesh->triangle_slots; t++) add_face(metric, t);
    return metric;
}

static void destroy(prom_collapse_metric *metric)
{
    if (!metric) return;
    prom_point_quadrics_finish(&metric->points);
    prom_array_finish(&metric->side_of_vertex);
    prom_free(metric->uv_scale);
    prom_free(metric->sides);
    prom_free(metric);
}

static size_t bytes(const prom_collapse_metric *metric)
{
    const prom_collapse_mesh *mesh = metric->points.mesh;
    return sizeof *metric + mesh->points * sizeof(prom_quadric) +
           mesh->base_vertices * side_floats(metric) * sizeof(float) +
           metric->side_of_vertex.capacity * sizeof(uint32_t);
}

const prom_collapse_metric_class prom_collapse_attributes = {
    .name = "qem-attributes",
    .uses_vertices = true,
    .create = create,
    .destroy = destroy,
    .evaluate = evaluate,
    .attributes = best_attributes,
    .merge = merge,
    .bytes = bytes,
};
