#include "traverse/selector.h"

// Entries on the path from the root to a node, and whether the path is in the frustum.
typedef struct path_state {
    uint32_t entries;
    bool outside;
} path_state;

static const char *count_entries(const prom_model *m, const prom_cut *cut, path_state *nodes)
{
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        if (e->node >= m->tree_count) return "an entry's node is not in the tree";
        const prom_prototype *p = &m->prototypes[m->prototype[e->node]];
        if (e->rep < p->first_rep || e->rep - p->first_rep >= p->rep_count)
            return "an entry's representation is not one of its node's prototype";
        nodes[e->node].entries++;
    }
    return NULL;
}

static const char *check_paths(const prom_model *m, const prom_view *view, path_state *nodes)
{
    for (uint32_t n = 0; n < m->tree_count; n++) {
        path_state *s = &nodes[n];
        if (n > 0) {
            const path_state *parent = &nodes[m->parent[n]];
            s->entries += parent->entries;
            s->outside = parent->outside;
        }
        if (prom_view_cull(view, m->center[n], m->half[n]) == PROM_OUTSIDE) s->outside = true;
        if (s->outside || m->child_count[n]) continue;
        if (!s->entries) return "a leaf in the frustum is not covered";
        if (s->entries > 1) return "a leaf in the frustum is covered more than once";
    }
    return NULL;
}

const char *prom_cut_check(const prom_model *model, const prom_view *view, const prom_cut *cut)
{
    path_state *nodes = prom_calloc(model->tree_count, sizeof *nodes);
    const char *fault = count_entries(model, cut, nodes);
    if (!fault) fault = check_paths(model, view, nodes);
    prom_free(nodes);
    return fault;
}
