#include "traverse/rule.h"

void prom_rule_run(prom_eval *eval, const prom_selection *selection, prom_eval_open *open,
                   prom_rule_choose *choose, void *user, prom_cut *cut)
{
    prom_eval_run(eval, selection, open, user);
    prom_eval_begin_cut(eval, cut);
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        const prom_eval_node *n = &eval->nodes[node];
        if (!n->expanded && n->option_count)
            prom_eval_emit(eval, node, choose(user, node), cut);
    }
    prom_eval_end_cut(eval, cut);
}

float prom_rule_scale(const prom_selection *selection)
{
    return selection->rule_scale > 0.0f ? selection->rule_scale : 1.0f;
}

void *prom_rule_create(const prom_model *model)
{
    prom_rule *rule = prom_calloc(1, sizeof *rule);
    prom_eval_init(&rule->eval, model);
    return rule;
}

void prom_rule_destroy(void *pointer)
{
    prom_rule *rule = pointer;
    if (!rule) return;
    prom_eval_finish(&rule->eval);
    prom_free(rule);
}
