// LINK: prom_simplify
//
// Which faces a repair turns over, and which it leaves.
#include "repair_meshes.h"

// The same faces in another material lie over these (a decal).
static void faces_of_other_materials_stay(void **state)
{
    (void)state;
    prom_mesh mesh;
    init_sheet(&mesh, 3);
    uint32_t count = mesh.index_count;
    add_triangles(&mesh, mesh.indices, count / 3);
    prom_free(mesh.submeshes);
    mesh.submeshes = prom_calloc(2, sizeof *mesh.submeshes);
    mesh.submesh_count = 2;
    mesh.submeshes[0] = (prom_submesh){0, count, 0};
    mesh.submeshes[1] = (prom_submesh){count, count, 1};
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.duplicate, 0);
    assert_int_equal(mesh.index_count, 2 * count);
    assert_int_equal(r.patches, 1);
    // Both turn over, both come back.
    prom_mesh before;
    prom_mesh_copy(&before, &mesh);
    turn(&mesh, 7);
    turn(&mesh, count / 3 + 7);
    r = repair(&mesh, NULL);
    assert_int_equal(r.turned, 2);
    assert_true(prom_mesh_hash(&mesh, 0) == prom_mesh_hash(&before, 0));
    prom_mesh_finish(&before);
    prom_mesh_finish(&mesh);
}

static void two_sided_sheets_stay(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    init_sheet(&mesh, 4);
    uint32_t count = mesh.index_count;
    // The back has the front's normals, which speak against its winding.
    add_triangles(&mesh, mesh.indices, count / 3);
    for (uint32_t t = count / 3; t < 2 * count / 3; t++) turn(&mesh, t);
    for (prom_repair_orient how = PROM_ORIENT_BY_NORMALS; how <= PROM_ORIENT_NOT; how++) {
        prom_mesh_copy(&before, &mesh);
        prom_repair_report r = repair(&mesh, &(prom_repair_options){.orient = how});
        assert_true(same_mesh(&before, &mesh));
        assert_int_equal(r.two_sided, 2 * count / 3);
        assert_int_equal(r.patches, 0);
        assert_false(prom_repair_closed(&r));
        prom_mesh_finish(&before);
    }
    prom_mesh_finish(&mesh);
}

// Whatever share of faces is turned over, normals that know better bring them all back.
static void turned_faces_come_back_by_normals(void **state)
{
    (void)state;
    uint32_t seed = 11;
    for (uint32_t i = 0; i < 60; i++) {
        prom_mesh mesh, before;
        if (i % 3 == 0)
            init_cube(&mesh);
        else if (i % 3 == 1)
            init_globe(&mesh, 3 + i % 9, 0.1f + uniform(&seed));
        else
            init_sheet(&mesh, 1 + i % 9);
        prom_mesh_copy(&before, &mesh);
        // An open sheet that is wholly turned over is left so.
        uint32_t turned = turn_some(&mesh, i % 3 == 2 ? 50 : i * 2, &seed);
        bool whole = turned == mesh.index_count / 3 && i % 3 == 2;
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.turned, whole ? 0 : turned);
        assert_int_equal(r.clashing_edges, 0);
        if (!whole) assert_true(prom_mesh_hash(&mesh, 0) == prom_mesh_hash(&before, 0));
        prom_mesh_finish(&mesh);
        prom_mesh_finish(&before);
    }
}

// Without a word from the author: closed ones have their volume, open ones their majority.
static void turned_faces_come_back_by_shape(void **state)
{
    (void)state;
    uint32_t seed = 12;
    const prom_repair_options by_shape = {.orient = PROM_ORIENT_BY_SHAPE};
    for (uint32_t i = 0; i < 40; i++) {
        prom_mesh mesh;
        bool open = i % 2;
        if (open)
            init_sheet(&mesh, 6);
        else
            init_globe(&mesh, 6, 1);
        uint32_t vertices = mesh.vertex_count;
        double inside = volume(&mesh);
        uint32_t turned = turn_some(&mesh, open ? 1 + i / 2 : 5 + 2 * i, &seed);
        normals_from_windings(&mesh);
        prom_repair_report r = repair(&mesh, &by_shape);
        assert_int_equal(r.clashing_edges, 0);
        assert_int_equal(r.turned, turned);
        assert_int_equal(against(&mesh), 0);
        if (open)
            assert_int_equal(mesh.vertex_count, vertices);
        else
            assert_true(fabs(volume(&mesh) - inside) < 1e-5);
        prom_mesh_finish(&mesh);
    }
}

static void normals_protect_their_faces(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    uint32_t seed = 13;
    init_globe(&mesh, 8, 1);
    turn_some(&mesh, 30, &seed);
    normals_from_windings(&mesh);
    prom_mesh_repair(&mesh, NULL, &(prom_repair_report){0}); // welds
    prom_mesh_copy(&before, &mesh);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.turned, 0);
    assert_true(r.clashing_edges > 0);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

// Normals that contradict each other say nothing about the windings.
static void quarrelling_normals_are_not_believed(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    uint32_t seed = 14;
    init_sheet(&mesh, 10);
    unweld(&mesh);
    turn_some(&mesh, 30, &seed);
    for (uint32_t v = 0; v < mesh.vertex_count; v++) // by triangle
        if (v / 3 * 7 % 10 < 4) mesh.vertices[v].normal[1] = -127;
    prom_mesh_repair(&mesh, &(prom_repair_options){.orient = PROM_ORIENT_NOT},
                     &(prom_repair_report){0});
    prom_mesh_copy(&before, &mesh);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.turned, 0);
    assert_true(r.clashing_edges > 0);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

// Of three sheets along one edge none has a side that the others would prove; but a large
// surface may touch others somewhere.
static void few_tangled_edges_do_no_harm(void **state)
{
    (void)state;
    for (uint32_t n = 1; n <= 8; n += 7) {
        prom_mesh mesh;
        init_sheet(&mesh, n);
        prom_vertex top = mesh.vertices[0];
        top.position[1] = 1;
        uint32_t a = add_vertex(&mesh, top);
        top.position[1] = -1;
        uint32_t b = add_vertex(&mesh, top);
        add_triangles(&mesh, (uint32_t[6]){0, 1, a, 0, 1, b}, 2);
        turn(&mesh, n * n * 2 - 1);
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.non_manifold_edges, 1);
        assert_int_equal(r.turned, n == 8);
        prom_mesh_finish(&mesh);
    }
}

// A room is a box seen from within: its normals say so, or nothing does.
static void rooms_and_backdrops_stay(void **state)
{
    (void)state;
    for (int how = 0; how <= PROM_ORIENT_NOT; how++) {
        prom_mesh room;
        init_cube(&room);
        for (uint32_t t = 0; t < 12; t++) turn(&room, t);
        for (uint32_t v = 0; v < room.vertex_count && how < PROM_ORIENT_NOT; v++)
            for (int k = 0; k < 3; k++) room.vertices[v].normal[k] *= -1;
        prom_repair_report r = repair(&room, &(prom_repair_options){.orient = how});
        assert_int_equal(r.turned, 0);
        assert_true(volume(&room) < 0);
        prom_mesh_finish(&room);
    }
}

// One twist in a closed band: no choice of sides makes all faces agree.
static void one_sided_bands_stay(void **state)
{
    (void)state;
    enum { N = 24 };
    prom_mesh mesh, before;
    prom_mesh_init(&mesh, 2 * N, 6 * N, 1);
    for (uint32_t i = 0; i < 2 * N; i++) {
        float at = 2 * (float)M_PI * (float)(i / 2) / N, side = i % 2 ? 0.3f : -0.3f;
        float r = 1 + side * cosf(at / 2);
        const float p[3] = {r * cosf(at), side * sinf(at / 2), r * sinf(at)};
        for (int k = 0; k < 3; k++) mesh.vertices[i].position[k] = p[k] + 0.0f; // no -0
    }
    for (uint32_t i = 0; i < N; i++) {
        uint32_t a = 2 * i, b = a + 1, c = a + 2, d = a + 3;
        if (i + 1 == N) c = 1, d = 0;
        const uint32_t quad[6] = {a, c, b, b, c, d};
        memcpy(mesh.indices + 6 * i, quad, sizeof quad);
    }
    mesh.submeshes[0].index_count = 6 * N;
    prom_mesh_copy(&before, &mesh);
    prom_repair_report r =
        repair(&mesh, &(prom_repair_options){.orient = PROM_ORIENT_BY_SHAPE});
    assert_int_equal(r.turned, 0);
    assert_int_equal(r.clashing_edges, 1);
    assert_int_equal(r.open_edges, 2 * N);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

// Three sheets along one edge.
static void edges_of_three_faces_are_counted(void **state)
{
    (void)state;
    prom_mesh mesh;
    prom_mesh_init(&mesh, 5, 9, 1);
    const float at[5][3] = {{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 0, 1}};
    for (int v = 0; v < 5; v++) memcpy(mesh.vertices[v].position, at[v], sizeof at[v]);
    const uint32_t faces[9] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
    memcpy(mesh.indices, faces, sizeof faces);
    mesh.submeshes[0].index_count = 9;
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.non_manifold_edges, 1);
    assert_int_equal(r.open_edges, 6);
    assert_int_equal(r.patches, 3);
    prom_mesh_finish(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(faces_of_other_materials_stay),
        cmocka_unit_test(two_sided_sheets_stay),
        cmocka_unit_test(turned_faces_come_back_by_normals),
        cmocka_unit_test(turned_faces_come_back_by_shape),
        cmocka_unit_test(normals_protect_their_faces),
        cmocka_unit_test(quarrelling_normals_are_not_believed),
        cmocka_unit_test(few_tangled_edges_do_no_harm),
        cmocka_unit_test(rooms_and_backdrops_stay),
        cmocka_unit_test(one_sided_bands_stay),
        cmocka_unit_test(edges_of_three_faces_are_counted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
