#include "app/pixel_shares.h"

void prom_count_pixels(const uint32_t *ids, size_t pixels, uint32_t tree_count, uint32_t *px)
{
    for (size_t i = 0; i < pixels; i++)
        if (ids[i] < tree_count) px[ids[i]]++;
}

// The accuracy with which each node is shown: that of its entry, or what stands for its parent.
// Parents come first.
static void spread_accuracy(const prom_model *model, const prom_cut *cut, float *accuracy)
{
    const float unknown = -1;
    for (uint32_t n = 0; n < model->tree_count; n++) accuracy[n] = unknown;
    for (size_t i = 0; i < cut->entries.count; i++)
        accuracy[cut->entries.data[i].node] = cut->entries.data[i].accuracy;
    for (uint32_t n = 0; n < model->tree_count; n++)
        if (accuracy[n] == unknown) accuracy[n] = n ? accuracy[model->parent[n]] : 0;
}

double prom_loss_share(const prom_model *model, const prom_cut *cut, const uint32_t *leaf_px,
                       float *scratch)
{
    double lost = 0, all = 0;
    spread_accuracy(model, cut, scratch);
    for (uint32_t n = 0; n < model->tree_count; n++) {
        lost += leaf_px[n] * (1.0 - (double)scratch[n]);
        all += leaf_px[n];
    }
    return all > 0 ? lost / all : 0;
}

prom_hidden_share prom_hidden_share_of(const prom_cut *cut, const uint32_t *px)
{
    prom_hidden_share hidden = {0};
    double cost = 0;
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        cost += (double)e->cost_ms;
        if (px[e->node]) continue;
        hidden.cost += (double)e->cost_ms;
        hidden.nodes++;
    }
    if (cost > 0) hidden.cost /= cost;
    if (cut->entries.count) hidden.nodes /= (double)cut->entries.count;
    return hidden;
}
