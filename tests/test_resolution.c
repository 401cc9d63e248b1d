// LINK: prom_traverse prom_metaobj
//
// The resolution as a choice: what frames cost at a scale, when another one is tried, and that
// it settles on the best one.
#include "traverse/resolution.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#define NEAR(a, b) assert_true(fabs((a) - (b)) < 1e-9)

static const prom_cost_model model = {.fixed_ms = 1,
                                      .draw_ms = 1e-3,
                                      .vertex_ms = 2e-5,
                                      .triangle_ms = 1e-4,
                                      .pixel_ms = {2e-6, 3e-6, 5e-6, 7e-6, 8e-6},
                                      .edge_ms = 1e-5,
                                      .hidden_edge_ms = 2e-6,
                                      .hidden_pixel_ms = 1e-6};

// ---- costs

// A picture of half the sides has a quarter of the pixels, and edges half as long.
static void a_scale_is_another_picture(void **state)
{
    (void)state;
    const prom_cost_features full = {.fixed = 1,
                                     .draws = 30,
                                     .vertices = 5000,
                                     .triangles = 9000,
                                     .pixels = {40e3, 300e3},
                                     .hidden = 80e3,
                                     .edges = 60e3,
                                     .hidden_edges = 9e3};
    prom_cost_features half = full;
    for (int i = 0; i < PROM_COST_KINDS; i++) half.pixels[i] /= 4;
    half.hidden /= 4;
    half.edges /= 2;
    half.hidden_edges /= 2;
    prom_cost_model scaled = prom_cost_at_scale(&model, 0.5, 0);
    NEAR(prom_cost_predict(&scaled, &full), prom_cost_predict(&model, &half));
    prom_cost_model charged = prom_cost_at_scale(&model, 0.5, 1e6);
    double up = 1e6 * model.pixel_ms[PROM_SHADE_TEXTURED];
    NEAR(prom_cost_predict(&charged, &full), prom_cost_predict(&model, &half) + up);
    prom_cost_model same = prom_cost_at_scale(&model, 1, 1e6);
    NEAR(prom_cost_predict(&same, &full), prom_cost_predict(&model, &full));
}

static void scales_end_at_the_least_one(void **state)
{
    (void)state;
    const double least[] = {1, 0.9, 0.84, 0.7, 0.5, 0.01};
    const unsigned counts[] = {1, 1, 2, 3, 5, 5};
    for (int i = 0; i < 6; i++) {
        prom_scaling s;
        prom_scaling_init(&s, least[i]);
        assert_int_equal(s.count, counts[i]);
        assert_true(s.scales[0].factor == 1);
        for (unsigned k = 1; k < s.count; k++)
            assert_true(s.scales[k].factor < s.scales[k - 1].factor);
    }
    uint32_t scaled[2];
    prom_scaled_size((const uint32_t[]){1280, 1}, 0.5, scaled);
    assert_true(scaled[0] == 640 && scaled[1] == 1);
}

// ---- choice

// What a selector gives at each scale: shares lost, and whether it is within the budget.
typedef struct offers {
    double loss[PROM_SCALES];
    bool feasible[PROM_SCALES];
} offers;

static prom_cut cut_of(const offers *o, unsigned i)
{
    return (prom_cut){.benefit = 1 - o->loss[i],
                      .loss = o->loss[i],
                      .predicted_ms = 20 - i,
                      .feasible = o->feasible[i]};
}

static prom_scaling scaling_with_losses(double step)
{
    prom_scaling s;
    prom_scaling_init(&s, 0.5);
    for (unsigned i = 0; i < s.count; i++) s.scales[i].loss = step * i;
    return s;
}

// One frame as a session does it; returns how often it selected.
static unsigned run_frame(prom_scaling *s, const offers *o)
{
    unsigned selections = 1;
    prom_cut cut = cut_of(o, s->at);
    do {
        unsigned tried = prom_scaling_try(s, &cut);
        if (tried == s->at) break;
        prom_cut other = cut_of(o, tried);
        selections++;
        if (!prom_scaling_decide(s, tried, &cut, &other)) break;
        cut = other;
    } while (!cut.feasible);
    return selections;
}

static unsigned run_frames(prom_scaling *s, const offers *o, int frames, unsigned *selections)
{
    unsigned changes = 0;
    for (int i = 0; i < frames; i++) {
        unsigned before = s->at;
        *selections += run_frame(s, o);
        changes += s->at != before;
    }
    return changes;
}

static const bool all_fit[PROM_SCALES] = {true, true, true, true, true};

static offers fitting(const double loss[PROM_SCALES])
{
    offers o;
    memcpy(o.loss, loss, sizeof o.loss);
    memcpy(o.feasible, all_fit, sizeof o.feasible);
    return o;
}

static void it_settles_on_the_best_scale(void **state)
{
    (void)state;
    const offers tight = fitting((double[]){0.6, 0.4, 0.2, 0.19, 0.18});
    const offers easy = fitting((double[]){0.05, 0.03, 0.02, 0.01, 0.01});
    prom_scaling s = scaling_with_losses(0.05);
    unsigned selections = 0;
    run_frames(&s, &tight, 400, &selections);
    assert_int_equal(s.at, 2);
    assert_true(selections < 460); // a trial every eighth frame at most
    assert_int_equal(run_frames(&s, &tight, 400, &selections), 0);
    run_frames(&s, &easy, 400, &selections);
    assert_int_equal(s.at, 0);
}

// Where a smaller scale cannot win, not even a trial is spent.
static void full_detail_is_left_alone(void **state)
{
    (void)state;
    const offers full = fitting((double[]){0, 0, 0, 0, 0});
    prom_scaling s = scaling_with_losses(0.03);
    unsigned selections = 0;
    assert_int_equal(run_frames(&s, &full, 200, &selections), 0);
    assert_int_equal(selections, 200);
}

// Below a feasible picture everything counts less: within one frame it gets there.
static void what_does_not_fit_is_scaled_at_once(void **state)
{
    (void)state;
    offers o = fitting((double[]){0.5, 0.5, 0.5, 0.5, 0.5});
    o.feasible[0] = o.feasible[1] = o.feasible[2] = false;
    prom_scaling s = scaling_with_losses(0.1);
    run_frame(&s, &o);
    assert_int_equal(s.at, 3);
    unsigned selections = 0;
    assert_int_equal(run_frames(&s, &o, 200, &selections), 0);
    memset(o.feasible, 0, sizeof o.feasible);
    run_frame(&s, &o);
    assert_int_equal(s.at, 4); // nothing fits: the cheapest
}

// Losses that jump about by less than what the change must bring change nothing; by more, the
// scale still stays for a while each time.
static void it_does_not_thrash(void **state)
{
    (void)state;
    prom_scaling s = scaling_with_losses(0.1);
    unsigned changes = 0, selections = 0;
    for (int i = 0; i < 3000; i++) {
        double noise = i % 2 ? 0.01 : -0.01;
        offers o = fitting((double[]){0.4 + noise, 0.3 - noise, 0.25, 0.2, 0.15});
        changes += run_frames(&s, &o, 1, &selections);
    }
    assert_int_equal(changes, 0);
    for (int i = 0; i < 3000; i++) {
        double swing = (i * 2654435761u >> 7 & 255) / 255.0;
        offers o = fitting((double[]){swing, 0.5, 1 - swing, 0.5, swing});
        changes += run_frames(&s, &o, 1, &selections);
    }
    assert_true(changes <= 3000 / 30 + 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_scale_is_another_picture),
        cmocka_unit_test(scales_end_at_the_least_one),
        cmocka_unit_test(it_settles_on_the_best_scale),
        cmocka_unit_test(full_detail_is_left_alone),
        cmocka_unit_test(what_does_not_fit_is_scaled_at_once),
        cmocka_unit_test(it_does_not_thrash),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
