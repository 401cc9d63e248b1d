// What counts when things are ordered beside the benefit: the classic sums and rules of thumb,
// and what the last cut was drawn by.
#include "traverse/evaluate_private.h"
#include "traverse/view_private.h"

static bool is_small(const prom_eval *eval, uint32_t node)
{
    return eval->selection->priors & PROM_PRIOR_FEW_PIXELS &&
           eval->nodes[node].size_px < PROM_SIZE_MIN_PX;
}

static bool is_large(const prom_eval *eval, uint32_t node)
{
    float screen = prom_view_screen_px(eval->selection->view);
    return eval->selection->priors & PROM_PRIOR_FULL_DETAIL &&
           !eval->model->child_count[node] &&
           eval->nodes[node].footprint_px >= PROM_PRIOR_LARGE_SHARE * screen;
}

static uint32_t average_box_of(const prom_eval *eval, const prom_eval_node *n)
{
    uint32_t option = n->first_option, end = option + n->option_count;
    while (option < end &&
           eval->model->reps[eval->options[option].rep].kind != PROM_REP_AVERAGE_BOX)
        option++;
    return option < end ? option : PROM_NONE;
}

void prom_eval_heed_priors(prom_eval *eval, uint32_t node)
{
    prom_eval_node *n = &eval->nodes[node];
    uint32_t only = PROM_NONE;
    if (!n->option_count) return;
    if (is_small(eval, node)) only = average_box_of(eval, n);
    if (is_large(eval, node)) only = n->first_option; // the finest
    if (only == PROM_NONE) return;
    eval->options[n->first_option] = eval->options[only];
    n->option_count = 1;
    eval->option_count = n->first_option + 1;
}

// What a node's pixels count: of a leaf, those that it would show by itself; of a cluster whose
// children are known, their sum.
static void add_up(prom_eval *eval, uint32_t node)
{
    const prom_model *m = eval->model;
    prom_eval_node *n = &eval->nodes[node];
    if (n->expanded) {
        n->value_px = 0.0f;
        for (uint32_t c = 0; c < m->child_count[node]; c++) {
            const prom_eval_node *child = &eval->nodes[m->first_child[node] + c];
            if (!child->culled) n->value_px += child->value_px;
        }
    } else if (n->hidden) {
        n->value_px = 0.0f;
    }
    for (uint32_t i = 0; i < n->option_count; i++) {
        prom_option *o = &eval->options[n->first_option + i];
        o->value = n->value_px * o->accuracy;
    }
}

static void favour_shown(prom_eval *eval, uint32_t node)
{
    const prom_selection *s = eval->selection;
    const prom_eval_node *n = &eval->nodes[node];
    uint32_t shown = s->last->rep[node];
    for (uint32_t i = 0; shown != PROM_NONE && i < n->option_count; i++) {
        prom_option *o = &eval->options[n->first_option + i];
        if (o->rep == shown) o->value += s->hysteresis * n->value_px;
    }
}

void prom_eval_find_values(prom_eval *eval)
{
    const prom_selection *s = eval->selection;
    bool favour = s->last && s->hysteresis > 0.0f;
    if (s->order == PROM_ORDER_PIXELS && !favour) return;
    for (uint32_t i = eval->visited_count; i-- > 0;) {
        uint32_t node = eval->visited[i];
        if (s->order == PROM_ORDER_SUM) add_up(eval, node);
        if (favour) favour_shown(eval, node);
    }
}
