// LINK: prom_builder prom_render prom_benefit prom_metaobj
// Atlases: every face in one chart, every chart in a place of its own, and in it what stands
// there.
#include "render_fixture.h"

#include "builder/atlas_bake.h"
#include "metaobj/base/alloc.h"

#define SIDE_MIN 32u

static uint32_t next_random(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return *seed >> 8;
}

static float random_unit(uint32_t *seed)
{
    return (float)next_random(seed) / (float)(1u << 24);
}

// ---- meshes

static void add_triangle(prom_mesh *mesh, const float corners[3][3], const uint8_t color[4])
{
    vec3 u, v, normal;
    glm_vec3_sub((float *)corners[1], (float *)corners[0], u);
    glm_vec3_sub((float *)corners[2], (float *)corners[0], v);
    glm_vec3_crossn(u, v, normal);
    for (int k = 0; k < 3; k++) {
        prom_vertex *out = &mesh->vertices[mesh->vertex_count];
        memcpy(out->position, corners[k], sizeof out->position);
        memcpy(out->color, color, 4);
        prom_pack_normal(normal, out->normal);
        mesh->indices[mesh->index_count++] = mesh->vertex_count++;
    }
    mesh->submeshes[0] = (prom_submesh){0, mesh->index_count, PROM_NONE};
}

static void begin_mesh(prom_mesh *mesh, uint32_t triangles)
{
    prom_mesh_init(mesh, triangles * 3, triangles * 3, 1);
    mesh->vertex_count = mesh->index_count = 0;
}

static const uint8_t white[4] = {255, 255, 255, 255};

static void init_soup(prom_mesh *mesh, uint32_t triangles, float extent, uint32_t seed)
{
    begin_mesh(mesh, triangles);
    for (uint32_t t = 0; t < triangles; t++) {
        float middle[3], corners[3][3];
        for (int a = 0; a < 3; a++) middle[a] = random_unit(&seed);
        for (int k = 0; k < 3; k++)
            for (int a = 0; a < 3; a++) corners[k][a] = middle[a] + extent * random_unit(&seed);
        add_triangle(mesh, (const float(*)[3])corners, white);
    }
}

// A wavy strip that turns once around y: smooth, with an open border.
static void init_ring(prom_mesh *mesh, uint32_t steps)
{
    begin_mesh(mesh, steps * 2);
    for (uint32_t i = 0; i < steps; i++) {
        float p[4][3];
        for (uint32_t k = 0; k < 4; k++) {
            float turn = 2 * GLM_PIf * (float)((i + k / 2) % steps) / (float)steps;
            float radius = 1 + 0.1f * sinf(5 * turn);
            p[k][0] = radius * sinf(turn), p[k][2] = radius * cosf(turn);
            p[k][1] = k % 2 ? 0.4f : -0.4f;
        }
        const float low[3][3] = {{p[0][0], p[0][1], p[0][2]},
                                 {p[2][0], p[2][1], p[2][2]},
                                 {p[1][0], p[1][1], p[1][2]}};
        const float high[3][3] = {{p[1][0], p[1][1], p[1][2]},
                                  {p[2][0], p[2][1], p[2][2]},
                                  {p[3][0], p[3][1], p[3][2]}};
        add_triangle(mesh, low, white);
        add_triangle(mesh, high, white);
    }
}

enum { MESHES = 4 };

static void init_mesh(prom_mesh *mesh, int which)
{
    const float center[3] = {1, 2, 3}, half[3] = {3, 1, 2};
    switch (which) {
    case 0:
        prom_mesh_init_box(mesh, center, half, NULL);
        break;
    case 1:
        init_ring(mesh, 60);
        break;
    case 2:
        init_soup(mesh, 300, 0.3f, 7);
        break;
    default: // with triangles of no area
        init_soup(mesh, 40, 0.3f, 8);
        for (uint32_t i = 0; i < 30; i += 3) mesh->indices[i + 1] = mesh->indices[i];
    }
}

// ---- charts

static void every_face_is_in_one_chart_that_sees_it(void **state)
{
    (void)state;
    for (int which = 0; which < MESHES; which++) {
        prom_mesh mesh;
        prom_atlas atlas;
        init_mesh(&mesh, which);
        assert_true(prom_atlas_init(&atlas, &mesh, 40, SIDE_MIN, 1024));
        assert_int_equal(atlas.face_count, mesh.index_count / 3);
        uint8_t *seen = prom_calloc(atlas.face_count, 1);
        uint32_t faces = 0;
        for (uint32_t c = 0; c < atlas.chart_count; c++) {
            const prom_chart *chart = &atlas.charts[c];
            assert_int_equal(chart->first, faces);
            faces += chart->count;
            for (uint32_t i = chart->first; i < faces; i++) {
                const uint32_t *corner = mesh.indices + atlas.faces[i] * 3;
                vec3 u, v, normal;
                const float *p = mesh.vertices[corner[0]].position;
                assert_int_equal(seen[atlas.faces[i]]++, 0);
                glm_vec3_sub(mesh.vertices[corner[1]].position, (float *)p, u);
                glm_vec3_sub(mesh.vertices[corner[2]].position, (float *)p, v);
                glm_vec3_cross(u, v, normal);
                float length = glm_vec3_norm(normal);
                if (length > 0)
                    assert_true(glm_vec3_dot(normal, (float *)chart->out) > 0.3f * length);
            }
        }
        assert_int_equal(faces, atlas.face_count);
        prom_free(seen);
        prom_atlas_finish(&atlas);
        prom_mesh_finish(&mesh);
    }
}

static void what_is_flat_or_smooth_stays_together(void **state)
{
    (void)state;
    prom_mesh mesh;
    prom_atlas atlas;
    init_mesh(&mesh, 0);
    assert_true(prom_atlas_init(&atlas, &mesh, 10, SIDE_MIN, 256));
    assert_int_equal(atlas.chart_count, 6);
    prom_atlas_finish(&atlas);
    prom_mesh_finish(&mesh);
    init_mesh(&mesh, 1); // all around in steps of at most twice 50 degrees
    assert_true(prom_atlas_init(&atlas, &mesh, 40, SIDE_MIN, 256));
    assert_in_range(atlas.chart_count, 4, 8);
    prom_atlas_finish(&atlas);
    prom_mesh_finish(&mesh);
}

// ---- places

static void charts_have_places_of_their_own(void **state)
{
    (void)state;
    for (int which = 0; which < MESHES; which++) {
        prom_mesh mesh;
        prom_atlas atlas;
        init_mesh(&mesh, which);
        assert_true(prom_atlas_init(&atlas, &mesh, 40, SIDE_MIN, 512));
        assert_in_range(atlas.side, SIDE_MIN, 512);
        uint8_t *taken = prom_calloc((size_t)atlas.side * atlas.side, 1);
        for (uint32_t c = 0; c < atlas.chart_count; c++) {
            const prom_chart *chart = &atlas.charts[c];
            assert_true(chart->x + chart->width <= atlas.side);
            assert_true(chart->y + chart->height <= atlas.side);
            for (uint32_t y = chart->y; y < chart->y + chart->height; y++)
                for (uint32_t x = chart->x; x < chart->x + chart->width; x++)
                    assert_int_equal(taken[y * atlas.side + x]++, 0);
        }
        prom_free(taken);
        prom_atlas_finish(&atlas);
        prom_mesh_finish(&mesh);
    }
}

static bool inside(const prom_atlas *atlas, const prom_chart *chart, const float uv[2])
{
    const float slack = 1e-3f, side = (float)atlas->side, gutter = PROM_ATLAS_GUTTER;
    float x = uv[0] * side - (float)chart->x, y = uv[1] * side - (float)chart->y;
    return x >= gutter - slack && x <= (float)chart->width - gutter + slack &&
           y >= gutter - slack && y <= (float)chart->height - gutter + slack;
}

static void triangles_stay_off_the_gutters(void **state)
{
    (void)state;
    for (int which = 0; which < MESHES; which++) {
        prom_mesh mesh, unwrapped;
        prom_atlas atlas;
        init_mesh(&mesh, which);
        assert_true(prom_atlas_init(&atlas, &mesh, 40, SIDE_MIN, 512));
        prom_atlas_unwrap(&atlas, &mesh, &unwrapped);
        assert_null(prom_mesh_check(&unwrapped, 0));
        assert_int_equal(unwrapped.index_count, mesh.index_count);
        for (uint32_t i = 0; i < unwrapped.index_count; i += 3) {
            uint32_t homes = 0;
            for (uint32_t c = 0; c < atlas.chart_count; c++) {
                bool all = true;
                for (uint32_t k = 0; k < 3; k++)
                    all = all && inside(&atlas, &atlas.charts[c],
                                        unwrapped.vertices[unwrapped.indices[i + k]].uv);
                homes += all;
            }
            assert_int_equal(homes, 1);
        }
        prom_mesh_finish(&unwrapped);
        prom_atlas_finish(&atlas);
        prom_mesh_finish(&mesh);
    }
}

static void room_decides_about_the_density(void **state)
{
    (void)state;
    prom_mesh mesh;
    prom_atlas atlas;
    init_mesh(&mesh, 0); // faces of 6 x 4, 6 x 2 and 4 x 2, twice each
    assert_true(prom_atlas_init(&atlas, &mesh, 4, SIDE_MIN, 256));
    assert_true(atlas.texels_per_unit == 4);
    assert_int_equal(atlas.side, 64);
    prom_atlas_finish(&atlas);
    assert_true(prom_atlas_init(&atlas, &mesh, 1e4f, SIDE_MIN, 128));
    assert_int_equal(atlas.side, 128);
    // 88 units squared; these rectangles fill more than a half.
    assert_true(88 * atlas.texels_per_unit * atlas.texels_per_unit > 128 * 128 / 2.0f);
    prom_atlas_finish(&atlas);
    prom_mesh_finish(&mesh);
    init_soup(&mesh, 2000, 0.1f, 3);
    assert_false(prom_atlas_init(&atlas, &mesh, 100, SIDE_MIN, 64));
    assert_null(atlas.charts);
    prom_mesh_finish(&mesh);
    begin_mesh(&mesh, 0);
    assert_false(prom_atlas_init(&atlas, &mesh, 100, SIDE_MIN, 64));
    prom_mesh_finish(&mesh);
}

// ---- pictures

static prom_baker *baker;

static void make_baker(void)
{
    prom_error error = {0};
    baker = prom_baker_create(fix.renderer, &error);
    if (!baker) fail_msg("%s", error.text);
}

// A box on the device, as an item with its sphere.
static void add_box(const float center[3], const float half[3], const uint8_t color[4],
                    prom_draw_item *item, prom_sphere *sphere)
{
    uint8_t colors[6][4];
    prom_mesh mesh;
    for (int f = 0; f < 6; f++) memcpy(colors[f], color, 4);
    prom_mesh_init_box(&mesh, center, half, (const uint8_t(*)[4])colors);
    *item = item_at(prom_renderer_add_mesh(fix.renderer, &mesh), 0, 0, 0, 1);
    memcpy(sphere->center, center, sizeof sphere->center);
    sphere->radius = glm_vec3_norm((float *)half);
    prom_mesh_finish(&mesh);
}

// Where a point of an unwrapped mesh stands in the texture; of the triangles that have it, the
// one that faces `out`.
static bool find_uv(const prom_mesh *mesh, const float point[3], const float out[3],
                    float uv[2])
{
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        const prom_vertex *v[3];
        vec3 e, f, to, normal, c;
        for (int k = 0; k < 3; k++) v[k] = &mesh->vertices[mesh->indices[i + k]];
        glm_vec3_sub((float *)v[1]->position, (float *)v[0]->position, e);
        glm_vec3_sub((float *)v[2]->position, (float *)v[0]->position, f);
        glm_vec3_sub((float *)point, (float *)v[0]->position, to);
        glm_vec3_cross(e, f, normal);
        float area2 = glm_vec3_norm2(normal), off = glm_vec3_dot(to, normal);
        if (glm_vec3_dot(normal, (float *)out) <= 0 || off * off > 1e-6f * area2) continue;
        glm_vec3_cross(to, f, c);
        float w1 = glm_vec3_dot(c, normal) / area2;
        glm_vec3_cross(e, to, c);
        float w2 = glm_vec3_dot(c, normal) / area2;
        if (w1 < -1e-4f || w2 < -1e-4f || w1 + w2 > 1 + 1e-4f) continue;
        for (int a = 0; a < 2; a++)
            uv[a] = v[0]->uv[a] * (1 - w1 - w2) + v[1]->uv[a] * w1 + v[2]->uv[a] * w2;
        return true;
    }
    return false;
}

static const uint8_t *texel_at(const prom_texture *t, const float uv[2])
{
    uint32_t x = (uint32_t)(uv[0] * (float)t->width), y = (uint32_t)(uv[1] * (float)t->height);
    return t->pixels + 4 * ((size_t)y * t->width + x);
}

static const uint8_t red[4] = {220, 30, 20, 255}, blue[4] = {20, 40, 230, 255};

// A red box at x < 0 and a blue one at x > 0, and one box instead of both.
typedef struct pair {
    prom_draw_item items[3];
    prom_sphere spheres[3];
    prom_mesh mesh, unwrapped;
    prom_atlas atlas;
    prom_texture texture;
} pair;

static void init_pair(pair *p)
{
    const float half[3] = {1, 1, 1}, whole[3] = {2, 1, 1};
    add_box((float[3]){-1, 0, 0}, half, red, &p->items[0], &p->spheres[0]);
    add_box((float[3]){1, 0, 0}, half, blue, &p->items[1], &p->spheres[1]);
    prom_mesh_init_box(&p->mesh, (float[3]){0, 0, 0}, whole, NULL);
    assert_true(prom_atlas_init(&p->atlas, &p->mesh, 16, SIDE_MIN, 256));
    prom_atlas_unwrap(&p->atlas, &p->mesh, &p->unwrapped);
}

static void finish_pair(pair *p)
{
    prom_texture_finish(&p->texture);
    prom_mesh_finish(&p->unwrapped);
    prom_mesh_finish(&p->mesh);
    prom_atlas_finish(&p->atlas);
}

static bool bake_pair(pair *p, size_t count, float error)
{
    const prom_atlas_subject subject = {
        .items = p->items, .spheres = p->spheres, .count = count, .error = error};
    return prom_atlas_bake(baker, &p->atlas, &p->unwrapped, &subject, &p->texture);
}

static void colors_meet_at_a_sharp_border(void **state)
{
    NEEDS_GL(state);
    make_baker();
    pair p = {0};
    init_pair(&p);
    bake_pair(&p, 2, 0.01f);
    const float far[2] = {-1.5f, 1.5f};
    static const float normals[4][3] = {{0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (int n = 0; n < 4; n++)
        for (int side = 0; side < 2; side++) {
            float uv[2], at[3] = {far[side], normals[n][1], normals[n][2]};
            assert_true(find_uv(&p.unwrapped, at, normals[n], uv));
            const uint8_t *plain = texel_at(&p.texture, uv);
            assert_true(side ? plain[2] > 2 * plain[0] : plain[0] > 2 * plain[2]);
            // A texel and a half from the border it is the same.
            at[0] = copysignf(1.5f / 16, far[side]);
            assert_true(find_uv(&p.unwrapped, at, normals[n], uv));
            assert_memory_equal(texel_at(&p.texture, uv), plain, 4);
        }
    finish_pair(&p);
    prom_baker_destroy(baker);
}

// The light makes six reds of one; which, the pictures of the sides tell.
static void random_points_look_as_the_source_does(void **state)
{
    enum { PX = 64, POINTS = 2000 };
    NEEDS_GL(state);
    make_baker();
    pair p = {0};
    uint32_t seed = 5, checked = 0;
    const float half[3] = {2, 1, 1};
    uint8_t *faces = prom_alloc((size_t)PX * PX * 6, 4);
    init_pair(&p);
    bake_pair(&p, 2, 0.01f);
    prom_baker_set_subject(baker, p.items, 2);
    prom_baker_take_faces(baker, half, PROM_OUTPUT_LIT, PX, faces);
    for (int i = 0; i < POINTS; i++) {
        int face = (int)(next_random(&seed) % 6);
        float right[3], up[3], out[3], at[3], uv[2];
        prom_box_face_axes(face, right, up, out);
        for (int a = 0; a < 3; a++) at[a] = half[a] * (1.96f * random_unit(&seed) - 0.98f);
        for (int a = 0; a < 3; a++)
            if (out[a] != 0) at[a] = half[a] * out[a];
        if (fabsf(at[0]) < 0.1f) continue; // the border of the colours
        float x = glm_vec3_dot(at, right), y = glm_vec3_dot(at, up), extent[2] = {0, 0};
        for (int a = 0; a < 3; a++) {
            extent[0] += fabsf(right[a]) * half[a];
            extent[1] += fabsf(up[a]) * half[a];
        }
        uint32_t column = (uint32_t)((x / extent[0] + 1) / 2 * PX);
        uint32_t row = (uint32_t)((1 - y / extent[1]) / 2 * PX);
        const uint8_t *truth = faces + 4 * (((size_t)face * PX + row) * PX + column);
        assert_true(find_uv(&p.unwrapped, at, out, uv));
        const uint8_t *texel = texel_at(&p.texture, uv);
        for (int c = 0; c < 3; c++) assert_in_range(texel[c] + 3, truth[c], truth[c] + 6);
        checked++;
    }
    assert_true(checked > POINTS / 2);
    prom_free(faces);
    finish_pair(&p);
    prom_baker_destroy(baker);
}

// A green board one unit before the front: within the error it is what stands there, beyond it
// is something else.
static void only_what_is_within_the_error_is_seen(void **state)
{
    static const uint8_t green[4] = {10, 240, 20, 255};
    NEEDS_GL(state);
    make_baker();
    pair p = {0};
    init_pair(&p);
    add_box((float[3]){0, 0, 2}, (float[3]){2, 1, 0.01f}, green, &p.items[2], &p.spheres[2]);
    float uv[2];
    const float at[3] = {0.5f, 0.2f, 1}, out[3] = {0, 0, 1};
    assert_true(find_uv(&p.unwrapped, at, out, uv));
    bake_pair(&p, 3, 0.5f);
    assert_true(texel_at(&p.texture, uv)[2] > texel_at(&p.texture, uv)[1]);
    prom_texture_finish(&p.texture);
    bake_pair(&p, 3, 5);
    assert_true(texel_at(&p.texture, uv)[1] > texel_at(&p.texture, uv)[2]);
    finish_pair(&p);
    prom_baker_destroy(baker);
}

// The blue box is not there: its place has the red of the other, and is cut out.
static void what_is_not_there_is_cut_out(void **state)
{
    NEEDS_GL(state);
    make_baker();
    pair p = {0};
    float uv[2], out[3] = {0, 1, 0};
    init_pair(&p);
    assert_true(bake_pair(&p, 1, 0.01f));
    for (size_t i = 0; i < (size_t)p.texture.width * p.texture.height; i++)
        assert_true(p.texture.pixels[4 * i] > 2 * p.texture.pixels[4 * i + 2]);
    for (float x = -1.95f; x < 2; x += 0.1f) {
        assert_true(find_uv(&p.unwrapped, (float[3]){x, 1, 0.3f}, out, uv));
        if (fabsf(x) > 0.1f) assert_int_equal(texel_at(&p.texture, uv)[3] >= 128, x < 0);
    }
    prom_texture_finish(&p.texture);
    assert_false(bake_pair(&p, 2, 0.01f)); // both are there: all is opaque
    for (size_t i = 0; i < prom_texture_bytes(&p.texture); i += 4)
        assert_int_equal(p.texture.pixels[i + 3], 255);
    finish_pair(&p);
    prom_baker_destroy(baker);
}

static void the_same_again(void **state)
{
    NEEDS_GL(state);
    make_baker();
    pair a = {0}, b = {0};
    init_pair(&a);
    bake_pair(&a, 2, 0.01f);
    init_pair(&b);
    bake_pair(&b, 2, 0.01f);
    assert_true(prom_texture_hash(&a.texture, 0) == prom_texture_hash(&b.texture, 0));
    assert_true(prom_mesh_hash(&a.unwrapped, 0) == prom_mesh_hash(&b.unwrapped, 0));
    finish_pair(&a);
    finish_pair(&b);
    prom_baker_destroy(baker);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_face_is_in_one_chart_that_sees_it),
        cmocka_unit_test(what_is_flat_or_smooth_stays_together),
        cmocka_unit_test(charts_have_places_of_their_own),
        cmocka_unit_test(triangles_stay_off_the_gutters),
        cmocka_unit_test(room_decides_about_the_density),
        cmocka_unit_test(colors_meet_at_a_sharp_border),
        cmocka_unit_test(random_points_look_as_the_source_does),
        cmocka_unit_test(only_what_is_within_the_error_is_seen),
        cmocka_unit_test(what_is_not_there_is_cut_out),
        cmocka_unit_test(the_same_again),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
