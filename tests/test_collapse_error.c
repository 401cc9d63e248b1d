// LINK: prom_simplify meshoptimizer::meshoptimizer
// How far the results of edge collapse are from the original, measured.
#include "collapse_fixture.h"

#include "builder/simplify/mesh_distance.h"

#include <meshoptimizer.h>
#include <stdio.h>

static float bumps(float x, float z)
{
    return 0.2f * sinf(5 * x) * cosf(4 * z) + 0.02f * sinf(31 * x + 17 * z);
}

// The error grows from step to step, and is of the order of what is measured.
static void test_error_is_honest(void **state)
{
    (void)state;
    shape s = {0};
    prom_mesh original;
    shape_grid(&s, 64, bumps, NULL);
    shape_to_mesh(&s, &original);
    prom_collapse_mesh mesh;
    prom_collapse_mesh_init(&mesh, s.vertices.data, (uint32_t)s.vertices.count, NULL,
                            s.indices.data, s.indices.count);
    const prom_collapse_options options = {.metric = prom_collapse_metric_find("qem")};
    prom_collapser *collapser = prom_collapser_create(&mesh, &options);
    float last = 0;
    for (uint32_t target = 4096; target > 100; target /= 2) {
        const float error = prom_collapser_run(collapser, target, INFINITY);
        assert_true(error >= last);
        assert_true(mesh.triangles <= target);
        last = error;
        prom_mesh now;
        prom_mesh_distances d;
        prom_collapse_mesh_emit(&mesh, &now);
        prom_mesh_distances_measure(&original, &now, 20000, &d);
        assert_true(d.rms <= (double)error);
        assert_true(d.hausdorff <= 8 * (double)error);
        assert_true(d.hausdorff >= (double)error / 8);
        prom_mesh_finish(&now);
    }
    prom_collapser_destroy(collapser);
    prom_collapse_mesh_finish(&mesh);
    prom_mesh_finish(&original);
    shape_finish(&s);
}

// Positions and triangles of a Wavefront file; false where there is none.
static bool read_obj(const char *name, shape *s)
{
    const char *shared = getenv("PROM_SHARED");
    char path[512], line[256];
    snprintf(path, sizeof path, "%s/scenes/%s", shared ? shared : ".", name);
    FILE *f = fopen(path, "r");
    if (!f) return false;
    while (fgets(line, sizeof line, f)) {
        float p[3];
        uint32_t v[3];
        if (sscanf(line, "v %f %f %f", &p[0], &p[1], &p[2]) == 3)
            shape_vertex(s, p[0], p[1], p[2], 0);
        else if (sscanf(line, "f %u%*[^ ] %u%*[^ ] %u", &v[0], &v[1], &v[2]) == 3 ||
                 sscanf(line, "f %u %u %u", &v[0], &v[1], &v[2]) == 3)
            shape_triangle(s, v[0] - 1, v[1] - 1, v[2] - 1);
    }
    fclose(f);
    return true;
}

// A scan with holes keeps them, and its surface is nearer than what meshoptimizer leaves.
static void test_scan(void **state)
{
    (void)state;
    shape s = {0};
    if (!read_obj("bunny/stanford-bunny.obj", &s)) skip();
    prom_mesh original, own, borrowed;
    shape_to_mesh(&s, &original);
    const topology before = topology_of(&original);
    const prom_collapse_options options = {.metric = &prom_collapse_qem};
    const uint32_t target = original.index_count / 3 / 10;
    shape_collapse(&s, &options, target, INFINITY, &own, NULL);
    const topology after = topology_of(&own);
    assert_in_range(own.index_count / 3, target - 1, target);
    assert_int_equal(after.euler, before.euler);
    assert_int_equal(after.crowded, 0);
    assert_int_equal(after.open > 0, before.open > 0);

    prom_mesh_copy(&borrowed, &original);
    borrowed.index_count = (uint32_t)meshopt_simplify(
        borrowed.indices, original.indices, original.index_count, original.vertices[0].position,
        original.vertex_count, sizeof(prom_vertex), 3 * target, 1e9f, 0, NULL);
    borrowed.submeshes[0].index_count = borrowed.index_count;
    prom_mesh_distances ours, theirs;
    prom_mesh_distances_measure(&original, &own, 50000, &ours);
    prom_mesh_distances_measure(&original, &borrowed, 50000, &theirs);
    assert_true(ours.rms < 0.8 * theirs.rms);
    assert_true(ours.hausdorff < 1.1 * theirs.hausdorff);
    prom_mesh_finish(&original);
    prom_mesh_finish(&own);
    prom_mesh_finish(&borrowed);
    shape_finish(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_error_is_honest),
        cmocka_unit_test(test_scan),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
