// LINK: prom_traverse prom_benefit prom_metaobj
// The guarantee on simulated machines and scenes, with fixed seeds; the interval of a rate.
#include "guarantee_simulation.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { RUNS = 20 };

static sim_run run; // too large for the stack

// Of several runs, each with noise of its own.
typedef struct totals {
    int misses, contested, longest, worst; // worst: misses of one run
    int quarters[4];
    double use; // mean
} totals;

static totals walk_often(const sim_case *c, int first_frame)
{
    totals t = {0};
    for (int r = 0; r < RUNS; r++) {
        sim_walk(c, (uint64_t)r * 7919u + 3, &run);
        int misses = sim_misses(&run, first_frame, SIM_FRAMES);
        t.misses += misses;
        t.contested += sim_contested(&run, first_frame, SIM_FRAMES);
        if (misses > t.worst) t.worst = misses;
        for (int q = 0; q < 4; q++)
            t.quarters[q] += sim_misses(&run, q * SIM_FRAMES / 4, (q + 1) * SIM_FRAMES / 4);
        if (sim_longest(&run) > t.longest) t.longest = sim_longest(&run);
        t.use += sim_use(&run, first_frame, SIM_FRAMES) / RUNS;
    }
    return t;
}

// No more misses than accepted in all, in no quarter many more, few in any run, hardly ever two
// in a row; and of the budget at least `use` of what a fixed frame could have.
static void expect_kept(const sim_case *c, double use)
{
    totals t = walk_often(c, 0);
    double rate = c->miss_rate > 0 ? c->miss_rate : PROM_MISS_RATE;
    assert_true(t.contested > RUNS * SIM_FRAMES / 3);
    assert_true(t.misses <= rate * t.contested);
    assert_true(t.misses > 0.1 * rate * t.contested);
    double low, high;
    prom_miss_interval((uint32_t)t.worst, (uint32_t)(t.contested / RUNS), &low, &high);
    assert_true(low <= rate);
    for (int q = 0; q < 4; q++)
        assert_true(t.quarters[q] <= 2.5 * rate * RUNS * SIM_FRAMES / 4);
    if (rate <= PROM_MISS_RATE) assert_true(t.longest <= 3);
    assert_true(t.use >= use * sim_fixed_use(c));
}

static void noise_is_covered_and_not_more(void **state)
{
    (void)state;
    expect_kept(&(sim_case){.noise = 1.17}, 0.92);
    expect_kept(&(sim_case){.noise = 1.5}, 0.86);
    expect_kept(&(sim_case){.noise = 1.17, .miss_rate = 0.1}, 0.93);
    expect_kept(&(sim_case){.noise = 1.17, .stall_ms = 4}, 0.9);
    expect_kept(&(sim_case){.noise = 1.17, .rare_stall_ms = 30}, 0.85);
}

static void another_pace_than_calibrated_is_found(void **state)
{
    (void)state;
    expect_kept(&(sim_case){.noise = 1.17, .start = 1.5}, 0.92);
    expect_kept(&(sim_case){.noise = 1.17, .start = 0.7}, 0.92);
    expect_kept(&(sim_case){.noise = 1.17, .drift = 0.3}, 0.9);
    expect_kept(&(sim_case){.noise = 1.17, .wander = 0.1}, 0.86);
}

// Others use the machine again and again: that is noise, if a loud one.
static void gusts_become_noise(void **state)
{
    (void)state;
    totals soft = walk_often(&(sim_case){.noise = 1.17, .gusts = 1.5}, SIM_FRAMES / 4);
    totals hard = walk_often(&(sim_case){.noise = 1.3, .gusts = 3}, SIM_FRAMES / 4);
    assert_true(soft.misses <= 0.01 * soft.contested && hard.misses <= 0.01 * hard.contested);
    assert_true(soft.use > 0.5 && hard.use > 0.25);
}

// The mix of the frames changes while pixels cost more than calibrated, and geometry less.
static void wrong_terms_are_put_right(void **state)
{
    (void)state;
    sim_case wrong = {.noise = 1.17, .wrong_terms = 1.5};
    expect_kept(&wrong, 0.9);
    sim_walk(&wrong, 5, &run);
    const double *f = run.guarantee.terms.factors;
    // Common to all is the scale's: the ratio of the two is what is learnt.
    double ratio = f[PROM_TERM_PIXELS] / f[PROM_TERM_GEOMETRY];
    assert_true(ratio > 1.8 && ratio < 2.8); // truly 2.25
    const prom_cost_model *cost = prom_guarantee_cost(&run.guarantee);
    assert_true(cost->fixed_ms == f[PROM_TERM_FIXED] * 1);

    // Where they are right they stay about right.
    sim_walk(&(sim_case){.noise = 1.17}, 5, &run);
    for (int t = 0; t < PROM_TERMS; t++) assert_true(f[t] > 0.8 && f[t] < 1.25);
}

// At most 8 misses in the 30 frames after the load starts, 3 in the next 100, and the budget
// is used again when it ends.
static void load_is_followed(void **state)
{
    (void)state;
    const sim_case cases[] = {{.noise = 1.17, .load = 2},
                              {.noise = 1.17, .load = 2, .load_noise = 1.5},
                              {.noise = 1.3, .load = 1.4, .load_noise = 1.5}};
    int start = SIM_FRAMES / 4, end = 3 * SIM_FRAMES / 4;
    for (size_t i = 0; i < 3; i++) {
        double use = 0;
        for (int r = 0; r < RUNS; r++) {
            sim_walk(&cases[i], (uint64_t)r * 104729u + 1, &run);
            assert_true(run.frames[start].miss || i == 2); // the load was felt
            assert_true(sim_misses(&run, start, start + 30) <= 6);
            assert_true(sim_misses(&run, start + 30, start + 130) <= 3);
            assert_true(sim_use(&run, start + 30, end) > 0.4);
            assert_true(sim_use(&run, end + 30, SIM_FRAMES) > 0.5);
            use += sim_use(&run, start + 30, end) / RUNS;
        }
        assert_true(use > 0.55);
    }
}

static void turns_are_followed(void **state)
{
    (void)state;
    const sim_case cases[] = {{.noise = 1.17, .turn = 1.25}, {.noise = 1.17, .turn = 0.8}};
    for (size_t i = 0; i < 2; i++) {
        expect_kept(&cases[i], 0.87);
        for (int r = 0; r < RUNS; r++) {
            sim_walk(&cases[i], (uint64_t)r * 15485863u + 1, &run);
            for (int t = SIM_TURN_PERIOD; t < SIM_FRAMES; t += SIM_TURN_PERIOD)
                assert_true(sim_misses(&run, t, t + 100) <= 4);
        }
    }
}

static void easy_views_do_not_wind_the_margin_down(void **state)
{
    (void)state;
    sim_case easy = {.noise = 1.17, .easy = 0.3};
    expect_kept(&easy, 0.9);
    int after = 0;
    for (int r = 0; r < RUNS; r++) {
        sim_walk(&easy, (uint64_t)r + 1, &run);
        assert_true(run.frames[199].margin >= run.frames[10].margin * 0.9);
        after += sim_misses(&run, 200, 250);
    }
    assert_true(after <= 0.02 * RUNS * 50);
}

static void what_cannot_be_kept_does_not_wind_it_up(void **state)
{
    (void)state;
    sim_case hard = {.noise = 1.17, .hard = 1.2};
    expect_kept(&hard, 0.92);
    double margin = run.guarantee.margin;
    sim_walk(&(sim_case){.noise = 1.17}, (RUNS - 1) * 7919u + 3, &run);
    assert_true(fabs(margin - run.guarantee.margin) < 0.05);
}

// ---- by hand

static prom_guarantee begun(double budget_ms, double margin, bool frozen)
{
    prom_guarantee g;
    prom_cost_model model = {.margin = margin};
    prom_guarantee_options options = {budget_ms, PROM_MISS_RATE, frozen};
    prom_guarantee_init(&g, &model, &options);
    return g;
}

static void feed(prom_guarantee *g, double predicted_ms, double draw_ms, double other_ms)
{
    prom_guarantee_frame frame = {.draw_ms = draw_ms, .other_ms = other_ms};
    for (int t = 0; t < PROM_TERMS; t++) frame.terms_ms[t] = predicted_ms / PROM_TERMS;
    prom_guarantee_feed(g, &frame);
}

static void the_first_frame_is_careful(void **state)
{
    (void)state;
    prom_guarantee g = begun(20, 0.1, false);
    double allowed = prom_guarantee_allowed(&g);
    assert_true(allowed < 18 && allowed > 12);
}

static void the_scale_follows_in_three_frames_and_ignores_one(void **state)
{
    (void)state;
    prom_guarantee g = begun(20, 0.1, false);
    for (int i = 0; i < 30; i++) feed(&g, 10, 10, 1);
    assert_true(fabs(g.scale - 1) < 1e-6 && fabs(g.charge_ms - 1) < 1e-6);
    double margin = g.margin;
    feed(&g, 10, 40, 1); // stalled
    assert_true(fabs(g.scale - 1) < 1e-6);
    feed(&g, 10, 10, 1);
    assert_true(fabs(g.scale - 1) < 1e-6 && fabs(g.margin - margin) < 0.05);
    for (int i = 0; i < 2; i++) feed(&g, 10, 20, 1);
    assert_true(fabs(g.scale - 2) < 1e-6);
    double allowed = prom_guarantee_allowed(&g);
    assert_true(prom_guarantee_expected(&g, allowed) + 1 <= 20);
    for (int i = 0; i < 2; i++) feed(&g, 10, 10, 1);
    assert_true(fabs(g.scale - 1) < 1e-6);
}

static void other_work_is_charged(void **state)
{
    (void)state;
    prom_guarantee g = begun(20, 0.1, false), idle = g;
    for (int i = 0; i < 40; i++) feed(&g, 10, 10, 5), feed(&idle, 10, 10, 0);
    assert_true(fabs(prom_guarantee_allowed(&idle) / prom_guarantee_allowed(&g) - 20.0 / 15) <
                1e-3);
    // A slow selection makes a late frame too.
    double excess = g.excess, allowed = prom_guarantee_allowed(&g);
    feed(&g, allowed, allowed, 15);
    assert_true(g.excess > excess + 0.9);
}

static void the_least_budget_is_the_one_that_allows(void **state)
{
    (void)state;
    prom_guarantee g = begun(20, 0.1, false);
    for (int i = 0; i < 40; i++) feed(&g, 10, 13, 2);
    double least = prom_guarantee_least_budget(&g, 31);
    prom_guarantee_set_budget(&g, least);
    assert_true(fabs(prom_guarantee_allowed(&g) - 31) < 1e-9);
    prom_guarantee_set_budget(&g, 1);
    assert_true(prom_guarantee_allowed(&g) == 0);
}

static void frames_set_aside_move_the_scale_alone(void **state)
{
    (void)state;
    prom_guarantee g = begun(20, 0.1, false);
    for (int i = 0; i < 30; i++) feed(&g, 10, 10, 1);
    uint64_t scored = g.scored;
    double excess = g.excess;
    prom_guarantee_frame frame = {.terms_ms = {10, 10, 0, 0}, .draw_ms = 60, .aside = true};
    for (int i = 0; i < 5; i++) prom_guarantee_feed(&g, &frame);
    assert_true(g.scored == scored && g.excess == excess && g.scale > 2);
}

// However many frames of one long disturbance were late, the budget is used again soon after.
static void a_long_disturbance_is_forgotten(void **state)
{
    (void)state;
    uint64_t seed = 1;
    prom_guarantee g = begun(20, 0.1, false);
    for (int i = 0; i < 400; i++) feed(&g, 20, 20 * sim_noise(1.17, &seed), 0);
    double margin = g.margin;
    for (int i = 0; i < 60; i++) feed(&g, 20, 20 * sim_noise(4, &seed), 0);
    assert_true(g.margin > margin + 0.2);
    for (int i = 0; i < 400; i++) feed(&g, 20, 20 * sim_noise(1.17, &seed), 0);
    assert_true(g.margin < margin + 0.05);
}

static void frozen_learns_nothing(void **state)
{
    (void)state;
    prom_guarantee g = begun(20, 0.1, true);
    assert_true(fabs(prom_guarantee_allowed(&g) - 18) < 1e-9);
    prom_guarantee before;
    memcpy(&before, &g, sizeof g);
    for (int i = 0; i < 50; i++) feed(&g, 10, 10 + i, i);
    assert_memory_equal(&g, &before, sizeof g);
}

static void nonsense_is_not_learnt_from(void **state)
{
    (void)state;
    prom_guarantee g = begun(20, 0.1, false), before;
    memcpy(&before, &g, sizeof g);
    const double bad[] = {0, -1, NAN, INFINITY};
    for (size_t i = 0; i < 4; i++) feed(&g, bad[i], 10, 1), feed(&g, 10, bad[i], 1);
    for (size_t i = 1; i < 4; i++) feed(&g, 10, 10, bad[i]);
    assert_memory_equal(&g, &before, sizeof g);
    // What is wild is bounded.
    uint64_t seed = 1;
    for (int i = 0; i < 3000; i++) {
        prom_guarantee_frame frame = {.draw_ms = exp(40 * sim_uniform(&seed) - 20),
                                      .other_ms = exp(20 * sim_uniform(&seed) - 10)};
        for (int t = 0; t < PROM_TERMS; t++)
            frame.terms_ms[t] = sim_uniform(&seed) < 0.3 ? 0 : exp(20 * sim_uniform(&seed));
        prom_guarantee_feed(&g, &frame);
        assert_true(g.scale >= 0.1 && g.scale <= 10 && g.margin >= 0 && g.margin <= 0.75);
        assert_true(prom_guarantee_allowed(&g) >= 0);
        for (int t = 0; t < PROM_TERMS; t++)
            assert_true(g.terms.factors[t] >= 0.5 && g.terms.factors[t] <= 2);
    }
}

// Values of the exact interval: 0 of n is [0, 1 - 0.025^(1/n)]; the others were checked
// in exact arithmetic: each tail has 0.025.
static void the_interval_is_the_exact_one(void **state)
{
    (void)state;
    const double known[][4] = {{0, 300, 0, 1 - pow(0.025, 1.0 / 300)},
                               {3, 300, 0.002066, 0.028946},
                               {5, 10, 0.187086, 0.812914},
                               {10, 10, pow(0.025, 0.1), 1},
                               {0, 1, 0, 0.975}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++) {
        double low, high;
        prom_miss_interval((uint32_t)known[i][0], (uint32_t)known[i][1], &low, &high);
        assert_true(fabs(low - known[i][2]) < 2e-6 && fabs(high - known[i][3]) < 2e-6);
    }
    // Of many the normal one: 1 % of a million within 1.96 standard deviations.
    double low, high, deviation = sqrt(0.01 * 0.99 / 1e6);
    prom_miss_interval(10000, 1000000, &low, &high);
    assert_true(fabs((0.01 - low) / deviation - 1.96) < 0.02);
    assert_true(fabs((high - 0.01) / deviation - 1.96) < 0.02);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noise_is_covered_and_not_more),
        cmocka_unit_test(another_pace_than_calibrated_is_found),
        cmocka_unit_test(gusts_become_noise),
        cmocka_unit_test(wrong_terms_are_put_right),
        cmocka_unit_test(load_is_followed),
        cmocka_unit_test(turns_are_followed),
        cmocka_unit_test(easy_views_do_not_wind_the_margin_down),
        cmocka_unit_test(what_cannot_be_kept_does_not_wind_it_up),
        cmocka_unit_test(the_first_frame_is_careful),
        cmocka_unit_test(the_scale_follows_in_three_frames_and_ignores_one),
        cmocka_unit_test(other_work_is_charged),
        cmocka_unit_test(the_least_budget_is_the_one_that_allows),
        cmocka_unit_test(frames_set_aside_move_the_scale_alone),
        cmocka_unit_test(a_long_disturbance_is_forgotten),
        cmocka_unit_test(frozen_learns_nothing),
        cmocka_unit_test(nonsense_is_not_learnt_from),
        cmocka_unit_test(the_interval_is_the_exact_one),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
