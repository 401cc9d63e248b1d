// LINK: prom_metaobj
//
// Statistics of a run: percentiles by nearest rank, prediction errors.
#include "app/statistics.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define NEAR(a, b) assert_true(fabs((a) - (b)) < 1e-9)

static void percentiles_are_by_nearest_rank(void **state)
{
    (void)state;
    double values[200];
    for (int i = 0; i < 200; i++) values[i] = (i * 73) % 200 + 1; // 1..200, mixed
    prom_spread s = prom_spread_of(values, 200);
    NEAR(s.p50, 100);
    NEAR(s.p95, 190);
    NEAR(s.p99, 198);
    NEAR(s.max, 200);
    NEAR(s.mean, 100.5);
    NEAR(s.std, sqrt((200.0 * 200.0 - 1) / 12)); // of the uniform distribution on 1..n
}

static void one_frame_is_all_of_its_percentiles(void **state)
{
    (void)state;
    double value = 7;
    prom_spread s = prom_spread_of(&value, 1);
    NEAR(s.p50, 7);
    NEAR(s.p99, 7);
    NEAR(s.max, 7);
    NEAR(s.std, 0);
}

static void a_percentile_is_never_between_two_frames(void **state)
{
    (void)state;
    double values[3] = {30, 10, 20};
    prom_spread s = prom_spread_of(values, 3);
    NEAR(s.p50, 20); // rank 1.5 is raised to 2
    NEAR(s.p95, 30);
}

static void predictions_are_compared_with_the_drawing(void **state)
{
    (void)state;
    prom_frame_record records[3] = {
        {.frame_ms = 99, .draw_ms = 10, .predicted_ms = 12}, // 20 % over
        {.frame_ms = 99, .draw_ms = 10, .predicted_ms = 5},  // half: took twice as long
        {.frame_ms = 99, .draw_ms = 10, .predicted_ms = 0},  // no prediction
    };
    prom_run_statistics s = prom_run_statistics_of(records, 3);
    NEAR(s.mape, (0.2 + 0.5) / 2);
    NEAR(s.worst_under, 1.0);
}

static void comparisons_count_where_they_were_made(void **state)
{
    (void)state;
    prom_frame_record records[4] = {
        {.difference = {.found = PROM_COMPARE_HOLES, .holes = 0.25}},
        {.difference = {.found = PROM_COMPARE_ACCURACY, .accuracy = 0.5},
         .benefit_px = 30,
         .loss_px = 10},
        {.difference = {.accuracy = 0.1, .holes = 0.9}, .benefit_px = 1, .loss_px = 9},
        {.difference = {.found = PROM_COMPARE_HOLES | PROM_COMPARE_ACCURACY,
                        .accuracy = 0.75}}, // nothing in view
    };
    prom_run_statistics s = prom_run_statistics_of(records, 4);
    assert_int_equal(s.hole_frames, 2);
    NEAR(s.holes_mean, 0.125);
    NEAR(s.holes_max, 0.25);
    assert_int_equal(s.accuracy_frames, 2);
    NEAR(s.accuracy_mean, 0.625);
    NEAR(s.accuracy_min, 0.5);
    NEAR(s.predicted_accuracy, (0.75 + 1.0) / 2);
    s = prom_run_statistics_of(records + 2, 1);
    assert_int_equal(s.hole_frames + s.accuracy_frames + s.quality_frames, 0);
}

static void quality_is_of_the_compared_frames(void **state)
{
    (void)state;
    prom_frame_record records[4] = {
        {.difference = {.found = PROM_COMPARE_QUALITY,
                        .flip = 0.3,
                        .loss = 0.1,
                        .hidden_cost = 0.5,
                        .hidden_nodes = 0.25}},
        {.difference = {.found = PROM_COMPARE_HOLES, .flip = 9, .loss = 9}},
        {.difference = {.found = PROM_COMPARE_QUALITY | PROM_COMPARE_HOLES,
                        .flip = 0.1,
                        .loss = 0.3,
                        .hidden_cost = 0.25,
                        .hidden_nodes = 0.75}},
        {.difference = {.found = PROM_COMPARE_QUALITY, .flip = 0.2}},
    };
    prom_run_statistics s = prom_run_statistics_of(records, 4);
    assert_int_equal(s.quality_frames, 3);
    NEAR(s.flip.mean, 0.2);
    NEAR(s.flip.p95, 0.3);
    NEAR(s.loss_share, 0.4 / 3);
    NEAR(s.hidden_cost, 0.25);
    NEAR(s.hidden_nodes, 1.0 / 3);
}

static void ranks_correlate(void **state)
{
    (void)state;
    const double rising[5] = {1, 2, 3, 4, 5}, powers[5] = {-1e9, 0, 1e-9, 7, 1e30};
    const double falling[5] = {5, 4, 3, 2, 1};
    NEAR(prom_spearman(rising, powers, 5), 1);
    NEAR(prom_spearman(rising, falling, 5), -1);
    // Without ties 1 - 6 * sum d^2 / (n (n^2 - 1)); d = 1, 1, 0, 1, 1.
    const double mixed[5] = {2, 1, 3, 6, 4.5}, other[5] = {1, 2, 3, 4, 6};
    NEAR(prom_spearman(mixed, other, 5), 1 - 6.0 * (1 + 1 + 1 + 1) / (5 * 24));
}

// Ranks 1, 2.5, 2.5, 4 and 1, 3, 2, 4, whose Pearson correlation is 4.5 / sqrt(4.5 * 5).
static void ties_share_their_ranks(void **state)
{
    (void)state;
    const double x[4] = {10, 20, 20, 30}, y[4] = {1, 3, 2, 4};
    NEAR(prom_spearman(x, y, 4), 4.5 / sqrt(4.5 * 5));
    NEAR(prom_spearman(y, x, 4), 4.5 / sqrt(4.5 * 5));
    NEAR(prom_spearman(x, x, 4), 1);
    const double flat[4] = {7, 7, 7, 7};
    assert_true(isnan(prom_spearman(x, flat, 4)));
    assert_true(isnan(prom_spearman(x, y, 1)) && isnan(prom_spearman(x, y, 0)));
}

static void the_slope_goes_through_the_origin(void **state)
{
    (void)state;
    const double x[3] = {1, 2, -3}, y[3] = {2, 4, -6}, z[3] = {3, 4, -6};
    NEAR(prom_slope(x, y, 3), 2);
    NEAR(prom_slope(x, z, 3), (3.0 + 8 + 18) / 14);
    assert_true(isnan(prom_slope(x, y, 0)));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(percentiles_are_by_nearest_rank),
        cmocka_unit_test(one_frame_is_all_of_its_percentiles),
        cmocka_unit_test(a_percentile_is_never_between_two_frames),
        cmocka_unit_test(predictions_are_compared_with_the_drawing),
        cmocka_unit_test(comparisons_count_where_they_were_made),
        cmocka_unit_test(quality_is_of_the_compared_frames),
        cmocka_unit_test(ranks_correlate),
        cmocka_unit_test(ties_share_their_ranks),
        cmocka_unit_test(the_slope_goes_through_the_origin),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
