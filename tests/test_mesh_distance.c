// LINK: prom_simplify prom_metaobj
// Distances between surfaces, areas and volumes, against what geometry says of them.
#include "builder/simplify/mesh_distance.h"
#include "builder/simplify/mesh_volume.h"

#include "metaobj/base/alloc.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define SAMPLES 200000

static void set_vertex(prom_mesh *mesh, uint32_t vertex, float x, float y, float z,
                       const float normal[3])
{
    memcpy(mesh->vertices[vertex].position, (const float[3]){x, y, z}, 3 * sizeof(float));
    prom_pack_normal(normal, mesh->vertices[vertex].normal);
}

// n x n quads over [0, side]^2 at height z, facing +z.
static void init_square(prom_mesh *mesh, uint32_t n, float side, float z)
{
    static const float up[3] = {0, 0, 1};
    prom_mesh_init(mesh, (n + 1) * (n + 1), n * n * 6, 1);
    for (uint32_t j = 0; j <= n; j++)
        for (uint32_t i = 0; i <= n; i++)
            set_vertex(mesh, j * (n + 1) + i, side * (float)i / (float)n,
                       side * (float)j / (float)n, z, up);
    uint32_t *at = mesh->indices;
    for (uint32_t j = 0; j < n; j++)
        for (uint32_t i = 0; i < n; i++) {
            uint32_t a = j * (n + 1) + i, c = a + n + 1;
            const uint32_t quad[6] = {a, a + 1, c + 1, a, c + 1, c};
            memcpy(at, quad, sizeof quad);
            at += 6;
        }
    mesh->submeshes[0] = (prom_submesh){0, mesh->index_count, PROM_NONE};
}

static void init_cube(prom_mesh *mesh, float half)
{
    static const float center[3] = {0.25f, -0.5f, 1};
    prom_mesh_init_box(mesh, center, (const float[3]){half, half, half}, NULL);
}

// A unit sphere's octahedron, each face cut into n x n triangles whose corners are on the
// sphere. Turned outwards.
static void init_ball(prom_mesh *mesh, uint32_t n)
{
    uint32_t per_face = (n + 1) * (n + 2) / 2, v = 0;
    prom_mesh_init(mesh, 8 * per_face, 8 * n * n * 3, 1);
    uint32_t *at = mesh->indices;
    for (uint32_t face = 0; face < 8; face++) {
        uint32_t first = v;
        bool odd = (face ^ face >> 1 ^ face >> 2) & 1;
        for (uint32_t j = 0; j <= n; j++)
            for (uint32_t i = 0; i + j <= n; i++, v++) {
                float p[3] = {(float)i, (float)j, (float)(n - i - j)};
                glm_vec3_normalize(p);
                for (uint32_t k = 0; k < 3; k++) p[k] = face >> k & 1 ? -p[k] : p[k];
                set_vertex(mesh, v, p[0], p[1], p[2], p);
            }
        for (uint32_t j = 0, row = first; j < n; row += n + 1 - j, j++)
            for (uint32_t i = 0; i + j < n; i++) {
                uint32_t a = row + i, above = row + n + 1 - j + i;
                const uint32_t t[6] = {a, a + 1, above, a + 1, above + 1, above};
                uint32_t count = i + j + 1 < n ? 6 : 3;
                for (uint32_t k = 0; k < count; k++)
                    at[k] = t[odd && k % 3 ? k / 3 * 3 + 3 - k % 3 : k];
                at += count;
            }
    }
    assert_int_equal(at - mesh->indices, mesh->index_count);
    mesh->submeshes[0] = (prom_submesh){0, mesh->index_count, PROM_NONE};
}

static void move(prom_mesh *mesh, float x, float y, float z)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        glm_vec3_add(mesh->vertices[v].position, (vec3){x, y, z}, mesh->vertices[v].position);
}

static prom_mesh_distances between(const prom_mesh *a, const prom_mesh *b)
{
    prom_mesh_distances d;
    prom_mesh_distances_measure(a, b, SAMPLES, &d);
    assert_true(d.ab.rms <= d.ab.max && d.ba.rms <= d.ba.max && d.rms <= d.hausdorff);
    assert_true(d.ab.mean <= d.ab.rms * (1 + 1e-12) && d.ba.mean <= d.ba.rms * (1 + 1e-12));
    return d;
}

#define assert_close(got, want, tolerance)                                                     \
    do {                                                                                       \
        double got_ = (got), want_ = (want);                                                   \
        if (!(fabs(got_ - want_) <= (tolerance)))                                              \
            fail_msg("%s is %.9g, not %.9g", #got, got_, want_);                               \
    } while (0)

// ---- distances

static void parallel_squares_are_apart_by_their_gap(void **state)
{
    (void)state;
    prom_mesh a, b;
    init_square(&a, 1, 2, 0);
    init_square(&b, 7, 2, 0.5f);
    prom_mesh_distances d = between(&a, &b);
    const prom_one_way *ways[2] = {&d.ab, &d.ba};
    for (int i = 0; i < 2; i++) {
        assert_close(ways[i]->mean, 0.5, 1e-9);
        assert_close(ways[i]->rms, 0.5, 1e-9);
        assert_close(ways[i]->max, 0.5, 1e-7);
        assert_close(ways[i]->normal_rms_degrees, 0, 1e-6);
        assert_int_equal(ways[i]->samples, SAMPLES);
    }
    prom_mesh_finish(&a);
    prom_mesh_finish(&b);
}

// Of [0, 2]^2, what lies outside of [0, 1]^2: over two strips the distance is one coordinate's,
// over the corner it is to the point (1, 1).
static void squares_of_two_sizes_differ_one_way(void **state)
{
    (void)state;
    prom_mesh large, small;
    init_square(&large, 5, 2, 0);
    init_square(&small, 3, 1, 0);
    prom_mesh_distances d = between(&large, &small);
    assert_close(d.ba.max, 0, 0);
    assert_close(d.ab.max, sqrt(2), 1e-12);
    double squares = 2 * (1.0 / 3) + 2.0 / 3; // integrals of x^2, y^2 and x^2 + y^2
    assert_close(d.ab.rms, sqrt(squares / 4), 1e-4);
    assert_close(d.hausdorff, d.ab.max, 0);
    for (int k = 0; k < 3; k++) {
        assert_close(d.ab.from[k], k < 2 ? 2 : 0, 0);
        assert_close(d.ab.to[k], k < 2 ? 1 : 0, 1e-12);
    }
    prom_mesh_finish(&large);
    prom_mesh_finish(&small);
}

// The greatest gap between a sphere and a triangle inside it: the radius less the distance of
// its plane, where the plane's foot is inside (as in all triangles here).
static double greatest_sagitta(const prom_mesh *ball)
{
    double greatest = 0;
    for (uint32_t i = 0; i < ball->index_count; i += 3) {
        float e[3], f[3], n[3];
        float *p = ball->vertices[ball->indices[i]].position;
        glm_vec3_sub(ball->vertices[ball->indices[i + 1]].position, p, e);
        glm_vec3_sub(ball->vertices[ball->indices[i + 2]].position, p, f);
        glm_vec3_crossn(e, f, n);
        greatest = fmax(greatest, 1 - fabs((double)glm_vec3_dot(n, p)));
    }
    return greatest;
}

static void a_ball_is_off_by_its_sagitta(void **state)
{
    (void)state;
    prom_mesh sphere, ball;
    init_ball(&sphere, 150);
    init_ball(&ball, 4);
    double sagitta = greatest_sagitta(&ball), own = greatest_sagitta(&sphere);
    assert_true(sagitta > 0.02 && own < 1e-4);
    prom_mesh_distances d = between(&sphere, &ball);
    assert_close(d.ab.max, sagitta, own + 1e-4);
    assert_close(d.ba.max, sagitta, own + 1e-4);
    // Corners are on the sphere, so the mean is well below the maximum.
    assert_true(d.rms > 0.3 * sagitta && d.rms < 0.8 * sagitta);
    // Both show the normals of the sphere, interpolated.
    assert_true(d.ab.normal_rms_degrees < 3);
    prom_mesh_finish(&sphere);
    prom_mesh_finish(&ball);
}

static void a_mesh_is_nowhere_off_itself(void **state)
{
    (void)state;
    prom_mesh meshes[3];
    init_square(&meshes[0], 13, 1.7f, 0.3f);
    init_cube(&meshes[1], 0.7f);
    init_ball(&meshes[2], 20);
    for (int i = 0; i < 3; i++) {
        prom_mesh_distances d = between(&meshes[i], &meshes[i]);
        assert_close(d.hausdorff, 0, 0);
        assert_close(d.rms, 0, 0);
        // At an edge a neighbour may be found, which is as near.
        assert_close(d.ab.normal_rms_degrees, 0, 0.5);
        prom_mesh_finish(&meshes[i]);
    }
}

static void ways_change_places(void **state)
{
    (void)state;
    prom_mesh a, b;
    init_ball(&a, 5);
    init_cube(&b, 0.8f);
    prom_mesh_distances d = between(&a, &b), e = between(&b, &a);
    assert_true(d.ab.max > 0.1);
    assert_memory_equal(&d.ab, &e.ba, sizeof d.ab);
    assert_memory_equal(&d.ba, &e.ab, sizeof d.ba);
    assert_true(d.rms == e.rms && d.hausdorff == e.hausdorff);
    prom_mesh_finish(&a);
    prom_mesh_finish(&b);
}

static void what_is_moved_is_off_by_the_shift(void **state)
{
    (void)state;
    prom_mesh a, b;
    init_cube(&a, 1);
    prom_mesh_copy(&b, &a);
    move(&b, 0.1f, 0, 0);
    prom_mesh_distances d = between(&a, &b);
    assert_close(d.ab.max, 0.1, 1e-6);
    assert_close(d.ba.max, 0.1, 1e-6);
    // The face that comes out of the other cube is off by the shift; the one that went in too,
    // but near its edges by the distance from these; of four sides a strip that hangs over.
    double t = 0.1, cubes = t * t * t / 3, out = 4 * t * t, sides = 4 * 2 * cubes;
    double in = 8 * (cubes - t * t * t * t / 4) + (2 - 2 * t) * (2 - 2 * t) * t * t;
    assert_close(d.ab.rms, sqrt((out + in + sides) / 24), 1e-5);
    assert_close(d.rms, d.ab.rms, 1e-4);
    prom_mesh_finish(&a);
    prom_mesh_finish(&b);
}

// A flat square against one that is bent along its diagonal: normals of both halves are off by
// a known angle where these are flat.
static void turned_normals_are_told(void **state)
{
    (void)state;
    prom_mesh a, b;
    init_square(&a, 1, 1, 0);
    init_square(&b, 1, 1, 0);
    const float tilted[3] = {0, 0.5f, 0.8660254f}, down[3] = {0, 0, -1};
    for (uint32_t v = 0; v < 4; v++) prom_pack_normal(tilted, b.vertices[v].normal);
    assert_close(between(&a, &b).ab.normal_rms_degrees, 30, 0.5);
    for (uint32_t v = 0; v < 4; v++) prom_pack_normal(down, b.vertices[v].normal);
    assert_close(between(&a, &b).ab.normal_rms_degrees, 0, 1e-6); // a back side
    prom_mesh_finish(&a);
    prom_mesh_finish(&b);
}

// Needles, on which floats cannot project.
static void thin_triangles_have_exact_distances(void **state)
{
    (void)state;
    static const float up[3] = {0, 0, 1};
    prom_mesh a, b;
    prom_mesh_init(&a, 3, 3, 1);
    prom_mesh_init(&b, 3, 3, 1);
    for (uint32_t v = 0; v < 3; v++) a.indices[v] = b.indices[v] = v;
    const float corners[3][3] = {{-0.9f, -0.7f, 0.3f}, {0.8f, 0.9f, -0.4f}, {0.1f, 0.2f, 0}};
    for (uint32_t v = 0; v < 3; v++) {
        set_vertex(&a, v, corners[v][0], corners[v][1], corners[v][2], up);
        set_vertex(&b, v, corners[v][0], corners[v][1], corners[v][2], up);
    }
    memcpy(a.vertices[2].position, (const float[3]){-0.05f, 0.1f, -0.05001f}, 12);
    memcpy(b.vertices[2].position, a.vertices[2].position, 12);
    assert_close(between(&a, &b).hausdorff, 0, 0);
    prom_mesh_finish(&a);
    prom_mesh_finish(&b);
}

static void points_and_nothing_are_answered(void **state)
{
    (void)state;
    prom_mesh square, point = {0}, none = {0};
    init_square(&square, 2, 1, 0);
    prom_mesh_init(&point, 3, 3, 1);
    for (uint32_t v = 0; v < 3; v++) {
        point.indices[v] = v;
        set_vertex(&point, v, 0.5f, 0.5f, 2, (const float[3]){0, 0, 1});
    }
    prom_mesh_distances d = between(&point, &square);
    assert_int_equal(d.ab.samples, 0);
    assert_close(d.ab.rms, 2, 1e-12);
    assert_close(d.ba.max, sqrt(4.5), 1e-12);
    prom_mesh_distances_measure(&square, &none, 0, &d);
    assert_true(isinf(d.rms) && isinf(d.ab.max) && isinf(d.ba.max));
    double volume;
    assert_false(prom_mesh_volume(&none, &volume) || prom_mesh_volume(&point, &volume));
    prom_mesh_finish(&square);
    prom_mesh_finish(&point);
}

// ---- volumes

static void a_cube_has_its_volume(void **state)
{
    (void)state;
    prom_mesh cube;
    init_cube(&cube, 0.75f);
    double volume = 0;
    assert_true(prom_mesh_volume(&cube, &volume));
    assert_close(volume, 1.5 * 1.5 * 1.5, 1e-9);
    assert_close(prom_mesh_area(&cube), 6 * 1.5 * 1.5, 1e-9);
    for (uint32_t i = 0; i < cube.index_count; i += 3) {
        uint32_t kept = cube.indices[i];
        cube.indices[i] = cube.indices[i + 1];
        cube.indices[i + 1] = kept;
    }
    assert_true(prom_mesh_volume(&cube, &volume));
    assert_close(volume, -1.5 * 1.5 * 1.5, 1e-9);
    uint32_t kept = cube.indices[0]; // one triangle the other way round
    cube.indices[0] = cube.indices[1];
    cube.indices[1] = kept;
    assert_false(prom_mesh_volume(&cube, &volume));
    cube.indices[1] = cube.indices[0];
    cube.indices[0] = kept;
    cube.index_count -= 3; // a hole
    assert_false(prom_mesh_volume(&cube, &volume));
    prom_mesh_finish(&cube);
}

static void a_ball_nears_its_volume(void **state)
{
    (void)state;
    double before = 1;
    for (uint32_t n = 4; n <= 64; n *= 2) {
        prom_mesh ball;
        init_ball(&ball, n);
        double volume = 0;
        assert_true(prom_mesh_volume(&ball, &volume));
        double lacks = 1 - volume / (4 * GLM_PI / 3);
        assert_true(lacks > 0 && lacks < 0.3 * before);
        before = lacks;
        prom_mesh_finish(&ball);
    }
    assert_true(before < 1e-3);
}

static void an_open_square_has_no_volume(void **state)
{
    (void)state;
    prom_mesh square;
    init_square(&square, 3, 2, 1);
    double volume = 7;
    assert_false(prom_mesh_volume(&square, &volume));
    assert_true(volume == 7);
    assert_close(prom_mesh_area(&square), 4, 1e-6);
    prom_mesh_finish(&square);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parallel_squares_are_apart_by_their_gap),
        cmocka_unit_test(squares_of_two_sizes_differ_one_way),
        cmocka_unit_test(a_ball_is_off_by_its_sagitta),
        cmocka_unit_test(a_mesh_is_nowhere_off_itself),
        cmocka_unit_test(ways_change_places),
        cmocka_unit_test(what_is_moved_is_off_by_the_shift),
        cmocka_unit_test(turned_normals_are_told),
        cmocka_unit_test(thin_triangles_have_exact_distances),
        cmocka_unit_test(points_and_nothing_are_answered),
        cmocka_unit_test(a_cube_has_its_volume),
        cmocka_unit_test(a_ball_nears_its_volume),
        cmocka_unit_test(an_open_square_has_no_volume),
    };
    return cmocka_run_group_tests_name("mesh_distance", tests, NULL, NULL);
}
