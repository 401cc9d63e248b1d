// LINK: prom_simplify
#include "simplify_fixture.h"

static int by_position(const void *a, const void *b)
{
    return memcmp(a, b, 3 * sizeof(float));
}

static void locked_borders_stay(void **state)
{
    (void)state;
    for (uint32_t n = 9; n <= 41; n += 16) {
        prom_mesh mesh, out;
        float error;
        init_field(&mesh, n, 0, n % 32 == 9);
        const prom_reduce_options options = {.lock_border = true};
        assert_true(reduce_mesh(&mesh, &options, n * n / 2, INFINITY, &out, &error));
        assert_sound(&out);
        assert_true(out.index_count < mesh.index_count);
        edge_list before = open_edges(&mesh), after = open_edges(&out);
        assert_int_equal(before.count, n * 4);
        assert_same_edges(&before, &after);
        prom_mesh_finish(&mesh);
        prom_mesh_finish(&out);
    }
}

// Neighbours that were simplified apart share the border's vertices bit by bit.
static void neighbours_meet(void **state)
{
    (void)state;
    enum { N = 24 };
    float shared[2][N + 1][3];
    for (int side = 0; side < 2; side++) {
        prom_mesh mesh, out;
        float error;
        init_field(&mesh, N, (float)side, false);
        const prom_reduce_options options = {.lock_border = true};
        assert_true(reduce_mesh(&mesh, &options, 300, INFINITY, &out, &error));
        uint32_t count = 0;
        for (uint32_t i = 0; i < out.vertex_count; i++)
            if (out.vertices[i].position[0] == 1.0f) {
                assert_in_range(count, 0, N);
                memcpy(shared[side][count++], out.vertices[i].position, 12);
            }
        assert_int_equal(count, N + 1);
        qsort(shared[side], count, 12, by_position);
        prom_mesh_finish(&mesh);
        prom_mesh_finish(&out);
    }
    assert_memory_equal(shared[0], shared[1], sizeof shared[0]);
}

// Submeshes of one mesh are simplified together: no crack opens between them, both stay.
static void submeshes_do_not_crack(void **state)
{
    (void)state;
    prom_mesh mesh, out;
    float error;
    init_field(&mesh, 40, 0, true);
    assert_true(reduce_mesh(&mesh, &(prom_reduce_options){0}, 400, INFINITY, &out, &error));
    assert_sound(&out);
    assert_in_range(out.index_count / 3, 300, 440);
    assert_int_equal(out.submesh_count, 2);
    assert_int_equal(out.submeshes[0].material, 3);
    assert_int_equal(out.submeshes[1].material, 7);
    edge_list open = open_edges(&out);
    for (size_t i = 0; i < open.count; i++) {
        const float *e = open.data[i].ends;
        bool on_side = false;
        for (int a = 0; a < 3; a += 2)
            for (int k = 0; k < 2; k++)
                on_side |= fabsf(e[a] - (float)k) < 5e-3f && fabsf(e[a + 3] - (float)k) < 5e-3f;
        assert_true(on_side);
    }
    prom_array_finish(&open);
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&out);
}

// From the vertices of one mesh to the surface of another, root of the mean square.
static float mean_distance(const prom_mesh *from, const prom_mesh *to)
{
    prom_surface surface;
    double sum = 0;
    prom_surface_init(&surface, to->vertices, to->vertex_count, to->indices, to->index_count);
    for (uint32_t i = 0; i < from->vertex_count; i++) {
        const float d =
            prom_surface_nearest(&surface, from->vertices[i].position, 0, PROM_NONE).distance;
        sum += (double)(d * d) / from->vertex_count;
    }
    prom_surface_finish(&surface);
    return (float)sqrt(sum);
}

// The error is a distance: at the original's vertices the field's height is known, so the
// simplified field's vertices may not leave it, and a flat field has none.
static void errors_are_distances(void **state)
{
    (void)state;
    prom_mesh mesh, out;
    float error;
    init_field(&mesh, 30, 0, false);
    assert_true(reduce_mesh(&mesh, &(prom_reduce_options){0}, 200, INFINITY, &out, &error));
    assert_true(error > 1e-4f && error < 0.3f);
    prom_mesh_finish(&out);
    assert_true(reduce_mesh(&mesh, &(prom_reduce_options){0}, 10, 0.02f, &out, &error));
    assert_true(mean_distance(&mesh, &out) <= 0.02f);
    prom_mesh_finish(&out);
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        mesh.vertices[i].position[1] = 0;
        mesh.vertices[i].normal[0] = mesh.vertices[i].normal[2] = 0;
        mesh.vertices[i].normal[1] = 127;
    }
    assert_true(reduce_mesh(&mesh, &(prom_reduce_options){0}, 8, INFINITY, &out, &error));
    assert_true(error < 1e-5f);
    assert_float_equal(area_of(&out), 1.0, 1e-4);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
}

// A sheet with two sides keeps its outline and both of its sides.
static void two_sided_sheets_stay(void **state)
{
    (void)state;
    prom_mesh field, mesh, out;
    float error;
    init_field(&field, 20, 0, false);
    uint32_t v = field.vertex_count, n = field.index_count;
    prom_mesh_init(&mesh, v * 2, n * 2, 1);
    for (uint32_t i = 0; i < v; i++) {
        mesh.vertices[i] = mesh.vertices[v + i] = field.vertices[i];
        for (int k = 0; k < 3; k++)
            mesh.vertices[v + i].normal[k] = (int8_t)-field.vertices[i].normal[k];
    }
    for (uint32_t i = 0; i < n; i++) {
        mesh.indices[i] = field.indices[i];
        mesh.indices[n + i] = v + field.indices[i - i % 3 + 2 - i % 3];
    }
    mesh.submeshes[0] = (prom_submesh){0, n * 2, 0};
    assert_true(reduce_mesh(&mesh, &(prom_reduce_options){0}, 200, INFINITY, &out, &error));
    assert_sound(&out);
    assert_in_range(out.index_count / 3, 100, 220);
    assert_float_equal(area_of(&out) / area_of(&mesh), 1, 0.1);
    edge_list open = open_edges(&out);
    assert_int_equal(open.count, 0);
    prom_array_finish(&open);
    prom_mesh_finish(&field);
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&out);
}

// Flat-shaded geometry has a vertex per face and corner; that must not stop simplification.
static void hard_edges_do_not_stop_it(void **state)
{
    (void)state;
    prom_mesh field, mesh, out;
    float error;
    init_field(&field, 30, 0, false);
    prom_mesh_init(&mesh, field.index_count, field.index_count, 1);
    for (uint32_t i = 0; i < field.index_count; i += 3) {
        float e[3], f[3], normal[3], *p[3];
        for (int k = 0; k < 3; k++) p[k] = field.vertices[field.indices[i + k]].position;
        glm_vec3_sub(p[1], p[0], e);
        glm_vec3_sub(p[2], p[0], f);
        glm_vec3_cross(e, f, normal);
        glm_vec3_normalize(normal);
        for (uint32_t k = 0; k < 3; k++) {
            mesh.vertices[i + k] = field.vertices[field.indices[i + k]];
            prom_pack_normal(normal, mesh.vertices[i + k].normal);
            mesh.indices[i + k] = i + k;
        }
    }
    mesh.submeshes[0] = (prom_submesh){0, mesh.index_count, 0};
    assert_true(reduce_mesh(&mesh, &(prom_reduce_options){0}, 300, INFINITY, &out, &error));
    assert_sound(&out);
    assert_in_range(out.index_count / 3, 100, 330);
    prom_mesh_finish(&field);
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&out);
}

// Where the rest is rough, a thin door costs less to eat up than what is around it, but it must
// not go.
static void notable_parts_do_not_vanish(void **state)
{
    (void)state;
    prom_mesh field, door, mesh, out;
    float error;
    const float center[3] = {0.5f, 1.9f, 0.5f}, half[3] = {0.05f, 0.2f, 0.003f};
    init_field(&field, 40, 0, false);
    for (uint32_t i = 0; i < field.vertex_count; i++) field.vertices[i].position[1] *= 4;
    prom_mesh_init_box(&door, center, half, NULL);
    for (uint32_t i = 0; i < door.vertex_count; i++) {
        memset(door.vertices[i].normal, 0, 4); // no seams that would hold it together
        memset(door.vertices[i].uv, 0, sizeof door.vertices[i].uv);
    }
    uint32_t v = field.vertex_count, n = field.index_count;
    prom_mesh_init(&mesh, v + door.vertex_count, n + door.index_count, 1);
    memcpy(mesh.vertices, field.vertices, v * sizeof *mesh.vertices);
    memcpy(mesh.vertices + v, door.vertices, door.vertex_count * sizeof *mesh.vertices);
    memcpy(mesh.indices, field.indices, n * sizeof *mesh.indices);
    for (uint32_t i = 0; i < door.index_count; i++) mesh.indices[n + i] = v + door.indices[i];
    mesh.submeshes[0] = (prom_submesh){0, mesh.index_count, 0};
    assert_true(reduce_mesh(&mesh, &(prom_reduce_options){0}, 50, INFINITY, &out, &error));
    assert_sound(&out);
    assert_in_range(out.index_count / 3, 1, 90);
    float face = 0;
    for (uint32_t i = 0; i < out.index_count; i += 3) {
        const float *p[3];
        for (int k = 0; k < 3; k++) p[k] = out.vertices[out.indices[i + k]].position;
        if (p[0][1] < 1.6f) continue;
        face += fabsf((p[1][0] - p[0][0]) * (p[2][1] - p[0][1]) -
                      (p[1][1] - p[0][1]) * (p[2][0] - p[0][0])) /
                2;
    }
    assert_float_equal(face, 0.08f, 0.01f); // 0.1 x 0.4 on both sides
    prom_mesh_finish(&field);
    prom_mesh_finish(&door);
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&out);
}

// Boxes in a row, each twice the size of the one before.
static void only_what_is_small_vanishes(void **state)
{
    (void)state;
    enum { BOXES = 8 };
    const float least = 0.004f, limit = 0.1f;
    prom_mesh box, mesh, out;
    prom_mesh_init(&mesh, BOXES * 24, BOXES * 36, 1);
    mesh.vertex_count = mesh.index_count = 0;
    for (uint32_t i = 0; i < BOXES; i++) {
        const float side = least * (float)(1u << i), half[3] = {side / 2, side / 2, side / 2};
        const float center[3] = {(float)i, 0, 0};
        prom_mesh_init_box(&box, center, half, NULL);
        for (uint32_t k = 0; k < box.index_count; k++)
            mesh.indices[mesh.index_count++] = mesh.vertex_count + box.indices[k];
        memcpy(mesh.vertices + mesh.vertex_count, box.vertices,
               box.vertex_count * sizeof *box.vertices);
        mesh.vertex_count += box.vertex_count;
        prom_mesh_finish(&box);
    }
    mesh.submeshes[0] = (prom_submesh){0, mesh.index_count, 0};
    for (int loose = 0; loose < 2; loose++) {
        float error;
        bool left[BOXES] = {false};
        const prom_reduce_options options = {.loose = loose, .keep_cards = true};
        assert_true(reduce_mesh(&mesh, &options, 0, limit, &out, &error));
        assert_sound(&out);
        for (uint32_t i = 0; i < out.vertex_count; i++)
            left[lroundf(out.vertices[i].position[0])] = true;
        for (uint32_t i = 0; i < BOXES; i++) {
            const float side = least * (float)(1u << i);
            if (side > limit || !loose) assert_true(left[i]);
            if (side < limit / 4 && loose) assert_false(left[i]);
        }
        prom_mesh_finish(&out);
    }
    prom_mesh_finish(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(locked_borders_stay),
        cmocka_unit_test(neighbours_meet),
        cmocka_unit_test(submeshes_do_not_crack),
        cmocka_unit_test(errors_are_distances),
        cmocka_unit_test(two_sided_sheets_stay),
        cmocka_unit_test(hard_edges_do_not_stop_it),
        cmocka_unit_test(notable_parts_do_not_vanish),
        cmocka_unit_test(only_what_is_small_vanishes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
