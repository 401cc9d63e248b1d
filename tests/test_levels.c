// LINK: prom_simplify
#include "builder/simplify/simplify.h"

#include "simplify_fixture.h"

static void levels_shrink(void **state)
{
    (void)state;
    for (int lock = 0; lock < 2; lock++) {
        prom_mesh mesh, levels[8];
        float errors[8];
        init_field(&mesh, 48, 0, true);
        uint32_t count = prom_simplify_levels(&mesh, lock, 100, 8, levels, errors);
        assert_in_range(count, 3, 8);
        assert_int_equal(levels[0].index_count, mesh.index_count);
        assert_true(errors[0] == 0);
        prom_box bounds = prom_mesh_bounds(&mesh);
        for (uint32_t i = 0; i < count; i++) {
            assert_sound(&levels[i]);
            if (i) {
                assert_true(levels[i].index_count <= 0.86 * levels[i - 1].index_count);
                assert_true(errors[i] >= errors[i - 1]);
                assert_true(errors[i] > 0 && errors[i] < prom_box_diagonal(&bounds));
            }
        }
        for (uint32_t i = 0; i < count; i++) prom_mesh_finish(&levels[i]);
        prom_mesh_finish(&mesh);
    }
}

static void foliage_keeps_its_area(void **state)
{
    (void)state;
    prom_mesh mesh, levels[6];
    float errors[6];
    init_foliage(&mesh, 700, 5);
    float area = area_of(&mesh);
    uint32_t count = prom_simplify_levels(&mesh, false, 60, 6, levels, errors);
    assert_in_range(count, 4, 6);
    for (uint32_t i = 0; i < count; i++) {
        assert_sound(&levels[i]);
        assert_float_equal(area_of(&levels[i]) / area, 1, 0.15);
        if (i) assert_true(errors[i] > 0);
        prom_mesh_finish(&levels[i]);
    }
    prom_mesh_finish(&mesh);
}

// Both sides of a leaf may share vertices, and so the normals: level 0 looks as it did.
static void shared_sides_keep_their_normals(void **state)
{
    (void)state;
    prom_mesh field, mesh, levels[3];
    float errors[3];
    init_field(&field, 12, 0, false);
    uint32_t n = field.index_count;
    prom_mesh_init(&mesh, field.vertex_count, n * 2, 1);
    memcpy(mesh.vertices, field.vertices, field.vertex_count * sizeof *mesh.vertices);
    for (uint32_t i = 0; i < n; i++) {
        mesh.indices[i] = field.indices[i];
        mesh.indices[n + i] = field.indices[i - i % 3 + 2 - i % 3];
    }
    mesh.submeshes[0] = (prom_submesh){0, n * 2, 0};
    uint32_t count = prom_simplify_levels(&mesh, false, 50, 3, levels, errors);
    assert_int_equal(count, 3);
    assert_int_equal(levels[0].vertex_count, mesh.vertex_count);
    for (uint32_t i = 0; i < count; i++) {
        for (uint32_t v = 0; v < levels[i].vertex_count; v++)
            assert_true(levels[i].vertices[v].normal[1] > 0);
        edge_list open = open_edges(&levels[i]);
        assert_int_equal(open.count, 0);
        prom_array_finish(&open);
        prom_mesh_finish(&levels[i]);
    }
    prom_mesh_finish(&field);
    prom_mesh_finish(&mesh);
}

static void bad_meshes_are_safe(void **state)
{
    (void)state;
    const prom_reduce_options options = {0};
    prom_mesh out = {0}, empty = {0}, levels[4];
    float error, errors[4];
    assert_false(reduce_mesh(&empty, &options, 10, INFINITY, &out, &error));
    assert_null(out.vertices);
    assert_int_equal(prom_simplify_levels(&empty, false, 10, 4, levels, errors), 0);
    prom_mesh_weld(&empty, 0.1f);
    assert_int_equal(empty.index_count, 0);
    prom_mesh_finish(&empty);

    // All in one point: a level 0, and nothing to simplify.
    prom_mesh point;
    prom_mesh_init(&point, 3, 300, 1);
    for (uint32_t i = 0; i < 300; i++) point.indices[i] = i % 3;
    point.submeshes[0] = (prom_submesh){0, 300, PROM_NONE};
    assert_false(reduce_mesh(&point, &options, 10, INFINITY, &out, &error));
    assert_int_equal(prom_simplify_levels(&point, false, 10, 4, levels, errors), 1);
    prom_mesh_finish(&levels[0]);
    prom_mesh_weld(&point, 1);
    assert_int_equal(point.index_count, 0);
    prom_mesh_finish(&point);

    // Damaged numbers cost their triangles and no more.
    prom_mesh field;
    init_field(&field, 20, 0, false);
    field.vertices[7].position[1] = NAN;
    field.vertices[100].position[0] = INFINITY;
    field.vertices[200].position[2] = 3e38f;
    field.vertices[50].uv[0] = NAN;
    assert_true(reduce_mesh(&field, &options, 200, INFINITY, &out, &error));
    assert_sound(&out);
    assert_true(isfinite(error));
    prom_mesh_finish(&out);
    assert_false(reduce_mesh(&field, &options, 5000, INFINITY, &out, &error));
    prom_mesh_finish(&field);
}

static void weld_merges(void **state)
{
    (void)state;
    prom_mesh mesh;
    init_field(&mesh, 10, 0, false);
    prom_mesh loose;
    prom_mesh_init(&loose, mesh.index_count, mesh.index_count, 1);
    uint32_t seed = 3;
    for (uint32_t i = 0; i < mesh.index_count; i++) {
        loose.vertices[i] = mesh.vertices[mesh.indices[i]];
        loose.indices[i] = i;
    }
    loose.submeshes[0] = (prom_submesh){0, loose.index_count, 0};
    prom_mesh jittered;
    prom_mesh_copy(&jittered, &loose);
    for (uint32_t i = 0; i < jittered.vertex_count; i++)
        for (int k = 0; k < 3; k++) jittered.vertices[i].position[k] += 1e-5f * uniform(&seed);
    prom_mesh_weld(&loose, 0);
    assert_int_equal(loose.vertex_count, 121);
    assert_int_equal(loose.index_count, mesh.index_count);
    prom_mesh_weld(&jittered, 2e-5f);
    assert_int_equal(jittered.vertex_count, 121);
    assert_float_equal(area_of(&jittered), area_of(&mesh), 1e-3);
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&loose);
    prom_mesh_finish(&jittered);
}

static void same_twice(void **state)
{
    (void)state;
    uint64_t hashes[2][2] = {{0}};
    for (int run = 0; run < 2; run++) {
        prom_mesh meshes[2], levels[8];
        float errors[8];
        init_field(&meshes[0], 40, 0, true);
        init_foliage(&meshes[1], 300, 9);
        for (int m = 0; m < 2; m++) {
            uint32_t count = prom_simplify_levels(&meshes[m], false, 30, 8, levels, errors);
            for (uint32_t i = 0; i < count; i++) {
                hashes[run][m] = prom_mesh_hash(&levels[i], hashes[run][m]);
                prom_mesh_finish(&levels[i]);
            }
            prom_mesh_finish(&meshes[m]);
        }
    }
    assert_memory_equal(hashes[0], hashes[1], sizeof hashes[0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(levels_shrink),
        cmocka_unit_test(foliage_keeps_its_area),
        cmocka_unit_test(shared_sides_keep_their_normals),
        cmocka_unit_test(bad_meshes_are_safe),
        cmocka_unit_test(weld_merges),
        cmocka_unit_test(same_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
