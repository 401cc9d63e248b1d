#include "traverse/moves.h"

#include <math.h>

// Part of the gain that may be lost by stopping at a step that does not fit; by taste, of the
// order of what the proxy is good for.
#define STOP_LOSS 0.02

// A trade must gain this much more than it costs, or cuts would never come to rest.
#define TRADE_GAIN 1.1

void prom_moves_init(prom_moves *moves, const prom_model *model, bool coarsens)
{
    size_t n = model->tree_count;
    *moves = (prom_moves){
        .coarsens = coarsens,
        .option = prom_alloc(n, sizeof *moves->option),
        .sum = prom_alloc(n, sizeof *moves->sum),
        .stack = prom_alloc(n, sizeof *moves->stack),
        .refine.entries = prom_alloc(n, sizeof *moves->refine.entries),
        .refine.place = prom_calloc(n, sizeof *moves->refine.place),
    };
    if (!coarsens) return;
    moves->coarsen.entries = prom_alloc(n, sizeof *moves->coarsen.entries);
    moves->coarsen.place = prom_calloc(n, sizeof *moves->coarsen.place);
}

void prom_moves_finish(prom_moves *moves)
{
    prom_free(moves->option);
    prom_free(moves->sum);
    prom_free(moves->stack);
    prom_free(moves->refine.entries);
    prom_free(moves->refine.place);
    prom_free(moves->coarsen.entries);
    prom_free(moves->coarsen.place);
    *moves = (prom_moves){0};
}

static const prom_priced_node *priced(const prom_prices *prices, uint32_t node)
{
    return &prices->nodes[prices->place[node]];
}

uint32_t prom_moves_choice(const prom_prices *prices, uint32_t node)
{
    const prom_priced_node *p = priced(prices, node);
    if (p->choice == PROM_NONE) return PROM_NONE;
    return prices->eval->nodes[node].first_option + (p->choice - p->first);
}

uint32_t prom_moves_cheapest(void *user, uint32_t node)
{
    const prom_eval *eval = user;
    return eval->nodes[node].cmin_option;
}

// ---- what can be done

typedef struct move {
    double slope;    // value per ms
    uint32_t option; // to what; PROM_NONE: opening
    bool any;
} move;

static double slope_of(prom_point from, prom_point to)
{
    return to.cost > from.cost ? (to.benefit - from.benefit) / (to.cost - from.cost) : INFINITY;
}

static move best_refinement(const prom_moves *moves, uint32_t node)
{
    const prom_priced_node *p = priced(moves->prices, node);
    const prom_point *points = moves->prices->points;
    prom_point now = moves->sum[node];
    move best = {.slope = -INFINITY};
    for (uint32_t k = p->first; k < p[1].first; k++) {
        double slope = slope_of(now, points[k]);
        if (!(points[k].benefit > now.benefit) || !(slope > best.slope)) continue;
        best = (move){slope, moves->eval->nodes[node].first_option + (k - p->first), true};
    }
    if (p->opened && p->below.benefit > now.benefit && slope_of(now, p->below) > best.slope)
        best = (move){slope_of(now, p->below), PROM_NONE, true};
    return best;
}

static move best_coarsening(const prom_moves *moves, uint32_t node)
{
    const prom_priced_node *p = priced(moves->prices, node);
    const prom_point *points = moves->prices->points;
    prom_point now = moves->sum[node];
    move best = {.slope = INFINITY};
    for (uint32_t k = p->first; k < p[1].first; k++) {
        if (!(points[k].cost < now.cost)) continue;
        double slope = slope_of(points[k], now);
        if (slope < best.slope)
            best = (move){slope, moves->eval->nodes[node].first_option + (k - p->first), true};
    }
    return best;
}

static void put_in(prom_heap *heap, move m, double key, uint32_t node)
{
    if (m.any)
        prom_heap_set(heap, key, node);
    else
        prom_heap_remove(heap, node);
}

static void queue(prom_moves *moves, uint32_t node)
{
    move m = {0};
    if (moves->option[node] != PROM_NONE) m = best_refinement(moves, node);
    put_in(&moves->refine, m, m.slope, node);
    if (!moves->coarsens) return;
    m = best_coarsening(moves, node);
    put_in(&moves->coarsen, m, -m.slope, node);
}

// ---- doing it

static uint32_t push_children(const prom_moves *moves, uint32_t node, uint32_t depth)
{
    const prom_model *m = moves->eval->model;
    for (uint32_t c = m->child_count[node]; c-- > 0;)
        if (!moves->eval->nodes[m->first_child[node] + c].culled)
            moves->stack[depth++] = m->first_child[node] + c;
    return depth;
}

static void add_to_ancestors(prom_moves *moves, uint32_t node, prom_point change, bool queued)
{
    const uint32_t *parent = moves->eval->model->parent;
    for (uint32_t n = parent[node]; n != PROM_NONE; n = parent[n]) {
        moves->sum[n].cost += change.cost;
        moves->sum[n].benefit += change.benefit;
        if (!queued || !moves->coarsens) continue;
        move m = best_coarsening(moves, n);
        put_in(&moves->coarsen, m, -m.slope, n);
    }
}

static prom_point point_of(const prom_moves *moves, uint32_t node, uint32_t option)
{
    const prom_priced_node *p = priced(moves->prices, node);
    return moves->prices->points[p->first + (option - moves->eval->nodes[node].first_option)];
}

// Opens a node to what the last look chose.
static void open_node(prom_moves *moves, uint32_t node)
{
    moves->option[node] = PROM_NONE;
    moves->sum[node] = priced(moves->prices, node)->below;
    queue(moves, node);
    for (uint32_t depth = push_children(moves, node, 0); depth;) {
        uint32_t n = moves->stack[--depth];
        uint32_t option = moves->option[n] = prom_moves_choice(moves->prices, n);
        moves->sum[n] =
            option == PROM_NONE ? priced(moves->prices, n)->below : point_of(moves, n, option);
        queue(moves, n);
        if (option == PROM_NONE) depth = push_children(moves, n, depth);
    }
}

// Draws a node by one of its options; what was drawn below is gone.
static void close_node(prom_moves *moves, uint32_t node, uint32_t option)
{
    uint32_t depth = moves->option[node] == PROM_NONE ? push_children(moves, node, 0) : 0;
    while (depth) {
        uint32_t n = moves->stack[--depth];
        prom_heap_remove(&moves->refine, n);
        if (moves->coarsens) prom_heap_remove(&moves->coarsen, n);
        if (moves->option[n] == PROM_NONE) depth = push_children(moves, n, depth);
    }
    moves->option[node] = option;
    moves->sum[node] = point_of(moves, node, option);
    queue(moves, node);
}

static void make(prom_moves *moves, uint32_t node, move m)
{
    prom_point before = moves->sum[node];
    if (m.option == PROM_NONE)
        open_node(moves, node);
    else
        close_node(moves, node, m.option);
    prom_point now = moves->sum[node];
    add_to_ancestors(moves, node,
                     (prom_point){now.cost - before.cost, now.benefit - before.benefit}, true);
}

void prom_moves_start(prom_moves *moves, const prom_prices *prices, prom_moves_choose *choose,
                      void *user)
{
    moves->eval = prices->eval;
    moves->prices = prices;
    prom_heap_clear(&moves->refine);
    prom_heap_clear(&moves->coarsen);
    moves->stack[0] = 0;
    for (uint32_t depth = 1; depth;) {
        uint32_t node = moves->stack[--depth];
        uint32_t option = moves->option[node] = choose(user, node);
        moves->sum[node] = (prom_point){0};
        if (option == PROM_NONE) {
            depth = push_children(moves, node, depth);
            continue;
        }
        moves->sum[node] = point_of(moves, node, option);
        add_to_ancestors(moves, node, moves->sum[node], false);
    }
    moves->stack[0] = 0;
    for (uint32_t depth = 1; depth;) {
        uint32_t node = moves->stack[--depth];
        queue(moves, node);
        if (moves->option[node] == PROM_NONE) depth = push_children(moves, node, depth);
    }
}

// ---- in which order

static double coarsening_slope(const prom_moves *moves)
{
    return moves->coarsen.count ? -moves->coarsen.entries[0].key : INFINITY;
}

static void coarsen_once(prom_moves *moves)
{
    uint32_t node = moves->coarsen.entries[0].node;
    make(moves, node, best_coarsening(moves, node));
}

void prom_moves_coarsen(prom_moves *moves, double budget)
{
    while (moves->coarsen.count &&
           (prom_moves_cost(moves) > budget || coarsening_slope(moves) <= 0.0))
        coarsen_once(moves);
}

// Makes the best refinement if it fits.
static bool refine_once(prom_moves *moves, double budget)
{
    uint32_t node = moves->refine.entries[0].node;
    move m = best_refinement(moves, node);
    prom_point to = m.option == PROM_NONE ? priced(moves->prices, node)->below
                                          : point_of(moves, node, m.option);
    if (prom_moves_cost(moves) + to.cost - moves->sum[node].cost > budget) return false;
    make(moves, node, m);
    return true;
}

bool prom_step_may_be_skipped(double slope, double left_ms, double gained)
{
    double lost = slope * left_ms;
    return lost > STOP_LOSS * (fmax(gained, 0.0) + lost);
}

double prom_moves_refine(prom_moves *moves, double budget, double least_value)
{
    double refused = 0.0;
    while (moves->refine.count) {
        double slope = moves->refine.entries[0].key;
        if (refine_once(moves, budget)) continue;
        if (refused == 0.0) refused = slope;
        if (!prom_step_may_be_skipped(slope, budget - prom_moves_cost(moves),
                                      moves->sum[0].benefit - least_value))
            break;
        prom_heap_pop(&moves->refine);
    }
    return refused;
}

void prom_moves_trade(prom_moves *moves, double budget, uint32_t count)
{
    for (uint32_t i = 0; i < count && moves->refine.count; i++) {
        if (refine_once(moves, budget)) continue;
        if (!(moves->refine.entries[0].key > TRADE_GAIN * coarsening_slope(moves))) break;
        coarsen_once(moves);
    }
}

void prom_moves_emit(const prom_moves *moves, prom_cut *cut)
{
    moves->stack[0] = 0;
    for (uint32_t depth = 1; depth;) {
        uint32_t node = moves->stack[--depth];
        if (moves->option[node] == PROM_NONE)
            depth = push_children(moves, node, depth);
        else
            prom_eval_emit(moves->eval, node, moves->option[node], cut);
    }
}
