// LINK: prom_traverse prom_benefit prom_metaobj
// Times the selectors on a large random tree and says how far their cuts are from the bound.
// Usage: bench_select [LEAVES] [FRAMES]
#include "../random_model.h"
#include "metaobj/base/clock.h"
#include "traverse/evaluate.h"

#include <stdio.h>
#include <stdlib.h>

// max over cuts of benefit - price * cost: bottom-up, exact.
static double best_value(const prom_eval *eval, double price, double *values)
{
    for (uint32_t i = eval->visited_count; i-- > 0;) {
        uint32_t node = eval->visited[i];
        const prom_eval_node *n = &eval->nodes[node];
        double best = -INFINITY, opened = 0.0;
        for (uint32_t o = 0; o < n->option_count; o++) {
            const prom_option *option = &eval->options[n->first_option + o];
            best = fmax(best, option->benefit - price * option->cost);
        }
        for (uint32_t c = 0; n->expanded && c < eval->model->child_count[node]; c++) {
            uint32_t child = eval->model->first_child[node] + c;
            if (!eval->nodes[child].culled) opened += values[child];
        }
        if (n->expanded) best = fmax(best, opened);
        values[node] = n->culled ? 0.0 : best;
    }
    return values[0];
}

// Least upper bound over prices of the benefit within a budget (DESIGN 7), by ternary search:
// it is convex in the price.
static double bound_of(const prom_eval *eval, double budget_ms, double *values)
{
    double low = -20.0, high = 30.0, left = budget_ms - eval->fixed_ms;
    double best = INFINITY;
    for (int i = 0; i < 60; i++) {
        double a = low + (high - low) / 3, b = high - (high - low) / 3;
        double at_a = best_value(eval, exp(a), values) + exp(a) * left;
        double at_b = best_value(eval, exp(b), values) + exp(b) * left;
        best = fmin(best, fmin(at_a, at_b));
        if (at_a < at_b)
            high = b;
        else
            low = a;
    }
    return best;
}

typedef struct tally {
    double ms, ns_per_node, visited, entries, gap, use;
    uint32_t gaps;
} tally;

static void time_selectors(uint32_t leaves, int frames)
{
    const random_model_options o = {leaves, 16, 8.0f * sqrtf((float)leaves), 0.1f, 0};
    prom_model m;
    random_model(&m, 1, &o);
    printf("random tree: %u nodes, %u prototypes, %u representations\n", m.tree_count,
           m.prototype_count, m.rep_count);
    prom_cost_model cost = {
        .fixed_ms = 1, .draw_ms = 5e-4, .triangle_ms = 1.2e-4, .hidden_pixel_ms = 5e-7};
    for (int k = 0; k < PROM_SHADE_COUNT; k++) cost.pixel_ms[k] = 4e-6;
    prom_selector *selectors[16];
    prom_cut cuts[16] = {0};
    tally tallies[16] = {0};
    double budgets[16] = {0};
    for (size_t s = 0; s < prom_selector_count(); s++)
        selectors[s] = prom_selector_create(prom_selector_at(s)->name, &m, NULL);
    prom_eval eval;
    prom_eval_init(&eval, &m);
    double *values = prom_alloc(m.tree_count, sizeof *values);
    uint64_t seed = 2;
    for (int f = 0; f < frames; f++) {
        prom_camera camera;
        prom_view view;
        random_camera(&m, &seed, &camera);
        camera.width = 1280, camera.height = 720, camera.fov_y = 1.0471976f;
        for (int k = 0; k < 3; k++)
            camera.eye[k] = m.center[0][k] + 0.5 * random_between(&seed, -1, 1) * m.half[0][k];
        prom_view_init(&view, &camera);
        prom_selection selection = {.view = &view, .cost = &cost};
        prom_eval_run(&eval, &selection, NULL, NULL);
        double full = 0.0, base = 0.0, bound = 0.0;
        for (size_t i = prom_selector_count(); i-- > 0;) { // the ends first
            selection.budget_ms = base + 0.2 * (full - base);
            double start = prom_clock_ms();
            prom_selector_run(selectors[i], &selection, &cuts[i]);
            double ms = prom_clock_ms() - start;
            const char *name = prom_selector_at(i)->name;
            if (!strcmp(name, "coarsest")) base = cuts[i].predicted_ms;
            if (!strcmp(name, "full")) {
                full = cuts[i].predicted_ms;
                bound = bound_of(&eval, base + 0.2 * (full - base), values);
            }
            tally *t = &tallies[i];
            t->ms += ms;
            t->visited += cuts[i].nodes_visited;
            t->entries += (double)cuts[i].entries.count;
            if (!prom_selector_at(i)->budgeted || full < 1.05 * base) continue;
            double least = cuts[prom_selector_count() - 1].benefit;
            t->gap += (bound - cuts[i].benefit) / (bound - least);
            t->use += cuts[i].predicted_ms / selection.budget_ms;
            t->gaps++;
        }
        budgets[0] += base + 0.2 * (full - base);
    }
    printf("%-10s %9s %9s %9s %9s %8s %6s\n", "selector", "ms", "visited", "ns/node", "entries",
           "gap %", "use %");
    for (size_t s = 0; s < prom_selector_count(); s++) {
        const tally *t = &tallies[s];
        printf("%-10s %9.3f %9.0f %9.0f %9.0f", prom_selector_at(s)->name, t->ms / frames,
               t->visited / frames, 1e6 * t->ms / fmax(t->visited, 1), t->entries / frames);
        if (t->gaps) printf(" %8.2f %6.1f", 100 * t->gap / t->gaps, 100 * t->use / t->gaps);
        printf("\n");
        prom_selector_destroy(selectors[s]);
        prom_cut_finish(&cuts[s]);
    }
    printf("mean budget %.2f ms\n", budgets[0] / frames);
    prom_free(values);
    prom_eval_finish(&eval);
    prom_model_finish(&m);
}

int main(int argc, char **argv)
{
    long leaves = argc > 1 ? strtol(argv[1], NULL, 10) : 3000;
    long frames = argc > 2 ? strtol(argv[2], NULL, 10) : 50;
    if (leaves < 1 || leaves > 1000000 || frames < 1 || frames > 100000) {
        fprintf(stderr, "error: usage: bench_select [LEAVES 1..1000000] [FRAMES 1..100000]\n");
        return 1;
    }
    time_selectors((uint32_t)leaves, (int)frames);
    return 0;
}
