// LINK: prom_traverse
//
// The oracle's moves on random models: cuts stay valid and within their limit, whatever is done
// to them; what is wrong is changed.
#include "app/cut_change.c"
#include "app/oracle_moves.c"

#include "selector_fixture.h"

typedef struct climb {
    bench b;
    prom_eval eval;
    prom_cut cut, tried;
    double *error;
} climb;

static void climb_init(climb *c, uint64_t *seed)
{
    random_model_options o = options_of(seed);
    *c = (climb){0};
    bench_init(&c->b, *seed, &o);
    prom_eval_init(&c->eval, &c->b.model);
    c->error = prom_calloc(c->b.model.tree_count, sizeof *c->error);
    bench_look(&c->b, seed);
    prom_cut_copy(bench_run(&c->b, "greedy", 0), &c->cut);
    c->b.selection.budget_ms = c->cut.predicted_ms * (1.0 + (double)random_unit(seed));
    prom_cut_copy(bench_run(&c->b, "greedy", c->b.selection.budget_ms), &c->cut);
    prom_eval_run(&c->eval, &c->b.selection, NULL, NULL);
}

static void climb_finish(climb *c)
{
    prom_cut_finish(&c->cut);
    prom_cut_finish(&c->tried);
    prom_eval_finish(&c->eval);
    prom_free(c->error);
    bench_finish(&c->b);
}

static bool same_entries(const prom_cut *a, const prom_cut *b)
{
    if (a->entries.count != b->entries.count) return false;
    for (size_t i = 0; i < a->entries.count; i++) {
        const prom_cut_entry *x = &a->entries.data[i], *y = &b->entries.data[i];
        if (x->node != y->node || x->rep != y->rep) return false;
    }
    return true;
}

static void moves_stay_valid_and_within_the_limit(void **state)
{
    (void)state;
    uint64_t seed = 21;
    int moved = 0, dearer = 0;
    for (int round = 0; round < 40; round++) {
        climb c;
        climb_init(&c, &seed);
        double limit = fmax(c.b.selection.budget_ms, c.cut.predicted_ms);
        prom_random random = {seed};
        for (int i = 0; i < 100; i++) {
            prom_cut_copy(&c.cut, &c.tried);
            for (size_t k = 0; k < c.cut.entries.count; k++)
                c.error[c.cut.entries.data[k].node] = (double)random_unit(&seed);
            if (!prom_oracle_move(&c.eval, &random, c.error, limit, &c.tried)) continue;
            assert_null(prom_cut_check(&c.b.model, &c.b.view, &c.tried));
            assert_true(c.tried.predicted_ms <= limit);
            assert_false(same_entries(&c.cut, &c.tried));
            dearer += c.tried.predicted_ms > c.cut.predicted_ms;
            prom_cut_copy(&c.tried, &c.cut); // go on from there
            moved++;
        }
        climb_finish(&c);
    }
    assert_true(moved > 1000 && dearer > 100);
}

// All of the error is one entry's: it is changed in most of the moves.
static void what_is_wrong_is_changed(void **state)
{
    (void)state;
    uint64_t seed = 8;
    int moved = 0, changed = 0;
    for (int round = 0; round < 40; round++) {
        climb c;
        climb_init(&c, &seed);
        prom_random random = {seed};
        size_t count = c.cut.entries.count;
        if (count < 20) {
            climb_finish(&c);
            continue;
        }
        const prom_cut_entry wrong = c.cut.entries.data[random_below(&seed, (uint32_t)count)];
        c.error[wrong.node] = 1;
        for (int i = 0; i < 20 && c.eval.nodes[wrong.node].option_count > 1; i++) {
            prom_cut_copy(&c.cut, &c.tried);
            if (!prom_oracle_move(&c.eval, &random, c.error, INFINITY, &c.tried)) continue;
            moved++;
            bool there = false;
            for (size_t k = 0; k < c.tried.entries.count; k++)
                there = there || (c.tried.entries.data[k].node == wrong.node &&
                                  c.tried.entries.data[k].rep == wrong.rep);
            changed += !there;
        }
        climb_finish(&c);
    }
    assert_true(moved > 50 && changed > moved / 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(moves_stay_valid_and_within_the_limit),
        cmocka_unit_test(what_is_wrong_is_changed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
