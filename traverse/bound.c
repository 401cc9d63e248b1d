#include "traverse/bound.h"

#include "traverse/price.h"

#include <math.h>

// Looks for the bound of a finished cut. More than this gain nothing (measured).
#define LOOKS 4

struct prom_bound {
    prom_prices prices;
};

prom_bound *prom_bound_create(const prom_model *model)
{
    prom_bound *bound = prom_alloc(1, sizeof *bound);
    prom_prices_init(&bound->prices, model);
    return bound;
}

void prom_bound_destroy(prom_bound *bound)
{
    if (!bound) return;
    prom_prices_finish(&bound->prices);
    prom_free(bound);
}

// What the pixels are worth, each counted in the topmost node that has it.
static double worth_of(const prom_eval *eval)
{
    const prom_model *m = eval->model;
    double worth = 0.0;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        const prom_eval_node *n = &eval->nodes[eval->visited[i]];
        uint32_t parent = m->parent[eval->visited[i]];
        if (n->in_flow && (parent == PROM_NONE || !eval->nodes[parent].in_flow))
            worth += (double)n->px * (double)n->weight;
    }
    return worth;
}

double prom_bound_find(prom_bound *bound, const prom_eval *eval, double price, unsigned looks)
{
    const prom_eval_node *root = &eval->nodes[0];
    double budget = eval->selection->budget_ms - eval->fixed_ms;
    if (root->culled || !(root->cmin <= budget)) return root->cmin_benefit;
    prom_prices_gather(&bound->prices, eval, PROM_PRICE_AT_MOST);
    prom_bracket b = prom_prices_search(&bound->prices, budget, price, looks);
    return fmin(b.least, worth_of(eval));
}

void prom_bound_certify(prom_bound *bound, const prom_eval *eval, double price, prom_cut *cut)
{
    if (!eval->selection->certify) return;
    double least = prom_bound_find(bound, eval, price, LOOKS);
    cut->bound = cut->feasible ? fmax(least, cut->benefit) : least; // but for rounding
}

double prom_cut_gap(const prom_cut *cut)
{
    if (!isfinite(cut->bound)) return NAN;
    double gain = cut->bound - cut->cmin_benefit;
    if (!(gain > 0.0)) return 0.0;
    return fmin(fmax((cut->bound - cut->benefit) / gain, 0.0), 1.0);
}
