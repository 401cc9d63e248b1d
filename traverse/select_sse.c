// Screen-space error, as viewers of 3D Tiles (OGC 22-025r4, "Geometric error") refine: from the
// root on, what stands for a part of the scene is replaced by the next finer thing while its
// geometric error, projected at the distance of its bounding volume,
//     error_px = error * f_px / nearest,
// is above a limit. No budget; leaves are the end.
//
// A node's representations, from the coarsest on, and then its children, are here what tiles
// are there, each of which has one content. The error of a box is its node's radius.
#include "traverse/rule.h"
#include "traverse/selectors.h"

// Cesium's maximumScreenSpaceError, unless its user says otherwise.
#define ERROR_PX 16.0f

// The coarsest option whose error is small enough, or PROM_NONE. In a form without quotients,
// which holds inside the box too: there only what is exact will do.
static uint32_t coarsest_fit(const prom_rule *rule, uint32_t node)
{
    const prom_eval *eval = &rule->eval;
    const prom_model *m = eval->model;
    const prom_eval_node *n = &eval->nodes[node];
    float most = ERROR_PX / rule->scale * n->nearest * m->prototypes[m->prototype[node]].radius;
    float per_error = m->radius[node] * eval->selection->view->f_px;
    for (uint32_t i = n->option_count; i-- > 0;) {
        uint32_t option = n->first_option + i;
        if (m->reps[eval->options[option].rep].error * per_error <= most) return option;
    }
    return PROM_NONE;
}

static bool open_cluster(void *user, uint32_t node)
{
    return coarsest_fit(user, node) == PROM_NONE;
}

static uint32_t choose_level(void *user, uint32_t node)
{
    const prom_rule *rule = user;
    uint32_t option = coarsest_fit(rule, node);
    return option != PROM_NONE ? option : rule->eval.nodes[node].first_option;
}

static void select_sse(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    prom_rule *rule = pointer;
    rule->scale = prom_rule_scale(selection);
    prom_rule_run(&rule->eval, selection, open_cluster, choose_level, rule, cut);
}

const prom_selector_class prom_select_sse = {
    .name = "sse",
    .summary = "refines above 16 px of screen-space error, as 3D Tiles; heeds no budget",
    .has_scale = true,
    .create = prom_rule_create,
    .destroy = prom_rule_destroy,
    .select = select_sse,
};
