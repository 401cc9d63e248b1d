// LINK: prom_benefit prom_metaobj
// Pooling of maps, and where pictures differ.
#include "benefit/pool.h"
#include "random_model.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { PIXELS = 9216 };

static void pooled_values_are_those_of_the_pixels(void **state)
{
    (void)state;
    const float map[10] = {0.5f, 0, 0.25f, 0, 1, 0, 0.125f, 0.125f, 0, 0};
    const prom_metric_class plain = {.name = "plain"}, squares = {.squares = true};
    prom_pooled p;
    prom_errors_pool(&plain, map, 10, NULL, NULL, &p);
    assert_int_equal(p.pixels, 10);
    assert_float_equal(p.mean, 0.2, 1e-9);
    assert_float_equal(p.weighted_median, 0.5, 0); // 1/8 + 1/8 + 1/4 + 1/2 = half of 2
    assert_float_equal(p.median, 0.0625, 1e-9);    // between 0 and 1/8
    assert_float_equal(p.p75, 0.21875, 1e-9);      // place 6.75: 3/4 from 1/8 to 1/4
    assert_float_equal(p.p95, 0.775, 1e-9);        // place 8.55
    assert_float_equal(p.p99, 0.955, 1e-9);        // place 8.91
    assert_float_equal(p.max, 1, 0);
    assert_float_equal(p.differing, 0.5, 1e-9);
    assert_float_equal(p.differing_mean, 0.4, 1e-9);
    prom_errors_pool(&squares, map, 10, NULL, NULL, &p);
    assert_float_equal(p.mean, sqrt(1.34375 / 10), 1e-9);
    assert_float_equal(p.differing_mean, sqrt(1.34375 / 5), 1e-9);
    assert_float_equal(p.p75, 0.21875, 1e-9);
}

static void pooling_keeps_to_the_footprint(void **state)
{
    (void)state;
    const float map[8] = {0.5f, 1, 0.25f, 0, 0.75f, 1, 0, 0.125f};
    const uint8_t footprint[8] = {1, 0, 7, 255, 1, 0, 0, 0}, none[8] = {0};
    const uint8_t differs[8] = {1, 1, 0, 0, 1, 0, 0, 1};
    const prom_metric_class plain = {.name = "plain"};
    prom_pooled p;
    prom_errors_pool(&plain, map, 8, footprint, differs, &p);
    assert_int_equal(p.pixels, 4);
    assert_float_equal(p.mean, 0.375, 1e-9);
    assert_float_equal(p.median, 0.375, 1e-9);
    assert_float_equal(p.weighted_median, 0.5, 1e-9); // 0 + 1/4 + 1/2 = half of 3/2
    assert_float_equal(p.max, 0.75, 1e-9);
    assert_float_equal(p.differing, 0.5, 1e-9);
    assert_float_equal(p.differing_mean, 0.625, 1e-9);
    prom_errors_pool(&plain, map, 8, none, NULL, &p);
    assert_int_equal(p.pixels, 0);
    assert_true(p.mean == 0 && p.max == 0 && p.differing == 0 && p.differing_mean == 0);
    prom_errors_pool(&plain, map + 3, 1, NULL, NULL, &p); // a single 0
    assert_true(p.pixels == 1 && p.mean == 0 && p.weighted_median == 0 && p.p99 == 0);
}

// The order of the values, as a plain search finds it.
static void percentiles_are_in_order(void **state)
{
    (void)state;
    static float map[PIXELS];
    const prom_metric_class plain = {.name = "plain"};
    uint64_t seed = 10;
    for (size_t count = 1; count < PIXELS; count = count * 3 + 1) {
        for (size_t i = 0; i < count; i++)
            map[i] = powf(random_unit(&seed), 1 + (float)random_below(&seed, 9));
        prom_pooled p;
        prom_errors_pool(&plain, map, count, NULL, NULL, &p);
        const double values[5] = {p.median, p.p75, p.p95, p.p99, p.max};
        const double shares[5] = {0.5, 0.75, 0.95, 0.99, 1};
        for (int k = 0; k < 5; k++) {
            size_t below = 0, up_to = 0;
            for (size_t i = 0; i < count; i++) {
                below += map[i] < values[k];
                up_to += map[i] <= values[k];
            }
            const double place = shares[k] * (double)(count - 1);
            assert_true((double)below <= place + 1);
            assert_true((double)up_to > place);
        }
    }
}

static void pictures_differ_where_their_colours_do(void **state)
{
    (void)state;
    const uint8_t a[] = {1, 2, 3, 4, 5, 6, 7, 8, 99, 99, 9, 9, 9, 9, 8, 8, 8, 8};
    const uint8_t b[] = {1, 2, 3, 9, 5, 6, 0, 8, 9, 9, 9, 9, 0, 8, 8, 8};
    const float c[] = {0.0f, 1, 2, 1e-30f, 0, 0}, d[] = {-0.0f, 1, 2, 0, 0, 0};
    uint8_t differs[4];
    // Of the rows of `a`, the last two bytes are not looked at.
    prom_picture_differs(&(prom_picture){2, 2, 4, false, a, 10},
                         &(prom_picture){2, 2, 4, false, b, 0}, differs);
    assert_memory_equal(differs, ((uint8_t[]){0, 1, 0, 1}), 4);
    prom_picture_differs(&(prom_picture){4, 1, 1, false, a, 0},
                         &(prom_picture){4, 1, 1, false, b, 0}, differs);
    assert_memory_equal(differs, ((uint8_t[]){0, 0, 0, 1}), 4);
    prom_picture_differs(&(prom_picture){2, 1, 3, true, c, 0},
                         &(prom_picture){2, 1, 3, true, d, 0}, differs);
    assert_memory_equal(differs, ((uint8_t[]){0, 1}), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pooled_values_are_those_of_the_pixels),
        cmocka_unit_test(pooling_keeps_to_the_footprint),
        cmocka_unit_test(percentiles_are_in_order),
        cmocka_unit_test(pictures_differ_where_their_colours_do),
    };
    return cmocka_run_group_tests_name("pool", tests, NULL, NULL);
}
