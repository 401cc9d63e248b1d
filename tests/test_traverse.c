// LINK: prom_traverse prom_benefit prom_metaobj
// The selectors on random trees and cameras.
#include "selector_fixture.h"
#include "traverse/evaluate.h"

#include <stdlib.h>

// ---- selectors

static bool same_cut(const prom_cut *a, const prom_cut *b)
{
    if (a->entries.count != b->entries.count || a->predicted_ms != b->predicted_ms)
        return false;
    for (size_t i = 0; i < a->entries.count; i++) {
        const prom_cut_entry *x = &a->entries.data[i], *y = &b->entries.data[i];
        if (x->node != y->node || x->rep != y->rep || x->depth != y->depth) return false;
    }
    return true;
}

static int by_node(const void *a, const void *b)
{
    const prom_cut_entry *x = a, *y = b;
    return x->node < y->node ? -1 : x->node > y->node;
}

// The same entries in any order.
static bool same_entries(prom_cut *a, prom_cut *b)
{
    if (a->entries.count != b->entries.count) return false;
    qsort(a->entries.data, a->entries.count, sizeof *a->entries.data, by_node);
    qsort(b->entries.data, b->entries.count, sizeof *b->entries.data, by_node);
    for (size_t i = 0; i < a->entries.count; i++)
        if (a->entries.data[i].node != b->entries.data[i].node ||
            a->entries.data[i].rep != b->entries.data[i].rep)
            return false;
    return true;
}

// Validity (DESIGN 5): boxes only from outside, not near, and up to their size.
static void check_validity(const prom_model *m, const prom_view *view, const prom_cut *cut)
{
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        prom_appearance a;
        prom_view_appearance(view, m, e->node, &a);
        if (m->reps[e->rep].kind != PROM_REP_MESH) {
            assert_false(a.near_case);
            assert_true(a.size_px <= m->reps[e->rep].max_size_px);
        }
        if (a.near_case) assert_int_equal(m->child_count[e->node], 0);
        assert_float_equal(e->fade, 1.0f, 0.0f);
        assert_int_equal(e->fade_from, PROM_NONE);
    }
}

static void every_cut_covers_each_leaf_once(void **state)
{
    (void)state;
    uint64_t seed = 10;
    for (int round = 0; round < 80; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        for (int look = 0; look < 5; look++) {
            bench_look(&b, &seed);
            double low = bench_run(&b, "coarsest", 0)->predicted_ms;
            double high = bench_run(&b, "full", 0)->predicted_ms;
            double budget = low + (high - low) * random_between(&seed, -0.2f, 1.2f);
            for (size_t i = 0; i < prom_selector_count(); i++) {
                prom_cut *cut = bench_run(&b, prom_selector_at(i)->name, budget);
                const char *fault = prom_cut_check(&b.model, &b.view, cut);
                if (fault) fail_msg("%s: %s", prom_selector_at(i)->name, fault);
                check_validity(&b.model, &b.view, cut);
                assert_int_equal(cut->feasible, cut->predicted_ms <= budget);
                double worth = cut->benefit + cut->loss;
                assert_true(worth >= 0.0 && cut->loss >= -1e-3 * worth);
            }
        }
        bench_finish(&b);
    }
}

static void the_check_finds_broken_cuts(void **state)
{
    (void)state;
    bench b;
    uint64_t seed = 11;
    bench_init(&b, 12, &(random_model_options){.leaves = 60, .max_children = 6, .extent = 30});
    do bench_look(&b, &seed);
    while (bench_run(&b, "full", 0)->entries.count < 5);
    prom_cut *cut = bench_run(&b, "full", 0);
    prom_cut_entry entry = cut->entries.data[cut->entries.count - 1];
    cut->entries.count--;
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    prom_array_push(&cut->entries, entry);
    assert_null(prom_cut_check(&b.model, &b.view, cut));
    prom_array_push(&cut->entries, entry);
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    cut->entries.data[cut->entries.count - 1].node = b.model.parent[entry.node];
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    cut->entries.count--;
    cut->entries.data[0].rep = b.model.rep_count;
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    bench_finish(&b);
}

static void budgets_are_kept(void **state)
{
    (void)state;
    uint64_t seed = 20;
    uint32_t kept = 0, over = 0;
    for (int round = 0; round < 60; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        for (int look = 0; look < 6; look++) {
            bench_look(&b, &seed);
            double low = bench_run(&b, "coarsest", 0)->predicted_ms;
            double high = bench_run(&b, "full", 0)->predicted_ms;
            double budget = low + (high - low) * random_between(&seed, -0.3f, 0.8f);
            prom_cut *greedy = bench_run(&b, "greedy", budget);
            if (greedy->feasible)
                kept++;
            else
                assert_true(same_entries(greedy, bench_run(&b, "coarsest", budget)));
            assert_true(greedy->feasible || low > budget * (1.0 - 1e-8));
            assert_true(fabs(greedy->cmin_ms - low) <= 1e-9 * low);

            prom_cut *meta = bench_run(&b, "meta", budget);
            // Of all nodes in view; `coarsest` goes over fewer.
            double least = meta->cmin_ms;
            assert_true(least <= low * (1.0 + 1e-9));
            bool feasible = meta->feasible;
            double spent = meta->predicted_ms;
            over += !feasible;
            // A budget of nothing buys no improvement: that is the initial cut, the only one
            // that may be over a budget.
            double initial = bench_run(&b, "meta", 0.0)->predicted_ms;
            assert_true(initial >= least * (1.0 - 1e-9));
            assert_true(feasible || fabs(spent - initial) <= 1e-9 * initial);
            assert_true(feasible || initial > budget * (1.0 - 1e-8));
        }
        bench_finish(&b);
    }
    assert_true(kept > 100 && over > 30);
}

static void greedy_gains_with_budget(void **state)
{
    (void)state;
    uint64_t seed = 30;
    double lost = 0.0, total = 0.0;
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        for (int look = 0; look < 4; look++) {
            bench_look(&b, &seed);
            prom_cut *coarsest = bench_run(&b, "coarsest", 0);
            double low = coarsest->predicted_ms, last = coarsest->benefit;
            prom_cut *full = bench_run(&b, "full", 0);
            double high = full->predicted_ms, most = full->benefit;
            for (int i = 0; i <= 24; i++) {
                double budget = low * (1.0 + 1e-6) + (high - low) * i / 20.0;
                double benefit = bench_run(&b, "greedy", budget)->benefit;
                assert_true(benefit >= last - 1e-6 * fabs(last));
                last = benefit;
            }
            // With more than full detail costs, what is left closed shows less than its pixels:
            // a node of 2 px, or one that loses half a pixel.
            const prom_cut *greedy = bench_run(&b, "greedy", 1.2 * high);
            assert_true(most - greedy->benefit <= 3.2 * (double)greedy->entries.count);
            lost += most - greedy->benefit;
            total += most;
        }
        bench_finish(&b);
    }
    print_message("greedy with time enough misses %.4f %% of full detail\n",
                  100 * lost / total);
    assert_true(lost <= 0.01 * total);
}

static void equal_inputs_give_equal_cuts(void **state)
{
    (void)state;
    uint64_t seed = 40;
    for (int round = 0; round < 20; round++) {
        bench a, b;
        random_model_options o = options_of(&seed);
        uint64_t model_seed = random_u64(&seed);
        bench_init(&a, model_seed, &o);
        bench_init(&b, model_seed, &o);
        for (int look = 0; look < 6; look++) {
            uint64_t look_seed = random_u64(&seed), other = look_seed;
            bench_look(&a, &look_seed);
            bench_look(&b, &other);
            double budget = random_between(&seed, 0, 20);
            for (size_t i = 0; i < prom_selector_count(); i++) {
                const char *name = prom_selector_at(i)->name;
                assert_true(same_cut(bench_run(&a, name, budget), bench_run(&b, name, budget)));
            }
        }
        bench_finish(&a);
        bench_finish(&b);
    }
}

static void unknown_selectors_are_refused(void **state)
{
    (void)state;
    prom_model m;
    prom_error error = {0};
    random_model(&m, 1, &(random_model_options){.leaves = 3, .max_children = 2, .extent = 9});
    assert_null(prom_selector_create("best", &m, &error));
    assert_int_equal(error.status, PROM_ERR_USAGE);
    assert_non_null(strstr(error.text, "'best'"));
    for (size_t i = 0; i < prom_selector_count(); i++)
        assert_non_null(strstr(error.text, prom_selector_at(i)->name));
    prom_model_finish(&m);
}

// ---- the optimum on small trees

typedef struct pareto {
    double cost, benefit;
} pareto;

typedef PROM_ARRAY(pareto) frontier;

static int by_cost(const void *a, const void *b)
{
    const pareto *x = a, *y = b;
    if (x->cost != y->cost) return x->cost < y->cost ? -1 : 1;
    return x->benefit > y->benefit ? -1 : x->benefit < y->benefit;
}

static void prune(frontier *f)
{
    size_t kept = 0;
    qsort(f->data, f->count, sizeof *f->data, by_cost);
    for (size_t i = 0; i < f->count; i++)
        if (!kept || f->data[i].benefit > f->data[kept - 1].benefit)
            f->data[kept++] = f->data[i];
    f->count = kept;
}

// All undominated (cost, benefit) pairs that cuts of a subtree can have: exact.
static void frontier_of(const prom_eval *eval, uint32_t node, frontier *out)
{
    const prom_model *m = eval->model;
    const prom_eval_node *n = &eval->nodes[node];
    if (n->expanded) {
        frontier sum = {0}, child = {0}, next = {0};
        prom_array_push(&sum, (pareto){0, 0});
        for (uint32_t c = 0; c < m->child_count[node]; c++) {
            uint32_t id = m->first_child[node] + c;
            if (eval->nodes[id].culled) continue;
            child.count = next.count = 0;
            frontier_of(eval, id, &child);
            for (size_t i = 0; i < sum.count; i++)
                for (size_t j = 0; j < child.count; j++)
                    prom_array_push(&next,
                                    (pareto){sum.data[i].cost + child.data[j].cost,
                                             sum.data[i].benefit + child.data[j].benefit});
            prune(&next);
            frontier swap = sum;
            sum = next;
            next = swap;
        }
        for (size_t i = 0; i < sum.count; i++) prom_array_push(out, sum.data[i]);
        prom_array_finish(&sum);
        prom_array_finish(&child);
        prom_array_finish(&next);
    }
    for (uint32_t i = 0; i < n->option_count; i++) {
        const prom_option *o = &eval->options[n->first_option + i];
        prom_array_push(out, (pareto){o->cost, o->benefit});
    }
    prune(out);
}

static void greedy_comes_near_the_optimum(void **state)
{
    (void)state;
    uint64_t seed = 60;
    double gaps = 0.0, meta_gaps = 0.0, worst = 0.0;
    uint32_t count = 0;
    for (int round = 0; round < 120; round++) {
        bench b;
        random_model_options o = {.leaves = 6 + random_below(&seed, 6),
                                  .max_children = 4,
                                  .extent = 30,
                                  .bare_clusters = 0.2f};
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        double low = bench_run(&b, "coarsest", 0)->predicted_ms;
        double base = bench_run(&b, "coarsest", 0)->benefit;
        double high = bench_run(&b, "full", 0)->predicted_ms;
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        // What greedy goes over, with time in plenty and without. (A node that it does not go
        // below keeps pixels that may turn out to be outside the frustum, so neither tree's
        // optimum is above the other's.)
        frontier all = {0};
        for (int closer = 0; closer < 2; closer++) {
            eval.tolerance = closer ? 0.0625f : 1.0f;
            prom_eval_run(&eval, &b.selection, prom_eval_open_visible, &eval);
            if (!eval.nodes[0].culled) frontier_of(&eval, 0, &all);
        }
        for (int i = 1; i < 8 && all.count; i++) {
            double budget = (low + (high - low) * i / 8.0) * (1.0 + 1e-6), best = 0.0;
            for (size_t k = 0; k < all.count; k++)
                if (eval.fixed_ms + all.data[k].cost <= budget) best = all.data[k].benefit;
            double greedy = bench_run(&b, "greedy", budget)->benefit;
            assert_true(greedy <= best * (1.0 + 1e-6) + 1e-6);
            if (best - base < 1e-3 * best) continue;
            double gap = (best - greedy) / (best - base);
            gaps += gap;
            worst = fmax(worst, gap);
            prom_cut *meta = bench_run(&b, "meta", budget);
            meta_gaps +=
                meta->feasible ? fmax((best - meta->benefit) / (best - base), 0.0) : 1.0;
            count++;
        }
        prom_array_finish(&all);
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
    print_message("gap to the exact optimum over %u cases: greedy %.2f %% mean, %.1f %% worst; "
                  "meta %.1f %% mean\n",
                  count, 100 * gaps / count, 100 * worst, 100 * meta_gaps / count);
    assert_true(count > 200);
    assert_true(gaps / count < 0.25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_cut_covers_each_leaf_once),
        cmocka_unit_test(the_check_finds_broken_cuts),
        cmocka_unit_test(budgets_are_kept),
        cmocka_unit_test(greedy_gains_with_budget),
        cmocka_unit_test(equal_inputs_give_equal_cuts),
        cmocka_unit_test(unknown_selectors_are_refused),
        cmocka_unit_test(greedy_comes_near_the_optimum),
    };
    return cmocka_run_group_tests_name("traverse", tests, NULL, NULL);
}
