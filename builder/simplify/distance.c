#include "builder/simplify/distance.h"

#include <math.h>
#include <meshoptimizer.h>

enum { LEAF_TRIANGLES = 4, MAX_SAMPLES = 16384 };

void prom_surface_init(prom_surface *surface, const prom_vertex *vertices, uint32_t count,
                       const uint32_t *indices, size_t index_count)
{
    *surface = (prom_surface){.vertices = vertices, .triangles = (uint32_t)(index_count / 3)};
    surface->leaves = 1;
    while (surface->leaves * LEAF_TRIANGLES < surface->triangles) surface->leaves *= 2;
    surface->indices = prom_alloc(index_count, sizeof *surface->indices);
    surface->boxes = prom_alloc((size_t)surface->leaves * 2, sizeof *surface->boxes);
    if (index_count)
        meshopt_spatialSortTriangles(surface->indices, indices, index_count,
                                     vertices[0].position, count, sizeof *vertices);
    for (uint32_t i = 0; i < surface->leaves * 2; i++) surface->boxes[i] = PROM_BOX_EMPTY;
    for (size_t i = 0; i < index_count; i++)
        prom_box_add_point(&surface->boxes[surface->leaves + i / 3 / LEAF_TRIANGLES],
                           vertices[surface->indices[i]].position);
    for (uint32_t i = surface->leaves; i-- > 1;) {
        surface->boxes[i] = surface->boxes[2 * i];
        prom_box_add_box(&surface->boxes[i], &surface->boxes[2 * i + 1]);
    }
}

void prom_surface_finish(prom_surface *surface)
{
    prom_free(surface->indices);
    prom_free(surface->boxes);
    *surface = (prom_surface){0};
}

// Written with comparisons: fminf and fmaxf are library calls and this is the hottest loop.
static float box_distance2(const prom_box *box, const float p[3])
{
    float d2 = 0;
    for (int a = 0; a < 3; a++) {
        float below = box->min[a] - p[a], above = p[a] - box->max[a];
        float d = below > above ? below : above;
        d2 += d > 0 ? d * d : 0;
    }
    return d2;
}

static float segment_parameter(const float p[3], const float a[3], const float edge[3])
{
    float length2 = glm_vec3_norm2((float *)edge), to[3];
    glm_vec3_sub((float *)p, (float *)a, to);
    float t = length2 > 0 ? glm_vec3_dot(to, (float *)edge) / length2 : 0;
    return t < 0 ? 0 : t > 1 ? 1 : t;
}

static float weighted_distance2(const float p[3], const float *corner[3], const float w[3])
{
    float d2 = 0;
    for (int a = 0; a < 3; a++) {
        float d = corner[0][a] * w[0] + corner[1][a] * w[1] + corner[2][a] * w[2] - p[a];
        d2 += d * d;
    }
    return d2;
}

// The nearest point lies inside if the projection does, else on the nearest of three edges.
static float triangle_distance2(const float p[3], const float *corner[3], float weights[3])
{
    float e[3], f[3], g[3], normal[3], to[3];
    glm_vec3_sub((float *)corner[1], (float *)corner[0], e);
    glm_vec3_sub((float *)corner[2], (float *)corner[0], f);
    glm_vec3_sub((float *)p, (float *)corner[0], to);
    glm_vec3_cross(e, f, normal);
    float area2 = glm_vec3_norm2(normal);
    if (area2 > 0) {
        float c[3];
        glm_vec3_cross(to, f, c);
        float w1 = glm_vec3_dot(c, normal) / area2;
        glm_vec3_cross(e, to, c);
        float w2 = glm_vec3_dot(c, normal) / area2;
        if (w1 >= 0 && w2 >= 0 && w1 + w2 <= 1) {
            weights[0] = 1 - w1 - w2, weights[1] = w1, weights[2] = w2;
            float along = glm_vec3_dot(to, normal);
            return along * along / area2;
        }
    }
    glm_vec3_sub((float *)corner[2], (float *)corner[1], g);
    float t[3] = {segment_parameter(p, corner[0], e), segment_parameter(p, corner[0], f),
                  segment_parameter(p, corner[1], g)};
    const float w[3][3] = {{1 - t[0], t[0], 0}, {1 - t[1], 0, t[1]}, {0, 1 - t[2], t[2]}};
    float best = INFINITY;
    for (int i = 0; i < 3; i++) {
        float d2 = weighted_distance2(p, corner, w[i]);
        if (d2 >= best) continue;
        best = d2;
        memcpy(weights, w[i], sizeof w[i]);
    }
    return best;
}

// Takes the triangle at `slot` if it is nearer than best2; returns the better of both.
static float try_triangle(const prom_surface *s, uint32_t slot, const float p[3], float best2,
                          prom_nearest *nearest)
{
    const uint32_t *v = s->indices + (size_t)slot * 3;
    const float *corner[3] = {s->vertices[v[0]].position, s->vertices[v[1]].position,
                              s->vertices[v[2]].position};
    float weights[3] = {1, 0, 0};
    float d2 = triangle_distance2(p, corner, weights);
    if (d2 >= best2) return best2;
    nearest->slot = slot;
    memcpy(nearest->triangle, v, sizeof nearest->triangle);
    memcpy(nearest->weights, weights, sizeof weights);
    return d2;
}

static float search_leaf(const prom_surface *s, uint32_t leaf, const float p[3], float best2,
                         prom_nearest *nearest)
{
    uint32_t first = leaf * LEAF_TRIANGLES;
    for (uint32_t t = first; t < first + LEAF_TRIANGLES && t < s->triangles; t++)
        best2 = try_triangle(s, t, p, best2, nearest);
    return best2;
}

prom_nearest prom_surface_nearest(const prom_surface *s, const float p[3], float enough,
                                  uint32_t hint)
{
    prom_nearest nearest = {.distance = INFINITY, .slot = PROM_NONE};
    struct {
        uint32_t node;
        float d2;
    } stack[64];
    int depth = 0;
    float best2 = INFINITY, enough2 = enough * enough;
    if (hint < s->triangles) best2 = try_triangle(s, hint, p, best2, &nearest);
    if (s->triangles) stack[depth++].node = 1, stack[0].d2 = 0;
    while (depth && best2 > enough2) {
        uint32_t node = stack[--depth].node;
        if (stack[depth].d2 >= best2) continue;
        if (node >= s->leaves) {
            best2 = search_leaf(s, node - s->leaves, p, best2, &nearest);
            continue;
        }
        float d[2] = {box_distance2(&s->boxes[2 * node], p),
                      box_distance2(&s->boxes[2 * node + 1], p)};
        uint32_t near = d[1] < d[0];
        if (d[!near] < best2)
            stack[depth].node = 2 * node + !near, stack[depth++].d2 = d[!near];
        if (d[near] < best2) stack[depth].node = 2 * node + near, stack[depth++].d2 = d[near];
    }
    nearest.distance = sqrtf(best2);
    return nearest;
}

static void centroid(const prom_vertex *v, const uint32_t *t, float out[3])
{
    for (int a = 0; a < 3; a++)
        out[a] = (v[t[0]].position[a] + v[t[1]].position[a] + v[t[2]].position[a]) / 3;
}

// Greatest distance of the samples of `faces` from the surface of the triangles `others`, if
// it exceeds `so_far`. A search ends as soon as its sample cannot raise it.
static float one_sided(const prom_work *work, const prom_index_array *faces,
                       const prom_index_array *others, const prom_surface *surface,
                       float so_far)
{
    const prom_vertex *v = work->vertices.data;
    size_t triangles = faces->count / 3;
    uint32_t hint = PROM_NONE;
    // A vertex is asked once, and not at all where both have it.
    uint8_t *seen = prom_calloc(work->vertices.count, 1);
    for (size_t i = 0; i < others->count; i++) seen[others->data[i]] = 1;
    size_t stride = triangles * 3 / 2 / MAX_SAMPLES + 1;
    for (size_t t = 0; t < triangles; t += stride) {
        const uint32_t *corner = faces->data + t * 3;
        float point[3];
        centroid(v, corner, point);
        prom_nearest near = prom_surface_nearest(surface, point, so_far, hint);
        so_far = fmaxf(so_far, near.distance);
        hint = near.slot;
        for (int k = 0; k < 3; k++) {
            if (seen[corner[k]]) continue;
            seen[corner[k]] = 1;
            const float *p = v[corner[k]].position;
            near = prom_surface_nearest(surface, p, so_far, hint);
            so_far = fmaxf(so_far, near.distance);
        }
    }
    prom_free(seen);
    return so_far;
}

float prom_work_deviation(const prom_work *work, const prom_index_array *faces)
{
    if (!faces->count) return INFINITY;
    const prom_vertex *v = work->vertices.data;
    uint32_t count = (uint32_t)work->vertices.count;
    prom_surface before, after;
    prom_surface_init(&before, v, count, work->indices.data, work->indices.count);
    prom_surface_init(&after, v, count, faces->data, faces->count);
    float deviation = one_sided(work, &work->indices, faces, &after, 0);
    deviation = one_sided(work, faces, &work->indices, &before, deviation);
    prom_surface_finish(&before);
    prom_surface_finish(&after);
    return deviation;
}

static float vertices_from(const prom_mesh *mesh, const prom_surface *surface, float so_far)
{
    uint32_t hint = PROM_NONE, stride = mesh->vertex_count / MAX_SAMPLES + 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v += stride) {
        prom_nearest near =
            prom_surface_nearest(surface, mesh->vertices[v].position, so_far, hint);
        so_far = fmaxf(so_far, near.distance);
        hint = near.slot;
    }
    return so_far;
}

float prom_mesh_deviation(const prom_mesh *a, const prom_mesh *b)
{
    prom_surface surfaces[2];
    prom_surface_init(&surfaces[0], a->vertices, a->vertex_count, a->indices, a->index_count);
    prom_surface_init(&surfaces[1], b->vertices, b->vertex_count, b->indices, b->index_count);
    float deviation = vertices_from(a, &surfaces[1], 0);
    deviation = vertices_from(b, &surfaces[0], deviation);
    prom_surface_finish(&surfaces[0]);
    prom_surface_finish(&surfaces[1]);
    return deviation;
}
