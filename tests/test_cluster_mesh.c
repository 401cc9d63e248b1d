// LINK: prom_builder
#include "builder/cluster_mesh.h"

#include "builder/simplify/simplify.h"
#include "metaobj/base/threads.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

// A grid of n x n quads in the xz plane over [0, size]^2, facing +y, its texture coordinates
// over [0, repeat]^2; y follows `bump`.
static void init_grid(prom_mesh *mesh, uint32_t n, float size, float repeat, float bump)
{
    prom_mesh_init(mesh, (n + 1) * (n + 1), n * n * 6, 1);
    for (uint32_t j = 0; j <= n; j++)
        for (uint32_t i = 0; i <= n; i++) {
            prom_vertex *v = &mesh->vertices[j * (n + 1) + i];
            float x = (float)i / (float)n, z = (float)j / (float)n;
            v->position[0] = x * size;
            v->position[1] = bump * sinf(9 * x) * cosf(7 * z);
            v->position[2] = z * size;
            v->normal[1] = 127;
            v->uv[0] = x * repeat;
            v->uv[1] = z * repeat;
            memset(v->color, 255, 4);
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
}

static void init_sphere(prom_mesh *mesh, uint32_t n)
{
    init_grid(mesh, n, 1, 1, 0);
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        prom_vertex *v = &mesh->vertices[i];
        uint32_t column = i % (n + 1), row = i / (n + 1);
        float turn = 2 * GLM_PIf * (float)(column % n) / (float)n;
        float rise = GLM_PIf * (float)row / (float)n;
        float ring = row == 0 || row == n ? 0 : sinf(rise);
        float p[3] = {ring * sinf(turn), cosf(rise), ring * cosf(turn)};
        memcpy(v->position, p, sizeof p);
        prom_pack_normal(p, v->normal);
        v->uv[0] = v->uv[1] = 0;
    }
    mesh->submeshes[0].material = PROM_NONE;
}

typedef void (*painter)(uint32_t x, uint32_t y, uint8_t texel[4]);

static void init_texture(prom_texture *texture, uint32_t size, painter paint, float cutoff)
{
    prom_texture_init(texture, PROM_TEXTURE_COLOR, size, size);
    for (uint32_t y = 0; y < size; y++)
        for (uint32_t x = 0; x < size; x++) paint(x, y, texture->pixels + 4 * (y * size + x));
    if (cutoff > 0) prom_texture_dilate(texture, 4);
    prom_texture_make_mips(texture, cutoff);
}

static void paint_constant(uint32_t x, uint32_t y, uint8_t texel[4])
{
    (void)x, (void)y;
    const uint8_t color[4] = {200, 100, 50, 255};
    memcpy(texel, color, 4);
}

static void paint_checker(uint32_t x, uint32_t y, uint8_t texel[4])
{
    memset(texel, (x / 4 + y / 4) % 2 ? 255 : 0, 3);
    texel[3] = 255;
}

static void paint_left_half(uint32_t x, uint32_t y, uint8_t texel[4])
{
    (void)y;
    const uint8_t leaf[4] = {40, 160, 30, 255}, nothing[4] = {255, 0, 255, 0};
    memcpy(texel, x < 32 ? leaf : nothing, 4);
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

static void assert_sound(const prom_mesh *mesh)
{
    const char *complaint = prom_mesh_check(mesh, 0);
    if (complaint) fail_msg("%s", complaint);
    assert_int_equal(mesh->submesh_count, 1);
    assert_true(mesh->index_count > 0);
}

static void assert_color(const prom_vertex *v, int r, int g, int b, int tolerance)
{
    const int expected[3] = {r, g, b};
    for (int c = 0; c < 3; c++)
        if (abs(v->color[c] - expected[c]) > tolerance)
            fail_msg("colour %d %d %d, expected %d %d %d", v->color[0], v->color[1],
                     v->color[2], r, g, b);
    assert_int_equal(v->color[3], 255);
}

static const prom_material textured = {{1, 1, 1, 1}, 0, PROM_ALPHA_OPAQUE, 0.5f, 0};
static const prom_material masked = {{1, 1, 1, 1}, 0, PROM_ALPHA_MASK, 0.5f, 0};

static void constant_texture_gives_its_color(void **state)
{
    (void)state;
    prom_texture texture;
    prom_mesh mesh, out;
    init_texture(&texture, 64, paint_constant, 0);
    init_grid(&mesh, 5, 1, 3.7f, 0);
    prom_mesh_bake_colors(&mesh, &textured, &texture, &out);
    assert_sound(&out);
    assert_int_equal(out.submeshes[0].material, PROM_NONE);
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        assert_color(&out.vertices[i], 200, 100, 50, 1);
        assert_true(out.vertices[i].uv[0] == 0 && out.vertices[i].uv[1] == 0);
    }
    prom_mesh_finish(&out);

    // Base colour and vertex colour multiply in linear light.
    prom_material half = textured;
    half.base_color[0] = 0.5f;
    for (uint32_t i = 0; i < mesh.vertex_count; i++) mesh.vertices[i].color[1] = 128;
    prom_mesh_bake_colors(&mesh, &half, &texture, &out);
    float red = prom_linear_to_srgb(0.5f * prom_srgb8_to_linear(200));
    float green = prom_linear_to_srgb(prom_srgb8_to_linear(128) * prom_srgb8_to_linear(100));
    assert_color(&out.vertices[0], (int)(red * 255 + 0.5f), (int)(green * 255 + 0.5f), 50, 1);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
    prom_texture_finish(&texture);
}

// Triangles far larger than the checks see their mean, triangles within one check its colour.
static void checker_is_averaged_by_size(void **state)
{
    (void)state;
    prom_texture texture;
    prom_mesh mesh, out;
    init_texture(&texture, 64, paint_checker, 0);
    init_grid(&mesh, 2, 1, 40, 0);
    prom_mesh_bake_colors(&mesh, &textured, &texture, &out);
    for (uint32_t i = 0; i < out.vertex_count; i++)
        assert_color(&out.vertices[i], 188, 188, 188, 3); // half of the light
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);

    init_grid(&mesh, 128, 1, 1, 0);
    prom_mesh_bake_colors(&mesh, &textured, &texture, &out);
    uint32_t dark = 0, bright = 0;
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        dark += out.vertices[i].color[0] < 20;
        bright += out.vertices[i].color[0] > 235;
    }
    // A vertex sees half a texel on each side, and filtering another half: of the 8 x 8
    // vertices of a check of 4 texels 5 x 5 are that far from its edges.
    assert_in_range(dark, out.vertex_count / 6, out.vertex_count / 2);
    assert_in_range(bright, out.vertex_count / 6, out.vertex_count / 2);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
    prom_texture_finish(&texture);
}

static void masked_parts_shrink_to_their_area(void **state)
{
    (void)state;
    prom_texture texture;
    prom_mesh mesh, out;
    init_texture(&texture, 64, paint_left_half, 0.5f);
    init_grid(&mesh, 1, 2, 1, 0); // one card
    prom_mesh_bake_colors(&mesh, &masked, &texture, &out);
    assert_sound(&out);
    assert_float_equal(area_of(&out) / area_of(&mesh), 0.5f, 0.05f);
    prom_box box = prom_mesh_bounds(&out);
    float center[3];
    prom_box_center(&box, center);
    assert_float_equal(center[0], 1, 1e-4f);
    for (uint32_t i = 0; i < out.vertex_count; i++) // none of the magenta nothing
        assert_color(&out.vertices[i], 40, 160, 30, 6);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);

    // A large connected piece keeps what is covered where it is covered.
    init_grid(&mesh, 16, 1, 1, 0);
    prom_mesh_bake_colors(&mesh, &masked, &texture, &out);
    assert_float_equal(area_of(&out), 0.5f, 0.05f);
    for (uint32_t i = 0; i < out.vertex_count; i++)
        assert_true(out.vertices[i].position[0] < 0.57f);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
    prom_texture_finish(&texture);
}

static void blended_parts_are_left_out(void **state)
{
    (void)state;
    prom_material materials[2] = {{{1, 0, 0, 1}, PROM_NONE, PROM_ALPHA_OPAQUE, 0, 0},
                                  {{0, 0, 1, 0.5f}, PROM_NONE, PROM_ALPHA_BLEND, 0, 0}};
    prom_mesh mesh, out;
    init_grid(&mesh, 4, 1, 1, 0);
    uint32_t half = mesh.index_count / 2;
    prom_submesh *two = realloc(mesh.submeshes, 2 * sizeof *two);
    mesh.submeshes = two;
    two[0] = (prom_submesh){0, half, 0};
    two[1] = (prom_submesh){half, half, 1};
    mesh.submesh_count = 2;
    prom_mesh_bake_colors(&mesh, materials, NULL, &out);
    assert_sound(&out);
    assert_int_equal(out.index_count, half);
    assert_color(&out.vertices[0], 255, 0, 0, 0);
    prom_mesh_finish(&out);
    materials[0].alpha_mode = PROM_ALPHA_BLEND;
    prom_mesh_bake_colors(&mesh, materials, NULL, &out);
    assert_int_equal(out.index_count, 0);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
}

static void double_sided_parts_get_back_sides(void **state)
{
    (void)state;
    prom_material sided = {{1, 1, 1, 1}, PROM_NONE, PROM_ALPHA_OPAQUE, 0, 1};
    prom_mesh mesh, out;
    init_grid(&mesh, 3, 1, 1, 0);
    prom_mesh_bake_colors(&mesh, &sided, NULL, &out);
    assert_sound(&out);
    assert_int_equal(out.index_count, 2 * mesh.index_count);
    uint32_t up = 0, down = 0;
    for (uint32_t i = 0; i < out.index_count; i += 3) {
        const prom_vertex *v[3];
        for (int k = 0; k < 3; k++) v[k] = &out.vertices[out.indices[i + k]];
        float e[3], f[3], cross[3];
        glm_vec3_sub((float *)v[1]->position, (float *)v[0]->position, e);
        glm_vec3_sub((float *)v[2]->position, (float *)v[0]->position, f);
        glm_vec3_cross(e, f, cross);
        assert_true(cross[1] * v[0]->normal[1] > 0);
        up += cross[1] > 0;
        down += cross[1] < 0;
    }
    assert_int_equal(up, down);
    prom_mesh_finish(&out);
    prom_mesh_finish(&mesh);
}

static prom_cluster_piece piece_at(const prom_mesh *mesh, double x, double z)
{
    prom_cluster_piece piece = {.mesh = mesh, .placement = prom_placement_identity};
    piece.placement.origin[0] = x;
    piece.placement.origin[2] = z;
    return piece;
}

static void pieces_are_placed(void **state)
{
    (void)state;
    prom_mesh sphere, out;
    float error;
    init_sphere(&sphere, 12);
    prom_cluster_piece pieces[2] = {piece_at(&sphere, -5, 0), piece_at(&sphere, 5, 0)};
    pieces[0].error = 0.01f;
    pieces[1].error = 0.02f;
    // Mirrored and stretched: faces must still look outwards, normals stand across them.
    const float basis[9] = {-3, 0, 0, 0, 1, 0, 0, 0, 1};
    memcpy(pieces[1].placement.basis, basis, sizeof basis);
    assert_true(prom_cluster_mesh_make(pieces, 2, false, 100000, &out, &error));
    assert_sound(&out);
    assert_float_equal(error, 0.06f, 1e-6f);
    prom_box box = prom_mesh_bounds(&out);
    assert_float_equal(box.min[0], -6, 1e-3f);
    assert_float_equal(box.max[0], 8, 1e-3f);
    for (uint32_t i = 0; i < out.index_count; i += 3) {
        float e[3], f[3], cross[3], *p[3], center[3] = {0}, normal[3];
        for (int k = 0; k < 3; k++) p[k] = out.vertices[out.indices[i + k]].position;
        center[0] = p[0][0] < 0 ? -5 : 5;
        glm_vec3_sub(p[1], p[0], e);
        glm_vec3_sub(p[2], p[0], f);
        glm_vec3_cross(e, f, cross);
        glm_vec3_sub(p[0], center, e);
        assert_true(glm_vec3_dot(cross, e) > 0);
        for (int k = 0; k < 3; k++) normal[k] = out.vertices[out.indices[i]].normal[k];
        glm_vec3_normalize(normal);
        glm_vec3_normalize(cross);
        assert_true(glm_vec3_dot(cross, normal) > 0.7f);
    }
    prom_mesh_finish(&out);
    prom_mesh_finish(&sphere);
}

static void clusters_reach_their_target(void **state)
{
    (void)state;
    prom_mesh sphere, out;
    float error;
    init_sphere(&sphere, 32);
    prom_cluster_piece pieces[16];
    for (int i = 0; i < 16; i++) pieces[i] = piece_at(&sphere, 3 * (i % 4), 3 * (i / 4));
    float last = 0;
    for (uint32_t target = 8192; target >= 512; target /= 4) {
        assert_true(prom_cluster_mesh_make(pieces, 16, false, target, &out, &error));
        assert_sound(&out);
        assert_in_range(out.index_count / 3, target / 2, target * 13 / 10);
        assert_true(error >= last && error < 1);
        // What is left is still 16 spheres.
        assert_float_equal(area_of(&out) / (16 * 4 * GLM_PIf), 1, 0.25f);
        last = error;
        prom_mesh_finish(&out);
    }
    prom_mesh_finish(&sphere);
}

// A wall of bricks with gaps: too many to keep a tetrahedron of each.
static void loose_parts_become_one(void **state)
{
    (void)state;
    enum { ROWS = 12, BRICKS = ROWS * ROWS };
    const float half[3] = {0.45f, 0.45f, 0.2f}, origin[3] = {0};
    prom_mesh brick, out;
    prom_cluster_piece pieces[BRICKS];
    prom_mesh_init_box(&brick, origin, half, NULL);
    for (uint32_t i = 0; i < BRICKS; i++)
        pieces[i] = piece_at(&brick, (double)(i % ROWS), (double)(i / ROWS));
    for (uint32_t target = 400; target >= 200; target /= 2) {
        float error;
        assert_true(prom_cluster_mesh_make(pieces, BRICKS, false, target, &out, &error));
        assert_sound(&out);
        assert_in_range(out.index_count / 3, 1, target * 13 / 10);
        assert_true(error > 0.05f && error < ROWS / 4); // more than a gap
        const prom_box box = prom_mesh_bounds(&out);
        assert_true(box.max[0] - box.min[0] > ROWS * 0.75f);
        assert_true(box.max[2] - box.min[2] > ROWS * 0.75f);
        prom_mesh_finish(&out);
    }
    prom_mesh_finish(&brick);
}

// Chunks of a surface: inner borders vanish, the outer border stays as it is.
static void surfaces_keep_their_outline(void **state)
{
    (void)state;
    enum { N = 16 };
    prom_mesh chunk, out;
    float error;
    init_grid(&chunk, N, 1, 1, 0);
    for (uint32_t i = 0; i < chunk.vertex_count; i++) {
        float *p = chunk.vertices[i].position; // periodic, so that chunks fit
        p[1] = 0.1f * sinf(2 * GLM_PIf * p[0]) * sinf(2 * GLM_PIf * p[2]);
    }
    prom_cluster_piece pieces[4];
    for (int i = 0; i < 4; i++) pieces[i] = piece_at(&chunk, i % 2, i / 2);
    assert_true(prom_cluster_mesh_make(pieces, 4, true, 500, &out, &error));
    assert_sound(&out);
    assert_in_range(out.index_count / 3, 130, 650);
    assert_true(error > 0 && error < 0.2f);
    // Outline: 4 sides of 2 N steps; no vertex lost, none moved.
    uint32_t outline = 0;
    for (uint32_t i = 0; i < out.vertex_count; i++) {
        const float *p = out.vertices[i].position;
        bool on = p[0] == 0 || p[0] == 2 || p[2] == 0 || p[2] == 2;
        outline += on;
        if (!on) continue;
        float along = (p[0] == 0 || p[0] == 2 ? p[2] : p[0]) * N;
        assert_float_equal(along, roundf(along), 1e-4f);
    }
    assert_int_equal(outline, 8 * N);
    assert_float_equal(area_of(&out), 4, 0.5f);
    prom_mesh_finish(&out);
    prom_mesh_finish(&chunk);
}

// Walls of small tiles in two colours: what is left has their mean, not one of them.
static void far_reductions_average_colors(void **state)
{
    (void)state;
    prom_mesh sphere, out;
    float error;
    init_sphere(&sphere, 64);
    for (uint32_t i = 0; i < sphere.vertex_count; i++)
        memset(sphere.vertices[i].color, (i % 65 + i / 65) % 2 ? 255 : 0, 3);
    prom_cluster_piece piece = piece_at(&sphere, 0, 0);
    assert_true(prom_cluster_mesh_make(&piece, 1, false, 200, &out, &error));
    assert_sound(&out);
    for (uint32_t i = 0; i < out.vertex_count; i++)
        assert_color(&out.vertices[i], 188, 188, 188, 25);
    prom_mesh_finish(&out);
    prom_mesh_finish(&sphere);
}

static void nothing_makes_nothing(void **state)
{
    (void)state;
    prom_mesh out, empty = {0}, sphere;
    float error;
    assert_false(prom_cluster_mesh_make(NULL, 0, false, 100, &out, &error));
    prom_cluster_piece piece = piece_at(&empty, 0, 0);
    assert_false(prom_cluster_mesh_make(&piece, 1, false, 100, &out, &error));
    assert_false(prom_cluster_mesh_make(&piece, 1, true, 100, &out, &error));
    assert_null(out.vertices);
    init_sphere(&sphere, 16);
    piece = piece_at(&sphere, 0, 0);
    memset(piece.placement.basis, 0, sizeof piece.placement.basis);
    assert_false(prom_cluster_mesh_make(&piece, 1, false, 100, &out, &error));
    piece = piece_at(&sphere, INFINITY, NAN);
    assert_false(prom_cluster_mesh_make(&piece, 1, true, 100, &out, &error));
    // One triangle is asked for: something or nothing, but sound.
    piece = piece_at(&sphere, 0, 0);
    if (prom_cluster_mesh_make(&piece, 1, false, 0, &out, &error)) {
        assert_sound(&out);
        assert_true(isfinite(error));
        prom_mesh_finish(&out);
    }
    prom_mesh_bake_colors(&empty, NULL, NULL, &out);
    assert_int_equal(out.index_count, 0);
    prom_mesh_finish(&out);
    prom_mesh_finish(&sphere);
}

typedef struct shared_work {
    prom_cluster_piece pieces[9];
    uint64_t hashes[12];
} shared_work;

static void make_one(void *user, size_t i, unsigned thread)
{
    (void)thread;
    shared_work *w = user;
    prom_mesh out;
    float error;
    if (!prom_cluster_mesh_make(w->pieces, 9, i % 2, 400, &out, &error)) return;
    w->hashes[i] = prom_mesh_hash(&out, 0);
    prom_mesh_finish(&out);
}

static void same_in_all_threads(void **state)
{
    (void)state;
    prom_mesh sphere;
    init_sphere(&sphere, 20);
    shared_work work = {0};
    for (int i = 0; i < 9; i++) work.pieces[i] = piece_at(&sphere, 3 * (i % 3), 3 * (i / 3));
    prom_parallel_for(12, make_one, &work);
    for (int i = 0; i < 12; i++)
        assert_true(work.hashes[i] && work.hashes[i] == work.hashes[i % 2]);
    prom_mesh_finish(&sphere);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(constant_texture_gives_its_color),
        cmocka_unit_test(checker_is_averaged_by_size),
        cmocka_unit_test(masked_parts_shrink_to_their_area),
        cmocka_unit_test(blended_parts_are_left_out),
        cmocka_unit_test(double_sided_parts_get_back_sides),
        cmocka_unit_test(pieces_are_placed),
        cmocka_unit_test(clusters_reach_their_target),
        cmocka_unit_test(loose_parts_become_one),
        cmocka_unit_test(surfaces_keep_their_outline),
        cmocka_unit_test(far_reductions_average_colors),
        cmocka_unit_test(nothing_makes_nothing),
        cmocka_unit_test(same_in_all_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
