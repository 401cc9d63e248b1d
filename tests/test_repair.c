// LINK: prom_simplify
#include "repair_meshes.h"

static void sound_meshes_stay(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    for (int kind = 0; kind < 3; kind++) {
        if (kind == 0) init_cube(&mesh);
        if (kind == 1) init_globe(&mesh, 8, 1);
        if (kind == 2) init_sheet(&mesh, 5);
        prom_mesh_copy(&before, &mesh);
        prom_repair_report r = repair(&mesh, NULL);
        assert_true(same_mesh(&before, &mesh));
        assert_false(prom_repair_mended(&r));
        assert_int_equal(r.patches, 1);
        assert_int_equal(r.closed_patches, kind < 2);
        assert_int_equal(prom_repair_closed(&r), kind < 2);
        assert_int_equal(r.open_edges, kind < 2 ? 0 : 20);
        prom_mesh_finish(&mesh);
        prom_mesh_finish(&before);
    }
}

static void loose_triangles_are_welded(void **state)
{
    (void)state;
    prom_mesh mesh;
    init_globe(&mesh, 8, 1);
    uint32_t vertices = mesh.vertex_count;
    unweld(&mesh);
    uint32_t loose = mesh.vertex_count;
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(mesh.vertex_count, vertices);
    assert_int_equal(r.welded, loose - vertices);
    assert_int_equal(r.snapped, 0);
    assert_true(prom_repair_closed(&r));
    prom_mesh_finish(&mesh);
}

// Jitter far below the tolerance, everywhere: cells of the search have borders somewhere.
static void cracks_close_wherever_they_are(void **state)
{
    (void)state;
    uint32_t seed = 5;
    for (int turn_no = 0; turn_no < 20; turn_no++) {
        prom_mesh mesh;
        float radius = powf(10, 4 * uniform(&seed) - 2);
        init_globe(&mesh, 12, radius);
        uint32_t vertices = mesh.vertex_count;
        unweld(&mesh);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            for (int k = 0; k < 3; k++)
                mesh.vertices[v].position[k] += 0.4e-5f * radius * (2 * uniform(&seed) - 1);
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(mesh.vertex_count, vertices);
        assert_true(r.snapped > 0);
        assert_true(prom_repair_closed(&r));
        prom_mesh_finish(&mesh);
    }
}

// No vertex moves further than the tolerance, none stays nearer than that to another's place.
static void the_tolerance_holds(void **state)
{
    (void)state;
    uint32_t seed = 9;
    prom_mesh mesh, before;
    init_sheet(&mesh, 12);
    for (uint32_t v = 0; v < mesh.vertex_count; v++)
        for (int k = 0; k < 3; k++)
            mesh.vertices[v].position[k] = 0.3f * uniform(&seed) + (v == 0 && k == 1);
    prom_mesh_copy(&before, &mesh);
    const prom_repair_options options = {.tolerance = 0.05f, .orient = PROM_ORIENT_NOT};
    prom_box box = prom_mesh_bounds(&mesh);
    float tolerance = 0.05f * prom_box_diagonal(&box) / 2;
    prom_mesh_repair(&mesh, &options, &(prom_repair_report){0});
    assert_true(mesh.vertex_count > 10 && mesh.vertex_count < before.vertex_count);
    for (uint32_t a = 0; a < mesh.vertex_count; a++) {
        float nearest = INFINITY;
        for (uint32_t b = 0; b < before.vertex_count; b++) {
            float far = 0;
            for (int k = 0; k < 3; k++)
                far = fmaxf(
                    far, fabsf(mesh.vertices[a].position[k] - before.vertices[b].position[k]));
            nearest = fminf(nearest, far);
        }
        assert_true(nearest == 0); // the place of one that was there
        for (uint32_t b = 0; b < a; b++) {
            float far = 0;
            for (int k = 0; k < 3; k++)
                far = fmaxf(far,
                            fabsf(mesh.vertices[a].position[k] - mesh.vertices[b].position[k]));
            assert_true(far > tolerance || far == 0);
        }
    }
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

static void what_is_further_apart_stays_apart(void **state)
{
    (void)state;
    for (int wide = 0; wide < 2; wide++) {
        prom_mesh mesh;
        init_sheet(&mesh, 2); // radius sqrt(2)
        unweld(&mesh);
        float gap = sqrtf(2) * PROM_REPAIR_TOLERANCE * (wide ? 1.1f : 0.9f);
        for (uint32_t v = 0; v < 3; v++) mesh.vertices[v].position[1] += gap;
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.open_edges, wide ? 8 + 2 : 8);
        prom_mesh_finish(&mesh);
    }
    prom_mesh exact;
    init_sheet(&exact, 2);
    exact.vertices[0].position[1] = 1e-7f;
    unweld(&exact);
    exact.vertices[0].position[1] = 0;
    prom_repair_report r = repair(&exact, &(prom_repair_options){.tolerance = -1});
    assert_int_equal(r.snapped, 0);
    prom_mesh_finish(&exact);
}

static void seams_of_the_texture_survive(void **state)
{
    (void)state;
    prom_mesh mesh;
    uint32_t n = 8, seed = 3;
    init_globe(&mesh, n, 1);
    uint32_t vertices = mesh.vertex_count;
    for (uint32_t v = 0; v < vertices; v++)
        for (int k = 0; k < 3; k++)
            mesh.vertices[v].position[k] += 0.4e-5f * (2 * uniform(&seed) - 1);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(mesh.vertex_count, vertices);
    assert_int_equal(r.welded, 0);
    assert_int_equal(r.snapped, n - 1); // one of each pair at the seam
    assert_true(prom_repair_closed(&r));
    uint32_t pairs = 0;
    for (uint32_t a = 0; a < vertices; a++)
        for (uint32_t b = 0; b < a; b++)
            pairs += !memcmp(mesh.vertices[a].position, mesh.vertices[b].position,
                             sizeof mesh.vertices[a].position) &&
                     fabsf(mesh.vertices[a].uv[0] - mesh.vertices[b].uv[0]) == 1;
    assert_int_equal(pairs, n - 1);
    prom_mesh_finish(&mesh);
}

static void faces_without_area_go(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    init_globe(&mesh, 6, 1);
    prom_mesh_copy(&before, &mesh);
    prom_vertex bad = mesh.vertices[0];
    bad.position[1] = NAN;
    uint32_t nan = add_vertex(&mesh, bad);
    bad.position[1] = INFINITY;
    uint32_t infinite = add_vertex(&mesh, bad);
    bad.position[1] = mesh.vertices[0].position[1] + 1e-7f;
    uint32_t near = add_vertex(&mesh, bad);
    const uint32_t faces[] = {4, 4, 9, 7, 7, 7, 0, 1, nan, 2, infinite, 5, 0, near, 20};
    add_triangles(&mesh, faces, 5);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.degenerate, 5);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

static void repeated_faces_go(void **state)
{
    (void)state;
    prom_mesh mesh, before;
    init_globe(&mesh, 6, 1);
    prom_mesh_copy(&before, &mesh);
    const uint32_t *t = mesh.indices;
    const uint32_t faces[] = {t[0], t[1], t[2],
                              t[4], t[5], t[3]}; // the second begins elsewhere
    add_triangles(&mesh, faces, 2);
    prom_repair_report r = repair(&mesh, NULL);
    assert_int_equal(r.duplicate, 2);
    assert_true(same_mesh(&before, &mesh));
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&before);
}

static void everything_at_once(void **state)
{
    (void)state;
    uint32_t seed = 77;
    for (uint32_t i = 0; i < 30; i++) {
        prom_mesh mesh;
        init_globe(&mesh, 6 + i % 7, 2);
        uint32_t vertices = mesh.vertex_count, faces = mesh.index_count / 3;
        double inside = volume(&mesh);
        unweld(&mesh);
        for (uint32_t v = 0; v < mesh.vertex_count; v++)
            for (int k = 0; k < 3; k++)
                mesh.vertices[v].position[k] += 0.8e-5f * (2 * uniform(&seed) - 1);
        for (uint32_t d = 0; d < 20; d++) { // before any is turned: no back sides come of it
            uint32_t t = next_random(&seed) % faces;
            add_triangles(&mesh, (uint32_t[3]){3 * t, 3 * t + 1, 3 * t + 2}, 1);
            add_triangles(&mesh, (uint32_t[3]){3 * t, 3 * t + 1, 3 * t + 1}, 1);
        }
        uint32_t turned = 0;
        bool *over = prom_calloc(faces, sizeof *over);
        for (uint32_t t = 0; t < faces; t++) over[t] = next_random(&seed) % 4 == 0;
        for (uint32_t t = 0; t < mesh.index_count / 3; t++)
            if (over[mesh.indices[3 * t] / 3]) turn(&mesh, t);
        for (uint32_t t = 0; t < faces; t++) turned += over[t];
        prom_repair_report r = repair(&mesh, NULL);
        assert_int_equal(r.degenerate, 20);
        assert_int_equal(r.duplicate, 20);
        assert_int_equal(r.turned, turned);
        assert_int_equal(mesh.index_count / 3, faces);
        assert_int_equal(mesh.vertex_count, vertices);
        assert_true(prom_repair_closed(&r));
        assert_true(fabs(volume(&mesh) - inside) < 1e-3);
        prom_free(over);
        prom_mesh_finish(&mesh);
    }
}

// Random triangles over few places: all that can go wrong does.
static void nothing_hurts_soups(void **state)
{
    (void)state;
    uint32_t seed = 99;
    for (uint32_t i = 0; i < 300; i++) {
        prom_mesh mesh;
        uint32_t vertices = 3 + next_random(&seed) % 12, faces = next_random(&seed) % 40;
        prom_mesh_init(&mesh, vertices, faces * 3, 2);
        for (uint32_t v = 0; v < vertices; v++) {
            for (int k = 0; k < 3; k++) {
                mesh.vertices[v].position[k] = (float)(next_random(&seed) % 3) - 1;
                mesh.vertices[v].normal[k] = (int8_t)(next_random(&seed) % 255 - 127);
            }
            if (next_random(&seed) % 50 == 0) mesh.vertices[v].position[0] = NAN;
            if (next_random(&seed) % 9 == 0) mesh.vertices[v].position[0] = -0.0f;
        }
        for (uint32_t c = 0; c < faces * 3; c++)
            mesh.indices[c] = next_random(&seed) % vertices;
        uint32_t half = faces / 2 * 3;
        mesh.submeshes[0] = (prom_submesh){0, half, 0};
        mesh.submeshes[1] = (prom_submesh){half, faces * 3 - half, 1};
        const prom_repair_options options = {.tolerance = i % 5 ? 0.0f : 0.3f,
                                             .orient = i % 3 ? i % 3 : PROM_ORIENT_BY_NORMALS};
        prom_repair_report r = repair(&mesh, &options);
        assert_int_equal(r.faces + r.degenerate + r.duplicate, faces);
        prom_mesh_finish(&mesh);
    }
}

static void empty_meshes_are_fine(void **state)
{
    (void)state;
    prom_mesh empty = {0};
    prom_repair_report r = repair(&empty, NULL);
    assert_false(prom_repair_mended(&r));
    assert_false(prom_repair_closed(&r));
    prom_mesh_finish(&empty);
    prom_mesh point;
    init_sheet(&point, 2);
    for (uint32_t v = 0; v < point.vertex_count; v++)
        memset(point.vertices[v].position, 0, sizeof point.vertices[v].position);
    r = repair(&point, NULL);
    assert_int_equal(r.degenerate, 8);
    assert_int_equal(point.vertex_count, 0);
    assert_int_equal(point.submesh_count, 0);
    prom_mesh_finish(&point);
}

static void numbers_are_told(void **state)
{
    (void)state;
    prom_repair_report r = {.welded = 12, .turned = 1, .faces = 9}, sum = {0}, read = {0};
    char *text = prom_repair_text(&r);
    assert_string_equal(text, "12 vertices welded, 1 face turned");
    prom_free(text);
    prom_repair_report_add(&sum, &r);
    prom_repair_report_add(&sum, &r);
    assert_int_equal(sum.welded, 24);
    assert_int_equal(sum.faces, 18);
    char *json = prom_repair_json(&r);
    assert_non_null(strstr(json, "\"welded\": 12,"));
    assert_non_null(strstr(json, "\"closed_patches\": 0}"));
    prom_free(json);
    prom_repair_set(&read, "welded", 12);
    prom_repair_set(&read, "turned", 1);
    prom_repair_set(&read, "faces", 9);
    prom_repair_set(&read, "nonsense", 7);
    assert_memory_equal(&read, &r, sizeof r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(sound_meshes_stay),
        cmocka_unit_test(loose_triangles_are_welded),
        cmocka_unit_test(cracks_close_wherever_they_are),
        cmocka_unit_test(the_tolerance_holds),
        cmocka_unit_test(what_is_further_apart_stays_apart),
        cmocka_unit_test(seams_of_the_texture_survive),
        cmocka_unit_test(faces_without_area_go),
        cmocka_unit_test(repeated_faces_go),
        cmocka_unit_test(everything_at_once),
        cmocka_unit_test(nothing_hurts_soups),
        cmocka_unit_test(empty_meshes_are_fine),
        cmocka_unit_test(numbers_are_told),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
