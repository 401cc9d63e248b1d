// Flat value per cost, after Funkhouser and Séquin (1993, Adaptive display algorithm for
// interactive frame rates during visualization of complex virtual environments): every object
// in view by itself gets the level that a greedy rule finds best for the time. No hierarchy.
// (Written from accounts of the paper, not from its text.)
//
// From its cheapest level each object climbs to the next finer one that shows more. Of all such
// steps that one comes first whose level has the largest value = benefit / cost; the first that
// does not fit is the end. The original begins with the levels of the last frame instead.
//
// Its benefit is size x accuracy by a formula, with factors for importance, focus, motion and
// hysteresis. Here it is ours, visible pixels x measured accuracy x weight, so that only the
// choice differs. It may leave objects out; here the cheapest level is the least, and where
// these are over the budget the cut says that it is not feasible.
#include "traverse/bound.h"
#include "traverse/heap.h"
#include "traverse/selectors.h"

#include <math.h>

typedef struct funkhouser_state {
    prom_eval eval;
    prom_heap heap;   // of leaves, by the value of their next level
    uint32_t *option; // per leaf in view: what it is drawn by
    prom_bound *bound;
} funkhouser_state;

static void *create(const prom_model *model)
{
    funkhouser_state *state = prom_calloc(1, sizeof *state);
    prom_eval_init(&state->eval, model);
    state->eval.any_mesh_hides = true;
    state->heap.entries = prom_alloc(model->tree_count, sizeof *state->heap.entries);
    state->option = prom_alloc(model->tree_count, sizeof *state->option);
    state->bound = prom_bound_create(model);
    return state;
}

static void destroy(void *pointer)
{
    funkhouser_state *state = pointer;
    if (!state) return;
    prom_eval_finish(&state->eval);
    prom_free(state->heap.entries);
    prom_free(state->option);
    prom_bound_destroy(state->bound);
    prom_free(state);
}

static bool is_drawn(const prom_eval *eval, uint32_t node)
{
    return !eval->model->child_count[node] && eval->nodes[node].option_count;
}

// PROM_NONE where no finer level shows more.
static uint32_t next_level(const funkhouser_state *state, uint32_t leaf)
{
    const prom_option *options = state->eval.options;
    uint32_t now = state->option[leaf];
    for (uint32_t i = now; i-- > state->eval.nodes[leaf].first_option;)
        if (options[i].value > options[now].value) return i;
    return PROM_NONE;
}

static void push_next(funkhouser_state *state, uint32_t leaf)
{
    uint32_t next = next_level(state, leaf);
    if (next == PROM_NONE) return;
    const prom_option *o = &state->eval.options[next];
    prom_heap_push(&state->heap, o->cost > 0.0 ? (double)o->value / o->cost : INFINITY, leaf);
}

// Gives each leaf its cheapest level; returns what they cost.
static double start(funkhouser_state *state)
{
    const prom_eval *eval = &state->eval;
    double total = eval->fixed_ms;
    state->heap.count = 0;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        if (!is_drawn(eval, node)) continue;
        state->option[node] = eval->nodes[node].cmin_option;
        total += eval->options[state->option[node]].cost;
        push_next(state, node);
    }
    return total;
}

// Returns whether something was left that did not fit.
static bool climb(funkhouser_state *state, double total, double budget)
{
    const prom_option *options = state->eval.options;
    while (state->heap.count) {
        uint32_t leaf = prom_heap_pop(&state->heap).node, next = next_level(state, leaf);
        total += options[next].cost - options[state->option[leaf]].cost;
        if (total > budget) return true;
        state->option[leaf] = next;
        push_next(state, leaf);
    }
    return false;
}

static void select_funkhouser(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    funkhouser_state *state = pointer;
    prom_eval *eval = &state->eval;
    prom_eval_run(eval, selection, NULL, NULL);
    prom_eval_begin_cut(eval, cut);
    cut->limited = climb(state, start(state), prom_eval_budget(eval));
    for (uint32_t i = 0; i < eval->visited_count; i++)
        if (is_drawn(eval, eval->visited[i]))
            prom_eval_emit(eval, eval->visited[i], state->option[eval->visited[i]], cut);
    prom_eval_end_cut(eval, cut);
    prom_bound_certify(state->bound, eval, 0.0, cut);
}

const prom_selector_class prom_select_funkhouser = {
    .name = "funkhouser",
    .summary = "objects alone, by falling benefit per cost (Funkhouser and Séquin 1993)",
    .budgeted = true,
    .uses_cost = true,
    .create = create,
    .destroy = destroy,
    .select = select_funkhouser,
};
