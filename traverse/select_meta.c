// The classic two-phase traversal (Maciel and Shirley 1995, as DESIGN 7 gives it).
//
// Phase 1 goes over everything in the frustum and gives each node its place in the list (a leaf
// its visible pixels, a cluster the highest of its children's, or their sum) and an initial
// representation (least cost per benefit). Phase 2 takes nodes from the list by falling
// benefit: a leaf is improved as far as the time allows, a cluster replaced by its visible
// children if the time allows; what does not fit is skipped.
//
// A cluster that has no valid representation is always replaced. Its initial cost is therefore
// that of its children's initial ones: the time is set aside before anything else is bought,
// and only the initial cut itself can be over the budget. It is not the cheapest cut: meta can
// be over a budget that cut->cmin_ms, the cheapest cut's time, would keep.
#include "traverse/bound.h"
#include "traverse/evaluate.h"
#include "traverse/heap.h"
#include "traverse/selectors.h"

#include <math.h>

typedef struct meta_node {
    double key;
    double cost;     // of the initial state
    uint32_t option; // of the initial state, or PROM_NONE: always replaced
} meta_node;

typedef struct meta_state {
    prom_eval eval;
    meta_node *nodes;
    prom_heap list;
    prom_bound *bound;
    bool limited; // something did not fit
} meta_state;

static void *create(const prom_model *model)
{
    meta_state *state = prom_calloc(1, sizeof *state);
    prom_eval_init(&state->eval, model);
    state->eval.any_mesh_hides = state->eval.heeds_priors = true;
    state->nodes = prom_alloc(model->tree_count, sizeof *state->nodes);
    state->list.entries = prom_alloc(model->tree_count, sizeof *state->list.entries);
    state->bound = prom_bound_create(model);
    return state;
}

static void destroy(void *pointer)
{
    meta_state *state = pointer;
    if (!state) return;
    prom_eval_finish(&state->eval);
    prom_free(state->nodes);
    prom_free(state->list.entries);
    prom_bound_destroy(state->bound);
    prom_free(state);
}

// ---- phase 1

// Least cost per benefit; with no benefit to be had, the least cost.
static uint32_t initial_option(const prom_eval *eval, const prom_eval_node *n)
{
    uint32_t best = PROM_NONE;
    double least = INFINITY;
    for (uint32_t i = 0; i < n->option_count; i++) {
        const prom_option *o = &eval->options[n->first_option + i];
        double ratio = o->cost / fmax(o->value, 1e-30);
        if (ratio < least) least = ratio, best = n->first_option + i;
    }
    return best;
}

// Key and cost of a cluster from its children's.
static void gather_children(meta_state *state, uint32_t node)
{
    const prom_model *m = state->eval.model;
    meta_node *n = &state->nodes[node];
    bool sum = state->eval.selection->order == PROM_ORDER_SUM;
    double cost = 0.0;
    for (uint32_t c = m->first_child[node]; c < m->first_child[node] + m->child_count[node];
         c++) {
        if (state->eval.nodes[c].culled) continue;
        n->key = sum ? n->key + state->nodes[c].key : fmax(n->key, state->nodes[c].key);
        cost += state->nodes[c].cost;
    }
    if (n->option == PROM_NONE) n->cost = cost;
}

static void phase_1(meta_state *state)
{
    const prom_eval *eval = &state->eval;
    for (uint32_t i = eval->visited_count; i-- > 0;) {
        uint32_t node = eval->visited[i];
        const prom_eval_node *e = &eval->nodes[node];
        if (e->culled) continue;
        uint32_t option = initial_option(eval, e);
        state->nodes[node] = (meta_node){
            .option = option,
            .cost = option == PROM_NONE ? 0.0 : eval->options[option].cost,
        };
        if (e->expanded)
            gather_children(state, node);
        else
            state->nodes[node].key = e->value_px;
    }
}

// ---- phase 2

// The option of highest benefit that fits; the least cost among equals.
static uint32_t improved(const prom_eval *eval, const prom_eval_node *n, uint32_t current,
                         double left_ms)
{
    uint32_t best = current;
    for (uint32_t i = 0; i < n->option_count; i++) {
        const prom_option *o = &eval->options[n->first_option + i], *b = &eval->options[best];
        if (o->cost - eval->options[current].cost > left_ms) continue;
        if (o->value > b->value || (o->value == b->value && o->cost < b->cost))
            best = n->first_option + i;
    }
    return best;
}

static double children_cost(const meta_state *state, uint32_t node)
{
    const prom_model *m = state->eval.model;
    double cost = 0.0;
    for (uint32_t c = 0; c < m->child_count[node]; c++)
        if (!state->eval.nodes[m->first_child[node] + c].culled)
            cost += state->nodes[m->first_child[node] + c].cost;
    return cost;
}

static void push_children(meta_state *state, uint32_t node)
{
    const prom_model *m = state->eval.model;
    for (uint32_t c = 0; c < m->child_count[node]; c++) {
        uint32_t child = m->first_child[node] + c;
        if (!state->eval.nodes[child].culled)
            prom_heap_push(&state->list, state->nodes[child].key, child);
    }
}

static void phase_2(meta_state *state, prom_cut *cut)
{
    const prom_eval *eval = &state->eval;
    double budget = prom_eval_budget(eval);
    double total = eval->fixed_ms + state->nodes[0].cost;
    prom_heap_push(&state->list, state->nodes[0].key, 0);
    while (state->list.count) {
        uint32_t node = prom_heap_pop(&state->list).node;
        const prom_eval_node *e = &eval->nodes[node];
        const meta_node *n = &state->nodes[node];
        if (e->expanded) {
            double change = n->option == PROM_NONE ? 0.0 : children_cost(state, node) - n->cost;
            if (n->option == PROM_NONE || total + change <= budget) {
                total += change;
                push_children(state, node);
            } else {
                state->limited = true;
                prom_eval_emit(eval, node, n->option, cut);
            }
        } else if (n->option != PROM_NONE) {
            uint32_t option = improved(eval, e, n->option, budget - total);
            if (option != improved(eval, e, n->option, INFINITY)) state->limited = true;
            total += eval->options[option].cost - n->cost;
            prom_eval_emit(eval, node, option, cut);
        }
    }
}

static void select_meta(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    meta_state *state = pointer;
    prom_eval_run(&state->eval, selection, NULL, NULL);
    prom_eval_begin_cut(&state->eval, cut);
    state->limited = false;
    if (!state->eval.nodes[0].culled) {
        phase_1(state);
        phase_2(state, cut);
    }
    prom_eval_end_cut(&state->eval, cut);
    cut->limited = state->limited || !cut->feasible;
    prom_bound_certify(state->bound, &state->eval, 0.0, cut);
}

const prom_selector_class prom_select_meta = {
    .name = "meta",
    .summary = "the classic: two phases, best first by benefit",
    .budgeted = true,
    .uses_cost = true,
    .create = create,
    .destroy = destroy,
    .select = select_meta,
};
