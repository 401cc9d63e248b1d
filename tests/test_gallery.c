// LINK: prom_scenes prom_builder prom_metaobj
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "builder/source.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/log.h"
#include "scenes/gallery.h"
#include "scenes/path.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static void make(const char *glb, const char *path, prom_gallery_options options,
                 prom_gallery_facts *facts)
{
    prom_error error = {0};
    if (prom_gallery_write(glb, path, &options, facts, &error)) fail_msg("%s", error.text);
}

static void read_bytes(const char *path, uint8_t **bytes, size_t *size)
{
    FILE *f = fopen(path, "rb");
    assert_non_null(f);
    assert_int_equal(fseek(f, 0, SEEK_END), 0);
    *size = (size_t)ftell(f);
    rewind(f);
    *bytes = prom_alloc(*size, 1);
    assert_int_equal(fread(*bytes, 1, *size, f), *size);
    fclose(f);
}

static bool same_bytes(const char *a, const char *b)
{
    uint8_t *x, *y;
    size_t nx, ny;
    read_bytes(a, &x, &nx);
    read_bytes(b, &y, &ny);
    bool same = nx == ny && !memcmp(x, y, nx);
    prom_free(x);
    prom_free(y);
    return same;
}

// The import as a reader of its own; it must have nothing to complain about.
static void read_scene(const char *glb, prom_source *source)
{
    prom_error error = {0};
    struct stat st = {0};
    int old = dup(2), log = open("test_gallery.log", O_CREAT | O_TRUNC | O_WRONLY, 0666);
    assert_true(old >= 0 && log >= 0);
    fflush(stderr);
    dup2(log, 2);
    prom_log_set_level(PROM_LOG_WARNING);
    prom_status status = prom_source_import(glb, NULL, source, &error);
    fflush(stderr);
    dup2(old, 2);
    close(old);
    assert_int_equal(fstat(log, &st), 0);
    close(log);
    unlink("test_gallery.log");
    if (status) fail_msg("%s", error.text);
    assert_int_equal(st.st_size, 0);
}

// ---- triangles in the world

typedef struct triangle {
    double p[3][3];
    double normal[3]; // the sum of its vertices'
} triangle;

typedef void (*visitor)(const triangle *t, void *context);

static void to_world(const double m[16], const float v[3], double w, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m[k] * (double)v[0] + m[4 + k] * (double)v[1] + m[8 + k] * (double)v[2] +
                 m[12 + k] * w;
}

static void visit_mesh(const prom_mesh *mesh, const double world[16], visitor visit,
                       void *context)
{
    for (uint32_t i = 0; i < mesh->index_count; i += 3) {
        triangle t = {0};
        for (int c = 0; c < 3; c++) {
            const prom_vertex *v = &mesh->vertices[mesh->indices[i + (uint32_t)c]];
            float n[3];
            double turned[3];
            for (int k = 0; k < 3; k++) n[k] = (float)v->normal[k] / 127;
            to_world(world, v->position, 1, t.p[c]);
            to_world(world, n, 0, turned);
            for (int k = 0; k < 3; k++) t.normal[k] += turned[k];
        }
        visit(&t, context);
    }
}

static uint64_t visit_scene(const prom_source *source, visitor visit, void *context)
{
    uint64_t triangles = 0;
    for (size_t i = 0; i < source->nodes.count; i++) {
        const prom_source_node *node = &source->nodes.data[i];
        for (uint32_t k = 0; k < node->mesh_count; k++) {
            const prom_mesh *mesh =
                &source->meshes.data[source->mesh_refs.data[node->first_mesh + k]];
            visit_mesh(mesh, node->world, visit, context);
            triangles += mesh->index_count / 3;
        }
    }
    return triangles;
}

typedef struct sides {
    uint64_t good, bad, empty;
} sides;

static void check_triangle(const triangle *t, void *context)
{
    sides *s = context;
    double c[3], area = 0, dot = 0, length = 0, lit = 0;
    static const double light[3] = {0.4243, 0.7576, 0.4960};
    for (int j = 0; j < 3; j++) {
        int x = (j + 1) % 3, y = (j + 2) % 3;
        for (int k = 0; k < 3; k++) assert_true(isfinite(t->p[k][j]));
        c[j] = (t->p[1][x] - t->p[0][x]) * (t->p[2][y] - t->p[0][y]) -
               (t->p[1][y] - t->p[0][y]) * (t->p[2][x] - t->p[0][x]);
        area += c[j] * c[j];
        dot += c[j] * t->normal[j];
        length += t->normal[j] * t->normal[j];
        lit += t->normal[j] * light[j];
    }
    area = sqrt(area);
    length = sqrt(length);
    assert_true(isfinite(length) && length > 0);
    if (area < 1e-10)
        s->empty++;
    else if (dot > 0 || lit > 0.995 * length) // what shines is turned to the light
        s->good++;
    else
        s->bad++;
}

static void test_same_seed_same_gallery(void **unused)
{
    (void)unused;
    prom_gallery_options options = {.seed = 5, .rooms = 17, .detail = 1};
    make("test_gallery_b.glb", "test_gallery_b.path", options, NULL);
    make("test_gallery_c.glb", "test_gallery_c.path", options, NULL);
    assert_true(same_bytes("test_gallery_b.glb", "test_gallery_c.glb"));
    assert_true(same_bytes("test_gallery_b.path", "test_gallery_c.path"));
    options.seed = 6;
    make("test_gallery_c.glb", NULL, options, NULL);
    assert_false(same_bytes("test_gallery_b.glb", "test_gallery_c.glb"));
    assert_int_equal(access("test_gallery_b.glb.part", F_OK), -1);
    unlink("test_gallery_b.glb");
    unlink("test_gallery_c.glb");
    unlink("test_gallery_b.path");
    unlink("test_gallery_c.path");
}

// ---- the walk

#define EYE 1.65
#define FREE 0.30 // metres around the walker, from the knee to the eye

typedef struct walk {
    const prom_path *path;
    double *floor;  // highest surface under each key's eye
    double clear;   // the least distance of a triangle from the walker
    size_t nearest; // the key where that is
} walk;

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static double clamp(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

static double segment_distance(const double p[3], const double a[3], const double b[3])
{
    double ab[3], ap[3], d[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = b[k] - a[k];
        ap[k] = p[k] - a[k];
    }
    double length = dot3(ab, ab), t = length > 0 ? clamp(dot3(ap, ab) / length) : 0;
    for (int k = 0; k < 3; k++) d[k] = ap[k] - t * ab[k];
    return sqrt(dot3(d, d));
}

// From a point to a triangle: inside its prism the plane's distance, else that of an edge.
static double distance(const double p[3], const triangle *t)
{
    double ab[3], ac[3], ap[3];
    for (int k = 0; k < 3; k++) {
        ab[k] = t->p[1][k] - t->p[0][k];
        ac[k] = t->p[2][k] - t->p[0][k];
        ap[k] = p[k] - t->p[0][k];
    }
    double aa = dot3(ab, ab), cc = dot3(ac, ac), ab_ac = dot3(ab, ac);
    double pb = dot3(ap, ab), pc = dot3(ap, ac), det = aa * cc - ab_ac * ab_ac;
    if (det > 1e-18) {
        double u = (cc * pb - ab_ac * pc) / det, v = (aa * pc - ab_ac * pb) / det, d[3];
        if (u >= 0 && v >= 0 && u + v <= 1) {
            for (int k = 0; k < 3; k++) d[k] = ap[k] - u * ab[k] - v * ac[k];
            return sqrt(dot3(d, d));
        }
    }
    return fmin(
        fmin(segment_distance(p, t->p[0], t->p[1]), segment_distance(p, t->p[1], t->p[2])),
        segment_distance(p, t->p[2], t->p[0]));
}

// The height at which the vertical line through p meets the triangle, or -INFINITY.
static double height_at(const double p[3], const triangle *t)
{
    double x[3], z[3];
    for (int k = 0; k < 3; k++) {
        x[k] = t->p[k][0] - p[0];
        z[k] = t->p[k][2] - p[2];
    }
    double a = x[1] * z[2] - x[2] * z[1], b = x[2] * z[0] - x[0] * z[2],
           c = x[0] * z[1] - x[1] * z[0];
    double sum = a + b + c;
    if (fabs(sum) < 1e-9 || a / sum < 0 || b / sum < 0 || c / sum < 0) return -INFINITY;
    return (a * t->p[0][1] + b * t->p[1][1] + c * t->p[2][1]) / sum;
}

static void meet_triangle(const triangle *t, void *context)
{
    walk *w = context;
    double low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(fmin(t->p[0][k], t->p[1][k]), t->p[2][k]);
        high[k] = fmax(fmax(t->p[0][k], t->p[1][k]), t->p[2][k]);
    }
    for (size_t i = 0; i < w->path->keys.count; i += 3) {
        const double *eye = w->path->keys.data[i].position;
        if (eye[0] < low[0] - FREE || eye[0] > high[0] + FREE || eye[2] < low[2] - FREE ||
            eye[2] > high[2] + FREE || low[1] > eye[1] + FREE)
            continue;
        double y = height_at(eye, t);
        if (y < eye[1] && y > w->floor[i]) w->floor[i] = y;
        if (high[1] < eye[1] - EYE + 0.5) continue; // below the knee: floors and steps
        for (int k = 0; k < 4; k++) {
            double p[3] = {eye[0], eye[1] - 0.25 * k, eye[2]}, d = distance(p, t);
            if (d >= w->clear) continue;
            w->clear = d;
            w->nearest = i;
        }
    }
}

static void check_pace(const prom_path *path)
{
    const prom_path_key *k = path->keys.data;
    assert_true(path->keys.count >= 600 && path->keys.count <= 1800);
    double high = 0, last = 0;
    for (size_t i = 0; i < path->keys.count; i++) {
        high = fmax(high, k[i].position[1]);
        last = k[i].position[1];
        if (!i) continue;
        double step = 0, dot = 0;
        for (int j = 0; j < 3; j++)
            step += (k[i].position[j] - k[i - 1].position[j]) *
                    (k[i].position[j] - k[i - 1].position[j]);
        for (int j = 0; j < 4; j++)
            dot += (double)(k[i].orientation[j] * k[i - 1].orientation[j]);
        assert_true(sqrt(step) > 0.03 && sqrt(step) < 0.06); // about 1.6 m/s
        assert_true(fabs(dot) > cos(0.05));                  // under six degrees a key
    }
    // Up one storey and down again.
    assert_true(fabs(high - 6 - EYE) < 0.01);
    assert_true(fabs(last - EYE) < 0.01);
}

static void check_geometry(const prom_source *source, const prom_gallery_facts *facts)
{
    sides s = {0};
    visit_scene(source, check_triangle, &s);
    // The import leaves out what has no area.
    assert_true(s.good + s.bad + s.empty <= facts->triangles);
    assert_true((double)(s.good + s.bad + s.empty) > 0.995 * (double)facts->triangles);
    // The sharp lips of thin vessels, smoothed, may lean away from their normals.
    assert_true((double)s.bad < 0.008 * (double)s.good);
}

static void check_walk(const prom_source *source, const prom_path *path)
{
    walk w = {
        .path = path, .clear = FREE, .floor = prom_alloc(path->keys.count, sizeof *w.floor)};
    check_pace(path);
    for (size_t i = 0; i < path->keys.count; i++) w.floor[i] = -INFINITY;
    visit_scene(source, meet_triangle, &w);
    for (size_t i = 0; i < path->keys.count; i += 3) {
        double above = path->keys.data[i].position[1] - w.floor[i];
        // A step is 0.17 m high, and the way over it a slope.
        if (fabs(above - EYE) > 0.2)
            fail_msg("key %zu: the eye is %.2f m above the floor", i, above);
    }
    if (w.clear < FREE) fail_msg("key %zu is %.2f m from something", w.nearest, w.clear);
    prom_free(w.floor);
}

static void check_scene(prom_gallery_options options, uint64_t least, uint64_t most)
{
    prom_source source = {0};
    prom_path path = {0};
    prom_error error = {0};
    prom_gallery_facts facts = {0};
    make("test_gallery_d.glb", "test_gallery_d.path", options, &facts);
    assert_int_equal(prom_path_load("test_gallery_d.path", &path, &error), PROM_OK);
    assert_int_equal(path.keys.count, facts.walk_keys);
    assert_true(facts.rooms >= options.rooms &&
                facts.rooms <= options.rooms + options.rooms / 2 + 8);
    if (facts.triangles < least || facts.triangles > most)
        fail_msg("%llu triangles", (unsigned long long)facts.triangles);
    read_scene("test_gallery_d.glb", &source);
    check_geometry(&source, &facts);
    check_walk(&source, &path);
    prom_path_finish(&path);
    prom_source_finish(&source);
    unlink("test_gallery_d.glb");
    unlink("test_gallery_d.path");
}

static void test_sound_and_free_to_walk(void **unused)
{
    (void)unused;
    check_scene((prom_gallery_options){.seed = 1, .rooms = 17, .detail = 1}, 90000, 200000);
    check_scene((prom_gallery_options){.seed = 2, .rooms = 40, .detail = 1}, 200000, 500000);
    check_scene((prom_gallery_options){.seed = 4, .rooms = 17, .detail = 1, .roofless = true},
                80000, 200000);
}

// ---- refusals

static void test_bad_options(void **unused)
{
    (void)unused;
    static const prom_gallery_options bad[] = {{.rooms = 16}, {.rooms = 2001}, {.detail = 5}};
    prom_error error = {0};
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++)
        assert_int_equal(prom_gallery_write("test_gallery_e.glb", NULL, &bad[i], NULL, &error),
                         PROM_ERR_USAGE);
    assert_int_equal(access("test_gallery_e.glb", F_OK), -1);
    prom_gallery_options small = {.rooms = 17, .detail = 1};
    assert_int_equal(prom_gallery_write("no/such/x.glb", NULL, &small, NULL, &error),
                     PROM_ERR_OUTPUT);
    assert_non_null(strstr(error.text, "no/such/x.glb"));
    assert_int_equal(
        prom_gallery_write("test_gallery_e.glb", "no/such/x.path", &small, NULL, &error),
        PROM_ERR_OUTPUT);
    assert_int_equal(access("test_gallery_e.glb", F_OK), -1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sound_and_free_to_walk),
        cmocka_unit_test(test_same_seed_same_gallery),
        cmocka_unit_test(test_bad_options),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
