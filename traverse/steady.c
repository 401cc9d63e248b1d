#include "traverse/steady.h"

#include <math.h>
#include <stdlib.h>

typedef prom_steady_region region;

void prom_steady_init(prom_steady *steady, const prom_model *model)
{
    *steady = (prom_steady){0};
    prom_last_cut_init(&steady->wanted, model);
    steady->keep = prom_calloc(model->tree_count, sizeof *steady->keep);
    steady->stack = prom_alloc(model->tree_count, sizeof *steady->stack);
}

void prom_steady_finish(prom_steady *steady)
{
    prom_last_cut_finish(&steady->wanted);
    prom_array_finish(&steady->regions);
    prom_free(steady->keep);
    prom_free(steady->stack);
    *steady = (prom_steady){0};
}

static uint32_t option_of(const prom_eval *eval, uint32_t node, uint32_t rep)
{
    const prom_eval_node *n = &eval->nodes[node];
    for (uint32_t i = 0; i < n->option_count; i++)
        if (eval->options[n->first_option + i].rep == rep) return n->first_option + i;
    return PROM_NONE;
}

static uint32_t push_children(const prom_eval *eval, uint32_t node, uint32_t *stack,
                              uint32_t depth)
{
    const prom_model *m = eval->model;
    for (uint32_t c = m->child_count[node]; c-- > 0;)
        if (!eval->nodes[m->first_child[node] + c].culled)
            stack[depth++] = m->first_child[node] + c;
    return depth;
}

// ---- what a region is worth, new and old

static void add_option(const prom_eval *eval, uint32_t option, double sign, region *r)
{
    r->cost += sign * eval->options[option].cost;
    r->benefit += sign * (double)eval->options[option].benefit;
}

// Next to be emitted of what stands for a node: an option, PROM_NONE: its children, or
// NOT_VALID.
enum { NOT_VALID = PROM_NONE - 1 };

static uint32_t old_option(const prom_eval *eval, uint32_t node)
{
    const prom_last_cut *last = eval->selection->last;
    if (last->rep[node] != PROM_NONE) {
        uint32_t option = option_of(eval, node, last->rep[node]);
        return option != PROM_NONE ? option : NOT_VALID;
    }
    if (!prom_last_cut_opened(last, node)) return eval->nodes[node].cmin_option;
    return eval->nodes[node].expanded ? PROM_NONE : NOT_VALID;
}

static uint32_t new_option(const prom_steady *s, const prom_eval *eval, uint32_t node)
{
    uint32_t rep = s->wanted.rep[node];
    return rep == PROM_NONE ? PROM_NONE : option_of(eval, node, rep);
}

static void add_new(prom_steady *s, const prom_eval *eval, region *r)
{
    s->stack[0] = r->root;
    for (uint32_t depth = 1; depth;) {
        uint32_t node = s->stack[--depth], option = new_option(s, eval, node);
        if (option == PROM_NONE) {
            depth = push_children(eval, node, s->stack, depth);
            continue;
        }
        add_option(eval, option, 1.0, r);
        const prom_cut_entry entry = {
            .node = node, .rep = eval->options[option].rep, .visible_px = eval->nodes[node].px};
        r->switches += prom_last_cut_is_switch(eval->selection->last, &entry);
    }
}

static void subtract_old(prom_steady *s, const prom_eval *eval, region *r)
{
    r->may_keep = true;
    s->stack[0] = r->root;
    for (uint32_t depth = 1; depth && r->may_keep;) {
        uint32_t node = s->stack[--depth], option = old_option(eval, node);
        if (option == NOT_VALID)
            r->may_keep = false;
        else if (option == PROM_NONE)
            depth = push_children(eval, node, s->stack, depth);
        else
            add_option(eval, option, -1.0, r);
    }
}

// Whether the old cut and the new one go further down from here.
static bool both_open(const prom_steady *s, const prom_last_cut *last, uint32_t node)
{
    return last->rep[node] == PROM_NONE && s->wanted.rep[node] == PROM_NONE &&
           prom_last_cut_opened(last, node);
}

static bool differ(const prom_steady *s, const prom_last_cut *last, uint32_t node)
{
    if (last->rep[node] == PROM_NONE && !prom_last_cut_opened(last, node)) return false;
    return last->rep[node] != s->wanted.rep[node];
}

static uint32_t find_regions(prom_steady *s, const prom_eval *eval)
{
    const prom_model *m = eval->model;
    const prom_last_cut *last = eval->selection->last;
    uint32_t switches = 0;
    s->regions.count = 0;
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        // Nodes below what both open; visited ones come parents first.
        uint32_t node = eval->visited[i], parent = m->parent[node];
        s->keep[node] = false;
        bool reached = parent == PROM_NONE || s->keep[parent];
        if (!reached || eval->nodes[node].culled) continue;
        if (both_open(s, last, node)) {
            s->keep[node] = true; // spent as the mark here
        } else if (differ(s, last, node)) {
            region r = {.root = node};
            add_new(s, eval, &r);
            subtract_old(s, eval, &r);
            switches += r.switches;
            prom_array_push(&s->regions, r);
        }
    }
    for (uint32_t i = 0; i < eval->visited_count; i++) s->keep[eval->visited[i]] = false;
    return switches;
}

// ---- which regions are switched

static double saving(const region *r)
{
    return -r->cost / r->switches;
}

static double gain(const region *r)
{
    return r->benefit / r->switches;
}

static int by_falling(double a, double b, const region *x, const region *y)
{
    if (a != b) return a > b ? -1 : 1;
    return x->root < y->root ? -1 : x->root > y->root;
}

static int by_saving(const void *a, const void *b)
{
    return by_falling(saving(a), saving(b), a, b);
}

static int by_gain(const void *a, const void *b)
{
    return by_falling(gain(a), gain(b), a, b);
}

static void choose_regions(prom_steady *s, const prom_eval *eval, double total)
{
    double budget = prom_eval_budget(eval);
    uint32_t most = eval->selection->max_switches, used = 0;
    region *r = s->regions.data;
    size_t count = s->regions.count;
    for (size_t i = 0; i < count; i++) {
        r[i].keeps = r[i].may_keep && r[i].switches > 0;
        if (r[i].keeps)
            total -= r[i].cost;
        else
            used += r[i].switches;
    }
    if (count) qsort(r, count, sizeof *r, by_saving);
    for (size_t i = 0; i < count && total > budget; i++) {
        if (!r[i].keeps || !(r[i].cost < 0.0)) continue;
        r[i].keeps = false;
        total += r[i].cost;
        used += r[i].switches;
    }
    if (count) qsort(r, count, sizeof *r, by_gain);
    for (size_t i = 0; i < count; i++) {
        bool few = used + r[i].switches <= most || !used;
        if (!r[i].keeps || !(r[i].benefit > 0.0) || !few || total + r[i].cost > budget)
            continue;
        r[i].keeps = false;
        total += r[i].cost;
        used += r[i].switches;
    }
}

static void emit(prom_steady *s, const prom_eval *eval, prom_cut *cut)
{
    double bound = cut->bound;
    bool limited = cut->limited;
    prom_eval_begin_cut(eval, cut);
    s->stack[0] = 0;
    // What is kept is so below its root too: marks go down.
    for (uint32_t depth = 1; depth;) {
        uint32_t node = s->stack[--depth];
        bool keep = s->keep[node];
        uint32_t option = keep ? old_option(eval, node) : new_option(s, eval, node);
        s->keep[node] = false;
        if (option != PROM_NONE) {
            prom_eval_emit(eval, node, option, cut);
            continue;
        }
        uint32_t before = depth;
        depth = push_children(eval, node, s->stack, depth);
        for (uint32_t i = before; keep && i < depth; i++) s->keep[s->stack[i]] = true;
    }
    prom_eval_end_cut(eval, cut);
    cut->bound = bound;
    cut->limited = limited;
}

void prom_steady_keep(prom_steady *steady, const prom_eval *eval, prom_cut *cut)
{
    const prom_selection *selection = eval->selection;
    if (!selection->last || !selection->max_switches || !cut->feasible) return;
    if (eval->nodes[0].culled) return;
    prom_last_cut_note(&steady->wanted, cut);
    if (find_regions(steady, eval) <= selection->max_switches) return;
    choose_regions(steady, eval, cut->predicted_ms);
    bool any = false;
    for (size_t i = 0; i < steady->regions.count; i++) {
        const region *r = &steady->regions.data[i];
        steady->keep[r->root] = r->keeps;
        any = any || r->keeps;
    }
    if (any) emit(steady, eval, cut);
}
