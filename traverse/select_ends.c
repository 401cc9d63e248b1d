// The two ends: everything at its finest, and the cheapest cut.
#include "traverse/evaluate.h"
#include "traverse/selectors.h"

static void *create(const prom_model *model)
{
    prom_eval *eval = prom_alloc(1, sizeof *eval);
    prom_eval_init(eval, model);
    return eval;
}

static void destroy(void *state)
{
    if (!state) return;
    prom_eval_finish(state);
    prom_free(state);
}

// Representations stand from the finest mesh on, and the finest mesh of a
// leaf is valid in every view.
static void select_full(void *state, const prom_selection *selection, prom_cut *cut)
{
    prom_eval *eval = state;
    prom_eval_run(eval, selection, NULL, NULL);
    prom_eval_begin_cut(eval, cut);
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        const prom_eval_node *n = &eval->nodes[node];
        if (!eval->model->child_count[node] && n->option_count)
            prom_eval_emit(eval, node, n->first_option, cut);
    }
    prom_eval_end_cut(eval, cut);
}

static void select_coarsest(void *state, const prom_selection *selection, prom_cut *cut)
{
    prom_eval *eval = state;
    eval->any_mesh_hides = true; // `full`, which shares the state's functions, takes the first
    prom_eval_run(eval, selection, prom_eval_open_visible, eval);
    prom_eval_begin_cut(eval, cut);
    prom_eval_emit_cmin(eval, cut);
    prom_eval_end_cut(eval, cut);
}

const prom_selector_class prom_select_full = {
    .name = "full",
    .summary = "everything in the frustum at its finest",
    .create = create,
    .destroy = destroy,
    .select = select_full,
};

const prom_selector_class prom_select_coarsest = {
    .name = "coarsest",
    .summary = "the cheapest cut that still shows everything",
    .uses_cost = true,
    .create = create,
    .destroy = destroy,
    .select = select_coarsest,
};
