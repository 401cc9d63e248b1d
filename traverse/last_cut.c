#include "traverse/last_cut.h"

void prom_last_cut_init(prom_last_cut *last, const prom_model *model)
{
    *last = (prom_last_cut){.model = model};
    last->rep = prom_alloc(model->tree_count, sizeof *last->rep);
    last->above = prom_calloc(model->tree_count, sizeof *last->above);
    for (uint32_t n = 0; n < model->tree_count; n++) last->rep[n] = PROM_NONE;
}

void prom_last_cut_finish(prom_last_cut *last)
{
    prom_free(last->rep);
    prom_free(last->above);
    prom_array_finish(&last->nodes);
    *last = (prom_last_cut){0};
}

// Whether what an entry shows was shown by something else before: by another representation,
// by what is below the node, or by what is above it.
bool prom_last_cut_is_switch(const prom_last_cut *last, const prom_cut_entry *e)
{
    uint32_t n = e->node;
    if (!(e->visible_px > 0.0f)) return false;
    if (last->rep[n] != PROM_NONE) return last->rep[n] != e->rep;
    if (prom_last_cut_opened(last, n)) return true;
    while ((n = last->model->parent[n]) != PROM_NONE)
        if (last->rep[n] != PROM_NONE) return true;
    return false;
}

static void forget(prom_last_cut *last)
{
    for (size_t i = 0; i < last->nodes.count; i++) last->rep[last->nodes.data[i]] = PROM_NONE;
    last->nodes.count = 0;
    last->number++;
}

prom_switches prom_last_cut_note(prom_last_cut *last, const prom_cut *cut)
{
    prom_switches switches = {0};
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        if (!prom_last_cut_is_switch(last, e)) continue;
        switches.count++;
        switches.px += (double)e->visible_px;
    }
    forget(last);
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        last->rep[e->node] = e->rep;
        prom_array_push(&last->nodes, e->node);
        uint32_t n = last->model->parent[e->node];
        for (; n != PROM_NONE && last->above[n] != last->number; n = last->model->parent[n])
            last->above[n] = last->number;
    }
    return switches;
}
