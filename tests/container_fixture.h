// A small synthetic model with meshes and textures, for the tests of the container.
#ifndef PROM_TESTS_CONTAINER_FIXTURE_H
#define PROM_TESTS_CONTAINER_FIXTURE_H

#include "metaobj/container.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

#define FIXTURE_MESHES 4
#define FIXTURE_TEXTURES 2

typedef struct fixture {
    prom_model model;
    prom_mesh meshes[FIXTURE_MESHES];
    prom_texture textures[FIXTURE_TEXTURES];
    prom_view_cells cells;
} fixture;

static inline uint32_t fixture_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

// A bumpy grid of n x n quads in two submeshes, the second without material.
static inline void fixture_grid(prom_mesh *mesh, uint32_t n, uint32_t *seed)
{
    prom_mesh_init(mesh, (n + 1) * (n + 1), 6 * n * n, 2);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        uint32_t x = v % (n + 1), z = v / (n + 1);
        float height = (float)(fixture_random(seed) % 1000) / 5000.0f;
        mesh->vertices[v] =
            (prom_vertex){{(float)x / (float)n - 0.5f, height, (float)z / (float)n - 0.5f},
                          {0, 127, 0, 0},
                          {255, (uint8_t)x, (uint8_t)z, 255},
                          {(float)x / (float)n, (float)z / (float)n}};
    }
    uint32_t *i = mesh->indices;
    for (uint32_t q = 0; q < n * n; q++) {
        uint32_t a = q / n * (n + 1) + q % n, b = a + 1, c = a + n + 1, d = c + 1;
        *i++ = c, *i++ = d, *i++ = a, *i++ = d, *i++ = b, *i++ = a;
    }
    uint32_t first = 3 * n * n / 3 * 3;
    mesh->submeshes[0] = (prom_submesh){0, first, 0};
    mesh->submeshes[1] = (prom_submesh){first, mesh->index_count - first, PROM_NONE};
}

static inline void fixture_picture(prom_texture *t, prom_texture_kind kind, uint32_t width,
                                   uint32_t height, uint32_t *seed)
{
    prom_texture_init(t, kind, width, height);
    for (size_t i = 0; i < 4 * (size_t)width * height * t->layers; i++)
        t->pixels[i] = (uint8_t)(i / 64 * 5 + (fixture_random(seed) & 7));
    prom_texture_make_mips(t, 0.5f);
}

static inline void fixture_bulk(fixture *f, uint32_t *seed)
{
    static const float zero[3] = {0, 0, 0}, half[3] = {0.5f, 0.1f, 0.5f};
    fixture_grid(&f->meshes[0], 24, seed);
    fixture_grid(&f->meshes[1], 5, seed);
    prom_mesh_init_box(&f->meshes[2], zero, half, NULL);
    fixture_grid(&f->meshes[3], 8, seed);
    fixture_picture(&f->textures[0], PROM_TEXTURE_COLOR, 50, 33, seed);
    fixture_picture(&f->textures[1], PROM_TEXTURE_IMPOSTOR_ALBEDO, 32, 32, seed);
    prom_model *m = &f->model;
    m->mesh_count = FIXTURE_MESHES;
    m->meshes = prom_arena_alloc(&m->arena, m->mesh_count, sizeof *m->meshes);
    for (int i = 0; i < FIXTURE_MESHES; i++)
        m->meshes[i] = (prom_mesh_info){f->meshes[i].vertex_count, f->meshes[i].index_count,
                                        f->meshes[i].submesh_count};
    m->texture_count = FIXTURE_TEXTURES;
    m->textures = prom_arena_alloc(&m->arena, m->texture_count, sizeof *m->textures);
    for (int i = 0; i < FIXTURE_TEXTURES; i++) {
        const prom_texture *t = &f->textures[i];
        m->textures[i] =
            (prom_texture_info){t->kind, t->width, t->height, t->layers, t->levels};
    }
    m->material_count = 1;
    m->materials = prom_arena_alloc(&m->arena, 1, sizeof *m->materials);
    m->materials[0] = (prom_material){{1, 0.5f, 0.25f, 1}, 0, PROM_ALPHA_MASK, 0.5f, 1};
}

static inline prom_representation fixture_rep(uint32_t kind, uint32_t mesh, uint32_t texture)
{
    return (prom_representation){
        .kind = kind,
        .mesh = mesh,
        .texture = texture,
        .shading = kind == PROM_REP_TEXTURED_BOX ? PROM_SHADE_IMPOSTOR : PROM_SHADE_TEXTURED,
        .level = mesh,
        .error = 0.125f * (float)mesh,
        .max_size_px = kind == PROM_REP_MESH ? INFINITY : 128,
        .near_k = 0.3f,
        .switch_distance = INFINITY,
        .draws = 1,
        .vertices = 24,
        .triangles = 12,
        .layers = 1.5f,
    };
}

// Prototype 0: leaf with two meshes and a textured box; 1: the cluster of `leaves` of it;
// 2: the root's, without a representation; 3: backdrop.
static inline void fixture_prototypes(prom_model *m, uint32_t clusters, uint32_t leaves,
                                      uint32_t *seed)
{
    prom_arena *a = &m->arena;
    m->prototype_count = 4;
    m->prototypes = prom_arena_alloc(a, 4, sizeof *m->prototypes);
    m->coverage = prom_arena_alloc(a, 4, sizeof *m->coverage);
    m->prototypes[0] =
        (prom_prototype){0, 3, 0, PROM_NONE, 0, {0, 0.1f, 0}, {0.5f, 0.1f, 0.5f}, 0.72f, 1152};
    m->prototypes[1] = (prom_prototype){
        3, 2, PROM_PROTO_CLUSTER, 0, leaves, {0, 0.1f, 0}, {2, 0.1f, 2}, 3, 1152ull * leaves};
    m->prototypes[2] =
        (prom_prototype){5,         0,  PROM_PROTO_CLUSTER,         leaves, clusters, {0, 0, 0},
                         {9, 9, 9}, 12, 1152ull * leaves * clusters};
    m->prototypes[3] = (prom_prototype){
        5, 1, PROM_PROTO_BACKDROP, PROM_NONE, 0, {0, 0, 0}, {0.5f, 0.1f, 0.5f}, 0.72f, 128};
    m->rep_count = 6;
    m->reps = prom_arena_alloc(a, 6, sizeof *m->reps);
    m->accuracy = prom_arena_alloc(a, 6, sizeof *m->accuracy);
    m->reps[0] = fixture_rep(PROM_REP_MESH, 0, PROM_NONE);
    m->reps[1] = fixture_rep(PROM_REP_MESH, 1, PROM_NONE);
    m->reps[2] = fixture_rep(PROM_REP_TEXTURED_BOX, 2, 1);
    m->reps[3] = fixture_rep(PROM_REP_MESH, 3, PROM_NONE);
    m->reps[4] = fixture_rep(PROM_REP_AVERAGE_BOX, 2, PROM_NONE);
    m->reps[5] = fixture_rep(PROM_REP_MESH, 3, PROM_NONE);
    m->share_count = leaves + clusters;
    m->shares = prom_arena_alloc(a, m->share_count, sizeof *m->shares);
    for (uint32_t d = 0; d < PROM_DIRS; d++) {
        for (uint32_t s = 0; s < m->share_count; s++)
            m->shares[s][d] = (uint16_t)fixture_random(seed);
        for (uint32_t p = 0; p < 4; p++) m->coverage[p][d] = (uint16_t)fixture_random(seed);
        for (uint32_t r = 0; r < 6; r++)
            for (uint32_t s = 0; s < PROM_SIZES; s++)
                m->accuracy[r].bins[d][s] = (uint8_t)fixture_random(seed);
    }
}

static inline void fixture_nodes(prom_model *m, uint32_t clusters, uint32_t leaves)
{
    static const char names[] = "\0root\0cluster\0leaf\0sky";
    prom_arena *a = &m->arena;
    uint32_t n = m->node_count = 2 + clusters + clusters * leaves;
    m->tree_count = n - 1;
    m->names_bytes = sizeof names;
    m->names = prom_arena_alloc(a, sizeof names, 1);
    memcpy(m->names, names, sizeof names);
    m->parent = prom_arena_alloc(a, n, sizeof *m->parent);
    m->first_child = prom_arena_alloc(a, n, sizeof *m->first_child);
    m->child_count = prom_arena_alloc(a, n, sizeof *m->child_count);
    m->prototype = prom_arena_alloc(a, n, sizeof *m->prototype);
    m->name = prom_arena_alloc(a, n, sizeof *m->name);
    m->placement = prom_arena_alloc(a, n, sizeof *m->placement);
    m->center = prom_arena_alloc(a, n, sizeof *m->center);
    m->half = prom_arena_alloc(a, n, sizeof *m->half);
    m->radius = prom_arena_alloc(a, n, sizeof *m->radius);
    m->weight = prom_arena_alloc(a, n, sizeof *m->weight);
    for (uint32_t i = 0; i < n; i++) m->weight[i] = 1.0f + 0.5f * (float)(i % 3);
    m->measured = (prom_measured){"flip", 22.34f, {0.2f, 0.8f}, 0.95f, 0.9f};
    for (uint32_t i = 0; i < n; i++) {
        m->placement[i] = prom_placement_identity;
        m->first_child[i] = m->parent[i] = PROM_NONE;
        m->placement[i].origin[0] = 1e6 + 0.1 * i;
        if (i == n - 1) {
            m->prototype[i] = 3;
            m->name[i] = 19;
        } else if (i == 0) {
            m->first_child[i] = 1;
            m->child_count[i] = clusters;
            m->prototype[i] = 2;
            m->name[i] = 1;
        } else if (i <= clusters) {
            m->parent[i] = 0;
            m->first_child[i] = 1 + clusters + (i - 1) * leaves;
            m->child_count[i] = leaves;
            m->prototype[i] = 1;
            m->name[i] = 6;
        } else {
            m->parent[i] = 1 + (i - 1 - clusters) / leaves;
            m->name[i] = 14;
        }
    }
    prom_model_update_bounds(m);
}

// `count` cubes, four in a row and some left out between rows, each with about half of the
// tree's leaves.
static inline void fixture_view_cells(prom_view_cells *cells, const prom_model *m,
                                      uint32_t count, uint32_t *seed)
{
    PROM_ARRAY(uint32_t) leaves = {0};
    *cells = (prom_view_cells){.origin = {-1e3, 0.25, 7}, .size = 2.5, .cell_count = count};
    cells->cells = prom_calloc(count, sizeof *cells->cells);
    for (uint32_t i = 0; i < count; i++) {
        prom_view_cell *c = &cells->cells[i];
        *c = (prom_view_cell){{(int32_t)(i % 4) - 2, 0, (int32_t)(i / 4) * 3 - 5}, 0, 0};
        c->first = (uint32_t)leaves.count;
        for (uint32_t n = 0; n < m->tree_count; n++)
            if (!m->child_count[n] && fixture_random(seed) % 2) prom_array_push(&leaves, n);
        c->count = (uint32_t)leaves.count - c->first;
    }
    cells->entry_count = (uint32_t)leaves.count;
    prom_array_reserve(&leaves, 1);
    cells->leaves = leaves.data;
    cells->shares = prom_alloc(leaves.count, 1);
    for (size_t i = 0; i < leaves.count; i++)
        cells->shares[i] = (uint8_t)(fixture_random(seed) % 256);
}

static inline void fixture_init(fixture *f, uint32_t clusters, uint32_t leaves)
{
    uint32_t seed = 7;
    *f = (fixture){0};
    fixture_bulk(f, &seed);
    fixture_prototypes(&f->model, clusters, leaves, &seed);
    fixture_nodes(&f->model, clusters, leaves);
    fixture_view_cells(&f->cells, &f->model, 12, &seed);
}

static inline void fixture_finish(fixture *f)
{
    prom_view_cells_finish(&f->cells);
    for (int i = 0; i < FIXTURE_MESHES; i++) prom_mesh_finish(&f->meshes[i]);
    for (int i = 0; i < FIXTURE_TEXTURES; i++) prom_texture_finish(&f->textures[i]);
    prom_model_finish(&f->model);
}

static inline prom_status fixture_write(const fixture *f, const char *path, double stage_ms,
                                        prom_error *error)
{
    prom_writer *w = prom_writer_create(path, error);
    if (!w) return error->status;
    prom_status status = PROM_OK;
    for (uint32_t i = 0, id; i < FIXTURE_MESHES && !status; i++)
        status = prom_writer_add_mesh(w, &f->meshes[i], &id, error);
    for (uint32_t i = 0, id; i < FIXTURE_TEXTURES && !status; i++)
        status = prom_writer_add_texture(w, &f->textures[i], &id, error);
    if (!status) status = prom_writer_set_meta(w, "source", "nothing", error);
    if (!status) status = prom_writer_set_meta(w, "source", "fixture", error);
    if (!status)
        status = prom_writer_add_stage(w, "import", 0xfedcba9876543210u, stage_ms, error);
    if (!status) status = prom_writer_put_model(w, &f->model, error);
    if (!status) status = prom_writer_put_view_cells(w, &f->cells, error);
    if (!status) status = prom_writer_finish(w, error);
    prom_writer_destroy(w);
    return status;
}

static inline void fixture_ignore_stage(void *user, const char *name, uint64_t content_hash,
                                        double ms)
{
    (void)user, (void)name, (void)content_hash, (void)ms;
}

// Opens a file and reads all there is in it; the first error ends it. *hash: of its content.
static inline prom_status fixture_read_hash(const char *path, uint64_t *hash, prom_error *error)
{
    prom_container *c = prom_container_open(path, error);
    if (!c) return error->status;
    prom_model m;
    prom_status status = prom_container_load_model(c, &m, error);
    for (uint32_t i = 0; i < m.mesh_count && !status; i++) {
        prom_mesh mesh;
        status = prom_container_read_mesh(c, &m, i, &mesh, error);
        prom_mesh_finish(&mesh);
    }
    for (uint32_t i = 0; i < m.texture_count && !status; i++) {
        prom_texture texture;
        status = prom_container_read_texture(c, &m, i, &texture, error);
        prom_texture_finish(&texture);
    }
    prom_view_cells cells = {0};
    if (!status) status = prom_container_read_view_cells(c, &m, &cells, error);
    prom_view_cells_finish(&cells);
    if (!status) status = prom_container_stages(c, fixture_ignore_stage, NULL, error);
    if (!status) status = prom_container_content_hash(c, hash, error);
    prom_model_finish(&m);
    prom_container_close(c);
    return status;
}

static inline prom_status fixture_read_all(const char *path, prom_error *error)
{
    uint64_t hash;
    return fixture_read_hash(path, &hash, error);
}

// A path of this process in the working directory; free it.
static inline char *fixture_path(const char *name)
{
    return prom_format("test-%d-%s.prom", (int)getpid(), name);
}

#endif
