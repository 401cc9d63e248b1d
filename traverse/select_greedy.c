// Greedy by marginal benefit per cost, from the cheapest cut upwards.
//
// The cheapest cut is set aside first; then steps of the chains (chain.h) are bought in one
// global order of falling slope, until one does not fit (see prom_step_may_be_skipped). The
// order does not depend on the budget, so more of it buys the same steps and more.
//
// That alone can be bad, where the first step that does not fit is a large one. So the cut is
// compared with the one that has, beside the cheapest, only that step and those that it
// presupposes: what greedy has bought and what this step gains are together at least what any
// cut within the budget gains, so the better of the two has half of it (as in the knapsack
// problem; Mason and Blake 1997 for trees).
#include "traverse/bound.h"
#include "traverse/chain.h"
#include "traverse/evaluate.h"
#include "traverse/moves.h"
#include "traverse/selectors.h"
#include "traverse/steady.h"

#include <math.h>

// When everything that is visibly better has been bought and this part of the budget is left,
// the tree is gone over again with a tolerance of a 32nd of a pixel a node: if that takes no
// more than this part of the budget, at so much a node (measured: 0.3 to 0.6 µs) and so many
// more nodes at most.
#define CLOSER_LEFT 0.2
#define CLOSER_TOLERANCE 0.0625f
#define CLOSER_TIME 0.1
#define CLOSER_NODES 8.0
#define NODE_MS 6e-4

// A node of the cut with its place in a chain.
typedef struct placed {
    uint32_t node;
    uint8_t place;
} placed;

typedef struct greedy_state {
    prom_eval eval;
    prom_chains chains;
    prom_heap heap; // by the slope of the next step
    uint8_t *place; // per visited node: its state in its chain
    bool *opened;   // per visited node: its children stand for it
    placed *stack;
    prom_bound *bound;
    prom_steady steady;
    double value;    // of what is bought
    double refused;  // slope of the first step that did not fit, or 0
    uint32_t unpaid; // its node, or PROM_NONE
    uint8_t unpaid_place;
    prom_point alone; // the cheapest cut with this step and those that it presupposes
} greedy_state;

static void *create(const prom_model *model)
{
    greedy_state *g = prom_calloc(1, sizeof *g);
    prom_eval_init(&g->eval, model);
    g->eval.any_mesh_hides = g->eval.heeds_priors = true;
    prom_chains_init(&g->chains, &g->eval);
    g->heap.entries = prom_alloc(model->tree_count, sizeof *g->heap.entries);
    g->place = prom_alloc(model->tree_count, sizeof *g->place);
    g->opened = prom_alloc(model->tree_count, sizeof *g->opened);
    g->stack = prom_alloc(model->tree_count, sizeof *g->stack);
    g->bound = prom_bound_create(model);
    prom_steady_init(&g->steady, model);
    return g;
}

static void destroy(void *pointer)
{
    greedy_state *g = pointer;
    if (!g) return;
    prom_bound_destroy(g->bound);
    prom_steady_finish(&g->steady);
    prom_chains_finish(&g->chains);
    prom_eval_finish(&g->eval);
    prom_free(g->heap.entries);
    prom_free(g->place);
    prom_free(g->opened);
    prom_free(g->stack);
    prom_free(g);
}

static const prom_chain_state *states_of(const greedy_state *g, uint32_t node)
{
    return &g->chains.states[g->chains.nodes[node].first];
}

// Pushes the children of a node that is opened to `limit`, each at its place.
static uint32_t push_children(const greedy_state *g, uint32_t node,
                              const prom_chain_limit *limit, uint32_t depth)
{
    const prom_model *m = g->eval.model;
    for (uint32_t c = m->child_count[node]; c-- > 0;) {
        uint32_t child = m->first_child[node] + c;
        if (g->eval.nodes[child].culled || !g->chains.nodes[child].count) continue;
        g->stack[depth++] = (placed){child, prom_chain_child_place(&g->chains, child, limit)};
    }
    return depth;
}

// Puts the nodes on the stack into the cut. Where nothing but openings lies ahead in a node's
// chain, its children take over: their own chains are finer.
static void place_stacked(greedy_state *g, uint32_t depth)
{
    while (depth) {
        placed p = g->stack[--depth];
        const prom_chain *chain = &g->chains.nodes[p.node];
        const prom_chain_state *s = states_of(g, p.node);
        g->place[p.node] = p.place;
        g->opened[p.node] = p.place >= chain->own_end;
        if (g->opened[p.node])
            depth = push_children(g, p.node, &s[p.place].limit, depth);
        else if (p.place + 1 < chain->count)
            prom_heap_push(&g->heap, s[p.place + 1].slope, p.node);
    }
}

// The next action on a node: to the next state of its chain; or, where that and all further
// ones are openings, to the opening with the fewest steps of its children that is worth while.
// What more the chain's own opening would hold follows by itself: the children's next steps are
// steeper than it.
static bool next_action(greedy_state *g, uint32_t node, prom_chain_state *next, bool *hand_over)
{
    const prom_chain *chain = &g->chains.nodes[node];
    const prom_chain_state *now = &states_of(g, node)[g->place[node]];
    *hand_over = g->place[node] + 1 >= chain->own_end;
    if (*hand_over) return prom_chain_least_opening(&g->chains, node, now->benefit, next);
    *next = now[1];
    return true;
}

// Notes the first step of the chains that does not fit.
static void note_unpaid(greedy_state *g, uint32_t node, double left)
{
    const prom_chain_state *now = &states_of(g, node)[g->place[node]];
    if (g->refused > 0.0 || now[1].cost - now->cost <= left) return;
    g->refused = now[1].slope;
    g->unpaid = node;
    g->unpaid_place = (uint8_t)(g->place[node] + 1);
}

// Takes the first step of the heap; false if it does not fit.
static bool buy_step(greedy_state *g, double *left)
{
    uint32_t node = g->heap.entries[0].node;
    prom_chain_state next;
    bool hand_over;
    note_unpaid(g, node, *left);
    if (!next_action(g, node, &next, &hand_over)) return false;
    const prom_chain_state *now = &states_of(g, node)[g->place[node]];
    if (next.cost - now->cost > *left) return false;
    *left -= next.cost - now->cost;
    g->value += next.benefit - now->benefit;
    prom_heap_pop(&g->heap);
    if (hand_over) {
        g->opened[node] = true;
        place_stacked(g, push_children(g, node, &next.limit, 0));
    } else {
        g->stack[0] = (placed){node, (uint8_t)(g->place[node] + 1)};
        place_stacked(g, 1);
    }
    return true;
}

// Buys steps; returns what is left.
static double buy_steps(greedy_state *g, double left)
{
    double least = states_of(g, 0)->benefit;
    g->value = least;
    g->refused = 0.0;
    g->unpaid = PROM_NONE;
    while (g->heap.count) {
        double slope = g->heap.entries[0].key;
        if (buy_step(g, &left)) continue;
        if (!prom_step_may_be_skipped(slope, left, g->value - least)) break;
        prom_heap_pop(&g->heap);
    }
    return left;
}

static void emit_cut(greedy_state *g, prom_cut *cut)
{
    const prom_model *m = g->eval.model;
    uint32_t depth = 1;
    g->stack[0] = (placed){0, g->place[0]};
    while (depth) {
        placed p = g->stack[--depth];
        const prom_chain_state *s = &states_of(g, p.node)[p.place];
        if (!g->opened[p.node]) {
            if (s->option != PROM_NONE)
                prom_eval_emit(&g->eval, p.node, s->option, cut);
            else
                depth = push_children(g, p.node, &s->limit, depth);
            continue;
        }
        for (uint32_t c = m->child_count[p.node]; c-- > 0;) {
            uint32_t child = m->first_child[p.node] + c;
            if (!g->eval.nodes[child].culled && g->chains.nodes[child].count)
                g->stack[depth++] = (placed){child, g->place[child]};
        }
    }
}

// ---- the first step that did not fit, by itself

// How far a node that was opened on the way to the unpaid step was opened at first, from its
// state at `place`; adds what that costs and gains.
static prom_chain_limit first_opening(greedy_state *g, uint32_t node, uint8_t place,
                                      prom_point *sum)
{
    const prom_chain_state *s = states_of(g, node);
    prom_chain_state opening = s[place];
    if (place < g->chains.nodes[node].own_end)
        prom_chain_least_opening(&g->chains, node, s[g->place[node]].benefit, &opening);
    sum->cost += opening.cost - s[place].cost;
    sum->benefit += opening.benefit - s[place].benefit;
    return opening.limit;
}

// Goes down to the unpaid step from the cheapest cut, along the steps that it presupposes.
// Returns what is drawn then; if `taken`, it becomes the state.
static prom_point go_to_unpaid(greedy_state *g, bool taken)
{
    const prom_model *m = g->eval.model;
    prom_point sum = {states_of(g, 0)->cost, states_of(g, 0)->benefit};
    uint32_t depth = 0;
    for (uint32_t n = g->unpaid; n != PROM_NONE; n = m->parent[n]) g->stack[depth++].node = n;
    for (uint32_t i = 0; taken && i < g->eval.visited_count; i++)
        g->opened[g->eval.visited[i]] = false;
    uint8_t place = 0;
    while (--depth) {
        uint32_t node = g->stack[depth].node, next = g->stack[depth - 1].node;
        prom_chain_limit limit = first_opening(g, node, place, &sum);
        place = prom_chain_child_place(&g->chains, next, &limit);
        if (!taken) continue;
        g->opened[node] = true;
        for (uint32_t c = 0; c < m->child_count[node]; c++) {
            uint32_t child = m->first_child[node] + c;
            if (g->eval.nodes[child].culled || child == next) continue;
            g->place[child] = prom_chain_child_place(&g->chains, child, &limit);
        }
    }
    const prom_chain_state *s = states_of(g, g->unpaid);
    sum.cost += s[g->unpaid_place].cost - s[place].cost;
    sum.benefit += s[g->unpaid_place].benefit - s[place].benefit;
    if (taken) g->place[g->unpaid] = g->unpaid_place;
    return sum;
}

static void take_better(greedy_state *g, double budget)
{
    if (g->unpaid == PROM_NONE) return;
    g->alone = go_to_unpaid(g, false);
    if (g->alone.cost <= budget && g->alone.benefit > g->value) go_to_unpaid(g, true);
}

bool prom_greedy_unpaid(const void *state, double *ms)
{
    const greedy_state *g = state;
    *ms = g->eval.fixed_ms + g->alone.cost;
    return !g->eval.nodes[0].culled && g->unpaid != PROM_NONE;
}

// ---- whole selections

// Returns what is left of the budget if all steps fitted, else 0.
static double select_once(greedy_state *g, const prom_selection *selection, float tolerance,
                          prom_cut *cut)
{
    prom_eval *eval = &g->eval;
    double left = 0.0;
    eval->tolerance = tolerance;
    g->refused = 0.0;
    prom_eval_run(eval, selection, prom_eval_open_visible, eval);
    prom_eval_begin_cut(eval, cut);
    if (!eval->nodes[0].culled) {
        prom_chains_build(&g->chains);
        for (uint32_t i = 0; i < eval->visited_count; i++) g->opened[eval->visited[i]] = false;
        g->heap.count = 0;
        g->stack[0] = (placed){0, 0};
        place_stacked(g, 1);
        double budget = prom_eval_budget(eval) - eval->fixed_ms;
        left = buy_steps(g, budget - eval->nodes[0].cmin);
        take_better(g, budget);
        emit_cut(g, cut);
    }
    prom_eval_end_cut(eval, cut);
    return g->refused > 0.0 ? 0.0 : left;
}

// Whether the time that is left allows to go over more of the tree.
static bool can_look_closer(const greedy_state *g, double left_ms)
{
    double nodes = fmin(g->eval.model->tree_count, CLOSER_NODES * g->eval.visited_count);
    return left_ms > CLOSER_LEFT * g->eval.selection->budget_ms &&
           nodes * NODE_MS < CLOSER_TIME * g->eval.selection->budget_ms;
}

static void look_closer(greedy_state *g, const prom_selection *selection, prom_cut *cut)
{
    double cmin_ms = cut->cmin_ms, benefit = cut->benefit;
    select_once(g, selection, CLOSER_TOLERANCE, cut);
    if (cut->benefit < benefit) select_once(g, selection, 1.0f, cut);
    cut->cmin_ms = cmin_ms;
}

static void select_greedy(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    greedy_state *g = pointer;
    double left = select_once(g, selection, 1.0f, cut);
    if (can_look_closer(g, left)) look_closer(g, selection, cut);
    cut->limited = g->refused > 0.0 || !cut->feasible;
    prom_bound_certify(g->bound, &g->eval, g->refused, cut);
    prom_steady_keep(&g->steady, &g->eval, cut);
}

const prom_selector_class prom_select_greedy = {
    .name = "greedy",
    .summary = "marginal benefit per cost, from the cheapest cut upwards",
    .budgeted = true,
    .uses_cost = true,
    .create = create,
    .destroy = destroy,
    .select = select_greedy,
};
