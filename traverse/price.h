// Cuts at a price: of all cuts of an evaluated view, the one with the most benefit - price *
// cost is found in one pass, since at a price every subtree can be judged by itself (Lagrangian
// relaxation). A price so low that its cut is over the budget and one so high that it is within
// bracket the price that the budget has.
#ifndef PROM_TRAVERSE_PRICE_H
#define PROM_TRAVERSE_PRICE_H

#include "traverse/evaluate.h"

typedef struct prom_point {
    double cost, benefit;
} prom_point;

// A visited node: its ways of being drawn are points [first, first of the next node).
typedef struct prom_priced_node {
    uint32_t first;
    uint32_t parent;  // its place among the visited nodes
    uint32_t choice;  // at the last look: one of the points, or PROM_NONE: opened
    bool opened;      // may be
    prom_point sum;   // scratch
    prom_point below; // of its children, at the last look
} prom_priced_node;

typedef struct prom_prices {
    const prom_eval *eval;
    prom_priced_node *nodes; // in the order of the visited ones, and one more
    uint32_t *place;         // per node of the model
    prom_point *points;
    double price; // of the last look
} prom_prices;

void prom_prices_init(prom_prices *prices, const prom_model *model);
void prom_prices_finish(prom_prices *prices);

typedef enum prom_price_of {
    // Options as they count where things are ordered; points stand as the options do.
    PROM_PRICE_VALUES,
    // Options by their benefit. A cluster that the evaluation did not open shows everything
    // right for what its cheapest option costs.
    PROM_PRICE_AT_MOST,
} prom_price_of;
// After prom_eval_run: what the looks go over, close together.
void prom_prices_gather(prom_prices *prices, const prom_eval *eval, prom_price_of kind);

// The cut with the most benefit - price * cost; of its kind the cheapest.
prom_point prom_prices_look(prom_prices *prices, double price);

// Cuts that are best at their prices: one over the budget, one within it.
typedef struct prom_bracket {
    prom_point over, within;
    double low, high; // their prices
    bool has_over;    // there is one over
    bool has_price;   // the one within is not just the cheapest
    double least;     // of benefit + price * (budget - cost) over all looks: no cut within the
                      // budget has more
} prom_bracket;

// cheapest: of the cuts, within the budget. budget: of the tree, without the fixed part. price:
// to begin with; 0: not known. Ends early once the bracket cannot be closer.
prom_bracket prom_prices_search(prom_prices *prices, prom_point cheapest, double budget,
                                double price, unsigned looks);

#endif
