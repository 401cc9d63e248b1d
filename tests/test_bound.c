// LINK: prom_traverse prom_benefit prom_metaobj
// The bound against the optimum and against itself, and the heap under moving keys.
#include "random_model.h"
#include "selector_fixture.h"
#include "traverse/bound.h"
#include "traverse/heap.h"
#include "traverse/selectors.h"

static void look(bench *b, uint64_t *seed)
{
    random_camera_outside(&b->model, seed, &b->camera);
    prom_view_init(&b->view, &b->camera);
}

static random_model_options small_options(uint64_t *seed)
{
    return (random_model_options){.leaves = 8 + random_below(seed, 8),
                                  .max_children = 4,
                                  .extent = 10,
                                  .bare_clusters = 0.1f,
                                  .correlated = true};
}

// At any price to begin with and after any number of looks, more of which never loosen it.
static void the_bound_is_never_below_the_optimum(void **state)
{
    (void)state;
    uint64_t seed = 1;
    uint32_t tight = 0, count = 0;
    for (int round = 0; round < 300; round++) {
        bench b;
        random_model_options o = small_options(&seed);
        bench_init(&b, random_u64(&seed), &o);
        look(&b, &seed);
        double low = bench_run(&b, "coarsest", 0)->predicted_ms;
        double high = bench_run(&b, "full", 0)->predicted_ms;
        double budget = low + (high - low) * random_between(&seed, 0.01f, 1.0f);
        double optimum = bench_run(&b, "optimal", budget)->benefit;
        double slack = 1e-6 * (double)b.camera.width * (double)b.camera.height;
        prom_bound *bound = prom_bound_create(&b.model);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        for (int visible = 0; visible < 2; visible++) {
            prom_eval_run(&eval, &b.selection, visible ? prom_eval_open_visible : NULL, &eval);
            double least = prom_bound_find(bound, &eval, 0.0, 200);
            for (int k = 0; k < 6; k++) {
                double price = powf(10.0f, random_between(&seed, -2, 8)), last = INFINITY;
                for (unsigned looks = 1; looks < 200; looks = 2 * looks + 1) {
                    double found = prom_bound_find(bound, &eval, k ? price : 0.0, looks);
                    assert_true(found >= optimum - slack);
                    assert_true(found <= last);
                    last = found;
                }
                assert_true(fabs(last - least) <= 1e-9 * fabs(least)); // all ways lead there
            }
            tight += least - optimum <= slack;
            count++;
        }
        prom_eval_finish(&eval);
        prom_bound_destroy(bound);
        bench_finish(&b);
    }
    print_message("the bound is the optimum in %u of %u\n", tight, count);
}

static void the_ends_are_known(void **state)
{
    (void)state;
    uint64_t seed = 2;
    for (int round = 0; round < 50; round++) {
        bench b;
        random_model_options o = small_options(&seed);
        bench_init(&b, random_u64(&seed), &o);
        look(&b, &seed);
        b.selection.certify = true;
        double low = bench_run(&b, "coarsest", 0)->predicted_ms;
        double high = bench_run(&b, "full", 0)->predicted_ms;
        static const char *const names[] = {"greedy", "lagrange", "incremental"};
        for (size_t i = 0; i < 3; i++) {
            const prom_cut *cut = bench_run(&b, names[i], 0.9 * low);
            assert_false(cut->feasible);
            assert_true(cut->limited);
            assert_true(cut->bound == cut->cmin_benefit && prom_cut_gap(cut) == 0.0);
            cut = bench_run(&b, names[i], 2.0 * high);
            assert_true(cut->feasible);
            assert_false(cut->limited);
            // What stays closed may hold half a pixel each.
            assert_true(cut->bound - cut->benefit <= 0.5 * (double)b.model.tree_count);
            b.selection.certify = false;
            assert_true(isinf(bench_run(&b, names[i], high)->bound));
            assert_true(isnan(prom_cut_gap(bench_run(&b, names[i], high))));
            b.selection.certify = true;
        }
        bench_finish(&b);
    }
}

static void the_gap_is_between_0_and_1(void **state)
{
    (void)state;
    prom_cut cut = {.cmin_benefit = 10, .benefit = 40, .bound = 50};
    assert_float_equal(prom_cut_gap(&cut), 0.25, 1e-12);
    cut.benefit = 5;
    assert_float_equal(prom_cut_gap(&cut), 1.0, 0);
    cut.benefit = 60;
    assert_float_equal(prom_cut_gap(&cut), 0.0, 0);
    cut.bound = 10;
    assert_float_equal(prom_cut_gap(&cut), 0.0, 0);
    cut.bound = INFINITY;
    assert_true(isnan(prom_cut_gap(&cut)));
}

// Against a plain list: set, removed and taken at random.
static void keys_may_move(void **state)
{
    (void)state;
    enum { NODES = 40 };
    prom_heap_entry entries[NODES];
    uint32_t place[NODES] = {0};
    prom_heap heap = {.entries = entries, .place = place};
    double keys[NODES];
    bool in[NODES] = {0};
    uint64_t seed = 3;
    for (int step = 0; step < 20000; step++) {
        uint32_t node = random_below(&seed, NODES), first = NODES, count = 0;
        if (random_below(&seed, 3)) {
            in[node] = true;
            keys[node] = (double)random_below(&seed, 20);
            prom_heap_set(&heap, keys[node], node);
        } else {
            in[node] = false;
            prom_heap_remove(&heap, node);
        }
        for (uint32_t n = 0; n < NODES; n++) {
            if (!in[n]) continue;
            count++;
            if (first == NODES || keys[n] > keys[first]) first = n;
        }
        assert_int_equal(heap.count, count);
        if (!count || random_below(&seed, 5)) continue;
        prom_heap_entry top = prom_heap_pop(&heap);
        assert_true(top.node == first && top.key == keys[first]);
        in[first] = false;
    }
    prom_heap_clear(&heap);
    for (uint32_t n = 0; n < NODES; n++) assert_int_equal(place[n], 0);
}

// ---- staying with the last cut

// One bare cluster of many objects: each switches by itself.
static void no_more_switch_than_may(void **state)
{
    (void)state;
    uint64_t seed = 4;
    uint32_t least = UINT32_MAX, without = 0;
    for (int round = 0; round < 20; round++) {
        bench b;
        bench_init(&b, random_u64(&seed),
                   &(random_model_options){.leaves = 40,
                                           .max_children = 60,
                                           .extent = 10,
                                           .bare_clusters = 1.0f,
                                           .correlated = true});
        look(&b, &seed);
        static const char *const names[] = {"greedy", "lagrange", "incremental"};
        double low = bench_run(&b, "coarsest", 0)->predicted_ms;
        double high = bench_run(&b, "full", 0)->predicted_ms;
        for (size_t i = 0; i < 3; i++) {
            prom_last_cut last;
            prom_last_cut_init(&last, &b.model);
            b.selection.last = &last;
            b.selection.max_switches = 3;
            prom_last_cut_note(&last, bench_run(&b, names[i], low * (1.0 + 1e-6)));
            double before = 0.0;
            for (int frame = 0; frame < 30; frame++) {
                const prom_cut *cut = bench_run(&b, names[i], low + 0.5 * (high - low));
                assert_null(prom_cut_check(&b.model, &b.view, cut));
                assert_true(cut->feasible && cut->benefit >= before);
                before = cut->benefit;
                uint32_t switches = prom_last_cut_note(&last, cut).count;
                assert_true(switches <= 3);
                if (!frame) least = switches < least ? switches : least;
            }
            // It gets where it would be at once, but for what was bought on the way.
            b.selection.max_switches = 0;
            const prom_cut *free_cut = bench_run(&b, names[i], low + 0.5 * (high - low));
            assert_true(before >= 0.9 * free_cut->benefit);
            without += prom_last_cut_note(&last, free_cut).count;
            // A budget that demands it is heeded at once, whatever switches.
            b.selection.max_switches = 3;
            const prom_cut *cut = bench_run(&b, names[i], low * (1.0 + 1e-6));
            assert_true(cut->feasible);
            b.selection.last = NULL;
            prom_last_cut_finish(&last);
        }
        bench_finish(&b);
    }
    print_message("%u switches left after 30 frames\n", without);
    assert_true(least > 0);
}

// Anything may be asked for; cuts stay valid and within the budget.
static void kept_cuts_are_cuts(void **state)
{
    (void)state;
    uint64_t seed = 5;
    uint32_t with = 0, without = 0;
    for (int round = 0; round < 30; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        prom_last_cut last, other;
        prom_last_cut_init(&last, &b.model);
        prom_last_cut_init(&other, &b.model);
        b.selection.last = &last;
        bench_look(&b, &seed);
        for (int frame = 0; frame < 12; frame++) {
            if (frame % 4 == 3) bench_look(&b, &seed);
            for (int k = 0; k < 3; k++) b.camera.eye[k] += random_between(&seed, -0.3f, 0.3f);
            prom_view_init(&b.view, &b.camera);
            double low = bench_run(&b, "coarsest", 0)->predicted_ms;
            double high = bench_run(&b, "full", 0)->predicted_ms;
            double budget = low * (1.0 + 1e-6) + (high - low) * 0.3;
            b.selection.max_switches = 0;
            without += prom_last_cut_note(&other, bench_run(&b, "greedy", budget)).count;
            b.selection.max_switches = 4;
            bench_run(&b, "incremental", budget);
            const prom_cut *cut = bench_run(&b, "greedy", budget);
            const char *fault = prom_cut_check(&b.model, &b.view, cut);
            if (fault) fail_msg("%s", fault);
            assert_true(cut->feasible);
            with += prom_last_cut_note(&last, cut).count;
        }
        prom_last_cut_finish(&last);
        prom_last_cut_finish(&other);
        bench_finish(&b);
    }
    print_message("%u switches, %u with a cap of 4\n", without, with);
    assert_true(with < without);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_bound_is_never_below_the_optimum),
        cmocka_unit_test(the_ends_are_known),
        cmocka_unit_test(the_gap_is_between_0_and_1),
        cmocka_unit_test(keys_may_move),
        cmocka_unit_test(no_more_switch_than_may),
        cmocka_unit_test(kept_cuts_are_cuts),
    };
    return cmocka_run_group_tests_name("bound", tests, NULL, NULL);
}
