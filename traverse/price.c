#include "traverse/price.h"

#include <math.h>

// While the price of the budget is known from one side only, looks move away from the first
// price by this factor, squared each time: last frame's price, or the slope at which a selector
// stopped, is near.
#define FIRST_STEP 1.1

void prom_prices_init(prom_prices *prices, const prom_model *model)
{
    size_t points = 0;
    for (uint32_t n = 0; n < model->tree_count; n++)
        points += model->prototypes[model->prototype[n]].rep_count;
    *prices = (prom_prices){
        .nodes = prom_alloc((size_t)model->tree_count + 1, sizeof *prices->nodes),
        .place = prom_alloc(model->tree_count, sizeof *prices->place),
        .points = prom_alloc(points, sizeof *prices->points),
    };
}

void prom_prices_finish(prom_prices *prices)
{
    prom_free(prices->nodes);
    prom_free(prices->place);
    prom_free(prices->points);
    *prices = (prom_prices){0};
}

void prom_prices_gather(prom_prices *prices, const prom_eval *eval, prom_price_of kind)
{
    const prom_model *m = eval->model;
    bool at_most = kind == PROM_PRICE_AT_MOST;
    uint32_t used = 0;
    prices->eval = eval;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        const prom_eval_node *n = &eval->nodes[node];
        prices->place[node] = i;
        prices->nodes[i] = (prom_priced_node){.first = used, .opened = n->expanded};
        if (i) prices->nodes[i].parent = prices->place[m->parent[node]];
        if (at_most && m->child_count[node] && !n->expanded) {
            prices->points[used++] = (prom_point){n->cmin, (double)(n->px * n->weight)};
            continue;
        }
        for (uint32_t k = 0; k < n->option_count; k++) {
            const prom_option *o = &eval->options[n->first_option + k];
            prices->points[used++] =
                (prom_point){o->cost, (double)(at_most ? o->benefit : o->value)};
        }
    }
    prices->nodes[eval->visited_count].first = used;
}

prom_point prom_prices_look(prom_prices *prices, double price)
{
    prom_priced_node *nodes = prices->nodes;
    prom_point best = {0};
    prices->price = price;
    for (uint32_t i = prices->eval->visited_count; i-- > 0;) {
        prom_priced_node *n = &nodes[i];
        double value = -INFINITY;
        n->below = n->sum;
        n->sum = best = (prom_point){0};
        n->choice = PROM_NONE;
        if (n->opened) best = n->below, value = best.benefit - price * best.cost;
        for (uint32_t k = n->first; k < n[1].first; k++) {
            const prom_point *p = &prices->points[k];
            double v = p->benefit - price * p->cost;
            if (v > value || (v == value && p->cost < best.cost))
                best = *p, value = v, n->choice = k;
        }
        if (!i) break;
        nodes[n->parent].sum.cost += best.cost;
        nodes[n->parent].sum.benefit += best.benefit;
    }
    return best;
}

// Where the lines benefit + price * (budget - cost) of the two meet. What they bound is least
// there, unless another cut is better there.
static double crossing(const prom_bracket *b)
{
    return fmax((b->over.benefit - b->within.benefit) / (b->over.cost - b->within.cost), 0.0);
}

prom_bracket prom_prices_search(prom_prices *prices, prom_point cheapest, double budget,
                                double price, unsigned looks)
{
    prom_bracket b = {.within = cheapest, .least = INFINITY};
    double p = fmax(price, 0.0), step = FIRST_STEP;
    for (unsigned i = 0; i < looks; i++) {
        bool crosses = b.has_over && (b.has_price || !(price > 0.0));
        if (crosses)
            p = crossing(&b);
        else if (i)
            p = b.has_over ? b.low * step : b.high / step, step *= step;
        prom_point at = prom_prices_look(prices, p);
        b.least = fmin(b.least, at.benefit + p * (budget - at.cost));
        if (at.cost <= budget && !(p > 0.0)) {
            b.within = at, b.high = p, b.has_price = true; // everything is paid
            break;
        }
        if (crosses && (at.cost == b.within.cost || at.cost == b.over.cost)) break;
        if (at.cost > budget)
            b.over = at, b.low = p, b.has_over = true;
        else
            b.within = at, b.high = p, b.has_price = true;
    }
    return b;
}
