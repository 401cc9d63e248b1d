// LINK: prom_scenes prom_builder prom_metaobj
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scenes/path.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define FILE_NAME "test_path.path"

static void write_text(const char *text)
{
    FILE *f = fopen(FILE_NAME, "w");
    assert_non_null(f);
    assert_true(fputs(text, f) >= 0);
    assert_int_equal(fclose(f), 0);
}

static double random_unit(uint64_t *state)
{
    *state = *state * 6364136223846793005u + 1442695040888963407u;
    return (double)(*state >> 33) / (double)(1u << 31);
}

// ---- files

static void test_round_trip(void **unused)
{
    (void)unused;
    prom_path path = {0}, back;
    uint64_t seed = 1;
    for (int i = 0; i < 200; i++) {
        double p[3], forward[3];
        for (int k = 0; k < 3; k++) {
            p[k] = 1e4 * (random_unit(&seed) - 0.5);
            forward[k] = random_unit(&seed) - 0.5;
        }
        prom_path_add(&path, p, forward);
    }
    prom_error error = {0};
    assert_int_equal(prom_path_save(FILE_NAME, &path, "round\ntrip", &error), PROM_OK);
    assert_int_equal(prom_path_load(FILE_NAME, &back, &error), PROM_OK);
    assert_int_equal(back.keys.count, path.keys.count);
    for (size_t i = 0; i < path.keys.count; i++) {
        assert_true(fabs(back.keys.data[i].t - path.keys.data[i].t) < 1e-6);
        float length = 0;
        for (int k = 0; k < 3; k++)
            assert_true(fabs(back.keys.data[i].position[k] - path.keys.data[i].position[k]) <
                        1e-6);
        for (int k = 0; k < 4; k++) {
            float q = back.keys.data[i].orientation[k];
            assert_true(fabsf(q - path.keys.data[i].orientation[k]) < 1e-6f);
            length += q * q;
        }
        assert_true(fabsf(length - 1) < 1e-6f);
    }
    assert_int_equal(access(FILE_NAME ".part", F_OK), -1);
    prom_path_finish(&path);
    prom_path_finish(&back);
    unlink(FILE_NAME);
}

static void test_added_key_looks_forward(void **unused)
{
    (void)unused;
    uint64_t seed = 7;
    for (int i = 0; i < 100; i++) {
        prom_path path = {0};
        double forward[3], length = 0;
        for (int k = 0; k < 3; k++) {
            forward[k] = random_unit(&seed) - 0.5;
            length += forward[k] * forward[k];
        }
        prom_path_add(&path, (double[3]){0}, forward);
        const float *q = path.keys.data[0].orientation;
        // The camera's -z and x axes in the world.
        double z[3] = {-2.0 * (q[0] * q[2] + q[3] * q[1]), -2.0 * (q[1] * q[2] - q[3] * q[0]),
                       -1 + 2.0 * (q[0] * q[0] + q[1] * q[1])};
        for (int k = 0; k < 3; k++) assert_true(fabs(z[k] - forward[k] / sqrt(length)) < 1e-5);
        assert_true(fabsf(q[0] * q[1] + q[3] * q[2]) < 1e-6f); // x stays level
        prom_path_finish(&path);
    }
}

static void test_bad_files(void **unused)
{
    (void)unused;
    static const struct {
        const char *text, *place, *what;
    } cases[] = {
        {"", ":1:", "without a key"},
        {"# a\n\n# b\n", ":3:", "without a key"},
        {"0 1 2 3 0 0 0 1\n0.1 1 2 3 0 0 1\n", ":2:", "fewer"},
        {"0 1 2 3 0 0 0 1 9\n", ":1:", "more"},
        {"# h\n0 1 x 3 0 0 0 1\n", ":2:", "not a number"},
        {"0 1 2,5 3 0 0 0 1\n", ":1:", "not a number"},
        {"0 1 nan 3 0 0 0 1\n", ":1:", "not finite"},
        {"0 1 2 inf 0 0 0 1\n", ":1:", "not finite"},
        {"0 1 2 1e999 0 0 0 1\n", ":1:", "not finite"},
        {"0 1 2 3 0 0 0 0\n", ":1:", "length 1"},
        {"0 1 2 3 1 1 0 0\n", ":1:", "length 1"},
        {"0 1 2 3 0 0 0 1\n\n0 1 2 3 0 0 0 1\n", ":3:", "not after"},
        {"1 1 2 3 0 0 0 1\n0.5 1 2 3 0 0 0 1\n", ":2:", "not after"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        prom_path path;
        prom_error error = {0};
        write_text(cases[i].text);
        assert_int_equal(prom_path_load(FILE_NAME, &path, &error), PROM_ERR_INPUT);
        assert_non_null(strstr(error.text, FILE_NAME));
        assert_non_null(strstr(error.text, cases[i].place));
        assert_non_null(strstr(error.text, cases[i].what));
        assert_int_equal(path.keys.count, 0);
    }
    unlink(FILE_NAME);
}

static void test_zero_byte(void **unused)
{
    (void)unused;
    FILE *f = fopen(FILE_NAME, "w");
    assert_non_null(f);
    static const char text[] = "0 1 2 3 0 0 0 1\n\0 1 2";
    assert_int_equal(fwrite(text, 1, sizeof text, f), sizeof text);
    fclose(f);
    prom_path path;
    prom_error error = {0};
    assert_int_equal(prom_path_load(FILE_NAME, &path, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, ":2:"));
    unlink(FILE_NAME);
}

// Cut anywhere, a good file gives keys or one error, never a crash.
static void test_truncation(void **unused)
{
    (void)unused;
    static const char text[] = "# title\n0 1 2 3 0 0 0 1\n0.5 -1e3 2 3 0.6 0 0 0.8\n";
    for (size_t n = 0; n < sizeof text; n++) {
        char part[sizeof text];
        memcpy(part, text, n);
        part[n] = 0;
        write_text(part);
        prom_path path;
        prom_error error = {0};
        prom_status status = prom_path_load(FILE_NAME, &path, &error);
        assert_true(status == PROM_OK ? path.keys.count > 0
                                      : strstr(error.text, FILE_NAME) != NULL);
        prom_path_finish(&path);
    }
    unlink(FILE_NAME);
}

static void test_missing_and_unwritable(void **unused)
{
    (void)unused;
    prom_path path;
    prom_error error = {0};
    assert_int_equal(prom_path_load("no/such.path", &path, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "no/such.path"));
    prom_path one = {0};
    prom_path_add(&one, (double[3]){0}, (double[3]){0, 0, -1});
    assert_int_equal(prom_path_save("no/such.path", &one, NULL, &error), PROM_ERR_OUTPUT);
    prom_path_finish(&one);
}

// ---- to and fro

static void test_to_and_fro(void **unused)
{
    (void)unused;
    for (int n = 1; n < 6; n++) {
        prom_path path = {0};
        for (int i = 0; i < n; i++)
            prom_path_add(&path, (double[]){i, 0, 0}, (double[]){0, 0, -1});
        int at = 0, step = 1;
        for (uint64_t frame = 0; frame < 40; frame++) {
            prom_camera camera = {.width = 7};
            prom_path_pose(&path, frame, &camera);
            assert_true(camera.eye[0] == at);
            assert_int_equal(camera.width, 7);
            if (n > 1 && (at + step < 0 || at + step >= n)) step = -step;
            if (n > 1) at += step;
        }
        prom_camera far = {0};
        prom_path_pose(&path, UINT64_MAX, &far);
        assert_true(far.eye[0] >= 0 && far.eye[0] < n);
        prom_path_finish(&path);
    }
}

// ---- the automatic walk

#define LEAVES_MAX 600

// A model of leaves under one root, all of one prototype: as much as the walk reads.
typedef struct fake {
    prom_model model;
    uint32_t first_child[LEAVES_MAX + 1], prototype[LEAVES_MAX + 1];
    double center[LEAVES_MAX + 1][3];
    float half[LEAVES_MAX + 1][3], radius[LEAVES_MAX + 1];
    prom_prototype prototypes[2];
} fake;

static void make_fake(fake *f, uint32_t leaves, double size, uint64_t seed)
{
    memset(f, 0, sizeof *f);
    f->prototypes[1].flags = PROM_PROTO_SURFACE;
    f->model = (prom_model){.node_count = leaves + 1,
                            .tree_count = leaves + 1,
                            .first_child = f->first_child,
                            .prototype = f->prototype,
                            .center = f->center,
                            .half = f->half,
                            .radius = f->radius,
                            .prototypes = f->prototypes,
                            .prototype_count = 2};
    f->first_child[0] = 1;
    for (uint32_t i = 1; i <= leaves; i++) {
        f->first_child[i] = PROM_NONE;
        f->prototype[i] = i % 7 == 0;
        for (int k = 0; k < 3; k++)
            f->half[i][k] = (float)(size * (0.005 + 0.02 * random_unit(&seed)));
        f->center[i][0] = size * (random_unit(&seed) - 0.5);
        f->center[i][1] = (double)f->half[i][1];
        f->center[i][2] = size * (random_unit(&seed) - 0.5);
    }
}

static void test_auto_stays_in_the_layout(void **unused)
{
    (void)unused;
    static const double sizes[] = {0.3, 3, 60, 400, 3000, 90000};
    static fake f;
    for (uint64_t seed = 0; seed < 12; seed++) {
        double size = sizes[seed % 6];
        make_fake(&f, 40 + 50 * (uint32_t)(seed % 11), size, seed);
        prom_path path, again;
        prom_error error = {0};
        assert_int_equal(prom_path_auto(NULL, &f.model, 300, &path, &error), PROM_OK);
        assert_int_equal(prom_path_auto(NULL, &f.model, 300, &again, &error), PROM_OK);
        assert_int_equal(path.keys.count, 300);
        assert_memory_equal(path.keys.data, again.keys.data, 300 * sizeof *path.keys.data);
        double way = 0, longest = 0;
        for (int i = 0; i < 300; i++) {
            const prom_path_key *k = &path.keys.data[i], *b = &path.keys.data[i ? i - 1 : 0];
            double step =
                hypot(k->position[0] - b->position[0], k->position[2] - b->position[2]);
            for (int j = 0; j < 3; j++) assert_true(isfinite(k->position[j]));
            for (int j = 0; j < 4; j++) assert_true(isfinite(k->orientation[j]));
            assert_true(fabs(k->position[0]) < 0.6 * size && fabs(k->position[2]) < 0.6 * size);
            assert_true(k->position[1] > 0 && k->position[1] < 0.3 * size);
            way += step;
            longest = fmax(longest, step);
        }
        assert_true(way > 0.25 * size && longest < 2 * way / 300); // gets on, without leaps
        prom_path_finish(&path);
        prom_path_finish(&again);
    }
}

static void test_auto_avoids_objects(void **unused)
{
    (void)unused;
    // A town of blocks: towers on a grid with streets twice as wide between them.
    static fake f;
    make_fake(&f, 121, 330, 1);
    for (uint32_t i = 1; i <= 121; i++) {
        f.prototype[i] = 0;
        f.half[i][0] = f.half[i][2] = 5;
        f.half[i][1] = 10;
        f.center[i][0] = 30.0 * ((i - 1) % 11) - 150;
        f.center[i][1] = 10;
        f.center[i][2] = 30.0 * ((i - 1) / 11) - 150;
    }
    prom_path path;
    prom_error error = {0};
    assert_int_equal(prom_path_auto(NULL, &f.model, 600, &path, &error), PROM_OK);
    for (size_t k = 0; k < 600; k++) {
        const double *p = path.keys.data[k].position;
        assert_true(fabs(p[1] - 1.7) < 1e-6);
        for (uint32_t i = 1; i <= 121; i++)
            assert_false(fabs(p[0] - f.center[i][0]) < 5 && fabs(p[2] - f.center[i][2]) < 5);
    }
    prom_path_finish(&path);
}

static void test_auto_circles_a_single_object(void **unused)
{
    (void)unused;
    static fake f;
    make_fake(&f, 1, 2, 3);
    f.center[1][0] = 50;
    prom_path path;
    prom_error error = {0};
    assert_int_equal(prom_path_auto(NULL, &f.model, 90, &path, &error), PROM_OK);
    for (size_t k = 0; k < 90; k++) {
        const prom_path_key *key = &path.keys.data[k];
        const float *q = key->orientation;
        double z[3] = {-2.0 * (q[0] * q[2] + q[3] * q[1]), -2.0 * (q[1] * q[2] - q[3] * q[0]),
                       -1 + 2.0 * (q[0] * q[0] + q[1] * q[1])};
        double along = 0, length = 0;
        for (int j = 0; j < 3; j++) {
            double to = f.center[1][j] - key->position[j];
            along += to * z[j];
            length += to * to;
        }
        assert_true(along > 0.999 * sqrt(length));
    }
    prom_path_finish(&path);
}

static void test_auto_refuses_nothing(void **unused)
{
    (void)unused;
    static fake f;
    prom_path path;
    prom_error error = {0};
    make_fake(&f, 1, 2, 3);
    assert_int_equal(prom_path_auto(NULL, &f.model, 0, &path, &error), PROM_ERR_USAGE);
    f.model.tree_count = 0;
    assert_int_equal(prom_path_auto(NULL, &f.model, 10, &path, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "no object"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),
        cmocka_unit_test(test_added_key_looks_forward),
        cmocka_unit_test(test_bad_files),
        cmocka_unit_test(test_zero_byte),
        cmocka_unit_test(test_truncation),
        cmocka_unit_test(test_missing_and_unwritable),
        cmocka_unit_test(test_to_and_fro),
        cmocka_unit_test(test_auto_stays_in_the_layout),
        cmocka_unit_test(test_auto_avoids_objects),
        cmocka_unit_test(test_auto_circles_a_single_object),
        cmocka_unit_test(test_auto_refuses_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
