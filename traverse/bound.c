#include "traverse/bound.h"

#include "traverse/price.h"

#include <math.h>

// Looks for the bound of a finished cut, from a price near the right one and from nothing. More
// than these gain nothing (measured).
#define LOOKS 4
#define FIRST_LOOKS 16

// Where the gap is larger than this, the bound is tightened: by so many branches at most.
#define WIDE_GAP 0.03
#define SPLIT_GAIN 0.1 // of the gap, that the first split has to close
enum { BRANCHES = 8 };

// Some ways of drawing a visited node: its own that cost no more than `cost`, and being opened
// if `opened`; or, if `rest`, all others.
typedef struct some_ways {
    uint32_t place; // among the visited nodes
    double cost;
    bool opened, rest;
} some_ways;

// The cuts in which some nodes are drawn in some ways, or are not drawn.
typedef struct branch {
    some_ways only[BRANCHES];
    uint32_t depth;
    double bound;
    bool splits; // at
    some_ways split;
} branch;

struct prom_bound {
    prom_prices prices;
    uint32_t *choice; // per visited node, of a look
    double *cost;
    bool *reached;
    branch branches[BRANCHES];
};

prom_bound *prom_bound_create(const prom_model *model)
{
    prom_bound *bound = prom_alloc(1, sizeof *bound);
    prom_prices_init(&bound->prices, model);
    bound->choice = prom_alloc(model->tree_count, sizeof *bound->choice);
    bound->cost = prom_alloc(model->tree_count, sizeof *bound->cost);
    bound->reached = prom_alloc(model->tree_count, sizeof *bound->reached);
    return bound;
}

void prom_bound_destroy(prom_bound *bound)
{
    if (!bound) return;
    prom_prices_finish(&bound->prices);
    prom_free(bound->choice);
    prom_free(bound->cost);
    prom_free(bound->reached);
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
    prom_bracket b = prom_prices_search(
        &bound->prices, (prom_point){root->cmin, root->cmin_benefit}, budget, price, looks);
    return fmin(b.least, worth_of(eval));
}

// ---- tighter: branch and bound (Land and Doig 1960), a few steps of it

// A single step that is large beside the budget makes the bound loose: bought in part, as the
// bound takes it, it gains where no cut can. So the cuts are parted into those without the step
// and those with it; each part has a bound of its own, and what holds for both holds for all.

static void keep_ways(prom_prices *prices, const some_ways *ways)
{
    prom_priced_node *n = &prices->nodes[ways->place];
    for (uint32_t k = n->first; k < n[1].first; k++)
        if ((prices->points[k].cost <= ways->cost) == ways->rest)
            prices->points[k].cost = INFINITY;
    n->opened = n->opened && ways->opened != ways->rest;
}

// How a node is drawn by the last look, and what that costs.
static double cost_of_choice(const prom_prices *prices, uint32_t place)
{
    const prom_priced_node *n = &prices->nodes[place];
    return n->choice == PROM_NONE ? n->below.cost : prices->points[n->choice].cost;
}

// The node whose ways at the two prices are furthest apart, of the topmost that are not alike.
static void find_split(prom_bound *bound, uint32_t count, double low, double high, branch *b)
{
    prom_prices *prices = &bound->prices;
    prom_prices_look(prices, low);
    for (uint32_t i = 0; i < count; i++) {
        bound->choice[i] = prices->nodes[i].choice;
        bound->cost[i] = cost_of_choice(prices, i);
    }
    prom_prices_look(prices, high);
    double furthest = 0.0;
    for (uint32_t i = 0; i < count; i++) {
        const prom_priced_node *n = &prices->nodes[i];
        bool drawn = !i || bound->reached[n->parent];
        bound->reached[i] = drawn && n->choice == PROM_NONE && bound->choice[i] == PROM_NONE;
        if (!drawn || n->choice == bound->choice[i]) continue;
        double cost = cost_of_choice(prices, i), apart = bound->cost[i] - cost;
        if (!(apart > furthest)) continue;
        furthest = apart;
        b->splits = true;
        b->split = (some_ways){i, cost, n->choice == PROM_NONE, false};
    }
}

static void bound_branch(prom_bound *bound, const prom_eval *eval, double price, branch *b)
{
    prom_prices *prices = &bound->prices;
    double budget = eval->selection->budget_ms - eval->fixed_ms, dear = 1e9 * price;
    prom_prices_gather(prices, eval, PROM_PRICE_AT_MOST);
    for (uint32_t i = 0; i < b->depth; i++) keep_ways(prices, &b->only[i]);
    prom_point cheapest = prom_prices_look(prices, dear);
    b->splits = false;
    b->bound = -INFINITY;
    if (cheapest.cost > budget) return; // by so much that no price for it is too high
    prom_bracket found = prom_prices_search(prices, cheapest, budget, price, 2 * LOOKS);
    b->bound = fmin(found.least, cheapest.benefit + dear * (budget - cheapest.cost));
    if (found.has_over && b->depth + 1 < BRANCHES)
        find_split(bound, eval->visited_count, found.low, found.has_price ? found.high : dear,
                   b);
}

// least: what a cut within the budget has.
static double tighten(prom_bound *bound, const prom_eval *eval, double price, double least)
{
    branch *b = bound->branches;
    uint32_t count = 1, worst = 0;
    b[0].depth = 0;
    bound_branch(bound, eval, price, &b[0]);
    double first = b[0].bound;
    while (b[worst].splits && count < BRANCHES) {
        // Where the first split does not help, it is not for one large step that it is wide.
        if (count == 2 && first - b[worst].bound < SPLIT_GAIN * (first - least)) break;
        b[count] = b[worst];
        b[worst].only[b[worst].depth++] = b[worst].split;
        b[count].only[b[count].depth] = b[count].split;
        b[count].only[b[count].depth++].rest = true;
        bound_branch(bound, eval, price, &b[worst]);
        bound_branch(bound, eval, price, &b[count++]);
        for (uint32_t i = 0; i < count; i++)
            if (b[i].bound > b[worst].bound) worst = i;
    }
    return b[worst].bound;
}

void prom_bound_certify(prom_bound *bound, const prom_eval *eval, double price, prom_cut *cut)
{
    if (!eval->selection->certify) return;
    cut->bound = prom_bound_find(bound, eval, price, price > 0.0 ? LOOKS : FIRST_LOOKS);
    if (!cut->feasible) return;
    if (price > 0.0 && prom_cut_gap(cut) > WIDE_GAP)
        cut->bound = fmin(cut->bound, tighten(bound, eval, price, cut->benefit));
    cut->bound = fmax(cut->bound, cut->benefit); // but for rounding
}

double prom_cut_gap(const prom_cut *cut)
{
    if (!isfinite(cut->bound)) return NAN;
    double gain = cut->bound - cut->cmin_benefit;
    if (!(gain > 0.0)) return 0.0;
    return fmin(fmax((cut->bound - cut->benefit) / gain, 0.0), 1.0);
}
