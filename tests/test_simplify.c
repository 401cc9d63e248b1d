// LINK: prom_builder
#include "builder/simplify/simplify.h"

#include "metaobj/base/alloc.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static uint32_t next_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    return *state >> 8;
}

static float uniform(uint32_t *state)
{
    return (float)next_random(state) / (float)(1 << 24);
}

static float height_at(float x, float z)
{
    return 0.3f * sinf(3.1f * x) * cosf(2.3f * z) + 0.05f * sinf(17 * x + 11 * z);
}

// A bumpy height field of n x n quads over [x0, x0 + 1] x [0, 1]; its outline depends on the
// place alone, so that neighbours share their border. Two submeshes when `split`.
static void init_field(prom_mesh *mesh, uint32_t n, float x0, bool split)
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
static void init_foliage(prom_mesh *mesh, uint32_t cards, uint32_t seed)
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

static float area_of(const prom_mesh *mesh)
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

static int by_position(const void *a, const void *b)
{
    return memcmp(a, b, 3 * sizeof(float));
}

typedef struct edge {
    float ends[6];
} edge;

typedef PROM_ARRAY(edge) edge_list;

static int by_edge(const void *a, const void *b)
{
    return memcmp(a, b, 6 * sizeof(float));
}

// Directed edges, as pairs of positions, that no triangle has the other way round.
static edge_list open_edges(const prom_mesh *mesh)
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

static void assert_same_edges(edge_list *a, edge_list *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->data, b->data, a->count * sizeof *a->data);
    prom_array_finish(a);
    prom_array_finish(b);
}

static void assert_sound(const prom_mesh *mesh)
{
    const char *complaint = prom_mesh_check(mesh, 100);
    if (complaint) fail_msg("%s", complaint);
    assert_true(mesh->index_count > 0);
}

static void locked_borders_stay(void **state)
{
    (void)state;
    for (uint32_t n = 9; n <= 41; n += 16) {
        prom_mesh mesh, out;
        float error;
        init_field(&mesh, n, 0, n % 32 == 9);
        prom_simplify_options options = {.target_triangles = n * n / 2, .lock_border = true};
        assert_true(prom_simplify(&mesh, &options, &out, &error));
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
        prom_simplify_options options = {.target_triangles = 300, .lock_border = true};
        assert_true(prom_simplify(&mesh, &options, &out, &error));
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
    prom_simplify_options options = {.target_triangles = 400};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
    assert_sound(&out);
    assert_in_range(out.index_count / 3, 300, 440);
    assert_int_equal(out.submesh_count, 2);
    assert_int_equal(out.submeshes[0].material, 3);
    assert_int_equal(out.submeshes[1].material, 7);
    edge_list open = open_edges(&out);
    for (size_t i = 0; i < open.count; i++) {
        const float *e = open.data[i].ends;
        bool on_side = (e[0] == e[3] && (e[0] == 0 || e[0] == 1)) ||
                       (e[2] == e[5] && (e[2] == 0 || e[2] == 1));
        assert_true(on_side);
    }
    prom_array_finish(&open);
    prom_mesh_finish(&mesh);
    prom_mesh_finish(&out);
}

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

// The error is a distance: at the original's vertices the field's height is known, so the
// simplified field's vertices may not leave it, and a flat field has none.
static void errors_are_distances(void **state)
{
    (void)state;
    prom_mesh mesh, out;
    float error;
    init_field(&mesh, 30, 0, false);
    prom_simplify_options options = {.target_triangles = 200};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
    assert_true(error > 1e-4f && error < 0.3f);
    prom_mesh_finish(&out);
    options = (prom_simplify_options){.target_triangles = 10, .max_error = 0.02f};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
    assert_true(error <= 0.02f);
    prom_mesh_finish(&out);
    for (uint32_t i = 0; i < mesh.vertex_count; i++) {
        mesh.vertices[i].position[1] = 0;
        mesh.vertices[i].normal[0] = mesh.vertices[i].normal[2] = 0;
        mesh.vertices[i].normal[1] = 127;
    }
    options = (prom_simplify_options){.target_triangles = 8};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
    assert_true(error < 1e-5f);
    assert_float_equal(area_of(&out), 1.0, 1e-4);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
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
    prom_simplify_options options = {.target_triangles = 200};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
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
    prom_simplify_options options = {.target_triangles = 300};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
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
    prom_simplify_options options = {.target_triangles = 50};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
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

static void sloppy_reaches_its_target(void **state)
{
    (void)state;
    prom_mesh mesh, out;
    float error;
    init_field(&mesh, 40, 0, true);
    prom_simplify_options options = {.target_triangles = 60, .sloppy = true};
    assert_true(prom_simplify(&mesh, &options, &out, &error));
    assert_sound(&out);
    assert_in_range(out.index_count / 3, 1, 60);
    assert_true(error > 0 && error < 1);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
}

static void bad_meshes_are_safe(void **state)
{
    (void)state;
    prom_simplify_options options = {.target_triangles = 10};
    prom_mesh out = {0}, empty = {0}, levels[4];
    float error, errors[4];
    assert_false(prom_simplify(&empty, &options, &out, &error));
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
    assert_false(prom_simplify(&point, &options, &out, &error));
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
    options.target_triangles = 200;
    assert_true(prom_simplify(&field, &options, &out, &error));
    assert_sound(&out);
    assert_true(isfinite(error));
    prom_mesh_finish(&out);
    options.target_triangles = 5000;
    assert_false(prom_simplify(&field, &options, &out, &error));
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
        cmocka_unit_test(locked_borders_stay),
        cmocka_unit_test(neighbours_meet),
        cmocka_unit_test(submeshes_do_not_crack),
        cmocka_unit_test(levels_shrink),
        cmocka_unit_test(errors_are_distances),
        cmocka_unit_test(foliage_keeps_its_area),
        cmocka_unit_test(two_sided_sheets_stay),
        cmocka_unit_test(shared_sides_keep_their_normals),
        cmocka_unit_test(hard_edges_do_not_stop_it),
        cmocka_unit_test(notable_parts_do_not_vanish),
        cmocka_unit_test(sloppy_reaches_its_target),
        cmocka_unit_test(bad_meshes_are_safe),
        cmocka_unit_test(weld_merges),
        cmocka_unit_test(same_twice),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
