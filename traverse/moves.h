// A cut that is changed move by move: entries are refined, or parts of it coarsened, each by
// the move of the best slope. Costs and values are those of the prices that it starts from, and
// nodes are opened to what the last look chose below them, so that a poor first split does not
// hide what lies further down.
#ifndef PROM_TRAVERSE_MOVES_H
#define PROM_TRAVERSE_MOVES_H

#include "traverse/heap.h"
#include "traverse/price.h"

typedef struct prom_moves {
    const prom_eval *eval;
    const prom_prices *prices;
    // Per node, valid from the root down to the entries:
    uint32_t *option;  // into eval->options, or PROM_NONE: opened
    prom_point *sum;   // of what is drawn for it
    prom_heap refine;  // entries, by the value that each ms buys
    prom_heap coarsen; // all nodes, by the value that each ms costs, negated; unless not wanted
    bool coarsens;
    uint32_t *stack;
} prom_moves;

void prom_moves_init(prom_moves *moves, const prom_model *model, bool coarsens);
void prom_moves_finish(prom_moves *moves);

// What a node is drawn by to begin with: an option of it, or PROM_NONE: opened. May look at
// moves->option of its ancestors.
typedef uint32_t prom_moves_choose(void *user, uint32_t node);
// The root must not be culled.
void prom_moves_start(prom_moves *moves, const prom_prices *prices, prom_moves_choose *choose,
                      void *user);
// The cheapest cut; user: the evaluation.
prom_moves_choose prom_moves_cheapest;
// The choice of the last look, to choose by.
uint32_t prom_moves_choice(const prom_prices *prices, uint32_t node);

static inline double prom_moves_cost(const prom_moves *moves)
{
    return moves->sum[0].cost;
}

// Makes moves that gain for nothing, and coarsens until the cost is within the budget, or there
// is no way to.
void prom_moves_coarsen(prom_moves *moves, double budget);
// Refines by falling slope, until a step does not fit (see prom_step_may_be_skipped). Returns
// the slope of the first such step, or 0 if all fitted.
double prom_moves_refine(prom_moves *moves, double budget, double least_value);
// Where a step does not fit, makes room for it by coarsening elsewhere for less than it gains;
// at most `count` times.
void prom_moves_trade(prom_moves *moves, double budget, uint32_t count);

// Steps come by falling slope, so what a budget could still buy when one does not fit is at
// most slope * left. Where that is little beside what has been gained, the filling stops there:
// going on with what fits would make levels flip. Else it is skipped.
bool prom_step_may_be_skipped(double slope, double left_ms, double gained);

void prom_moves_emit(const prom_moves *moves, prom_cut *cut);

#endif
