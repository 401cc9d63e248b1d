// Ranges with hysteresis, as in most engines: what is drawn follows from the distance in radii
// alone. No budget; the baseline that people know.
#include "traverse/evaluate.h"
#include "traverse/selectors.h"

#include <math.h>

// Radii at which a cluster opens and at which a leaf leaves its finest mesh; each doubling of
// the distance is one step coarser. By taste: at 720 lines and 60 degrees a cluster opens at
// some 120 px, a leaf is coarsened below 150.
#define CLUSTER_RANGE 10.0f
#define LEAF_RANGE 8.0f
// A step changes only when its border has been passed by this part of a step.
#define HYSTERESIS 0.15f
// Boxes only where little can be seen of their being boxes.
#define BOX_SIZE_PX 24.0f

enum { NO_STEP = 255 };

typedef struct distance_state {
    prom_eval eval;
    uint8_t *step; // per node: the last step, or NO_STEP
    float scale;
} distance_state;

static void *create(const prom_model *model)
{
    distance_state *state = prom_calloc(1, sizeof *state);
    prom_eval_init(&state->eval, model);
    state->step = prom_alloc(model->tree_count, 1);
    memset(state->step, NO_STEP, model->tree_count);
    return state;
}

static void destroy(void *pointer)
{
    distance_state *state = pointer;
    if (!state) return;
    prom_eval_finish(&state->eval);
    prom_free(state->step);
    prom_free(state);
}

static int clamp_step(float position)
{
    return position < 0.0f ? 0 : position > 30.0f ? 30 : (int)position;
}

// 0 within the range, 1 up to twice the range, and so on; keeps the last step near a border.
static uint32_t step_of(distance_state *state, uint32_t node, float range)
{
    const prom_eval_node *n = &state->eval.nodes[node];
    float reach = range * state->scale * state->eval.model->radius[node];
    float position = reach > 0.0f ? log2f(fmaxf(n->distance, 1e-6f) / reach) + 1.0f : 30.0f;
    int last = state->step[node];
    bool keep = last != NO_STEP && last >= clamp_step(position - HYSTERESIS) &&
                last <= clamp_step(position + HYSTERESIS);
    if (!keep) state->step[node] = (uint8_t)clamp_step(position);
    return state->step[node];
}

static bool open_cluster(void *user, uint32_t node)
{
    return step_of(user, node, CLUSTER_RANGE) == 0;
}

// The option `step` places after the finest, of those that the rules allow.
static uint32_t option_at(const prom_eval *eval, uint32_t node, uint32_t step)
{
    const prom_eval_node *n = &eval->nodes[node];
    uint32_t chosen = n->first_option, left = step;
    for (uint32_t i = 1; i < n->option_count && left > 0; i++) {
        const prom_representation *r =
            &eval->model->reps[eval->options[n->first_option + i].rep];
        if (r->kind != PROM_REP_MESH && n->size_px > BOX_SIZE_PX) continue;
        chosen = n->first_option + i;
        left--;
    }
    return chosen;
}

static void select_distance(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    distance_state *state = pointer;
    prom_eval *eval = &state->eval;
    state->scale = selection->distance_scale > 0.0f ? selection->distance_scale : 1.0f;
    prom_eval_run(eval, selection, open_cluster, state);
    prom_eval_begin_cut(eval, cut);
    for (uint32_t i = 0; i < eval->visited_count; i++) {
        uint32_t node = eval->visited[i];
        const prom_eval_node *n = &eval->nodes[node];
        if (n->expanded || !n->option_count) continue;
        bool leaf = !eval->model->child_count[node];
        // A closed cluster is beyond its range: its step counts from there.
        uint32_t step = leaf ? step_of(state, node, LEAF_RANGE) : state->step[node] - 1u;
        prom_eval_emit(eval, node, option_at(eval, node, step), cut);
    }
    prom_eval_end_cut(eval, cut);
}

const prom_selector_class prom_select_distance = {
    .name = "distance",
    .summary = "fixed ranges with hysteresis; heeds no budget",
    .create = create,
    .destroy = destroy,
    .select = select_distance,
};
