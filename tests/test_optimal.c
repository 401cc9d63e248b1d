// LINK: prom_traverse prom_benefit prom_metaobj
// The selectors against the optimum, on many small trees.
#include "random_model.h"
#include "selector_fixture.h"
#include "traverse/bound.h"
#include "traverse/selectors.h"

#include <stdlib.h>

#if defined(__SANITIZE_ADDRESS__)
enum { TREES = 400 };
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
enum { TREES = 400 };
#else
enum { TREES = 10000 };
#endif
#else
enum { TREES = 10000 };
#endif

// Those that promise a cut within the budget wherever there is one; greedy first.
static const prom_selector_class *const keepers[] = {
    &prom_select_greedy,
    &prom_select_lagrange,
    &prom_select_incremental,
};
enum { KEEPERS = sizeof keepers / sizeof *keepers };

typedef struct small_tree {
    prom_model model;
    prom_camera camera;
    prom_view view;
    prom_cost_model cost;
    prom_selection selection;
} small_tree;

static void tree_init(small_tree *t, uint64_t *seed)
{
    memset(t, 0, sizeof *t);
    random_model(&t->model, random_u64(seed),
                 &(random_model_options){.leaves = 12 + random_below(seed, 5),
                                         .max_children = 4,
                                         .extent = 10,
                                         .bare_clusters = 0.1f,
                                         .correlated = true});
    t->cost = random_cost(seed);
    random_camera_outside(&t->model, seed, &t->camera);
    prom_view_init(&t->view, &t->camera);
    t->selection = (prom_selection){.view = &t->view, .cost = &t->cost, .certify = true};
}

static void run(const prom_selector_class *class, void *state, const small_tree *t,
                prom_cut *cut)
{
    class->select(state, &t->selection, cut);
    const char *fault = prom_cut_check(&t->model, &t->view, cut);
    if (fault) fail_msg("%s: %s", class->name, fault);
}

static double ms_of(const prom_selector_class *class, small_tree *t)
{
    prom_cut cut = {0};
    void *state = class->create(&t->model);
    run(class, state, t, &cut);
    double ms = cut.predicted_ms;
    class->destroy(state);
    prom_cut_finish(&cut);
    return ms;
}

// A budget between the cheapest cut and full detail.
static void set_budget(small_tree *t, uint64_t *seed)
{
    double low = ms_of(&prom_select_coarsest, t), high = ms_of(&prom_select_full, t);
    t->selection.budget_ms = low + (high - low) * random_between(seed, 0.0f, 1.0f);
}

typedef struct tally {
    double gap, worst_gap, ratio, worst_ratio;
    uint32_t count, at_optimum;
} tally;

static void count_gain(tally *t, const prom_cut *cut, const prom_cut *best)
{
    double most = best->benefit - best->cmin_benefit;
    if (!(most > 1.0)) return;
    double ratio = (cut->benefit - best->cmin_benefit) / most;
    t->ratio += ratio;
    t->worst_ratio = t->count ? fmin(t->worst_ratio, ratio) : ratio;
    t->gap += prom_cut_gap(cut);
    t->worst_gap = fmax(t->worst_gap, prom_cut_gap(cut));
    t->at_optimum += ratio > 1.0 - 1e-6;
    t->count++;
}

static void print_tally(const char *name, const tally *t)
{
    print_message("%-12s gain %.2f %% of the optimal, least %.1f %%; optimal in %.0f %%; gap "
                  "to its bound %.2f %%, most %.0f %%\n",
                  name, 100 * t->ratio / t->count, 100 * t->worst_ratio,
                  100.0 * t->at_optimum / t->count, 100 * t->gap / t->count,
                  100 * t->worst_gap);
}

// No cut is above the optimum, none over the budget, no bound below; greedy has half.
static void selectors_keep_to_the_optimum(void **unused)
{
    (void)unused;
    uint64_t seed = 1;
    tally tallies[KEEPERS] = {0}, unpayable = {0};
    prom_cut best = {0}, cut = {0};
    uint32_t payable = 0;
    for (int tree = 0; tree < TREES; tree++) {
        small_tree t;
        tree_init(&t, &seed);
        set_budget(&t, &seed);
        double slack = 1e-6 * (double)t.camera.width * (double)t.camera.height;
        void *optimal = prom_select_optimal.create(&t.model);
        run(&prom_select_optimal, optimal, &t, &best);
        prom_select_optimal.destroy(optimal);
        assert_true(best.bound <= best.benefit); // proven
        for (size_t i = 0; i < KEEPERS; i++) {
            void *state = keepers[i]->create(&t.model);
            run(keepers[i], state, &t, &cut);
            assert_true(cut.feasible == best.feasible);
            assert_true(cut.benefit <= best.benefit + slack);
            assert_true(cut.bound >= best.benefit - slack);
            count_gain(&tallies[i], &cut, &best);
            double alone_ms;
            if (!i && prom_greedy_unpaid(state, &alone_ms)) {
                double gain = cut.benefit - best.cmin_benefit;
                if (alone_ms > t.selection.budget_ms * (1.0 - 1e-9)) {
                    count_gain(&unpayable, &cut, &best);
                } else {
                    payable++;
                    assert_true(2.0 * gain >= best.benefit - best.cmin_benefit - slack);
                }
            }
            keepers[i]->destroy(state);
        }
        prom_model_finish(&t.model);
    }
    prom_cut_finish(&best);
    prom_cut_finish(&cut);
    for (size_t i = 0; i < KEEPERS; i++) print_tally(keepers[i]->name, &tallies[i]);
    print_message("the first step that did not fit was payable alone in %u trees; where not:\n",
                  payable);
    print_tally("greedy", &unpayable);
    assert_true(payable > TREES / 4);
    for (size_t i = 0; i < KEEPERS; i++) assert_true(tallies[i].gap < 0.1 * tallies[i].count);
}

// With fewer cuts in its fronts than there are, `optimal` still keeps the budget.
static void large_trees_are_nearly_optimal(void **unused)
{
    (void)unused;
    uint64_t seed = 2;
    prom_cut best = {0}, greedy = {0};
    for (int tree = 0; tree < 3; tree++) {
        small_tree t = {0};
        random_model(&t.model, random_u64(&seed),
                     &(random_model_options){
                         .leaves = 60, .max_children = 6, .extent = 20, .correlated = true});
        t.cost = random_cost(&seed);
        random_camera_outside(&t.model, &seed, &t.camera);
        prom_view_init(&t.view, &t.camera);
        t.selection = (prom_selection){.view = &t.view, .cost = &t.cost, .certify = true};
        set_budget(&t, &seed);
        if (!tree) t.selection.budget_ms = ms_of(&prom_select_coarsest, &t) * (1.0 + 1e-8);
        void *states[] = {prom_select_optimal.create(&t.model),
                          prom_select_greedy.create(&t.model)};
        run(&prom_select_optimal, states[0], &t, &best);
        run(&prom_select_greedy, states[1], &t, &greedy);
        assert_true(best.feasible);
        assert_true(best.benefit <= best.bound && best.benefit <= greedy.bound + 1.0);
        assert_true(best.benefit >= 0.98 * greedy.benefit);
        prom_select_optimal.destroy(states[0]);
        prom_select_greedy.destroy(states[1]);
        prom_model_finish(&t.model);
    }
    prom_cut_finish(&best);
    prom_cut_finish(&greedy);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(selectors_keep_to_the_optimum),
        cmocka_unit_test(large_trees_are_nearly_optimal),
    };
    return cmocka_run_group_tests_name("optimal", tests, NULL, NULL);
}
