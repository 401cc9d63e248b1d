#include "app/oracle_moves.h"

#include "app/cut_change.h"

#define PLACES 4    // changed in a try, at most
#define PAYMENTS 48 // tried, until a cut is within its limit
#define BLIND 0.2f  // of the changes, where the picture says nothing
#define OPENINGS 3  // of so many changes of a cluster, one opens it
#define CLOSINGS 4  // of so many payments, one closes a cluster

static uint32_t pick_any(prom_random *random, const prom_cut *cut)
{
    return prom_random_below(random, (uint32_t)cut->entries.count);
}

// An entry, each as often as its error is great.
static uint32_t pick_wrong(prom_random *random, const double *error, const prom_cut *cut)
{
    double sum = 0;
    for (size_t i = 0; i < cut->entries.count; i++) sum += error[cut->entries.data[i].node];
    if (!(sum > 0) || prom_random_unit(random) < BLIND) return pick_any(random, cut);
    double left = sum * (double)prom_random_unit(random);
    uint32_t last = 0;
    for (size_t i = 0; i < cut->entries.count; i++) {
        double own = error[cut->entries.data[i].node];
        if (!(own > 0)) continue;
        last = (uint32_t)i;
        if ((left -= own) < 0) break;
    }
    return last;
}

static bool is_other(const prom_eval *eval, uint32_t option, const prom_cut_entry *e,
                     bool cheaper)
{
    const prom_option *o = &eval->options[option];
    return o->rep != e->rep && (!cheaper || (float)o->cost < e->cost_ms);
}

// Takes another option of the entry's node, if there is one.
static void take_other(const prom_eval *eval, prom_random *random, prom_cut *cut,
                       uint32_t index, bool cheaper)
{
    const prom_cut_entry e = cut->entries.data[index];
    const prom_eval_node *n = &eval->nodes[e.node];
    uint32_t end = n->first_option + n->option_count, others = 0;
    for (uint32_t o = n->first_option; o < end; o++) others += is_other(eval, o, &e, cheaper);
    if (!others) return;
    uint32_t wanted = prom_random_below(random, others);
    for (uint32_t o = n->first_option; o < end; o++) {
        if (!is_other(eval, o, &e, cheaper) || wanted-- > 0) continue;
        prom_cut_take_option(eval, cut, index, o);
        return;
    }
}

static void change(const prom_eval *eval, prom_random *random, const double *error,
                   prom_cut *cut)
{
    uint32_t index = pick_wrong(random, error, cut);
    uint32_t node = cut->entries.data[index].node;
    bool cluster = eval->model->child_count[node] > 0;
    bool best = prom_random_below(random, 2);
    if (cluster && !prom_random_below(random, OPENINGS) &&
        prom_cut_open(eval, cut, index, best ? prom_cut_best_option : prom_cut_cheapest_option))
        return;
    take_other(eval, random, cut, index, false);
}

// Makes some entry cheaper, or a cluster of some.
static void pay(const prom_eval *eval, prom_random *random, prom_cut *cut)
{
    uint32_t index = pick_any(random, cut);
    uint32_t parent = eval->model->parent[cut->entries.data[index].node];
    bool can_close = parent != PROM_NONE && eval->nodes[parent].option_count;
    if (can_close && !prom_random_below(random, CLOSINGS)) {
        const prom_eval_node *p = &eval->nodes[parent];
        prom_cut_close(eval, cut, parent,
                       p->first_option + prom_random_below(random, p->option_count));
        return;
    }
    take_other(eval, random, cut, index, true);
}

// Of what is drawn, in whatever order.
static uint64_t sum_of(const prom_cut *cut)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        sum += prom_random_mix((uint64_t)e->node << 32 | e->rep);
    }
    return sum;
}

bool prom_oracle_move(const prom_eval *eval, prom_random *random, const double *error,
                      double limit_ms, prom_cut *cut)
{
    if (!cut->entries.count) return false;
    uint64_t before = sum_of(cut);
    for (uint32_t i = 1 + prom_random_below(random, PLACES); i-- > 0;)
        change(eval, random, error, cut);
    for (int i = 0; i < PAYMENTS && cut->predicted_ms > limit_ms; i++) pay(eval, random, cut);
    return cut->predicted_ms <= limit_ms && sum_of(cut) != before;
}
