// LINK: prom_metaobj
// Geometry helpers, colours, meshes, view bins, the camera and the cut.
#include "container_fixture.h"

#include "metaobj/camera.h"
#include "metaobj/cut.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static float dot(const float a[3], const float b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static float random_unit(uint32_t *seed)
{
    return (float)fixture_random(seed) / 8388608.0f - 1; // [-1,1)
}

static void random_direction(uint32_t *seed, float d[3])
{
    float length;
    do {
        for (int a = 0; a < 3; a++) d[a] = random_unit(seed);
        length = sqrtf(dot(d, d));
    } while (length > 1 || length < 0.1f);
    for (int a = 0; a < 3; a++) d[a] /= length;
}

static void boxes(void **state)
{
    (void)state;
    prom_box box = PROM_BOX_EMPTY;
    assert_true(prom_box_is_empty(&box));
    assert_true(prom_box_diagonal(&box) == 0);
    prom_box_add_point(&box, (float[]){1, 2, 3});
    prom_box_add_box(&box, &(prom_box){{-1, 2, 3}, {1, 6, 7}});
    float center[3], half[3];
    prom_box_center(&box, center);
    prom_box_half(&box, half);
    assert_false(prom_box_is_empty(&box));
    assert_memory_equal(center, ((float[]){0, 4, 5}), sizeof center);
    assert_memory_equal(half, ((float[]){1, 2, 2}), sizeof half);
    assert_true(prom_box_diagonal(&box) == 6);
    prom_box empty = PROM_BOX_EMPTY, before = box;
    prom_box_add_box(&box, &empty);
    assert_memory_equal(&box, &before, sizeof box);
}

static void bases(void **state)
{
    (void)state;
    uint32_t seed = 1;
    for (int k = 0; k < 200; k++) {
        float m[9], inverse[9], product[9], v[3], w[3], back[3], size = k % 2 ? 1e-3f : 1e3f;
        for (int i = 0; i < 9; i++) m[i] = random_unit(&seed) * size;
        if (!prom_basis_invert(m, inverse)) continue;
        prom_basis_multiply(m, inverse, product);
        float tolerance = 1e-4f * prom_basis_scale(m) * prom_basis_scale(inverse);
        for (int i = 0; i < 9; i++)
            assert_float_equal(product[i], (i % 4 == 0 ? 1 : 0), tolerance);
        assert_float_equal((prom_basis_determinant(m) * prom_basis_determinant(inverse)), 1,
                           tolerance);
        random_direction(&seed, v);
        prom_basis_apply(m, v, w);
        prom_basis_apply(inverse, w, back);
        for (int a = 0; a < 3; a++) assert_float_equal(back[a], v[a], tolerance);
        // <u, M v> = <M^T u, v>
        float u[3], mtu[3];
        random_direction(&seed, u);
        prom_basis_apply_transposed(m, u, mtu);
        assert_float_equal(dot(u, w), dot(mtu, v), 1e-5f * size);
        // A turned box holds its turned corners.
        float half[3] = {1, 2, 3}, turned[3], corner[3];
        prom_basis_apply_half(m, half, turned);
        prom_basis_apply(m, (float[]){1, -2, 3}, corner);
        for (int a = 0; a < 3; a++) assert_true(fabsf(corner[a]) <= turned[a] * 1.00001f);
    }
    float flat[9] = {1, 0, 0, 0, 1, 0, 1, 1, 0}, out[9];
    assert_false(prom_basis_invert(flat, out));
    float mirrored[9] = {-2, 0, 0, 0, 1, 0, 0, 0, 1};
    assert_float_equal(prom_basis_determinant(mirrored), -2, 0);
    assert_float_equal(prom_basis_scale(mirrored), 2, 0);
}

static void placements(void **state)
{
    (void)state;
    const double matrix[16] = {0, 0, -2, 0, 0, 3, 0, 0, 1, 0, 0, 0, 1e7, 20, 30, 1};
    prom_placement p = prom_placement_from_matrix(matrix);
    double world[3];
    prom_placement_apply(&p, (float[]){1, 2, 0.125f}, world);
    assert_true(world[0] == 1e7 + 0.125 && world[1] == 26 && world[2] == 28);
    prom_placement_apply(&prom_placement_identity, (float[]){1, 2, 3}, world);
    assert_true(world[0] == 1 && world[1] == 2 && world[2] == 3);
}

static void octahedral_map(void **state)
{
    (void)state;
    uint32_t seed = 5;
    float up[2];
    prom_octahedral_encode((float[]){0, 2, 0}, up);
    assert_true(up[0] == 0.5f && up[1] == 0.5f);
    for (int k = 0; k < 10000; k++) {
        float d[3], uv[2], back[3];
        random_direction(&seed, d);
        prom_octahedral_encode(d, uv);
        assert_true(uv[0] >= 0 && uv[0] <= 1 && uv[1] >= 0 && uv[1] <= 1);
        if (d[1] > 0) assert_true(fabsf(uv[0] - 0.5f) + fabsf(uv[1] - 0.5f) <= 0.50001f);
        prom_octahedral_decode(uv, back);
        for (int a = 0; a < 3; a++) assert_float_equal(d[a], back[a], 2e-6f);
    }
}

static void direction_bins(void **state)
{
    (void)state;
    uint32_t seed = 9;
    for (uint32_t bin = 0; bin < PROM_DIRS; bin++) {
        float d[3];
        prom_direction_of_bin(bin, d);
        assert_float_equal(dot(d, d), 1, 1e-5f);
        for (int a = 0; a < 3; a++) d[a] *= 40; // length does not matter
        assert_int_equal(prom_bin_of_direction(d), bin);
    }
    for (int k = 0; k < 10000; k++) {
        float d[3], center[3];
        random_direction(&seed, d);
        prom_direction_of_bin(prom_bin_of_direction(d), center);
        assert_true(dot(d, center) > 0.8f); // no cell is wider than that
    }
    assert_true(prom_bin_of_direction((float[]){0, -1, 0}) < PROM_DIRS);
    assert_float_equal(prom_size_of_bin(0), PROM_SIZE_MIN_PX, 0);
    assert_float_equal(prom_size_of_bin(PROM_SIZES - 1), PROM_SIZE_MAX_PX, 1e-4f);
    for (uint32_t s = 0; s < PROM_SIZES + PROM_SIZES_LARGE; s++)
        assert_float_equal(prom_bin_of_size(prom_size_of_bin(s)), s, 1e-5f);
}

// Directions next to each other have nearly the same weights for all directions.
static void directions_are_interpolated_without_seams(void **state)
{
    (void)state;
    uint32_t seed = 11;
    for (int k = 0; k < 20000; k++) {
        float d[3], near[3], weights[PROM_DIRS] = {0}, axes[PROM_DIRS_LARGE] = {0};
        do
            random_direction(&seed, d);
        while (fabsf(d[0]) + fabsf(d[2]) < 0.2f);
        for (int a = 0; a < 3; a++) near[a] = d[a] + ((k >> a) % 2 ? 2e-4f : -2e-4f);
        if (k % 4 == 0) near[1] = -d[1] * 1e-5f, d[1] *= 1e-5f; // across the fold
        for (int side = 0; side < 2; side++) {
            float uv[2], sum = 0, sign = side ? -1 : 1;
            prom_direction_weights around;
            prom_axis_weights axis;
            prom_octahedral_encode(side ? near : d, uv);
            prom_directions_around(uv, &around);
            prom_axes_around(uv, &axis);
            for (int i = 0; i < 4; i++) {
                assert_true(around.dir[i] < PROM_DIRS && around.weight[i] >= 0);
                weights[around.dir[i]] += sign * around.weight[i];
                sum += around.weight[i];
            }
            assert_float_equal(sum, 1, 1e-5f);
            for (int i = 0; i < 3; i++) {
                assert_true(axis.dir[i] < PROM_DIRS_LARGE && axis.weight[i] >= -1e-6f);
                axes[axis.dir[i]] += sign * axis.weight[i];
            }
        }
        for (uint32_t i = 0; i < PROM_DIRS; i++) assert_float_equal(weights[i], 0, 2e-2f);
        for (uint32_t i = 0; i < PROM_DIRS_LARGE; i++) assert_float_equal(axes[i], 0, 2e-2f);
    }
}

static void coarse_directions_surround_fine_ones(void **state)
{
    (void)state;
    uint32_t around[4], edges = 0, cells = 0;
    for (uint32_t bin = 0; bin < PROM_DIRS; bin++) {
        uint32_t count = prom_coarse_directions_around(bin, around);
        if (bin < PROM_DIRS_COARSE) {
            assert_int_equal(count, 0);
            continue;
        }
        float d[3], c[3];
        prom_direction_of_bin(bin, d);
        for (uint32_t i = 0; i < count; i++) {
            assert_true(around[i] < PROM_DIRS_COARSE);
            prom_direction_of_bin(around[i], c);
            assert_true(dot(d, c) > 0.5f);
        }
        edges += count == 2;
        cells += count == 4;
    }
    assert_int_equal(edges + cells, PROM_DIRS - PROM_DIRS_COARSE);
    assert_int_equal(cells, PROM_DIR_GRID * PROM_DIR_GRID / 4);
}

static void srgb_curve(void **state)
{
    (void)state;
    for (int i = 0; i < 256; i++) {
        assert_int_equal(prom_linear_to_srgb8(prom_srgb8_to_linear((uint8_t)i)), i);
        assert_float_equal(prom_linear_to_srgb(prom_srgb8_to_linear((uint8_t)i)),
                           ((float)i / 255), 1e-5f);
    }
    for (int k = 0; k <= 100000; k++) { // the table against the formula
        float linear = (float)k / 100000;
        float exact = prom_linear_to_srgb(linear) * 255;
        assert_true(fabsf((float)prom_linear_to_srgb8(linear) - exact) < 0.501f);
    }
    assert_int_equal(prom_linear_to_srgb8(-1), 0);
    assert_int_equal(prom_linear_to_srgb8(7), 255);
    assert_int_equal(prom_linear_to_srgb8(NAN), 0);
}

static void box_mesh(void **state)
{
    (void)state;
    const float center[3] = {1, 2, 3}, half[3] = {0.5f, 1, 2};
    uint8_t colors[6][4];
    for (int i = 0; i < 24; i++) colors[i / 4][i % 4] = (uint8_t)i;
    prom_mesh mesh;
    prom_mesh_init_box(&mesh, center, half, (const uint8_t(*)[4])colors);
    assert_null(prom_mesh_check(&mesh, 0));
    assert_int_equal(mesh.index_count, 36);
    assert_int_equal(mesh.vertex_count, 24);
    for (uint32_t t = 0; t < 36; t += 3) {
        int face = (int)t / 6;
        const prom_vertex *v[3];
        for (int k = 0; k < 3; k++) v[k] = &mesh.vertices[mesh.indices[t + (uint32_t)k]];
        float a[3], b[3], right[3], up[3], out[3], cross[3];
        prom_box_face_axes(face, right, up, out);
        for (int k = 0; k < 3; k++) {
            a[k] = v[1]->position[k] - v[0]->position[k];
            b[k] = v[2]->position[k] - v[0]->position[k];
        }
        glm_vec3_cross(a, b, cross);
        assert_true(dot(cross, out) > 0); // counter-clockwise from outside
        for (int k = 0; k < 3; k++) {
            float offset[3];
            for (int x = 0; x < 3; x++) {
                offset[x] = v[k]->position[x] - center[x];
                assert_int_equal(v[k]->normal[x], (int)(127 * out[x]));
            }
            assert_true(dot(offset, out) > 0); // on its own side
            assert_int_equal(v[k]->normal[3], face);
            assert_memory_equal(v[k]->color, colors[face], 4);
            // u grows to the camera's right, v downwards
            assert_true(v[k]->uv[0] == (dot(offset, right) > 0 ? 1.0f : 0.0f));
            assert_true(v[k]->uv[1] == (dot(offset, up) > 0 ? 0.0f : 1.0f));
        }
        glm_vec3_cross(right, up, cross);
        assert_true(dot(cross, out) == 1); // right-handed camera
    }
    static const float outs[6] = {1, -1, 1, -1, 1, -1};
    for (int face = 0; face < 6; face++) {
        float right[3], up[3], out[3];
        prom_box_face_axes(face, right, up, out);
        assert_true(out[face / 2] == outs[face]);
        if (face / 2 != 1) assert_true(up[1] == 1);
    }
    prom_mesh_finish(&mesh);
}

static void mesh_check(void **state)
{
    (void)state;
    uint32_t seed = 2;
    prom_mesh m;
    fixture_grid(&m, 4, &seed);
    assert_null(prom_mesh_check(&m, 1));
    assert_non_null(prom_mesh_check(&m, 0)); // material 0 is missing
    uint32_t index = m.indices[5];
    m.indices[5] = m.vertex_count;
    assert_non_null(prom_mesh_check(&m, 1));
    m.indices[5] = index;
    m.vertices[3].position[1] = NAN;
    assert_non_null(prom_mesh_check(&m, 1));
    m.vertices[3].position[1] = 0;
    m.vertices[3].uv[1] = INFINITY;
    assert_non_null(prom_mesh_check(&m, 1));
    m.vertices[3].uv[1] = 0;
    m.submeshes[1].first_index += 3;
    assert_non_null(prom_mesh_check(&m, 1));
    m.submeshes[1].first_index -= 3;
    m.submeshes[1].index_count -= 3;
    assert_non_null(prom_mesh_check(&m, 1));
    m.submeshes[1].index_count += 3;
    m.index_count -= 1;
    assert_non_null(prom_mesh_check(&m, 1));
    m.index_count += 1;
    m.submeshes[0].index_count = UINT32_MAX / 3 * 3; // sums that wrap around
    assert_non_null(prom_mesh_check(&m, 1));
    prom_mesh_finish(&m);
    prom_mesh none = {0};
    assert_null(prom_mesh_check(&none, 0));
    prom_mesh_finish(&none);
}

static void mesh_hash(void **state)
{
    (void)state;
    uint32_t seed = 2;
    prom_mesh a, b;
    fixture_grid(&a, 20, &seed);
    prom_mesh_copy(&b, &a);
    assert_true(prom_mesh_hash(&a, 0) == prom_mesh_hash(&b, 0));
    assert_true(prom_mesh_hash(&a, 0) != prom_mesh_hash(&a, 1));
    uint32_t *t = b.indices + 30, first = t[0];
    t[0] = t[1], t[1] = t[2], t[2] = first; // turned: the same triangle
    assert_true(prom_mesh_hash(&a, 0) == prom_mesh_hash(&b, 0));
    first = t[0], t[0] = t[1], t[1] = first; // its back
    assert_true(prom_mesh_hash(&a, 0) != prom_mesh_hash(&b, 0));
    prom_box box = prom_mesh_bounds(&a);
    assert_true(box.min[0] == -0.5f && box.max[2] == 0.5f && box.min[1] >= 0);
    prom_mesh_finish(&a);
    prom_mesh_finish(&b);
}

static void packed_normals(void **state)
{
    (void)state;
    int8_t packed[4];
    prom_pack_normal((float[]){0, 0, 0}, packed);
    assert_memory_equal(packed, ((int8_t[]){0, 127, 0, 0}), 4);
    prom_pack_normal((float[]){NAN, 0, 0}, packed);
    assert_memory_equal(packed, ((int8_t[]){0, 127, 0, 0}), 4);
    prom_pack_normal((float[]){-3e20f, 0, 0}, packed);
    assert_memory_equal(packed, ((int8_t[]){-127, 0, 0, 0}), 4);
}

static void camera_looks_at(void **state)
{
    (void)state;
    static const double targets[][3] = {{0, 0, -5}, {3, 4, 5},  {-2, 1, 7}, {0, 9, 0},
                                        {0, -9, 0}, {0, 0, 11}, {-1, -8, 0}};
    for (size_t k = 0; k < sizeof targets / sizeof *targets; k++) {
        prom_camera c = {.eye = {1e6, 2, 3}};
        double target[3], length = 0;
        for (int a = 0; a < 3; a++) {
            target[a] = c.eye[a] + targets[k][a];
            length += targets[k][a] * targets[k][a];
        }
        prom_camera_look_at(&c, target);
        vec3 forward, up, right;
        glm_quat_rotatev(c.orientation, (vec3){0, 0, -1}, forward);
        glm_quat_rotatev(c.orientation, (vec3){0, 1, 0}, up);
        glm_quat_rotatev(c.orientation, (vec3){1, 0, 0}, right);
        for (int a = 0; a < 3; a++)
            assert_float_equal(forward[a], (targets[k][a] / sqrt(length)), 1e-5f);
        assert_float_equal(right[1], 0, 1e-5f); // level
        assert_true(up[1] > -1e-5f);            // not upside down
    }
    prom_camera c = {.eye = {1, 2, 3}, .orientation = {0, 0, 0, 1}};
    prom_camera_look_at(&c, c.eye);
    assert_true(c.orientation[3] == 1);
}

static void kind_names(void **state)
{
    (void)state;
    assert_string_equal(prom_rep_kind_name(PROM_REP_MESH), "mesh");
    assert_string_equal(prom_rep_kind_name(PROM_REP_TEXTURED_BOX), "textured-box");
    assert_string_equal(prom_rep_kind_name(1000), "?");
    prom_cut cut = {0};
    prom_array_push(&cut.entries, (prom_cut_entry){0});
    prom_cut_finish(&cut);
    prom_cut_finish(&cut);
    assert_null(cut.entries.data);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes),
        cmocka_unit_test(bases),
        cmocka_unit_test(placements),
        cmocka_unit_test(octahedral_map),
        cmocka_unit_test(direction_bins),
        cmocka_unit_test(directions_are_interpolated_without_seams),
        cmocka_unit_test(coarse_directions_surround_fine_ones),
        cmocka_unit_test(srgb_curve),
        cmocka_unit_test(box_mesh),
        cmocka_unit_test(mesh_check),
        cmocka_unit_test(mesh_hash),
        cmocka_unit_test(packed_normals),
        cmocka_unit_test(camera_looks_at),
        cmocka_unit_test(kind_names),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
