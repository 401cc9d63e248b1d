// LINK: prom_scenes prom_builder prom_metaobj
// Eyes: evenly along paths, and over every floor of a box.
#define TOWN_FILE "test_eyes.prom"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "scenes/eyes.h"
#include "walk_town.h"

static double apart(const prom_eyes *eyes, size_t a, size_t b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += pow(eyes->data[a][k] - eyes->data[b][k], 2);
    return sqrt(sum);
}

static void add_key(prom_path *path, double x, double y, double z)
{
    prom_path_add(path, (double[]){x, y, z}, (double[]){0, 0, 1});
}

// Keys that crowd where the walker dawdles, stand still, and rush.
static void paths_are_sampled_by_distance(void **state)
{
    (void)state;
    prom_path path = {0};
    prom_eyes eyes = {0};
    prom_error error = {0};
    for (int i = 0; i < 100; i++) add_key(&path, 0.01 * i, 1, 0);
    for (int i = 0; i < 5; i++) add_key(&path, 1, 1, 0);
    for (int i = 1; i <= 3; i++) add_key(&path, 1, 1, 7.0 * i);
    assert_int_equal(prom_eyes_along(&path, 0.5, &eyes, &error), PROM_OK);
    assert_int_equal(eyes.count, 45); // 22 units
    assert_memory_equal(eyes.data[0], path.keys.data[0].position, sizeof(prom_eye));
    const double *end = path.keys.data[path.keys.count - 1].position;
    for (int k = 0; k < 3; k++) assert_true(fabs(eyes.data[eyes.count - 1][k] - end[k]) < 1e-6);
    for (size_t i = 1; i < eyes.count; i++) {
        assert_true(fabs(apart(&eyes, i - 1, i) - 0.5) < 1e-6); // the corner is at one of them
        assert_true(eyes.data[i][0] >= 0 && eyes.data[i][0] <= 1 + 1e-9);
    }
    prom_array_finish(&eyes);
    prom_path_finish(&path);
}

// Steps are even and no longer than was asked for, whatever the lengths; eyes are added to
// those that are there.
static void any_spacing_will_do(void **state)
{
    (void)state;
    prom_eyes eyes = {0};
    prom_error error = {0};
    for (int i = 1; i <= 60; i++) {
        prom_path path = {0};
        size_t before = eyes.count;
        double length = 0.137 * i * i, spacing = 0.31 + 0.07 * (i % 9);
        add_key(&path, 3, 2, -length / 3);
        add_key(&path, 3, 2, length / 7);
        add_key(&path, 3, 2, length * 2 / 3);
        assert_int_equal(prom_eyes_along(&path, spacing, &eyes, &error), PROM_OK);
        size_t added = eyes.count - before;
        assert_int_equal(added, (size_t)ceil(length / spacing) + 1);
        double step = length / (double)(added - 1);
        for (size_t k = before; k + 1 < eyes.count; k++)
            assert_true(fabs(apart(&eyes, k, k + 1) - step) < 1e-6 * length);
        prom_path_finish(&path);
    }
    prom_array_finish(&eyes);
}

static void a_resting_path_has_one_eye(void **state)
{
    (void)state;
    prom_path path = {0};
    prom_eyes eyes = {0};
    prom_error error = {0};
    for (int i = 0; i < 3; i++) add_key(&path, 1, 2, 3);
    assert_int_equal(prom_eyes_along(&path, 1, &eyes, &error), PROM_OK);
    assert_int_equal(eyes.count, 1);
    assert_true(eyes.data[0][2] == 3);
    add_key(&path, 1e12, 2, 3);
    assert_int_equal(prom_eyes_along(&path, 0.1, &eyes, &error), PROM_ERR_USAGE);
    assert_non_null(strstr(error.text, "larger cells"));
    assert_int_equal(eyes.count, 1);
    prom_array_finish(&eyes);
    prom_path_finish(&path);
}

static prom_status fill_box(const double low[3], const double high[3], double spacing,
                            prom_eyes *eyes, prom_error *error)
{
    prom_model model;
    prom_container *container = open_town(&model);
    prom_status status = prom_eyes_in_box(container, &model, low, high, spacing, eyes, error);
    prom_model_finish(&model);
    prom_container_close(container);
    return status;
}

// The streets, and what is within the towers' walls at their height, but neither the cellar
// below nor the roofs above.
static void eyes_stand_on_the_floors_of_a_box(void **state)
{
    (void)state;
    prom_eyes eyes = {0};
    prom_error error = {0};
    const double low[3] = {-60, -9, -50}, high[3] = {60, 9, 50};
    size_t in_streets = 0;
    assert_int_equal(fill_box(low, high, 2, &eyes, &error), PROM_OK);
    for (size_t i = 0; i < eyes.count; i++) {
        const double *e = eyes.data[i];
        assert_true(fabs(e[1] - PROM_EYE_HEIGHT - ground(e[0], e[2])) < 0.4);
        in_streets += !in_tower(e[0], e[2], 0);
        assert_true(e[0] >= low[0] && e[0] <= high[0] + 1 && e[2] >= low[2] &&
                    e[2] <= high[2] + 1);
    }
    // Towers take 144 of every 1024 square units.
    assert_in_range(in_streets, 0.7 * 60 * 50, 0.95 * 60 * 50);
    assert_in_range(eyes.count, in_streets, 60 * 50);
    prom_array_finish(&eyes);
}

static void a_box_may_hold_several_storeys(void **state)
{
    (void)state;
    prom_eyes streets = {0}, cellar = {0}, both = {0};
    prom_error error = {0};
    double low[3] = {-20, -9, -20}, high[3] = {20, 9, 20};
    assert_int_equal(fill_box(low, high, 3, &streets, &error), PROM_OK);
    low[1] = -25; // the cellar's floor itself
    high[1] = -20;
    assert_int_equal(fill_box(low, high, 3, &cellar, &error), PROM_OK);
    high[1] = 9;
    assert_int_equal(fill_box(low, high, 3, &both, &error), PROM_OK);
    assert_int_equal(both.count, streets.count + cellar.count);
    prom_array_finish(&streets);
    prom_array_finish(&cellar);
    prom_array_finish(&both);
}

static void a_box_without_a_floor_says_so(void **state)
{
    (void)state;
    prom_eyes eyes = {0};
    prom_error error = {0};
    const double above[2][3] = {{-60, 100, -50}, {60, 110, 50}};
    assert_int_equal(fill_box(above[0], above[1], 2, &eyes, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "between the heights 100 and 110"));
    assert_non_null(strstr(error.text, "there are some from"));
    const double beside[2][3] = {{1000, -90, 1000}, {1100, 90, 1100}};
    assert_int_equal(fill_box(beside[0], beside[1], 2, &eyes, &error), PROM_ERR_INPUT);
    assert_non_null(strstr(error.text, "no floor"));
    assert_int_equal(eyes.count, 0);
    prom_array_finish(&eyes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(paths_are_sampled_by_distance),
        cmocka_unit_test(any_spacing_will_do),
        cmocka_unit_test(a_resting_path_has_one_eye),
        cmocka_unit_test(eyes_stand_on_the_floors_of_a_box),
        cmocka_unit_test(a_box_may_hold_several_storeys),
        cmocka_unit_test(a_box_without_a_floor_says_so),
    };
    return cmocka_run_group_tests(tests, write_town, remove_town);
}
