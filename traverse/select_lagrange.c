// Lagrangian relaxation: each ms has a price, every subtree is drawn by what is best at it, and
// the price is searched at which the whole is within the budget. What is left then is filled by
// steps of falling slope.
//
// The search starts at the price of the frame before; its lower side is the certificate.
#include "traverse/bound.h"
#include "traverse/moves.h"
#include "traverse/selectors.h"
#include "traverse/steady.h"

#include <math.h>

// Looks for the price; it is found after 3 or 4 from a near one, after 10 from nothing.
#define LOOKS 16

typedef struct lagrange_state {
    prom_eval eval;
    prom_prices prices;
    prom_moves moves;
    prom_bound *bound;
    prom_steady steady;
    double price; // of the last frame
} lagrange_state;

static void *create(const prom_model *model)
{
    lagrange_state *l = prom_calloc(1, sizeof *l);
    prom_eval_init(&l->eval, model);
    l->eval.any_mesh_hides = l->eval.heeds_priors = true;
    prom_prices_init(&l->prices, model);
    prom_moves_init(&l->moves, model, false);
    l->bound = prom_bound_create(model);
    prom_steady_init(&l->steady, model);
    return l;
}

static void destroy(void *pointer)
{
    lagrange_state *l = pointer;
    if (!l) return;
    prom_steady_finish(&l->steady);
    prom_bound_destroy(l->bound);
    prom_moves_finish(&l->moves);
    prom_prices_finish(&l->prices);
    prom_eval_finish(&l->eval);
    prom_free(l);
}

static uint32_t priced_choice(void *user, uint32_t node)
{
    const lagrange_state *l = user;
    return prom_moves_choice(&l->prices, node);
}

// Returns the slope of the first step that did not fit; 0: all did.
static double find_cut(lagrange_state *l, double budget)
{
    prom_prices_gather(&l->prices, &l->eval, PROM_PRICE_VALUES);
    const prom_eval_node *root = &l->eval.nodes[0];
    prom_bracket b = prom_prices_search(
        &l->prices, (prom_point){root->cmin, root->cmin_benefit}, budget, l->price, LOOKS);
    // Opened nodes are opened as at the price just too low; what is drawn is as at the other.
    if (b.has_price) {
        prom_prices_look(&l->prices, b.high);
        prom_moves_start(&l->moves, &l->prices, priced_choice, l);
        l->price = b.high;
    } else {
        prom_moves_start(&l->moves, &l->prices, prom_moves_cheapest, &l->eval);
        l->price = b.has_over ? b.low : 0.0;
    }
    return prom_moves_refine(&l->moves, budget, root->cmin_benefit);
}

static void select_lagrange(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    lagrange_state *l = pointer;
    prom_eval *eval = &l->eval;
    prom_eval_run(eval, selection, prom_eval_open_visible, eval);
    prom_eval_begin_cut(eval, cut);
    double budget = prom_eval_budget(eval) - eval->fixed_ms, refused = 0.0;
    if (!eval->nodes[0].culled && eval->nodes[0].cmin <= budget) {
        refused = find_cut(l, budget);
        prom_moves_emit(&l->moves, cut);
    } else {
        prom_eval_emit_cmin(eval, cut);
    }
    prom_eval_end_cut(eval, cut);
    cut->limited = refused > 0.0 || !cut->feasible;
    prom_bound_certify(l->bound, eval, refused > 0.0 ? l->price : 0.0, cut);
    prom_steady_keep(&l->steady, eval, cut);
}

const prom_selector_class prom_select_lagrange = {
    .name = "lagrange",
    .summary = "the best at a price per ms, which is searched; then what fits",
    .budgeted = true,
    .uses_cost = true,
    .create = create,
    .destroy = destroy,
    .select = select_lagrange,
};
