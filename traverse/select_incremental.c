// The last frame's cut, refined and coarsened: only the cut itself, what is above it and the
// children of its clusters are looked at, so that the work grows with the cut.
//
// What was drawn is drawn again where it is still valid, at its costs in the new view. Two
// heaps hold what each ms buys by the next refinement, and what it costs by the next
// coarsening: over the budget the cheapest coarsenings are made, within it the best
// refinements; where one does not fit, others make room for it if that loses less than it
// gains. Without a last frame, or where its neighbourhood is not within the budget, the whole
// tree is gone over as by the other selectors.
#include "traverse/bound.h"
#include "traverse/moves.h"
#include "traverse/selectors.h"
#include "traverse/steady.h"

#include <math.h>

// Looks for a price when nothing is known.
#define LOOKS 16
#define BOUND_LOOKS 4

typedef struct incremental_state {
    prom_eval eval;
    prom_prices prices;
    prom_moves moves;
    prom_bound *bound;
    prom_steady steady;
    prom_last_cut last;
    double price;       // at which steps were bought in the last frame
    bool stopped_short; // above something that would be visibly better
} incremental_state;

static void *create(const prom_model *model)
{
    incremental_state *s = prom_calloc(1, sizeof *s);
    prom_eval_init(&s->eval, model);
    s->eval.any_mesh_hides = s->eval.heeds_priors = true;
    prom_prices_init(&s->prices, model);
    prom_moves_init(&s->moves, model, true);
    s->bound = prom_bound_create(model);
    prom_steady_init(&s->steady, model);
    prom_last_cut_init(&s->last, model);
    return s;
}

static void destroy(void *pointer)
{
    incremental_state *s = pointer;
    if (!s) return;
    prom_last_cut_finish(&s->last);
    prom_steady_finish(&s->steady);
    prom_bound_destroy(s->bound);
    prom_moves_finish(&s->moves);
    prom_prices_finish(&s->prices);
    prom_eval_finish(&s->eval);
    prom_free(s);
}

// ---- what is looked at

static bool is_known(const prom_last_cut *last, uint32_t node)
{
    return last->rep[node] != PROM_NONE || prom_last_cut_opened(last, node);
}

// Down to the children of what was drawn; where something came into view, as far as it shows.
static bool open_near(void *user, uint32_t node)
{
    incremental_state *s = user;
    if (!prom_eval_open_visible(&s->eval, node)) return false;
    if (is_known(&s->last, node)) return true;
    uint32_t parent = s->eval.model->parent[node];
    bool open = parent == PROM_NONE || s->last.rep[parent] == PROM_NONE;
    s->stopped_short = s->stopped_short || !open;
    return open;
}

// ---- what is drawn to begin with

static uint32_t last_option(const incremental_state *s, uint32_t node)
{
    const prom_eval_node *n = &s->eval.nodes[node];
    uint32_t rep = s->last.rep[node];
    for (uint32_t i = 0; rep != PROM_NONE && i < n->option_count; i++)
        if (s->eval.options[n->first_option + i].rep == rep) return n->first_option + i;
    return PROM_NONE;
}

// As in the last cut; what was not in it, or cannot be so any more, as is best at the price.
static uint32_t choose(void *user, uint32_t node)
{
    const incremental_state *s = user;
    uint32_t option = last_option(s, node);
    if (option != PROM_NONE) return option;
    if (prom_last_cut_opened(&s->last, node) && s->eval.nodes[node].expanded) return PROM_NONE;
    return prom_moves_choice(&s->prices, node);
}

// Returns the slope of the first step that did not fit; 0: all did.
static double change_cut(incremental_state *s, double budget)
{
    const prom_eval_node *root = &s->eval.nodes[0];
    prom_prices_gather(&s->prices, &s->eval, PROM_PRICE_VALUES);
    if (s->last.number)
        prom_prices_look(&s->prices, s->price);
    else
        s->price = prom_prices_search(&s->prices, (prom_point){root->cmin, root->cmin_benefit},
                                      budget, s->price, LOOKS)
                       .high;
    prom_moves_start(&s->moves, &s->prices, choose, s);
    prom_moves_coarsen(&s->moves, budget);
    // Coarsening one by one may end beside the cheapest cut.
    if (prom_moves_cost(&s->moves) > budget)
        prom_moves_start(&s->moves, &s->prices, prom_moves_cheapest, &s->eval);
    prom_moves_trade(&s->moves, budget, s->eval.visited_count);
    double refused = prom_moves_refine(&s->moves, budget, root->cmin_benefit);
    s->price = refused;
    return refused;
}

// Evaluates what is near the last cut, or all, and changes the cut. Returns as change_cut;
// below 0 if nothing is within the budget.
static double select_among(incremental_state *s, const prom_selection *selection, bool near,
                           prom_cut *cut)
{
    prom_eval *eval = &s->eval;
    prom_eval_run(eval, selection, near ? open_near : prom_eval_open_visible,
                  near ? (void *)s : eval);
    prom_eval_begin_cut(eval, cut);
    double budget = prom_eval_budget(eval) - eval->fixed_ms;
    bool fits = !eval->nodes[0].culled && eval->nodes[0].cmin <= budget;
    return fits ? change_cut(s, budget) : -1.0;
}

// Without branches: where this bound is wide it is for what was not opened.
static void certify(incremental_state *s, double price, prom_cut *cut)
{
    if (!s->eval.selection->certify) return;
    cut->bound = prom_bound_find(s->bound, &s->eval, price, BOUND_LOOKS);
    if (cut->feasible) cut->bound = fmax(cut->bound, cut->benefit); // but for rounding
}

static void select_incremental(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    incremental_state *s = pointer;
    prom_eval *eval = &s->eval;
    s->stopped_short = false;
    double refused = select_among(s, selection, s->last.number > 0, cut);
    bool fits = refused >= 0.0;
    if (s->last.number && (!fits || (refused == 0.0 && s->stopped_short))) {
        refused = select_among(s, selection, false, cut);
        fits = refused >= 0.0;
    }
    if (fits)
        prom_moves_emit(&s->moves, cut);
    else
        prom_eval_emit_cmin(eval, cut);
    prom_eval_end_cut(eval, cut);
    cut->limited = refused > 0.0 || !cut->feasible;
    certify(s, refused, cut);
    prom_steady_keep(&s->steady, eval, cut);
    prom_last_cut_note(&s->last, cut);
}

const prom_selector_class prom_select_incremental = {
    .name = "incremental",
    .summary = "the last cut, refined and coarsened; the work grows with the cut",
    .budgeted = true,
    .uses_cost = true,
    .create = create,
    .destroy = destroy,
    .select = select_incremental,
};
