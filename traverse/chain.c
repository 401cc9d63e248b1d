#include "traverse/chain.h"

#include <assert.h>
#include <math.h>

struct prom_chain_point {
    double cost, benefit;
    uint32_t option;
    prom_chain_limit limit;
};

void prom_chains_init(prom_chains *chains, const prom_eval *eval)
{
    const prom_model *m = eval->model;
    *chains = (prom_chains){.eval = eval};
    size_t states = 0, options = 0;
    for (uint32_t n = 0; n < m->tree_count; n++) {
        size_t reps = m->prototypes[m->prototype[n]].rep_count;
        bool few = !m->child_count[n] && reps < PROM_CHAIN_MAX;
        states += few ? reps : PROM_CHAIN_MAX;
        if (reps > options) options = reps;
    }
    size_t points = options + 1 + (size_t)eval->max_children * (PROM_CHAIN_MAX - 1);
    chains->nodes = prom_calloc(m->tree_count, sizeof *chains->nodes);
    chains->states = prom_alloc(states, sizeof *chains->states);
    chains->points = prom_alloc(points, sizeof *chains->points);
    chains->hull = prom_alloc(points, sizeof *chains->hull);
    chains->own = prom_alloc(options, sizeof *chains->own);
    chains->merge.entries = prom_alloc(eval->max_children, sizeof *chains->merge.entries);
    chains->taken = prom_alloc(eval->max_children, 1);
}

void prom_chains_finish(prom_chains *chains)
{
    prom_free(chains->nodes);
    prom_free(chains->states);
    prom_free(chains->points);
    prom_free(chains->hull);
    prom_free(chains->own);
    prom_free(chains->merge.entries);
    prom_free(chains->taken);
    *chains = (prom_chains){0};
}

// ---- what opening a node offers

// Starts the merge of the children's steps; *point is the children at their cheapest. False if
// no child is in the frustum.
static bool merge_begin(prom_chains *chains, uint32_t node, prom_chain_point *point)
{
    const prom_model *m = chains->eval->model;
    uint32_t first = m->first_child[node];
    bool any = false;
    *point = (prom_chain_point){.option = PROM_NONE, .limit = {INFINITY, 0}};
    chains->merge.count = 0;
    for (uint32_t c = 0; c < m->child_count[node]; c++) {
        if (chains->eval->nodes[first + c].culled) continue;
        const prom_chain *chain = &chains->nodes[first + c];
        if (!chain->count) continue;
        const prom_chain_state *s = &chains->states[chain->first];
        any = true;
        point->cost += s[0].cost;
        point->benefit += s[0].benefit;
        chains->taken[c] = 0;
        if (chain->count > 1) prom_heap_push(&chains->merge, s[1].slope, first + c);
    }
    return any;
}

// Adds the next step to *point; false when there is none.
static bool merge_next(prom_chains *chains, uint32_t node, prom_chain_point *point)
{
    if (!chains->merge.count) return false;
    prom_heap_entry top = chains->merge.entries[0];
    const prom_chain *chain = &chains->nodes[top.node];
    uint8_t place = ++chains->taken[top.node - chains->eval->model->first_child[node]];
    const prom_chain_state *s = &chains->states[chain->first + place];
    point->cost += s->cost - s[-1].cost;
    point->benefit += s->benefit - s[-1].benefit;
    point->limit = (prom_chain_limit){top.key, top.node};
    if (place + 1 < chain->count)
        prom_heap_lower_first(&chains->merge, s[1].slope);
    else
        prom_heap_pop(&chains->merge);
    return true;
}

uint8_t prom_chain_child_place(const prom_chains *chains, uint32_t child,
                               const prom_chain_limit *limit)
{
    const prom_chain *chain = &chains->nodes[child];
    const prom_chain_state *s = &chains->states[chain->first];
    uint8_t place = 0;
    while (place + 1 < chain->count &&
           (s[place + 1].slope > limit->slope ||
            (s[place + 1].slope == limit->slope && child <= limit->child)))
        place++;
    return place;
}

bool prom_chain_least_opening(prom_chains *chains, uint32_t node, double benefit,
                              prom_chain_state *state)
{
    prom_chain_point p;
    if (!merge_begin(chains, node, &p)) return false;
    while (!(p.benefit > benefit))
        if (!merge_next(chains, node, &p)) return false;
    *state = (prom_chain_state){p.cost, p.benefit, 0.0, PROM_NONE, p.limit};
    return true;
}

// ---- the hull

static bool cheaper(const prom_chain_point *a, const prom_chain_point *b)
{
    return a->cost < b->cost || (a->cost == b->cost && a->benefit > b->benefit);
}

// The node's own options by rising cost.
static uint32_t sort_own(prom_chains *chains, uint32_t node)
{
    const prom_eval_node *n = &chains->eval->nodes[node];
    for (uint32_t i = 0; i < n->option_count; i++) {
        const prom_option *o = &chains->eval->options[n->first_option + i];
        prom_chain_point p = {o->cost, o->value, n->first_option + i, {INFINITY, 0}};
        uint32_t k = i;
        for (; k > 0 && cheaper(&p, &chains->own[k - 1]); k--)
            chains->own[k] = chains->own[k - 1];
        chains->own[k] = p;
    }
    return n->option_count;
}

// All points, own and opened, by rising cost.
static uint32_t gather_points(prom_chains *chains, uint32_t node)
{
    uint32_t own = sort_own(chains, node), used = 0, count = 0;
    prom_chain_point opened;
    bool more = chains->eval->nodes[node].expanded && merge_begin(chains, node, &opened);
    while (more || used < own) {
        // On equal terms the node's own picture comes first.
        bool take_own = used < own && !(more && cheaper(&opened, &chains->own[used]));
        chains->points[count++] = take_own ? chains->own[used++] : opened;
        if (!take_own) more = merge_next(chains, node, &opened);
    }
    return count;
}

static double slope_between(const prom_chain_point *a, const prom_chain_point *b)
{
    return (b->benefit - a->benefit) / (b->cost - a->cost);
}

// The upper concave hull from the cheapest point to the one of most benefit.
static uint32_t find_hull(prom_chains *chains, uint32_t count)
{
    prom_chain_point *hull = chains->hull;
    uint32_t size = 0;
    for (uint32_t i = 0; i < count; i++) {
        const prom_chain_point *p = &chains->points[i];
        if (size && (p->benefit <= hull[size - 1].benefit || p->cost <= hull[size - 1].cost))
            continue;
        while (size > 1 && slope_between(&hull[size - 1], p) >=
                               slope_between(&hull[size - 2], &hull[size - 1]))
            size--;
        hull[size++] = *p;
    }
    return size;
}

// Keeps the cheapest, its first step, the best, and of the rest an even choice.
static uint32_t thin_hull(prom_chain_point *hull, uint32_t size)
{
    if (size <= PROM_CHAIN_MAX) return size;
    for (uint32_t i = 2; i < PROM_CHAIN_MAX; i++)
        hull[i] = hull[1 + (size_t)(i - 1) * (size - 2) / (PROM_CHAIN_MAX - 2)];
    return PROM_CHAIN_MAX;
}

static void store_chain(prom_chains *chains, uint32_t node, uint32_t size)
{
    const prom_chain_point *hull = chains->hull;
    prom_chain *chain = &chains->nodes[node];
    *chain = (prom_chain){.first = chains->state_count};
    prom_chain_state *s = &chains->states[chain->first];
    for (uint32_t i = 0; i < size; i++) {
        // Thinning can make neighbouring slopes equal by rounding; the merge needs them apart.
        double slope = i ? slope_between(&hull[i - 1], &hull[i]) : INFINITY;
        while (chain->count > 1 && slope >= s[chain->count - 1].slope) {
            chain->count--;
            const prom_chain_state *b = &s[chain->count - 1];
            slope = (hull[i].benefit - b->benefit) / (hull[i].cost - b->cost);
        }
        s[chain->count++] = (prom_chain_state){hull[i].cost, hull[i].benefit, slope,
                                               hull[i].option, hull[i].limit};
    }
    chain->own_end = chain->count;
    while (chain->own_end && s[chain->own_end - 1].option == PROM_NONE) chain->own_end--;
    chains->state_count += chain->count;
}

void prom_chains_build(prom_chains *chains)
{
    const prom_eval *eval = chains->eval;
    chains->state_count = 0;
    for (uint32_t i = eval->visited_count; i-- > 0;) {
        uint32_t node = eval->visited[i];
        chains->nodes[node].count = 0;
        if (eval->nodes[node].culled) continue;
        uint32_t size = find_hull(chains, gather_points(chains, node));
        store_chain(chains, node, thin_hull(chains->hull, size));
    }
}
