// Meshes for tests of edge collapse, and what must hold of any result.
#ifndef PROM_TESTS_COLLAPSE_FIXTURE_H
#define PROM_TESTS_COLLAPSE_FIXTURE_H

#include "builder/simplify/engine.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

typedef struct shape {
    PROM_ARRAY(prom_vertex) vertices;
    PROM_ARRAY(uint32_t) groups;
    PROM_ARRAY(uint32_t) indices;
} shape;

static inline void shape_finish(shape *s)
{
    prom_array_finish(&s->vertices);
    prom_array_finish(&s->groups);
    prom_array_finish(&s->indices);
}

static inline float random_unit(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return (float)(*state >> 8) / (float)(1 << 24);
}

static inline uint32_t shape_vertex(shape *s, float x, float y, float z, uint32_t group)
{
    prom_vertex v = {.position = {x, y, z}, .color = {200, 200, 200, 255}};
    prom_array_push(&s->vertices, v);
    prom_array_push(&s->groups, group);
    return (uint32_t)s->vertices.count - 1;
}

static inline void shape_triangle(shape *s, uint32_t a, uint32_t b, uint32_t c)
{
    prom_array_push(&s->indices, a);
    prom_array_push(&s->indices, b);
    prom_array_push(&s->indices, c);
}

// n x n quads over the unit square of x and z, facing +y; groups: per quad by `group_of`.
static inline void shape_grid(shape *s, uint32_t n, float (*height)(float, float),
                              uint32_t (*group_of)(uint32_t i, uint32_t j))
{
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t v[4];
            for (uint32_t k = 0; k < 4; k++) {
                const float x = (float)(i + k % 2) / (float)n,
                            z = (float)(j + k / 2) / (float)n;
                v[k] = shape_vertex(s, x, height(x, z), z, group_of ? group_of(i, j) : 0);
                s->vertices.data[v[k]].uv[0] = x, s->vertices.data[v[k]].uv[1] = z;
            }
            shape_triangle(s, v[0], v[2], v[1]);
            shape_triangle(s, v[1], v[2], v[3]);
        }
}

// A sphere of radius 1, from an octahedron whose faces are divided; closed.
static inline void shape_sphere(shape *s, uint32_t n)
{
    for (int face = 0; face < 8; face++) {
        const float sx = face & 1 ? -1.0f : 1.0f, sy = face & 2 ? -1.0f : 1.0f,
                    sz = face & 4 ? -1.0f : 1.0f;
        const bool turned = (face & 1) ^ (face >> 1 & 1) ^ (face >> 2 & 1);
        uint32_t first = (uint32_t)s->vertices.count;
        for (uint32_t i = 0; i <= n; i++)
            for (uint32_t j = 0; j <= n - i; j++) {
                // Exactly alike on the edges between faces.
                const float p[3] = {sx * (float)(n - i - j), sy * (float)i, sz * (float)j};
                const float l = sqrtf(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
                const uint32_t v = shape_vertex(s, p[0] / l + 0, p[1] / l + 0, p[2] / l + 0, 0);
                prom_pack_normal(s->vertices.data[v].position, s->vertices.data[v].normal);
            }
        for (uint32_t i = 0; i < n; i++) {
            const uint32_t row = first, next = first += n - i + 1;
            for (uint32_t j = 0; j < n - i; j++)
                for (int half = 0; half < (j + 1 < n - i ? 2 : 1); half++) {
                    const uint32_t a = half ? next + j + 1 : row + j;
                    const uint32_t b = half ? next + j : row + j + 1;
                    const uint32_t c = half ? row + j + 1 : next + j;
                    if (turned)
                        shape_triangle(s, a, b, c);
                    else
                        shape_triangle(s, a, c, b);
                }
        }
    }
}

// Every face gets corners of its own, with the face's normal.
static inline void shape_facet(shape *s)
{
    shape out = {0};
    for (size_t i = 0; i < s->indices.count; i += 3) {
        float e[3], f[3], normal[3], *p[3];
        for (size_t k = 0; k < 3; k++) p[k] = s->vertices.data[s->indices.data[i + k]].position;
        glm_vec3_sub(p[1], p[0], e);
        glm_vec3_sub(p[2], p[0], f);
        glm_vec3_cross(e, f, normal);
        glm_vec3_normalize(normal);
        for (size_t k = 0; k < 3; k++) {
            prom_vertex v = s->vertices.data[s->indices.data[i + k]];
            prom_pack_normal(normal, v.normal);
            prom_array_push(&out.indices, (uint32_t)out.vertices.count);
            prom_array_push(&out.groups, s->groups.data[s->indices.data[i + k]]);
            prom_array_push(&out.vertices, v);
        }
    }
    shape_finish(s);
    *s = out;
}

// A run from start to end. records may be NULL.
static inline float shape_collapse(const shape *s, const prom_collapse_options *options,
                                   uint32_t target, float max_error, prom_mesh *out,
                                   prom_collapse_stats *stats)
{
    prom_collapse_mesh mesh;
    prom_collapse_mesh_init(&mesh, s->vertices.data, (uint32_t)s->vertices.count,
                            s->groups.data, s->indices.data, s->indices.count);
    prom_collapser *collapser = prom_collapser_create(&mesh, options);
    const float error = prom_collapser_run(collapser, target, max_error);
    if (stats) prom_collapser_stats(collapser, stats);
    prom_collapser_destroy(collapser);
    prom_collapse_mesh_emit(&mesh, out);
    assert_null(prom_mesh_check(out, UINT32_MAX));
    prom_collapse_mesh_finish(&mesh);
    return error;
}

static inline void shape_to_mesh(const shape *s, prom_mesh *out)
{
    prom_collapse_mesh mesh;
    prom_collapse_mesh_init(&mesh, s->vertices.data, (uint32_t)s->vertices.count,
                            s->groups.data, s->indices.data, s->indices.count);
    prom_collapse_mesh_emit(&mesh, out);
    prom_collapse_mesh_finish(&mesh);
}

// ---- topology by position

typedef struct edge_key {
    float ends[2][3]; // the lower first
} edge_key;

static inline int by_bytes_of_edge(const void *a, const void *b)
{
    return memcmp(a, b, sizeof(edge_key));
}

typedef struct topology {
    uint32_t points, edges, open, crowded; // edges of one triangle, of more than two
    int euler;
} topology;

static inline int by_bytes_of_place(const void *a, const void *b)
{
    return memcmp(a, b, 3 * sizeof(float));
}

static inline topology topology_of(const prom_mesh *mesh)
{
    topology t = {0};
    edge_key *edges = prom_alloc(mesh->index_count, sizeof *edges);
    float(*places)[3] = prom_alloc(mesh->index_count, sizeof *places);
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        float p[2][3];
        for (int k = 0; k < 3; k++) {
            p[0][k] = mesh->vertices[mesh->indices[i]].position[k] + 0.0f;
            p[1][k] = mesh->vertices[mesh->indices[next]].position[k] + 0.0f;
        }
        const int swap = memcmp(p[0], p[1], sizeof p[0]) > 0;
        memcpy(edges[i].ends[swap], p[0], sizeof p[0]);
        memcpy(edges[i].ends[!swap], p[1], sizeof p[1]);
        memcpy(places[i], p[0], sizeof p[0]);
    }
    qsort(edges, mesh->index_count, sizeof *edges, by_bytes_of_edge);
    qsort(places, mesh->index_count, sizeof *places, by_bytes_of_place);
    for (uint32_t i = 0, n; i < mesh->index_count; i += n) {
        for (n = 1; i + n < mesh->index_count && !by_bytes_of_edge(&edges[i], &edges[i + n]);)
            n++;
        t.edges++;
        t.open += n == 1;
        t.crowded += n > 2;
    }
    for (uint32_t i = 0; i < mesh->index_count; i++)
        t.points += !i || by_bytes_of_place(places[i], places[i - 1]);
    t.euler = (int)t.points - (int)t.edges + (int)(mesh->index_count / 3);
    prom_free(edges);
    prom_free(places);
    return t;
}

// Twice the area's vector of a triangle.
static inline void mesh_face(const prom_mesh *mesh, uint32_t first_index, float normal[3],
                             float center[3])
{
    float e[3], f[3], *p[3];
    for (uint32_t k = 0; k < 3; k++)
        p[k] = mesh->vertices[mesh->indices[first_index + k]].position;
    glm_vec3_sub(p[1], p[0], e);
    glm_vec3_sub(p[2], p[0], f);
    glm_vec3_cross(e, f, normal);
    for (int k = 0; k < 3; k++) center[k] = (p[0][k] + p[1][k] + p[2][k]) / 3;
}

#endif
