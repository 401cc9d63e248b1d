// Meshes with known properties for the tests of simplification, and one reduction at a time.
#ifndef PROM_TESTS_SIMPLIFY_FIXTURE_H
#define PROM_TESTS_SIMPLIFY_FIXTURE_H

#include "builder/simplify/distance.h"
#include "builder/simplify/reduce.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static inline uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static inline float uniform(uint32_t *state)
{
    return (float)next_random(state) / (float)(1 << 24);
}

static inline float height_at(float x, float z)
{
    return 0.3f * sinf(3.1f * x) * cosf(2.3f * z) + 0.05f * sinf(17 * x + 11 * z);
}

// A bumpy height field of n x n quads over [x0, x0 + 1] x [0, 1]; its outline depends on the
// place alone, so that neighbours share their border. Two submeshes when `split`.
static inline void init_field(prom_mesh *mesh, uint32_t n, float x0, bool split)
{
    prom_mesh_init(mesh, (n + 1) * (n + 1), n * n * 6, split ? 2 : 1);
    for (uint32_t j = 0; j <= n; j++)
        for (uint32_t i = 0; i <= n; i++) {
            prom_vertex *v = &mesh->vertices[j * (n + 1) + i];
            float x = x0 + (float)i / (float)n, z = (float)j / (float)n, e = 1e-3f;
            v->position[0] = x;
            v->position[1] = height_at(x, z);
            v->position[2] = z;
            float normal[3] = {(height_at(x, z) - height_at(x + e, z)) / e, 1,
                               (height_at(x, z) - height_at(x, z + e)) / e};
            glm_vec3_normalize(normal);
            prom_pack_normal(normal, v->normal);
            memset(v->color, 200, 4);
        }
    uint32_t at = 0;
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = j * (n + 1) + i, b = a + 1, c = a + n + 1, d = c + 1;
            const uint32_t quad[6] = {a, c, b, b, c, d};
            memcpy(mesh->indices + at, quad, sizeof quad);
            at += 6;
        }
    mesh->submeshes[0] = (prom_submesh){0, at, 0};
    if (!split) return;
    uint32_t half = at / 6 / 2 * 6;
    mesh->submeshes[0] = (prom_submesh){0, half, 3};
    mesh->submeshes[1] = (prom_submesh){half, at - half, 7};
}

// Leaf cards at random places and directions.
static inline void init_foliage(prom_mesh *mesh, uint32_t cards, uint32_t seed)
{
    prom_mesh_init(mesh, cards * 4, cards * 6, 1);
    for (uint32_t i = 0; i < cards; i++) {
        float center[3], u[3], w[3];
        for (int k = 0; k < 3; k++) {
            center[k] = uniform(&seed) * 4;
            u[k] = uniform(&seed) - 0.5f;
            w[k] = uniform(&seed) - 0.5f;
        }
        glm_vec3_normalize(u);
        glm_vec3_normalize(w);
        for (uint32_t c = 0; c < 4; c++) {
            prom_vertex *v = &mesh->vertices[i * 4 + c];
            for (int k = 0; k < 3; k++)
                v->position[k] =
                    center[k] + 0.1f * (c & 1 ? u[k] : -u[k]) + 0.1f * (c & 2 ? w[k] : -w[k]);
            v->normal[1] = 127;
            v->uv[0] = (float)(c & 1);
            v->uv[1] = (float)(c >> 1);
        }
        const uint32_t quad[6] = {0, 1, 2, 2, 1, 3};
        for (uint32_t k = 0; k < 6; k++) mesh->indices[i * 6 + k] = i * 4 + quad[k];
    }
    mesh->submeshes[0] = (prom_submesh){0, cards * 6, 0};
}

static inline float area_of(const prom_mesh *mesh)
{
    float area = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        float e[3], f[3], cross[3], *p[3];
        for (int k = 0; k < 3; k++) p[k] = mesh->vertices[mesh->indices[i + k]].position;
        glm_vec3_sub(p[1], p[0], e);
        glm_vec3_sub(p[2], p[0], f);
        glm_vec3_cross(e, f, cross);
        area += glm_vec3_norm(cross) / 2;
    }
    return area;
}

typedef struct edge {
    float ends[6];
} edge;

typedef PROM_ARRAY(edge) edge_list;

static inline int by_edge(const void *a, const void *b)
{
    return memcmp(a, b, 6 * sizeof(float));
}

// Directed edges, as pairs of positions, that no triangle has the other way round.
static inline edge_list open_edges(const prom_mesh *mesh)
{
    edge_list all = {0}, open = {0};
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        uint32_t next = i % 3 == 2 ? i - 2 : i + 1;
        float *ends = prom_array_extend(&all, 1)->ends;
        memcpy(ends, mesh->vertices[mesh->indices[i]].position, 12);
        memcpy(ends + 3, mesh->vertices[mesh->indices[next]].position, 12);
    }
    qsort(all.data, all.count, sizeof *all.data, by_edge);
    for (size_t i = 0; i < all.count; i++) {
        float back[6];
        memcpy(back, all.data[i].ends + 3, 12);
        memcpy(back + 3, all.data[i].ends, 12);
        if (bsearch(back, all.data, all.count, sizeof *all.data, by_edge)) continue;
        prom_array_push(&open, all.data[i]);
    }
    prom_array_finish(&all);
    return open;
}

static inline void assert_same_edges(edge_list *a, edge_list *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->data, b->data, a->count * sizeof *a->data);
    prom_array_finish(a);
    prom_array_finish(b);
}

// Reduces once; false, and *out empty, if nothing smaller came of it. *error: the deviation.
static inline bool reduce_mesh(const prom_mesh *mesh, const prom_reduce_options *options,
                               uint32_t target, float max_error, prom_mesh *out, float *error)
{
    prom_work work;
    prom_index_array faces = {0};
    *out = (prom_mesh){0};
    prom_work_init(&work, mesh);
    prom_reduction *reduction = prom_reduction_create(&work, options);
    prom_reduction_run(reduction, target, max_error, &faces);
    const bool less = faces.count && prom_work_count(&work, &faces) < work.triangles;
    *error = less ? prom_work_deviation(&work, &faces) : 0;
    if (less) prom_work_emit(&work, &faces, out);
    prom_reduction_destroy(reduction);
    prom_array_finish(&faces);
    prom_work_finish(&work);
    return less;
}

static inline void assert_sound(const prom_mesh *mesh)
{
    const char *complaint = prom_mesh_check(mesh, 100);
    if (complaint) fail_msg("%s", complaint);
    assert_true(mesh->index_count > 0);
}

#endif
