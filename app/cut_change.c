#include "app/cut_change.h"

#include <math.h>

void prom_cut_copy(const prom_cut *from, prom_cut *to)
{
    size_t count = from->entries.count;
    prom_cut copy = *from;
    copy.entries.data = to->entries.data;
    copy.entries.capacity = to->entries.capacity;
    *to = copy;
    prom_array_reserve(&to->entries, count);
    memcpy(to->entries.data, from->entries.data, count * sizeof *from->entries.data);
}

// Summed anew, so that many changes leave no rounding behind.
static void predict(const prom_eval *eval, prom_cut *cut)
{
    cut->predicted_ms = eval->fixed_ms;
    for (size_t i = 0; i < cut->entries.count; i++)
        cut->predicted_ms += (double)cut->entries.data[i].cost_ms;
}

static void remove_entry(prom_cut *cut, size_t index)
{
    cut->entries.data[index] = cut->entries.data[--cut->entries.count];
}

void prom_cut_take_option(const prom_eval *eval, prom_cut *cut, size_t index, uint32_t option)
{
    prom_eval_emit(eval, cut->entries.data[index].node, option, cut);
    remove_entry(cut, index);
    predict(eval, cut);
}

uint32_t prom_cut_best_option(const prom_eval *eval, uint32_t node)
{
    const prom_eval_node *n = &eval->nodes[node];
    uint32_t best = PROM_NONE;
    float most = -INFINITY;
    for (uint32_t o = n->first_option; o < n->first_option + n->option_count; o++) {
        float accuracy = eval->options[o].accuracy;
        if (accuracy > most) best = o, most = accuracy;
    }
    return best;
}

uint32_t prom_cut_cheapest_option(const prom_eval *eval, uint32_t node)
{
    const prom_eval_node *n = &eval->nodes[node];
    uint32_t best = PROM_NONE;
    for (uint32_t o = n->first_option; o < n->first_option + n->option_count; o++)
        if (best == PROM_NONE || eval->options[o].cost < eval->options[best].cost) best = o;
    return best;
}

// Appends what stands for the children of a node.
static void append_children(const prom_eval *eval, prom_cut *cut, uint32_t node,
                            uint32_t (*choose)(const prom_eval *, uint32_t))
{
    const prom_model *m = eval->model;
    uint32_t first = m->first_child[node], end = first + m->child_count[node];
    for (uint32_t c = first; c < end; c++) {
        if (eval->nodes[c].culled) continue;
        uint32_t option = choose(eval, c);
        if (option != PROM_NONE)
            prom_eval_emit(eval, c, option, cut);
        else
            append_children(eval, cut, c, choose);
    }
}

bool prom_cut_open(const prom_eval *eval, prom_cut *cut, size_t index,
                   uint32_t (*choose)(const prom_eval *, uint32_t))
{
    uint32_t node = cut->entries.data[index].node;
    if (!eval->model->child_count[node] || eval->nodes[node].culled) return false;
    append_children(eval, cut, node, choose);
    remove_entry(cut, index);
    predict(eval, cut);
    return true;
}

static bool is_below(const prom_model *m, uint32_t node, uint32_t ancestor)
{
    // A child's index is above its parent's.
    while (node != PROM_NONE && node > ancestor) node = m->parent[node];
    return node == ancestor;
}

void prom_cut_close(const prom_eval *eval, prom_cut *cut, uint32_t node, uint32_t option)
{
    for (size_t i = cut->entries.count; i-- > 0;)
        if (is_below(eval->model, cut->entries.data[i].node, node)) remove_entry(cut, i);
    prom_eval_emit(eval, node, option, cut);
    predict(eval, cut);
}
