// The optimum, for experiments and tests: dynamic programming over the tree. A subtree's front
// holds all its cuts that no other one beats in both cost and benefit; a node's is that of its
// own options and of the sums of its children's.
//
// Exact while fronts have no more than FRONT_MAX cuts, as with a dozen or two leaves; in larger
// trees fronts share POINTS among all nodes, but FRONT_MIN each. A front that has more
// is thinned: of cuts whose costs are in one step of the budget the one with the most benefit
// stays, so that the result is still a cut within the budget, but no longer proven optimal;
// then cut->bound is the usual one instead of the benefit itself. Takes memory as it needs it.
#include "traverse/bound.h"
#include "traverse/evaluate.h"
#include "traverse/selectors.h"

#include <math.h>

enum { FRONT_MAX = 4096, FRONT_MIN = 256, POINTS = 1 << 17 };

// A cut of a subtree, or of the first few children of a node.
typedef struct pareto {
    double cost, benefit;
    uint32_t option;     // the node's own, or PROM_NONE: opened,
    uint32_t rest, last; // as the cut of the children before the last one, and of that
} pareto;

typedef PROM_ARRAY(pareto) point_array;

typedef struct pareto_front {
    size_t first, count; // of the points
} pareto_front;

typedef struct optimal_state {
    prom_eval eval;
    prom_bound *bound;
    pareto_front *of;                 // per node
    point_array points;               // of all fronts
    point_array front, fresh, merged; // scratch
    double budget;                    // of the tree
    size_t most;                      // points of a front
    bool exact;
    uint32_t *stack, *chosen; // nodes to be emitted, and which of their cuts
} optimal_state;

static void *create(const prom_model *model)
{
    optimal_state *o = prom_calloc(1, sizeof *o);
    prom_eval_init(&o->eval, model);
    o->eval.any_mesh_hides = o->eval.heeds_priors = true;
    o->bound = prom_bound_create(model);
    o->of = prom_alloc(model->tree_count, sizeof *o->of);
    o->stack = prom_alloc(model->tree_count, sizeof *o->stack);
    o->chosen = prom_alloc(model->tree_count, sizeof *o->chosen);
    return o;
}

static void destroy(void *pointer)
{
    optimal_state *o = pointer;
    if (!o) return;
    prom_eval_finish(&o->eval);
    prom_bound_destroy(o->bound);
    prom_free(o->of);
    prom_free(o->stack);
    prom_free(o->chosen);
    prom_array_finish(&o->points);
    prom_array_finish(&o->front);
    prom_array_finish(&o->fresh);
    prom_array_finish(&o->merged);
    prom_free(o);
}

// Appends a point to a front, which comes by rising cost, unless it is beaten.
static void append(const optimal_state *o, point_array *front, const pareto *p)
{
    const pareto *last = front->count ? &front->data[front->count - 1] : NULL;
    if (p->cost > o->budget || (last && p->benefit <= last->benefit)) return;
    if (last && p->cost == last->cost) front->count--;
    prom_array_push(front, *p);
}

// Takes the fresh points, which stand by rising cost, into the front.
static void merge_fresh(optimal_state *o)
{
    const point_array *a = &o->front, *b = &o->fresh;
    o->merged.count = 0;
    for (size_t i = 0, k = 0; i < a->count || k < b->count;) {
        bool old = i < a->count && (k == b->count || a->data[i].cost <= b->data[k].cost);
        append(o, &o->merged, old ? &a->data[i++] : &b->data[k++]);
    }
    point_array swap = o->front;
    o->front = o->merged;
    o->merged = swap;
}

// Of the cuts whose costs are in one step of the budget, keeps the last: it shows most; and the
// cheapest of all, on which it may depend whether the whole can be paid.
static void thin_front(optimal_state *o)
{
    point_array *f = &o->front;
    if (f->count <= o->most) return;
    double step = o->budget / (double)o->most;
    size_t kept = 1;
    o->exact = false;
    for (size_t i = 1; i < f->count; i++) {
        bool same =
            kept > 1 && floor(f->data[i].cost / step) == floor(f->data[kept - 1].cost / step);
        f->data[same ? kept - 1 : kept++] = f->data[i];
    }
    f->count = kept;
}

static pareto_front store_front(optimal_state *o)
{
    thin_front(o);
    pareto_front stored = {o->points.count, o->front.count};
    for (size_t i = 0; i < o->front.count; i++) prom_array_push(&o->points, o->front.data[i]);
    return stored;
}

// The sums of two fronts.
static pareto_front add_fronts(optimal_state *o, pareto_front rest, pareto_front last)
{
    o->front.count = 0;
    for (size_t k = last.first; k < last.first + last.count; k++) {
        pareto added = o->points.data[k];
        o->fresh.count = 0;
        for (size_t i = rest.first; i < rest.first + rest.count; i++) {
            const pareto *p = &o->points.data[i];
            prom_array_push(&o->fresh,
                            (pareto){p->cost + added.cost, p->benefit + added.benefit,
                                     PROM_NONE, (uint32_t)i, (uint32_t)k});
        }
        merge_fresh(o);
    }
    return store_front(o);
}

// The front of opening a node.
static pareto_front add_children(optimal_state *o, uint32_t node)
{
    const prom_model *m = o->eval.model;
    pareto_front sum = {0};
    bool any = false;
    for (uint32_t c = 0; c < m->child_count[node]; c++) {
        uint32_t child = m->first_child[node] + c;
        if (o->eval.nodes[child].culled) continue;
        sum = any ? add_fronts(o, sum, o->of[child]) : o->of[child];
        any = true;
    }
    return sum;
}

static void find_front(optimal_state *o, uint32_t node)
{
    const prom_eval_node *n = &o->eval.nodes[node];
    pareto_front opened = n->expanded ? add_children(o, node) : (pareto_front){0};
    o->front.count = 0;
    for (size_t i = 0; i < opened.count; i++) {
        pareto p = o->points.data[opened.first + i];
        p.option = PROM_NONE;
        p.rest = (uint32_t)(opened.first + i);
        prom_array_push(&o->front, p);
    }
    for (uint32_t i = n->first_option; i < n->first_option + n->option_count; i++) {
        const prom_option *option = &o->eval.options[i];
        o->fresh.count = 0;
        prom_array_push(&o->fresh, (pareto){option->cost, (double)option->benefit, i, 0, 0});
        merge_fresh(o);
    }
    o->of[node] = store_front(o);
}

// Puts the children of a node on the stack, each with its part in the opened cut `index`.
static uint32_t push_children(optimal_state *o, uint32_t node, uint32_t index, uint32_t depth)
{
    const prom_model *m = o->eval.model;
    uint32_t left = 0;
    for (uint32_t c = 0; c < m->child_count[node]; c++)
        left += !o->eval.nodes[m->first_child[node] + c].culled;
    for (uint32_t c = m->child_count[node]; c-- > 0;) {
        uint32_t child = m->first_child[node] + c;
        if (o->eval.nodes[child].culled) continue;
        bool first = --left == 0;
        o->stack[depth] = child;
        o->chosen[depth++] = first ? index : o->points.data[index].last;
        if (!first) index = o->points.data[index].rest;
    }
    return depth;
}

static void emit_best(optimal_state *o, prom_cut *cut)
{
    pareto_front root = o->of[0];
    o->stack[0] = 0;
    o->chosen[0] = (uint32_t)(root.first + root.count - 1);
    for (uint32_t depth = 1; depth;) {
        uint32_t node = o->stack[--depth];
        const pareto *p = &o->points.data[o->chosen[depth]];
        if (p->option == PROM_NONE)
            depth = push_children(o, node, p->rest, depth);
        else
            prom_eval_emit(&o->eval, node, p->option, cut);
    }
}

static void select_optimal(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    optimal_state *o = pointer;
    prom_eval *eval = &o->eval;
    prom_eval_run(eval, selection, NULL, NULL);
    prom_eval_begin_cut(eval, cut);
    o->budget = prom_eval_budget(eval) - eval->fixed_ms;
    o->exact = true;
    o->most = POINTS / (size_t)(eval->visited_count + 1);
    if (o->most > FRONT_MAX) o->most = FRONT_MAX;
    if (o->most < FRONT_MIN) o->most = FRONT_MIN;
    o->points.count = 0;
    if (eval->nodes[0].culled || !(eval->nodes[0].cmin <= o->budget)) {
        prom_eval_emit_cmin(eval, cut);
    } else {
        for (uint32_t i = eval->visited_count; i-- > 0;)
            if (!eval->nodes[eval->visited[i]].culled) find_front(o, eval->visited[i]);
        if (o->of[0].count)
            emit_best(o, cut);
        else // by rounding
            prom_eval_emit_cmin(eval, cut);
    }
    prom_eval_end_cut(eval, cut);
    double most = 0.0;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        const prom_eval_node *n = &eval->nodes[eval->visited[i]];
        if (!n->expanded) most += (double)(n->px * n->weight);
    }
    cut->limited = !cut->feasible || cut->benefit < most * (1.0 - 1e-6);
    prom_bound_certify(o->bound, eval, 0.0, cut);
    if (selection->certify && o->exact && cut->feasible) cut->bound = cut->benefit;
}

const prom_selector_class prom_select_optimal = {
    .name = "optimal",
    .summary = "the optimum of small trees; of large ones nearly, and slowly",
    .budgeted = true,
    .uses_cost = true,
    .create = create,
    .destroy = destroy,
    .select = select_optimal,
};
