// LINK: prom_traverse
//
// How frames kept to their budget: misses and their runs, the frames that count, turns,
// quarters and the noise floor.
#include "app/budget_use.c"
#include "app/statistics.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#define NEAR(a, b) assert_true(fabs((a) - (b)) < 1e-9)
#define BUDGET 10.0

typedef struct run {
    prom_frame_record frames[400];
    prom_loop_result result;
} run;

// Frames of 8 ms, every one of them contested.
static void steady(run *r, size_t count)
{
    *r = (run){0};
    for (size_t i = 0; i < count; i++)
        r->frames[i] =
            (prom_frame_record){.frame_ms = 8, .fits = true, .limited = true, .gap = NAN};
    r->result.frames.data = r->frames;
    r->result.frames.count = count;
}

static void misses_are_frames_over_the_budget(void **state)
{
    (void)state;
    const double times[] = {9, 10, 11, 12, 13, 10, 14, 9};
    run r;
    steady(&r, 8);
    for (int i = 0; i < 8; i++) r.frames[i].frame_ms = times[i];
    prom_budget_use use = prom_budget_use_of(r.frames, 8, BUDGET, NULL);
    assert_int_equal(use.frames, 8);
    assert_int_equal(use.misses, 4); // a frame that takes the whole budget is none
    assert_int_equal(use.longest_run, 3);
    NEAR(use.miss_rate, 0.5);
    assert_true(use.rate_low > 0 && use.rate_low < 0.5 && use.rate_high > 0.5);
    NEAR(use.use, 88.0 / 8 / BUDGET);
    NEAR(use.overshoot, (0.1 + 0.2 + 0.3 + 0.4) / 4);
    NEAR(use.change_p99, 5); // from 14 to 9
}

static void frames_that_are_not_wanted_do_not_count(void **state)
{
    (void)state;
    run r;
    steady(&r, 6);
    // Two misses with one between that more time would not have made better.
    for (int i = 1; i < 4; i++) r.frames[i].frame_ms = 12;
    r.frames[2].limited = false;
    r.frames[5].fits = false;
    r.frames[5].frame_ms = 30;
    prom_budget_use use = prom_budget_use_of(r.frames, 6, BUDGET, prom_is_contested);
    assert_int_equal(use.frames, 4);
    assert_int_equal(use.misses, 2);
    assert_int_equal(use.longest_run, 1);
    NEAR(use.frame_ms.max, 12);
    NEAR(use.change_p99, 4); // 8 to 12 and back; 12 to 30 is not one of them
    for (int i = 0; i < 6; i++) r.frames[i].limited = false;
    use = prom_budget_use_of(r.frames, 6, BUDGET, prom_is_contested);
    assert_int_equal(use.frames + use.misses, 0);
    NEAR(use.use + use.miss_rate + use.frame_ms.mean + use.overshoot, 0);
}

static void quarters_share_the_misses_out(void **state)
{
    (void)state;
    run r;
    steady(&r, 43); // no multiple of four
    const int missed[] = {0, 10, 11, 33, 41, 42};
    for (int i = 0; i < 6; i++) r.frames[missed[i]].frame_ms = 11;
    prom_budget_report report = prom_budget_report_of(&r.result, BUDGET);
    assert_int_equal(report.quarter_misses[0], 2);
    assert_int_equal(report.quarter_misses[1], 1);
    assert_int_equal(report.quarter_misses[2], 0);
    assert_int_equal(report.quarter_misses[3], 3);
    uint32_t frames = 0;
    for (int i = 0; i < PROM_QUARTERS; i++) frames += report.quarter_frames[i];
    assert_int_equal(frames, 43);
}

static void turns_are_looked_at_from_their_frame_on(void **state)
{
    (void)state;
    run r;
    steady(&r, 400);
    r.frames[50].turned = r.frames[220].turned = r.frames[399].turned = true;
    // Before it, on it, the last one of its window, and the one after that.
    r.frames[49].frame_ms = r.frames[50].frame_ms = r.frames[149].frame_ms =
        r.frames[150].frame_ms = 11;
    r.frames[399].frame_ms = 11;
    prom_budget_report report = prom_budget_report_of(&r.result, BUDGET);
    assert_int_equal(report.turns, 3);
    assert_int_equal(report.most_after_turn, 2);
}

static void a_walk_as_even_as_its_floor_has_all_of_it(void **state)
{
    (void)state;
    run r;
    steady(&r, 200);
    double draws[200];
    for (int i = 0; i < 200; i++) r.frames[i].frame_ms = draws[i] = 7 + (i * 73) % 200 * 0.01;
    prom_budget_report report = prom_budget_report_of(&r.result, BUDGET);
    assert_int_equal(report.floor_draws, 0);
    assert_true(isnan(report.use_of_floor) && isnan(report.std_of_floor));
    r.result.floor.ms.data = draws;
    r.result.floor.ms.count = 200;
    report = prom_budget_report_of(&r.result, report.all.frame_ms.p99);
    NEAR(report.use_of_floor, 1);
    NEAR(report.std_of_floor, 1);
    // The same walk within a greater budget leaves some of it.
    report = prom_budget_report_of(&r.result, 2 * report.all.frame_ms.p99);
    NEAR(report.use_of_floor, 0.5);
    NEAR(draws[1], 7.73); // in their order
}

static void a_gap_counts_where_it_is_known(void **state)
{
    (void)state;
    run r;
    steady(&r, 10);
    prom_budget_report report = prom_budget_report_of(&r.result, BUDGET);
    assert_int_equal(report.gap.frames, 0);
    r.frames[3].gap = 0.25;
    r.frames[7].gap = 0.05;
    report = prom_budget_report_of(&r.result, BUDGET);
    assert_int_equal(report.gap.frames, 2);
    NEAR(report.gap.share.mean, 0.15);
    NEAR(report.gap.share.p99, 0.25);
    r.frames[7].fits = false;
    report = prom_budget_report_of(&r.result, BUDGET);
    assert_int_equal(report.contested_gap.frames, 1);
    NEAR(report.contested_gap.share.mean, 0.25);
}

static void every_cut_counts_in_the_hash_of_a_run(void **state)
{
    (void)state;
    run r;
    steady(&r, 3);
    for (uint64_t i = 0; i < 3; i++) r.frames[i].cut_hash = 100 + i;
    uint64_t hash = prom_budget_report_of(&r.result, BUDGET).cuts_hash;
    r.frames[0].frame_ms = 99; // what it took does not
    assert_true(hash == prom_budget_report_of(&r.result, BUDGET).cuts_hash);
    for (int i = 0; i < 3; i++) {
        r.frames[i].cut_hash ^= 1;
        assert_true(hash != prom_budget_report_of(&r.result, BUDGET).cuts_hash);
        r.frames[i].cut_hash ^= 1;
    }
    r.frames[0].cut_hash = 101, r.frames[1].cut_hash = 100; // in another order
    assert_true(hash != prom_budget_report_of(&r.result, BUDGET).cuts_hash);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(misses_are_frames_over_the_budget),
        cmocka_unit_test(frames_that_are_not_wanted_do_not_count),
        cmocka_unit_test(quarters_share_the_misses_out),
        cmocka_unit_test(turns_are_looked_at_from_their_frame_on),
        cmocka_unit_test(a_walk_as_even_as_its_floor_has_all_of_it),
        cmocka_unit_test(a_gap_counts_where_it_is_known),
        cmocka_unit_test(every_cut_counts_in_the_hash_of_a_run),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
