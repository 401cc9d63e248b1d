// LINK: prom_traverse prom_benefit prom_metaobj
// The baselines: funkhouser, pixels, sse, feedback, and the scale of all that follow a rule.
#include "selector_fixture.h"
#include "traverse/evaluate.h"

#include <stdlib.h>

static const char *const ruled[] = {"pixels", "sse", "distance", "feedback"};
enum { RULED = sizeof ruled / sizeof *ruled };

// A cut as a selector gives it that has seen no other view.
static const prom_cut *fresh_run(bench *b, const char *name, double budget_ms)
{
    for (size_t i = 0; i < prom_selector_count(); i++) {
        if (strcmp(prom_selector_at(i)->name, name)) continue;
        prom_selector_destroy(b->selectors[i]);
        b->selectors[i] = prom_selector_create(name, &b->model, NULL);
    }
    return bench_run(b, name, budget_ms);
}

static void copy_entries(const prom_cut *from, prom_cut *to)
{
    to->entries.count = 0;
    for (size_t i = 0; i < from->entries.count; i++)
        prom_array_push(&to->entries, from->entries.data[i]);
}

static bool same_entries(const prom_cut *a, const prom_cut *b)
{
    if (a->entries.count != b->entries.count) return false;
    for (size_t i = 0; i < a->entries.count; i++)
        if (a->entries.data[i].node != b->entries.data[i].node ||
            a->entries.data[i].rep != b->entries.data[i].rep)
            return false;
    return true;
}

static void scales_are_heeded_by_those_that_say_so(void **state)
{
    (void)state;
    uint64_t seed = 1;
    bench b;
    random_model_options o = {.leaves = 300, .max_children = 8, .extent = 100};
    bench_init(&b, 2, &o);
    uint32_t changed[16] = {0};
    for (int look = 0; look < 10; look++) {
        bench_look(&b, &seed);
        for (size_t i = 0; i < prom_selector_count(); i++) {
            const char *name = prom_selector_at(i)->name;
            prom_cut other = {0};
            b.selection.rule_scale = 0;
            copy_entries(fresh_run(&b, name, 5), &other);
            b.selection.rule_scale = 1;
            assert_true(same_entries(&other, fresh_run(&b, name, 5)));
            b.selection.rule_scale = 0.25f;
            changed[i] += !same_entries(&other, fresh_run(&b, name, 5));
            prom_cut_finish(&other);
        }
    }
    for (size_t i = 0; i < prom_selector_count(); i++)
        assert_int_equal(changed[i] > 0, prom_selector_at(i)->has_scale);
    bench_finish(&b);
}

// ---- finer scales

// The entry of a cut that stands for a node, by itself or above it; NULL: none.
static const prom_cut_entry *entry_over(const bench *b, const prom_cut *cut, uint32_t node)
{
    for (uint32_t n = node; n != PROM_NONE; n = b->model.parent[n])
        for (size_t i = 0; i < cut->entries.count; i++)
            if (cut->entries.data[i].node == n) return &cut->entries.data[i];
    return NULL;
}

// No node of a finer cut lies above one of the coarser cut, and where both draw a node, its
// place in the prototype is no later.
static void assert_refines(const bench *b, const prom_cut *finer, const prom_cut *coarser)
{
    for (size_t i = 0; i < finer->entries.count; i++) {
        const prom_cut_entry *e = &finer->entries.data[i];
        const prom_cut_entry *over = entry_over(b, coarser, e->node);
        assert_non_null(over);
        if (over->node == e->node) assert_true(e->rep <= over->rep);
    }
}

typedef struct totals {
    double benefit, triangles;
} totals;

static void add_up(const bench *b, const prom_cut *cut, totals *t)
{
    t->benefit += cut->benefit;
    for (size_t i = 0; i < cut->entries.count; i++)
        t->triangles += b->model.reps[cut->entries.data[i].rep].triangles;
}

enum { SCALES = 9 };

// Each cut refines the one before it; sums over all views grow, though in a single one what is
// finer may show less (a cluster's own picture may be good).
static void finer_scales_refine(void **state)
{
    (void)state;
    uint64_t seed = 10;
    totals sums[RULED][SCALES] = {0};
    prom_cut coarser = {0};
    for (int round = 0; round < 60; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        o.artists = 0.0f; // of whose levels the coarser may have more triangles
        bench_init(&b, random_u64(&seed), &o);
        for (int look = 0; look < 3; look++) {
            bench_look(&b, &seed);
            for (int r = 0; r < RULED; r++)
                for (int s = 0; s < SCALES; s++) {
                    b.selection.rule_scale = exp2f((float)(s - SCALES / 2));
                    const prom_cut *cut = fresh_run(&b, ruled[r], 5);
                    assert_null(prom_cut_check(&b.model, &b.view, cut));
                    if (s) assert_refines(&b, cut, &coarser);
                    copy_entries(cut, &coarser);
                    add_up(&b, cut, &sums[r][s]);
                }
        }
        bench_finish(&b);
    }
    prom_cut_finish(&coarser);
    for (int r = 0; r < RULED; r++) {
        for (int s = 1; s < SCALES; s++) {
            assert_true(sums[r][s].benefit >= sums[r][s - 1].benefit);
            assert_true(sums[r][s].triangles >= sums[r][s - 1].triangles);
        }
        assert_true(sums[r][SCALES - 1].triangles > 2 * sums[r][0].triangles);
    }
}

// ---- the rules

// Calls `check` for the entries of many cuts of a selector at random scales, with the options
// that their nodes have in the view.
typedef void check_entry(const bench *b, const prom_eval *eval, const prom_cut_entry *entry);
static void check_entries(const char *name, uint64_t seed, check_entry *check)
{
    uint32_t seen = 0;
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        for (int look = 0; look < 4; look++) {
            bench_look(&b, &seed);
            b.selection.rule_scale = exp2f(random_between(&seed, -3, 3));
            const prom_cut *cut = bench_run(&b, name, 5);
            prom_eval_run(&eval, &b.selection, NULL, NULL);
            for (size_t i = 0; i < cut->entries.count; i++, seen++)
                check(&b, &eval, &cut->entries.data[i]);
        }
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
    assert_true(seen > 1000);
}

static const prom_representation *option_rep(const prom_eval *eval, uint32_t node, uint32_t i)
{
    return &eval->model->reps[eval->options[eval->nodes[node].first_option + i].rep];
}

static double error_px(const prom_eval *eval, uint32_t node, const prom_representation *rep)
{
    const prom_model *m = eval->model;
    double scale = (double)(m->radius[node] / m->prototypes[m->prototype[node]].radius);
    return (double)rep->error * scale * (double)eval->selection->view->f_px /
           (double)eval->nodes[node].nearest;
}

// What is drawn is good enough, or an object itself; what is coarser, or above it, is not.
static void is_the_first_below_the_error(const bench *b, const prom_eval *eval,
                                         const prom_cut_entry *e)
{
    double most = 16.0 / (double)b->selection.rule_scale;
    const prom_representation *drawn = &b->model.reps[e->rep];
    if (b->model.child_count[e->node])
        assert_true(error_px(eval, e->node, drawn) < most * 1.001);
    if (drawn->error > 0.0f) assert_true(error_px(eval, e->node, drawn) < most * 1.001);
    for (uint32_t i = eval->nodes[e->node].option_count; i-- > 0;) {
        const prom_representation *r = option_rep(eval, e->node, i);
        if (r == drawn) break;
        assert_true(error_px(eval, e->node, r) > most * 0.999);
    }
    for (uint32_t up = b->model.parent[e->node]; up != PROM_NONE; up = b->model.parent[up])
        for (uint32_t i = 0; i < eval->nodes[up].option_count; i++)
            assert_true(error_px(eval, up, option_rep(eval, up, i)) > most * 0.999);
}

static void sse_stops_at_the_first_that_is_good_enough(void **state)
{
    (void)state;
    check_entries("sse", 20, is_the_first_below_the_error);
}

// Twice the size allows four times the triangles, whatever is drawn.
static void has_triangles_for_its_size(const bench *b, const prom_eval *eval,
                                       const prom_cut_entry *e)
{
    const prom_eval_node *n = &eval->nodes[e->node];
    float size = n->size_px * b->selection.rule_scale, allowed = size * size / 4.0f;
    const prom_representation *drawn = &b->model.reps[e->rep];
    if (b->model.child_count[e->node]) assert_true(size <= PROM_SIZE_MAX_PX);
    for (uint32_t i = 0; i < n->option_count; i++) {
        const prom_representation *r = option_rep(eval, e->node, i);
        if ((float)drawn->triangles > allowed)
            assert_true(r->triangles >= drawn->triangles);
        else if (r < drawn)
            assert_true((float)r->triangles > allowed);
    }
}

static void pixels_gives_triangles_by_size(void **state)
{
    (void)state;
    check_entries("pixels", 21, has_triangles_for_its_size);
}

// ---- funkhouser

// The most that the leaves can show, and the least that they can cost.
static double most_of_leaves(const prom_eval *eval, double *least_ms)
{
    double most = 0.0;
    *least_ms = eval->fixed_ms;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        const prom_eval_node *n = &eval->nodes[eval->visited[i]];
        if (eval->model->child_count[eval->visited[i]] || !n->option_count) continue;
        float best = -INFINITY;
        for (uint32_t k = 0; k < n->option_count; k++)
            best = fmaxf(best, eval->options[n->first_option + k].benefit);
        most += (double)best;
        *least_ms += n->cmin;
    }
    return most;
}

static void funkhouser_fills_the_budget_with_leaves(void **state)
{
    (void)state;
    uint64_t seed = 30;
    uint32_t within = 0, over = 0;
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        for (int look = 0; look < 3; look++) {
            bench_look(&b, &seed);
            prom_eval_run(&eval, &b.selection, NULL, NULL);
            double least, most = most_of_leaves(&eval, &least), last = -INFINITY;
            double full = fmax(bench_run(&b, "full", 0)->predicted_ms, least);
            b.selection.certify = look > 0;
            for (int i = -3; i <= 20; i++) {
                double budget = least * (1.0 + 1e-6) + (full - least) * i / 20.0;
                const prom_cut *cut = bench_run(&b, "funkhouser", budget);
                assert_true(isfinite(cut->bound) || !b.selection.certify);
                assert_null(prom_cut_check(&b.model, &b.view, cut));
                for (size_t k = 0; k < cut->entries.count; k++)
                    assert_int_equal(b.model.child_count[cut->entries.data[k].node], 0);
                if (cut->feasible)
                    within++;
                else
                    assert_true(i < 0 && fabs(cut->predicted_ms - least) <= 1e-9 * least),
                        over++;
                // More of the budget buys the same steps and more.
                assert_true(cut->benefit >= last - 1e-6 * fabs(last));
                last = cut->benefit;
            }
            const prom_cut *cut = bench_run(&b, "funkhouser", INFINITY);
            assert_true(fabs(cut->benefit - most) <= 1e-5 * fabs(most) + 1e-6);
            assert_false(cut->limited);
        }
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
    assert_true(within > 1000 && over > 100);
}

// What did not fit was the step to the level of most value.
static void funkhouser_stops_at_the_best_value(void **state)
{
    (void)state;
    uint64_t seed = 31;
    uint32_t stopped = 0;
    for (int round = 0; round < 60; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        eval.any_mesh_hides = true;
        double budget = bench_run(&b, "full", 0)->predicted_ms * random_between(&seed, 0.2f, 1);
        const prom_cut *cut = bench_run(&b, "funkhouser", budget);
        prom_eval_run(&eval, &b.selection, NULL, NULL);
        double best = -INFINITY, change = 0.0;
        for (size_t i = 0; i < cut->entries.count; i++) {
            const prom_eval_node *n = &eval.nodes[cut->entries.data[i].node];
            uint32_t now = n->first_option;
            while (eval.options[now].rep != cut->entries.data[i].rep) now++;
            uint32_t next = now;
            while (next > n->first_option &&
                   !(eval.options[--next].benefit > eval.options[now].benefit)) {
            }
            if (!(eval.options[next].benefit > eval.options[now].benefit)) continue;
            double value = (double)eval.options[next].benefit / eval.options[next].cost;
            if (value <= best) continue;
            best = value, change = eval.options[next].cost - eval.options[now].cost;
        }
        assert_int_equal(cut->limited, isfinite(best));
        if (cut->limited) assert_true(cut->predicted_ms + change > budget * (1.0 - 1e-8));
        stopped += cut->limited;
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
    assert_true(stopped > 20);
}

// ---- feedback

// A device that takes `factor` times what is predicted.
typedef struct device {
    double factor, last_ms;
    uint32_t misses; // in the frames since they were last set to 0
    double sum_ms;
} device;

static void draw_frames(bench *b, device *d, double budget_ms, uint32_t frames)
{
    d->misses = 0;
    d->sum_ms = 0.0;
    for (uint32_t i = 0; i < frames; i++) {
        b->selection.measured_ms = d->last_ms;
        const prom_cut *cut = bench_run(b, "feedback", budget_ms);
        assert_null(prom_cut_check(&b->model, &b->view, cut));
        d->last_ms = d->factor * cut->predicted_ms;
        d->sum_ms += d->last_ms;
        d->misses += d->last_ms > budget_ms;
    }
}

// Predicted time of `pixels` at a scale.
static double ms_at(bench *b, float scale)
{
    b->selection.rule_scale = scale;
    double ms = bench_run(b, "pixels", 0)->predicted_ms;
    b->selection.rule_scale = 1;
    return ms;
}

// A view in which twice the load can be borne, and half of it leaves something to wish for.
static bool steerable(bench *b, double *budget_ms)
{
    double low = ms_at(b, 1.0f / 16), high = ms_at(b, 16);
    *budget_ms = 1.7 * fmax(2.5 * low, 0.5 * (low + high));
    return *budget_ms < 0.8 * 1.7 * high;
}

static void feedback_converges_and_recovers(void **state)
{
    (void)state;
    uint64_t seed = 40;
    uint32_t steered = 0, settled = 0, recovered = 0;
    double use = 0.0;
    for (int round = 0; round < 300 && steered < 40; round++) {
        bench b;
        random_model_options o = {.leaves = 400, .max_children = 8, .extent = 40};
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        double budget;
        if (steerable(&b, &budget)) {
            device d = {.factor = 1.7};
            draw_frames(&b, &d, budget, 60); // from wherever it starts
            draw_frames(&b, &d, budget, 60);
            settled += d.misses <= 3;
            use += d.sum_ms / 60 / budget;
            d.factor = 3.4;
            draw_frames(&b, &d, budget, 10);
            draw_frames(&b, &d, budget, 60);
            recovered += d.misses <= 3 && d.sum_ms < 60 * budget;
            steered++;
        }
        bench_finish(&b);
    }
    print_message("of %u views feedback settles in %u using %.0f %%, and recovers in %u\n",
                  steered, settled, 100 * use / steered, recovered);
    assert_int_equal(steered, 40);
    assert_true(settled >= 34 && recovered >= 34);
    assert_true(use / steered > 0.75 && use / steered < 0.95);
}

// Without a measured time nothing moves; with the same times the same cuts follow.
static void feedback_follows_what_it_is_told(void **state)
{
    (void)state;
    uint64_t seed = 41;
    bench a, b;
    random_model_options o = {.leaves = 300, .max_children = 8, .extent = 60};
    bench_init(&a, 7, &o);
    bench_init(&b, 7, &o);
    bench_look(&a, &seed);
    b.camera = a.camera, b.view = a.view;
    prom_cut first = {0};
    copy_entries(bench_run(&a, "feedback", 5), &first);
    for (int i = 0; i < 5; i++) assert_true(same_entries(bench_run(&a, "feedback", 5), &first));
    bench_run(&b, "feedback", 5);
    bool moved = false;
    for (int i = 0; i < 100; i++) {
        a.selection.measured_ms = b.selection.measured_ms = random_between(&seed, 0.1f, 20);
        const prom_cut *cut = bench_run(&a, "feedback", 5);
        assert_true(same_entries(cut, bench_run(&b, "feedback", 5)));
        moved = moved || !same_entries(cut, &first);
    }
    assert_true(moved);
    // Times without measure, and a budget of nothing, leave it where it can come back from.
    for (int i = 0; i < 100; i++) {
        a.selection.measured_ms = i % 2 ? 1e300 : 1e-300;
        assert_null(prom_cut_check(&a.model, &a.view, bench_run(&a, "feedback", i % 3)));
    }
    device d = {.factor = 1.7};
    a.selection.rule_scale = 0.5f; // which starts it anew
    a.selection.measured_ms = 0;
    b.selection.rule_scale = 0.5f;
    assert_true(same_entries(bench_run(&a, "feedback", 5), bench_run(&b, "pixels", 5)));
    draw_frames(&a, &d, 1e9, 60);
    b.selection.rule_scale = 0.5f * 32;
    assert_true(same_entries(bench_run(&a, "feedback", 5), bench_run(&b, "pixels", 5)));
    prom_cut_finish(&first);
    bench_finish(&a);
    bench_finish(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(scales_are_heeded_by_those_that_say_so),
        cmocka_unit_test(finer_scales_refine),
        cmocka_unit_test(sse_stops_at_the_first_that_is_good_enough),
        cmocka_unit_test(pixels_gives_triangles_by_size),
        cmocka_unit_test(funkhouser_fills_the_budget_with_leaves),
        cmocka_unit_test(funkhouser_stops_at_the_best_value),
        cmocka_unit_test(feedback_converges_and_recovers),
        cmocka_unit_test(feedback_follows_what_it_is_told),
    };
    return cmocka_run_group_tests_name("baselines", tests, NULL, NULL);
}
