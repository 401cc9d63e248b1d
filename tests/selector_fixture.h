// All selectors on one random model, run by name from any camera.
#ifndef PROM_TESTS_SELECTOR_FIXTURE_H
#define PROM_TESTS_SELECTOR_FIXTURE_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "random_model.h"
#include "traverse/selector.h"

typedef struct bench {
    prom_model model;
    prom_camera camera;
    prom_view view;
    prom_cost_model cost;
    prom_selection selection;
    prom_selector *selectors[16];
    prom_cut cuts[16];
} bench;

static inline void bench_init(bench *b, uint64_t seed, const random_model_options *o)
{
    memset(b, 0, sizeof *b);
    random_model(&b->model, seed, o);
    assert_null(prom_model_check(&b->model, NULL));
    b->cost = random_cost(&seed);
    for (size_t i = 0; i < prom_selector_count(); i++)
        b->selectors[i] = prom_selector_create(prom_selector_at(i)->name, &b->model, NULL);
    b->selection = (prom_selection){.view = &b->view, .cost = &b->cost};
}

static inline void bench_finish(bench *b)
{
    for (size_t i = 0; i < prom_selector_count(); i++) {
        prom_selector_destroy(b->selectors[i]);
        prom_cut_finish(&b->cuts[i]);
    }
    prom_model_finish(&b->model);
}

static inline void bench_look(bench *b, uint64_t *seed)
{
    random_camera(&b->model, seed, &b->camera);
    prom_view_init(&b->view, &b->camera);
}

static inline prom_cut *bench_run(bench *b, const char *name, double budget_ms)
{
    for (size_t i = 0; i < prom_selector_count(); i++) {
        if (strcmp(prom_selector_at(i)->name, name)) continue;
        b->selection.budget_ms = budget_ms;
        prom_selector_run(b->selectors[i], &b->selection, &b->cuts[i]);
        return &b->cuts[i];
    }
    fail_msg("no selector %s", name);
    return NULL;
}

static inline random_model_options options_of(uint64_t *seed)
{
    return (random_model_options){
        .leaves = 1 + random_below(seed, 200),
        .max_children = 2 + random_below(seed, 12),
        .extent = random_between(seed, 5, 300),
        .bare_clusters = random_unit(seed) * random_unit(seed),
        .artists = random_below(seed, 2) ? random_unit(seed) : 0.0f,
    };
}

#endif
