// A town to walk in: towers on a hilly ground, as a model in a file. TOWN_FILE: its name.
#ifndef PROM_TESTS_WALK_TOWN_H
#define PROM_TESTS_WALK_TOWN_H

#include "metaobj/container.h"
#include "metaobj/model.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#define TOWN_SIDE 9 // towers along a side
#define TOWERS (TOWN_SIDE * TOWN_SIDE)
#define LEAVES (TOWERS + 2)
#define PITCH 32.0
#define HALF 6.0f     // of a tower's plan
#define EXTENT 190.0f // of the ground

// A hilly ground with towers on a grid, their foundations deep, and a cellar under all of it:
// by the boxes alone nobody could tell where the ground is.
static inline double ground(double x, double z)
{
    return 5 * sin(x / 45) + 3 * cos(z / 30);
}

static inline void make_ground(prom_mesh *mesh, bool hilly)
{
    const uint32_t n = 96;
    prom_mesh_init(mesh, (n + 1) * (n + 1), 6 * n * n, 1);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        float x = EXTENT * (2 * (float)(v % (n + 1)) / (float)n - 1);
        float z = EXTENT * (2 * (float)(v / (n + 1)) / (float)n - 1);
        float y = hilly ? (float)ground((double)x, (double)z) : -25;
        mesh->vertices[v] = (prom_vertex){.position = {x, y, z}, .normal = {0, 127, 0, 0}};
    }
    uint32_t *i = mesh->indices;
    for (uint32_t q = 0; q < n * n; q++) {
        uint32_t a = q / n * (n + 1) + q % n, b = a + 1, c = a + n + 1, d = c + 1;
        *i++ = c, *i++ = d, *i++ = a, *i++ = d, *i++ = b, *i++ = a;
    }
    mesh->submeshes[0] = (prom_submesh){0, mesh->index_count, PROM_NONE};
}

static inline double tower_at(uint32_t i)
{
    return PITCH * ((double)i - (TOWN_SIDE - 1) / 2.0);
}

static inline void make_model(prom_model *m, const prom_mesh meshes[3])
{
    memset(m, 0, sizeof *m);
    prom_arena *a = &m->arena;
#define TABLE(member, count) m->member = prom_arena_alloc(a, (count), sizeof *m->member)
    m->node_count = m->tree_count = LEAVES + 1;
    TABLE(parent, m->node_count);
    TABLE(first_child, m->node_count);
    TABLE(child_count, m->node_count);
    TABLE(prototype, m->node_count);
    TABLE(name, m->node_count);
    TABLE(placement, m->node_count);
    TABLE(center, m->node_count);
    TABLE(half, m->node_count);
    TABLE(radius, m->node_count);
    TABLE(weight, m->node_count);
    m->measured.ppd = PROM_PPD_MIN;
    strcpy(m->measured.metric, "flip");
    m->prototype_count = 4;
    m->mesh_count = m->rep_count = 3;
    m->share_count = LEAVES;
    m->names_bytes = 1;
    TABLE(prototypes, 4);
    TABLE(coverage, 4);
    TABLE(reps, 3);
    TABLE(accuracy, 3);
    TABLE(meshes, 3);
    TABLE(shares, LEAVES);
    TABLE(names, 1);
#undef TABLE
    for (uint32_t i = 0; i < 3; i++) {
        prom_box box = prom_mesh_bounds(&meshes[i]);
        prom_prototype *p = &m->prototypes[i];
        *p = (prom_prototype){.first_rep = i,
                              .rep_count = 1,
                              .first_share = PROM_NONE,
                              .flags = i ? PROM_PROTO_SURFACE : 0,
                              .radius = prom_box_diagonal(&box) / 2};
        prom_box_center(&box, p->center);
        prom_box_half(&box, p->half);
        m->meshes[i] = (prom_mesh_info){meshes[i].vertex_count, meshes[i].index_count, 1};
        m->reps[i] = (prom_representation){.switch_distance = INFINITY,
                                           .mesh = i,
                                           .texture = PROM_NONE,
                                           .max_size_px = INFINITY,
                                           .draws = 1,
                                           .layers = 1};
    }
    m->prototypes[3] =
        (prom_prototype){.first_rep = 3, .flags = PROM_PROTO_CLUSTER, .child_count = LEAVES};
    for (uint32_t i = 0; i <= LEAVES; i++) {
        m->parent[i] = i ? 0 : PROM_NONE;
        m->first_child[i] = i ? PROM_NONE : 1;
        m->child_count[i] = i ? 0 : LEAVES;
        m->prototype[i] = !i ? 3 : i <= TOWERS ? 0 : i - TOWERS;
        m->placement[i] = prom_placement_identity;
        if (!i || i > TOWERS) continue;
        double x = tower_at((i - 1) % TOWN_SIDE), z = tower_at((i - 1) / TOWN_SIDE);
        m->placement[i].origin[0] = x;
        m->placement[i].origin[1] = ground(x, z);
        m->placement[i].origin[2] = z;
    }
    prom_model_update_bounds(m);
}

// Named by the test program, so that several may run at a time.
static const char town_file[] = TOWN_FILE;

static inline int write_town(void **unused)
{
    (void)unused;
    prom_mesh meshes[3];
    prom_model model;
    prom_error error = {0};
    uint64_t row = 0;
    prom_mesh_init_box(&meshes[0], (float[]){0, -5, 0}, (float[]){HALF, 25, HALF}, NULL);
    make_ground(&meshes[1], true);
    make_ground(&meshes[2], false);
    make_model(&model, meshes);
    const char *wrong = prom_model_check(&model, &row);
    if (wrong) fail_msg("%s (%llu)", wrong, (unsigned long long)row);
    prom_writer *writer = prom_writer_create(town_file, &error);
    assert_non_null(writer);
    for (int i = 0; i < 3; i++) {
        uint32_t id;
        assert_int_equal(prom_writer_add_mesh(writer, &meshes[i], &id, &error), PROM_OK);
        prom_mesh_finish(&meshes[i]);
    }
    assert_int_equal(prom_writer_put_model(writer, &model, &error), PROM_OK);
    assert_int_equal(prom_writer_finish(writer, &error), PROM_OK);
    prom_writer_destroy(writer);
    prom_model_finish(&model);
    return 0;
}

static inline int remove_town(void **unused)
{
    (void)unused;
    return unlink(town_file);
}

static inline prom_container *open_town(prom_model *model)
{
    prom_error error = {0};
    prom_container *container = prom_container_open(town_file, &error);
    assert_non_null(container);
    assert_int_equal(prom_container_load_model(container, model, &error), PROM_OK);
    return container;
}

static inline bool in_tower(double x, double z, double margin)
{
    for (uint32_t i = 0; i < TOWERS; i++)
        if (fabs(x - tower_at(i % TOWN_SIDE)) < (double)HALF + margin &&
            fabs(z - tower_at(i / TOWN_SIDE)) < (double)HALF + margin)
            return true;
    return false;
}

#endif
