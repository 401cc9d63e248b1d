// LINK: prom_simplify
// What edge collapse does to attributes, seams, creases and groups.
#include "collapse_fixture.h"

static float flat(float x, float z)
{
    (void)x, (void)z;
    return 0;
}

static float bumps(float x, float z)
{
    return 0.1f * sinf(6 * x) * cosf(5 * z);
}

static uint32_t by_half(uint32_t i, uint32_t j)
{
    (void)j;
    return i >= 16;
}

static uint32_t by_zigzag(uint32_t i, uint32_t j)
{
    return i + (j % 8 < 4 ? j % 4 : 4 - j % 4) >= 16 ? 7 : 2;
}

// Each result vertex still has the texture coordinates of its place, on its side of the seam.
static void check_charts(bool half_edge)
{
    shape s = {0};
    prom_mesh out;
    shape_grid(&s, 32, flat, NULL);
    for (size_t i = 0; i < s.vertices.count; i++)
        if (i / 4 % 32 >= 16) s.vertices.data[i].uv[0] += 10;
    const prom_collapse_options options = {.half_edge = half_edge};
    shape_collapse(&s, &options, 40, INFINITY, &out, NULL);
    assert_in_range(out.index_count / 3, 4, 40);
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        const prom_vertex *v = &out.vertices[i];
        const float chart = v->uv[0] > 5 ? 10 : 0;
        assert_true(fabsf(v->uv[0] - chart - v->position[0]) < 1e-4f);
        assert_true(fabsf(v->uv[1] - v->position[2]) < 1e-4f);
        assert_true(chart > 0 ? v->position[0] > 0.5f - 1e-3f : v->position[0] < 0.5f + 1e-3f);
    }
    assert_int_equal(topology_of(&out).euler, 1);
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void test_plane_keeps_texture(void **state)
{
    (void)state;
    check_charts(false);
    check_charts(true);
}

static void bend_texture(const float p[3], float uv[2])
{
    uv[0] = p[0] + 0.4f * sinf(3 * p[1]);
    uv[1] = p[2] + 0.4f * sinf(3 * p[0]);
}

// RMS of texture coordinates against what belongs to the face's point, over samples in faces.
static double texture_error(const prom_mesh *mesh)
{
    double sum = 0, weight = 0;
    uint32_t seed = 1;
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        float normal[3], center[3];
        mesh_face(mesh, i, normal, center);
        const double area = (double)glm_vec3_norm(normal);
        for (int sample = 0; sample < 8; sample++) {
            float w[3] = {random_unit(&seed), random_unit(&seed), 0}, p[3] = {0}, uv[2] = {0};
            if (w[0] + w[1] > 1) w[0] = 1 - w[0], w[1] = 1 - w[1];
            w[2] = 1 - w[0] - w[1];
            for (uint32_t k = 0; k < 3; k++) {
                const prom_vertex *v = &mesh->vertices[mesh->indices[i + k]];
                for (int a = 0; a < 3; a++) p[a] += w[k] * v->position[a];
                for (int a = 0; a < 2; a++) uv[a] += w[k] * v->uv[a];
            }
            float truth[2];
            glm_vec3_normalize(p);
            bend_texture(p, truth);
            for (int a = 0; a < 2; a++)
                sum += area * (double)((uv[a] - truth[a]) * (uv[a] - truth[a]));
            weight += area;
        }
    }
    return sqrt(sum / weight);
}

static void test_texture_counts(void **state)
{
    (void)state;
    double error[2];
    for (int attributes = 0; attributes < 2; attributes++) {
        shape s = {0};
        prom_mesh out;
        shape_sphere(&s, 32);
        for (size_t i = 0; i < s.vertices.count; i++)
            bend_texture(s.vertices.data[i].position, s.vertices.data[i].uv);
        const prom_collapse_options options = {.metric = attributes ? &prom_collapse_attributes
                                                                    : &prom_collapse_qem};
        shape_collapse(&s, &options, 400, INFINITY, &out, NULL);
        assert_in_range(out.index_count / 3, 398, 400);
        error[attributes] = texture_error(&out);
        prom_mesh_finish(&out);
        shape_finish(&s);
    }
    print_message("texture error: qem %g, qem-attributes %g\n", error[0], error[1]);
    assert_true(error[1] < 0.8 * error[0]);
}

static void test_facets_get_few(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        shape s = {0};
        prom_mesh out;
        shape_sphere(&s, 24);
        shape_facet(&s);
        const uint32_t target = (uint32_t)s.indices.count / 3 / 50;
        const prom_collapse_options options = {.half_edge = half};
        shape_collapse(&s, &options, target, INFINITY, &out, NULL);
        const topology t = topology_of(&out);
        assert_true(out.index_count / 3 <= target);
        assert_int_equal(t.open, 0);
        assert_int_equal(t.euler, 2);
        // Faces still look about where their normals do.
        for (uint32_t i = 0; i < out.index_count; i += 3) {
            float normal[3], center[3], sum = 0;
            mesh_face(&out, i, normal, center);
            for (uint32_t k = 0; k < 3; k++)
                for (int a = 0; a < 3; a++)
                    sum += normal[a] * (float)out.vertices[out.indices[i + k]].normal[a];
            assert_true(sum > 0);
        }
        prom_mesh_finish(&out);
        shape_finish(&s);
    }
}

static void check_open_edges(const prom_mesh *mesh, float loss)
{
    const topology t = topology_of(mesh);
    assert_int_equal(t.euler, 1);
    assert_int_equal(t.crowded, 0);
    float area = 0;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        const float *p = mesh->vertices[i].position;
        assert_true(p[0] > -0.05f && p[0] < 1.05f && p[2] > -0.05f && p[2] < 1.05f);
    }
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        float normal[3], center[3];
        mesh_face(mesh, i, normal, center);
        area += normal[1] / 2;
    }
    assert_true(fabsf(area - 1) < loss);
}

// Every quad a chart of its own.
static void test_tiny_charts_get_few(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        shape s = {0};
        prom_mesh out;
        uint32_t seed = 3;
        shape_grid(&s, 32, bumps, NULL);
        for (size_t i = 0; i < s.vertices.count; i += 4) {
            const float u = random_unit(&seed), v = random_unit(&seed);
            for (size_t k = 0; k < 4; k++) {
                s.vertices.data[i + k].uv[0] += u;
                s.vertices.data[i + k].uv[1] += v;
            }
        }
        const prom_collapse_options options = {.half_edge = half};
        shape_collapse(&s, &options, 2048 / 20, INFINITY, &out, NULL);
        assert_in_range(out.index_count / 3, 50, 2048 / 20);
        // With half edges a face at a border between charts gets the neighbour's coordinates,
        // and the metric gives some of the outline away first.
        check_open_edges(&out, half ? 0.3f : 0.1f);
        prom_mesh_finish(&out);
        shape_finish(&s);
    }
}

// Submeshes never come apart, their areas stay, and each triangle has one group.
static void check_groups(bool half_edge, uint32_t (*group_of)(uint32_t, uint32_t))
{
    shape s = {0};
    prom_mesh before, out;
    shape_grid(&s, 32, bumps, group_of);
    shape_to_mesh(&s, &before);
    const prom_collapse_options options = {.half_edge = half_edge};
    shape_collapse(&s, &options, 2048 / 16, INFINITY, &out, NULL);
    assert_in_range(out.index_count / 3, 2, 2048 / 16);
    assert_int_equal(out.submesh_count, 2);
    check_open_edges(&out, 0.05f);
    for (uint32_t m = 0; m < 2; m++) {
        float area[2] = {0};
        const prom_mesh *both[2] = {&before, &out};
        assert_int_equal(before.submeshes[m].material, out.submeshes[m].material);
        for (int b = 0; b < 2; b++) {
            const prom_submesh *sub = &both[b]->submeshes[m];
            for (uint32_t i = 0; i < sub->index_count; i += 3) {
                float normal[3], center[3];
                mesh_face(both[b], sub->first_index + i, normal, center);
                area[b] += normal[1] / 2;
            }
        }
        assert_true(fabsf(area[0] - area[1]) < 0.04f);
    }
    prom_mesh_finish(&before);
    prom_mesh_finish(&out);
    shape_finish(&s);
}

static void test_groups_stay_together(void **state)
{
    (void)state;
    for (int half = 0; half < 2; half++) {
        check_groups(half, by_half);
        check_groups(half, by_zigzag);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_plane_keeps_texture),  cmocka_unit_test(test_texture_counts),
        cmocka_unit_test(test_facets_get_few),       cmocka_unit_test(test_tiny_charts_get_few),
        cmocka_unit_test(test_groups_stay_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
