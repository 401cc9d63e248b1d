// LINK: prom_scenes prom_builder prom_metaobj
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scenes/path.h"
#include "scenes/walk_map.h"

#include <math.h>
#include <string.h>
#include <unistd.h>

#define FILE_NAME "test_auto_walk.prom"
#define SIDE 9 // towers along a side
#define TOWERS (SIDE * SIDE)
#define LEAVES (TOWERS + 2)
#define PITCH 32.0
#define HALF 6.0f     // of a tower's plan
#define EXTENT 190.0f // of the ground

// A hilly ground with towers on a grid, their foundations deep, and a cellar under all of it:
// by the boxes alone nobody could tell where the ground is.
static double ground(double x, double z)
{
    return 5 * sin(x / 45) + 3 * cos(z / 30);
}

static void make_ground(prom_mesh *mesh, bool hilly)
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

static double tower_at(uint32_t i)
{
    return PITCH * ((double)i - (SIDE - 1) / 2.0);
}

static void make_model(prom_model *m, const prom_mesh meshes[3])
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
                                           .draws = 1};
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
        double x = tower_at((i - 1) % SIDE), z = tower_at((i - 1) / SIDE);
        m->placement[i].origin[0] = x;
        m->placement[i].origin[1] = ground(x, z);
        m->placement[i].origin[2] = z;
    }
    prom_model_update_bounds(m);
}

static int write_town(void **unused)
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
    prom_writer *writer = prom_writer_create(FILE_NAME, &error);
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

static int remove_town(void **unused)
{
    (void)unused;
    return unlink(FILE_NAME);
}

static prom_container *open_town(prom_model *model)
{
    prom_error error = {0};
    prom_container *container = prom_container_open(FILE_NAME, &error);
    assert_non_null(container);
    assert_int_equal(prom_container_load_model(container, model, &error), PROM_OK);
    return container;
}

static bool in_tower(double x, double z, double margin)
{
    for (uint32_t i = 0; i < TOWERS; i++)
        if (fabs(x - tower_at(i % SIDE)) < (double)HALF + margin &&
            fabs(z - tower_at(i / SIDE)) < (double)HALF + margin)
            return true;
    return false;
}

static void test_walks_on_the_ground(void **unused)
{
    (void)unused;
    prom_model model;
    prom_error error = {0};
    prom_path path, again;
    prom_container *container = open_town(&model);
    assert_int_equal(prom_path_auto(container, &model, 600, &path, &error), PROM_OK);
    assert_int_equal(prom_path_auto(container, &model, 600, &again, &error), PROM_OK);
    assert_int_equal(path.keys.count, 600);
    assert_memory_equal(path.keys.data, again.keys.data, 600 * sizeof *path.keys.data);
    double way = 0;
    for (size_t i = 0; i < 600; i++) {
        const double *p = path.keys.data[i].position;
        assert_true(fabs(p[1] - ground(p[0], p[2]) - 1.7) < 0.6);
        assert_false(in_tower(p[0], p[2], 0.5));
        for (int k = 0; k < 4; k++) assert_true(isfinite(path.keys.data[i].orientation[k]));
        if (!i) continue;
        const double *b = path.keys.data[i - 1].position;
        double step = hypot(p[0] - b[0], p[2] - b[2]);
        assert_true(step < 1); // under 30 m/s
        way += step;
    }
    assert_true(way > 100);
    prom_path_finish(&path);
    prom_path_finish(&again);
    prom_model_finish(&model);
    prom_container_close(container);
}

static void test_map(void **unused)
{
    (void)unused;
    prom_model model;
    prom_error error = {0};
    prom_walk_map map;
    prom_container *container = open_town(&model);
    const double low[2] = {-100, -80}, high[2] = {100, 80};
    assert_int_equal(prom_walk_map_init(&map, container, &model, low, high, 1.7, &error),
                     PROM_OK);
    size_t grounds = 0;
    uint32_t street = prom_walk_map_at(&map, 16, ground(16, 16), 16);
    uint32_t cellar = prom_walk_map_at(&map, 16, -25, 16);
    assert_int_not_equal(street, PROM_NONE);
    assert_int_not_equal(cellar, PROM_NONE);
    assert_int_equal(map.floors.data[street].open, 1);
    assert_int_equal(map.floors.data[cellar].open, 0);
    assert_int_not_equal(map.floors.data[street].component, map.floors.data[cellar].component);
    for (size_t i = 0; i < map.floors.count; i++) {
        const prom_walk_floor *f = &map.floors.data[i];
        double p[3];
        prom_walk_map_point(&map, (uint32_t)i, p);
        assert_true(p[0] >= low[0] && p[0] <= high[0] && p[2] >= low[1] &&
                    p[2] <= high[1] + map.cell);
        if (f->component == map.floors.data[street].component) {
            grounds++;
            assert_true(fabs(p[1] - ground(p[0], p[2])) < 0.4);
            assert_false(in_tower(p[0], p[2], -map.cell));
        }
        for (int side = 0; side < 4; side++) {
            uint32_t n = prom_walk_map_neighbour(&map, (uint32_t)i, side);
            if (n == PROM_NONE) continue;
            assert_true(fabs((double)(map.floors.data[n].y - f->y)) <= map.step);
            assert_int_equal(map.floors.data[n].component, f->component);
        }
    }
    // The streets take most of the area: 1 - (12/32)^2.
    assert_true((double)grounds * map.cell * map.cell > 0.75 * 200 * 160);
    prom_walk_map_finish(&map);
    prom_model_finish(&model);
    prom_container_close(container);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_map),
        cmocka_unit_test(test_walks_on_the_ground),
    };
    return cmocka_run_group_tests(tests, write_town, remove_town);
}
