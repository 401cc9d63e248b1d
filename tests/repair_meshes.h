// Meshes to be spoiled and repaired, and what holds of every repair.
#ifndef PROM_TESTS_REPAIR_MESHES_H
#define PROM_TESTS_REPAIR_MESHES_H

#include "builder/simplify/repair.h"

#include "metaobj/base/alloc.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

// ---- meshes

static inline uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static inline float uniform(uint32_t *state)
{
    return (float)next_random(state) / (float)(1 << 24);
}

// A globe of n x 2n quads, triangles at the poles, normals outwards. The seam of the texture
// has its vertices twice, with u = 0 and 1; the poles have theirs once.
static inline void init_globe(prom_mesh *mesh, uint32_t n, float radius)
{
    uint32_t rows = n - 1, columns = 2 * n + 1, at = 0;
    prom_mesh_init(mesh, rows * columns + 2, (rows - 1) * 2 * n * 6 + 2 * 2 * n * 3, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t j = v / columns, i = v % columns;
        float lat = (float)(j + 1) / (float)n * (float)M_PI;
        float lon = (float)(i % (2 * n)) / (float)n * (float)M_PI;
        float p[3] = {sinf(lat) * cosf(lon), cosf(lat), sinf(lat) * sinf(lon)};
        if (j == rows) p[0] = p[2] = 0, p[1] = i ? -1 : 1;
        for (int k = 0; k < 3; k++) mesh->vertices[v].position[k] = radius * p[k];
        prom_pack_normal(p, mesh->vertices[v].normal);
        memset(mesh->vertices[v].color, 255, 4);
        mesh->vertices[v].uv[0] = (float)i / (float)(2 * n);
        mesh->vertices[v].uv[1] = lat;
    }
    uint32_t north = rows * columns, south = north + 1;
    for (uint32_t i = 0; i < 2 * n; i++) {
        uint32_t last = (rows - 1) * columns + i;
        const uint32_t caps[6] = {north, i + 1, i, south, last, last + 1};
        memcpy(mesh->indices + at, caps, sizeof caps);
        at += 6;
        for (uint32_t j = 0; j + 1 < rows; j++) {
            uint32_t a = j * columns + i, b = a + columns;
            const uint32_t quad[6] = {a, a + 1, b, b, a + 1, b + 1};
            memcpy(mesh->indices + at, quad, sizeof quad);
            at += 6;
        }
    }
    mesh->submeshes[0] = (prom_submesh){0, at, 0};
}

static inline void init_cube(prom_mesh *mesh)
{
    prom_mesh_init_box(mesh, (float[3]){0, 0, 0}, (float[3]){1, 2, 3}, NULL);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) mesh->vertices[v].normal[3] = 0;
}

// A sheet of n x n quads in y = 0 that faces upwards.
static inline void init_sheet(prom_mesh *mesh, uint32_t n)
{
    prom_mesh_init(mesh, (n + 1) * (n + 1), n * n * 6, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        mesh->vertices[v].position[0] = (float)(v % (n + 1));
        mesh->vertices[v].position[2] = (float)(v / (n + 1));
        mesh->vertices[v].normal[1] = 127;
    }
    for (uint32_t q = 0; q < n * n; q++) {
        uint32_t a = q / n * (n + 1) + q % n, b = a + n + 1;
        const uint32_t quad[6] = {a, b, a + 1, a + 1, b, b + 1};
        memcpy(mesh->indices + q * 6, quad, sizeof quad);
    }
    mesh->submeshes[0] = (prom_submesh){0, n * n * 6, 0};
}

// Appends triangles to the last submesh; `corners` may be the mesh's own.
static inline void add_triangles(prom_mesh *mesh, const uint32_t *corners, uint32_t count)
{
    uint32_t *all = prom_alloc(mesh->index_count + count * 3, sizeof *all);
    memcpy(all, mesh->indices, mesh->index_count * sizeof *all);
    memcpy(all + mesh->index_count, corners, count * 3 * sizeof *all);
    prom_free(mesh->indices);
    mesh->indices = all;
    mesh->index_count += count * 3;
    mesh->submeshes[mesh->submesh_count - 1].index_count += count * 3;
}

static inline uint32_t add_vertex(prom_mesh *mesh, prom_vertex vertex)
{
    mesh->vertices =
        prom_realloc(mesh->vertices, mesh->vertex_count + 1, sizeof *mesh->vertices);
    mesh->vertices[mesh->vertex_count] = vertex;
    return mesh->vertex_count++;
}

static inline void turn(prom_mesh *mesh, uint32_t triangle)
{
    uint32_t *t = mesh->indices + triangle * 3, second = t[1];
    t[1] = t[2];
    t[2] = second;
}

static inline uint32_t turn_some(prom_mesh *mesh, uint32_t per_cent, uint32_t *seed)
{
    uint32_t turned = 0;
    for (uint32_t t = 0; t < mesh->index_count / 3; t++) {
        if (next_random(seed) % 100 >= per_cent) continue;
        turn(mesh, t);
        turned++;
    }
    return turned;
}

// Gives every triangle vertices of its own.
static inline void unweld(prom_mesh *mesh)
{
    prom_vertex *loose = prom_alloc(mesh->index_count, sizeof *loose);
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        loose[i] = mesh->vertices[mesh->indices[i]];
        mesh->indices[i] = i;
    }
    prom_free(mesh->vertices);
    mesh->vertices = loose;
    mesh->vertex_count = mesh->index_count;
}

static inline void normals_from_windings(prom_mesh *mesh)
{
    unweld(mesh);
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        prom_vertex *v = mesh->vertices + i;
        vec3 e, f, n;
        glm_vec3_sub(v[1].position, v[0].position, e);
        glm_vec3_sub(v[2].position, v[0].position, f);
        glm_vec3_cross(e, f, n);
        for (int k = 0; k < 3; k++) prom_pack_normal(n, v[k].normal);
    }
}

// ---- what is asked of them

static inline double volume(const prom_mesh *mesh)
{
    double sum = 0;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        vec3 c;
        const prom_vertex *v[3];
        for (int k = 0; k < 3; k++) v[k] = &mesh->vertices[mesh->indices[i + k]];
        glm_vec3_cross((float *)v[1]->position, (float *)v[2]->position, c);
        sum += (double)glm_vec3_dot((float *)v[0]->position, c) / 6;
    }
    return sum;
}

// Corners whose normal is against their triangle's winding.
static inline uint32_t against(const prom_mesh *mesh)
{
    uint32_t n = 0;
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        const prom_vertex *v[3];
        for (uint32_t k = 0; k < 3; k++) v[k] = &mesh->vertices[mesh->indices[i / 3 * 3 + k]];
        vec3 e, f, c;
        glm_vec3_sub((float *)v[1]->position, (float *)v[0]->position, e);
        glm_vec3_sub((float *)v[2]->position, (float *)v[0]->position, f);
        glm_vec3_cross(e, f, c);
        const int8_t *normal = v[i % 3]->normal;
        n += normal[0] * c[0] + normal[1] * c[1] + normal[2] * c[2] < 0;
    }
    return n;
}

static inline bool same_bytes(const void *a, const void *b, size_t bytes)
{
    return !bytes || !memcmp(a, b, bytes); // arrays of nothing may be NULL
}

static inline bool same_mesh(const prom_mesh *a, const prom_mesh *b)
{
    return a->vertex_count == b->vertex_count && a->index_count == b->index_count &&
           a->submesh_count == b->submesh_count &&
           same_bytes(a->vertices, b->vertices, a->vertex_count * sizeof *a->vertices) &&
           same_bytes(a->indices, b->indices, a->index_count * sizeof *a->indices) &&
           same_bytes(a->submeshes, b->submeshes, a->submesh_count * sizeof *a->submeshes);
}

// Repairs, and sees to what holds of every repair: the mesh is sound, and a second repair with
// the same options finds nothing and changes nothing.
static inline prom_repair_report repair(prom_mesh *mesh, const prom_repair_options *options)
{
    prom_repair_report first, second;
    prom_mesh_repair(mesh, options, &first);
    assert_null(prom_mesh_check(mesh, UINT32_MAX));
    assert_int_equal(first.faces, mesh->index_count / 3);
    prom_mesh again;
    prom_mesh_copy(&again, mesh);
    prom_mesh_repair(&again, options, &second);
    assert_true(same_mesh(mesh, &again));
    assert_false(prom_repair_mended(&second));
    prom_mesh_finish(&again);
    prom_repair_report left = first;
    left.snapped = left.welded = left.degenerate = left.duplicate = left.turned = 0;
    assert_memory_equal(&left, &second, sizeof second);
    return first;
}

#endif
