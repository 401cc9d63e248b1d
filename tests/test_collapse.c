// LINK: prom_simplify
// What must hold of edge collapse on any mesh, whatever the metric.
#include "collapse_fixture.h"

static float bumps(float x, float z)
{
    return 0.2f * sinf(5 * x) * cosf(4 * z) + 0.02f * sinf(31 * x + 17 * z);
}

static float flat(float x, float z)
{
    (void)x, (void)z;
    return 0;
}

// Calls for all metrics, with full and half edges.
static void for_each_way(void (*each)(const prom_collapse_options *options))
{
    const prom_collapse_metric_class *metric = NULL;
    for (uint32_t i = 0; (metric = prom_collapse_metric_at(i)); i++)
        for (int half = 0; half < 2; half++) {
            const prom_collapse_options options = {.metric = metric, .half_edge = half};
            each(&options);
        }
}

static void check_sphere(const prom_collapse_options *options)
{
    shape s = {0};
    prom_mesh out;
    shape_sphere(&s, 24);
    const uint32_t target = (uint32_t)s.indices.count / 3 / 20;
    shape_collapse(&s, options, target, INFINITY, &out, NULL);
    const topology t = topology_of(&out);
    assert_in_range(out.index_count / 3, target - 1, target);
    assert_int_equal(t.open, 0);
    assert_int_equal(t.crowded, 0);
    assert_int_equal(t.euler, 2);
    for (uint32_t i = 0; i < out.index_count; i += 3) {
        float normal[3], center[3];
        mesh_face(&out, i, normal, center);
        assert_true(glm_vec3_dot(normal, center) > 0);
    }
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void test_closed_stays_closed(void **state)
{
    (void)state;
    for_each_way(check_sphere);
}

static int is_outline(const float *p)
{
    return p[0] == 0 || p[0] == 1 || p[2] == 0 || p[2] == 1;
}

static void check_border(const prom_collapse_options *given)
{
    const uint32_t n = 24;
    shape s = {0};
    prom_mesh out;
    prom_collapse_options options = *given;
    options.lock_border = true;
    shape_grid(&s, n, bumps, NULL);
    shape_collapse(&s, &options, n * n / 4, INFINITY, &out, NULL);
    const topology t = topology_of(&out);
    // Each border edge is still there, so the outline's points are.
    assert_int_equal(t.open, 4 * n);
    assert_int_equal(t.euler, 1);
    uint32_t outline = 0;
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        const float *p = out.vertices[i].position;
        if (!is_outline(p)) continue;
        outline++;
        assert_true(p[1] == bumps(p[0], p[2]));
        assert_true(p[0] * (float)n == roundf(p[0] * (float)n));
        assert_true(p[2] * (float)n == roundf(p[2] * (float)n));
    }
    assert_true(outline >= 4 * n);
    assert_true(out.index_count / 3 <= n * n / 4);
    for (uint32_t i = 0; i < out.index_count; i += 3) {
        float normal[3], center[3];
        mesh_face(&out, i, normal, center);
        // Three points of a side of the outline may make an upright face.
        assert_true(normal[1] >= -1e-4f * glm_vec3_norm(normal));
    }
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void test_locked_borders_stay(void **state)
{
    (void)state;
    for_each_way(check_border);
}

static void check_locks(const prom_collapse_options *given)
{
    shape s = {0};
    prom_mesh out;
    uint32_t seed = 7, missing = 0;
    shape_sphere(&s, 16);
    uint8_t *locked = prom_calloc(s.vertices.count, 1);
    for (size_t i = 0; i < s.vertices.count; i++) locked[i] = random_unit(&seed) < 0.03f;
    prom_collapse_options options = *given;
    options.locked = locked;
    shape_collapse(&s, &options, 0, INFINITY, &out, NULL);
    for (size_t i = 0; i < s.vertices.count; i++) {
        bool found = !locked[i];
        for (uint32_t k = 0; k < out.vertex_count && !found; k++)
            found = !memcmp(&out.vertices[k], &s.vertices.data[i], sizeof(prom_vertex));
        missing += !found;
    }
    assert_int_equal(missing, 0);
    prom_free(locked);
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void test_locked_vertices_stay(void **state)
{
    (void)state;
    for_each_way(check_locks);
}

// Half edges leave vertices of the original alone, byte by byte.
static void test_half_edges_make_nothing(void **state)
{
    (void)state;
    shape s = {0};
    prom_mesh out;
    shape_grid(&s, 20, bumps, NULL);
    shape_facet(&s);
    const prom_collapse_options options = {.half_edge = true};
    shape_collapse(&s, &options, 80, INFINITY, &out, NULL);
    assert_in_range(out.index_count / 3, 1, 100);
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        bool found = false;
        for (size_t k = 0; k < s.vertices.count && !found; k++)
            found = !memcmp(&out.vertices[i], &s.vertices.data[k], sizeof(prom_vertex));
        assert_true(found);
    }
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void check_limit(const prom_collapse_options *options)
{
    shape s = {0};
    prom_mesh out;
    shape_sphere(&s, 16);
    const float limit = 0.01f;
    prom_collapse_stats stats;
    assert_true(shape_collapse(&s, options, 0, limit, &out, &stats) <= limit);
    assert_true(stats.triangles > 4);
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void test_limit_holds(void **state)
{
    (void)state;
    for_each_way(check_limit);
}

// Stopping on the way does not change where it ends.
static void test_runs_go_on(void **state)
{
    (void)state;
    shape s = {0};
    prom_mesh a, b;
    shape_sphere(&s, 12);
    const prom_collapse_options options = {0};
    shape_collapse(&s, &options, 60, INFINITY, &a, NULL);
    prom_collapse_mesh mesh;
    prom_collapse_mesh_init(&mesh, s.vertices.data, (uint32_t)s.vertices.count, NULL,
                            s.indices.data, s.indices.count);
    prom_collapser *collapser = prom_collapser_create(&mesh, &options);
    for (uint32_t target = 1000; target > 60; target -= 50)
        prom_collapser_run(collapser, target, INFINITY);
    prom_collapser_run(collapser, 60, INFINITY);
    prom_collapse_mesh_emit(&mesh, &b);
    assert_true(prom_mesh_hash(&a, 1) == prom_mesh_hash(&b, 1));
    prom_collapser_destroy(collapser);
    prom_collapse_mesh_finish(&mesh);
    prom_mesh_finish(&a);
    prom_mesh_finish(&b);
    shape_finish(&s);
}

static void check_soup(const prom_collapse_options *given)
{
    for (uint32_t seed = 1; seed <= 60; seed++) {
        shape s = {0};
        uint32_t random = seed;
        const uint32_t points = 3 + (uint32_t)(random_unit(&random) * 30);
        for (uint32_t i = 0; i < 2 * points; i++) {
            // Places repeat: vertices share points, and triangles edges, as they please.
            float p[3];
            for (int k = 0; k < 3; k++) p[k] = floorf(random_unit(&random) * 4);
            shape_vertex(&s, p[0], p[1], p[2], (uint32_t)(random_unit(&random) * 2));
            prom_vertex *v = &s.vertices.data[i];
            v->normal[0] = (int8_t)(random_unit(&random) * 127);
            v->uv[0] = seed % 7 ? random_unit(&random) : (float)NAN;
            if (seed % 5 == 0 && i % 9 == 0) v->position[i % 3] = i % 2 ? NAN : INFINITY;
        }
        for (uint32_t i = 0; i < 6 * points; i++)
            prom_array_push(&s.indices, (uint32_t)(random_unit(&random) * 2 * (float)points));
        prom_collapse_options options = *given;
        options.pair_distance = seed % 3 ? 0 : 1.5f;
        for (uint32_t target = 12; target < 13; target--) {
            prom_mesh out;
            shape_collapse(&s, &options, target, INFINITY, &out, NULL);
            for (uint32_t t = 0; t < out.index_count; t += 3) {
                float normal[3], center[3];
                mesh_face(&out, t, normal, center);
                assert_true(glm_vec3_norm2(normal) > 0);
            }
            prom_mesh_finish(&out);
        }
        shape_finish(&s);
    }
}

static void test_anything_goes_in(void **state)
{
    (void)state;
    for_each_way(check_soup);
}

// A fin on a ridge: an edge of three triangles must not keep the rest from getting simpler, and
// there must not be more such edges.
static void test_edges_of_three(void **state)
{
    (void)state;
    const uint32_t n = 20;
    shape s = {0};
    prom_mesh before, out;
    shape_grid(&s, n, flat, NULL);
    for (uint32_t i = 0; i < n; i++) {
        uint32_t v[4];
        for (uint32_t k = 0; k < 4; k++)
            v[k] = shape_vertex(&s, (float)(i + k % 2) / (float)n, k < 2 ? 0 : 0.1f, 0.5f, 0);
        shape_triangle(&s, v[0], v[1], v[2]);
        shape_triangle(&s, v[1], v[3], v[2]);
    }
    shape_to_mesh(&s, &before);
    const prom_collapse_options options = {.metric = prom_collapse_metric_find("qem")};
    shape_collapse(&s, &options, 30, INFINITY, &out, NULL);
    assert_int_equal(topology_of(&before).crowded, n);
    assert_in_range(topology_of(&out).crowded, 1, n);
    assert_in_range(out.index_count / 3, 1, 40);
    prom_mesh_finish(&before);
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void test_nothing(void **state)
{
    (void)state;
    const prom_collapse_options options = {0};
    const prom_vertex vertices[3] = {{.position = {0}}, {.position = {1, 0, 0}}};
    const uint32_t indices[6] = {0, 1, 2, 0, 1, 1}; // a segment and less
    for (int all = 0; all < 2; all++) {
        prom_collapse_mesh mesh;
        prom_mesh out;
        prom_collapse_mesh_init(&mesh, all ? vertices : NULL, all ? 3 : 0, NULL,
                                all ? indices : NULL, all ? 6 : 0);
        assert_int_equal(mesh.triangles, 0);
        prom_collapser *collapser = prom_collapser_create(&mesh, &options);
        assert_true(prom_collapser_run(collapser, 0, INFINITY) == 0);
        prom_collapse_mesh_emit(&mesh, &out);
        assert_int_equal(out.index_count + out.vertex_count + out.submesh_count, 0);
        prom_collapser_destroy(collapser);
        prom_collapse_mesh_finish(&mesh);
        prom_mesh_finish(&out);
    }
}

// Undone to the last, the records give back the original; done again, the result.
static void check_records(const prom_collapse_options *given)
{
    shape s = {0};
    shape_grid(&s, 16, bumps, NULL);
    shape_facet(&s);
    prom_collapse_mesh mesh;
    prom_collapse_mesh_init(&mesh, s.vertices.data, (uint32_t)s.vertices.count, NULL,
                            s.indices.data, s.indices.count);
    const size_t bytes = 3 * (size_t)mesh.triangle_slots * sizeof *mesh.corners;
    uint32_t *original = prom_alloc(bytes, 1);
    memcpy(original, mesh.corners, bytes);
    prom_records records;
    prom_records_init(&records, mesh.triangle_slots);
    prom_collapse_options options = *given;
    options.records = &records;
    prom_collapser *collapser = prom_collapser_create(&mesh, &options);
    prom_collapser_run(collapser, 20, INFINITY);
    assert_true(records.records.count > 50);
    prom_replay replay;
    prom_replay_init(&replay, &records, original);
    prom_replay_seek(&replay, (uint32_t)records.records.count);
    assert_memory_equal(replay.corners, mesh.corners, bytes);
    prom_replay_seek(&replay, 0);
    assert_memory_equal(replay.corners, original, bytes);
    prom_replay_finish(&replay);
    prom_records_finish(&records);
    prom_collapser_destroy(collapser);
    prom_collapse_mesh_finish(&mesh);
    prom_free(original);
    shape_finish(&s);
}

static void test_records_undo(void **state)
{
    (void)state;
    for_each_way(check_records);
}

// Strips with gaps between them become one surface if the gaps are close enough, and only then.
static void test_pieces_join(void **state)
{
    (void)state;
    for (int joined = 0; joined < 2; joined++) {
        shape s = {0};
        prom_mesh out;
        for (uint32_t strip = 0; strip < 4; strip++) {
            const size_t first = s.vertices.count;
            shape_grid(&s, 8, flat, NULL);
            for (size_t i = first; i < s.vertices.count; i++)
                s.vertices.data[i].position[0] += 1.01f * (float)strip;
        }
        const prom_collapse_options options = {.metric = prom_collapse_metric_find("qem"),
                                               .pair_distance = joined ? 0.02f : 0};
        // Four squares are eight triangles, apart or joined, at so small an error.
        shape_collapse(&s, &options, 6, 0.05f, &out, NULL);
        assert_int_equal(out.index_count / 3, 8);
        assert_int_equal(topology_of(&out).euler, joined ? 1 : 4);
        prom_mesh_finish(&out);
        shape_finish(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_closed_stays_closed),
        cmocka_unit_test(test_locked_borders_stay),
        cmocka_unit_test(test_locked_vertices_stay),
        cmocka_unit_test(test_half_edges_make_nothing),
        cmocka_unit_test(test_limit_holds),
        cmocka_unit_test(test_runs_go_on),
        cmocka_unit_test(test_anything_goes_in),
        cmocka_unit_test(test_edges_of_three),
        cmocka_unit_test(test_nothing),
        cmocka_unit_test(test_records_undo),
        cmocka_unit_test(test_pieces_join),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
