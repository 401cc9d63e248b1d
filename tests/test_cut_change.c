// LINK: prom_traverse
//
// Changes of cuts: on random models, whatever is done to a cut in whatever order, it stays
// valid and its prediction the sum of its parts.
#include "app/cut_change.c"

#include "selector_fixture.h"

static void whole_eval(bench *b, prom_eval *eval)
{
    b->selection.budget_ms = INFINITY;
    prom_eval_run(eval, &b->selection, NULL, NULL);
}

static double sum_of(const prom_eval *eval, const prom_cut *cut)
{
    double ms = eval->fixed_ms;
    for (size_t i = 0; i < cut->entries.count; i++) ms += (double)cut->entries.data[i].cost_ms;
    return ms;
}

static void change_at_random(const prom_eval *eval, prom_cut *cut, uint64_t *seed)
{
    const prom_model *m = eval->model;
    size_t index = random_below(seed, (uint32_t)cut->entries.count);
    uint32_t node = cut->entries.data[index].node;
    const prom_eval_node *n = &eval->nodes[node];
    uint32_t parent = m->parent[node];
    switch (random_below(seed, 4)) {
    case 0:
        if (!n->option_count) return;
        prom_cut_take_option(eval, cut, index,
                             n->first_option + random_below(seed, n->option_count));
        return;
    case 1:
        prom_cut_open(eval, cut, index, prom_cut_best_option);
        return;
    case 2:
        prom_cut_open(eval, cut, index, prom_cut_cheapest_option);
        return;
    default:
        if (parent == PROM_NONE || !eval->nodes[parent].option_count) return;
        prom_cut_close(eval, cut, parent, eval->nodes[parent].first_option);
    }
}

static void cuts_stay_valid(void **state)
{
    (void)state;
    uint64_t seed = 11;
    for (int round = 0; round < 40; round++) {
        random_model_options o = options_of(&seed);
        bench b;
        bench_init(&b, seed, &o);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        prom_cut cut = {0};
        for (int view = 0; view < 5; view++) {
            bench_look(&b, &seed);
            whole_eval(&b, &eval);
            prom_cut_copy(bench_run(&b, "coarsest", 1), &cut);
            for (int i = 0; i < 60 && cut.entries.count; i++) {
                change_at_random(&eval, &cut, &seed);
                assert_null(prom_cut_check(&b.model, &b.view, &cut));
                double sum = sum_of(&eval, &cut);
                assert_true(fabs(cut.predicted_ms - sum) <= 1e-6 * sum); // costs are floats
            }
        }
        prom_cut_finish(&cut);
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
}

// The root's picture, opened as far as it goes, is full detail; closed again, the root's.
static void opening_and_closing_are_inverse(void **state)
{
    (void)state;
    uint64_t seed = 5;
    int clusters = 0;
    for (int round = 0; round < 40; round++) {
        random_model_options o = options_of(&seed);
        bench b;
        bench_init(&b, seed, &o);
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        bench_look(&b, &seed);
        whole_eval(&b, &eval);
        prom_cut cut = {0};
        prom_cut_copy(bench_run(&b, "coarsest", 1), &cut);
        for (size_t i = 0; i < cut.entries.count;) {
            if (prom_cut_open(&eval, &cut, i, prom_cut_best_option))
                i = 0;
            else
                i++;
        }
        size_t leaves = 0; // a cluster may be in the frustum, and nothing below it
        for (size_t i = 0; i < cut.entries.count; i++) {
            uint32_t node = cut.entries.data[i].node;
            leaves += !eval.nodes[node].culled;
            assert_true(eval.nodes[node].culled || !b.model.child_count[node]);
        }
        assert_int_equal(leaves, bench_run(&b, "full", 1)->entries.count);
        if (cut.entries.count && eval.nodes[0].option_count) {
            clusters += b.model.child_count[0] > 0;
            prom_cut_close(&eval, &cut, 0, prom_cut_best_option(&eval, 0));
            assert_int_equal(cut.entries.count, 1);
            assert_int_equal(cut.entries.data[0].node, 0);
        }
        prom_cut_finish(&cut);
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
    assert_true(clusters > 0);
}

static void the_best_is_best_and_the_cheapest_cheapest(void **state)
{
    (void)state;
    uint64_t seed = 3;
    random_model_options o = {.leaves = 100, .max_children = 6, .extent = 50};
    bench b;
    bench_init(&b, seed, &o);
    prom_eval eval;
    prom_eval_init(&eval, &b.model);
    bench_look(&b, &seed);
    whole_eval(&b, &eval);
    for (uint32_t i = 0; i < eval.visited_count; i++) {
        uint32_t node = eval.visited[i];
        const prom_eval_node *n = &eval.nodes[node];
        uint32_t best = prom_cut_best_option(&eval, node);
        uint32_t cheapest = prom_cut_cheapest_option(&eval, node);
        assert_true((best == PROM_NONE) == !n->option_count);
        assert_true((cheapest == PROM_NONE) == !n->option_count);
        for (uint32_t k = n->first_option; k < n->first_option + n->option_count; k++) {
            assert_true(eval.options[k].accuracy <= eval.options[best].accuracy);
            assert_true(eval.options[k].cost >= eval.options[cheapest].cost);
        }
    }
    prom_eval_finish(&eval);
    bench_finish(&b);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cuts_stay_valid),
        cmocka_unit_test(opening_and_closing_are_inverse),
        cmocka_unit_test(the_best_is_best_and_the_cheapest_cheapest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
