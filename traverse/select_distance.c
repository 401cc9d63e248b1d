// Ranges with hysteresis, as in most engines: what is drawn follows from the distance alone. No
// budget; the baseline that people know.
//
// An object whose artist gave levels with switching distances is drawn as its artist meant it:
// by those levels and no others, switched at the distance from the eye to the object's centre.
// Where the artist's engine would drop it, its last level stays. For all other objects, and for
// clusters, the distance counts in radii.
#include "traverse/rule.h"
#include "traverse/selectors.h"

#include <math.h>

// Radii at which a cluster opens and at which a leaf leaves its finest mesh; each doubling of
// the distance is one step coarser. By taste: at 720 lines and 60 degrees a cluster opens at
// some 120 px, a leaf is coarsened below 150.
#define CLUSTER_RANGE 10.0f
#define LEAF_RANGE 8.0f
// A step changes only when its border has been passed by this part of a doubling of the
// distance.
#define HYSTERESIS 0.15f
// Boxes only where little can be seen of their being boxes.
#define BOX_SIZE_PX 24.0f

enum { STEP_MAX = 30, NO_STEP = 255 };

typedef struct artist_level {
    uint32_t rep;
    float until; // distance up to which it is shown
} artist_level;

typedef struct distance_state {
    prom_eval eval;
    artist_level *levels;  // of all prototypes that have some, each from fine to coarse
    uint32_t *first_level; // per prototype, and the end of the last one's
    bool *is_level;        // per representation: one of the levels above
    uint8_t *step;         // per node: the last step, or NO_STEP
    uint8_t *place;        // per node: the place of what it was last drawn by, or NO_STEP
    float scale;
} distance_state;

// ---- levels by artists

// Appends the levels of a prototype to *levels; returns how many. The object itself comes
// first, the others by distance: prototypes order them by what they cost.
static uint32_t gather_levels(const prom_model *model, const prom_prototype *p,
                              artist_level *levels)
{
    if (p->child_count || !p->rep_count) return 0;
    bool finite = false;
    uint32_t count = 0;
    for (uint32_t i = 0; i < p->rep_count; i++) {
        const prom_representation *r = &model->reps[p->first_rep + i];
        finite = finite || isfinite(r->switch_distance);
        if ((i && !(r->flags & PROM_REP_ARTIST)) || count == NO_STEP) continue;
        uint32_t at = count++;
        for (; at > 1 && levels[at - 1].until > r->switch_distance; at--)
            levels[at] = levels[at - 1];
        levels[at] = (artist_level){p->first_rep + i, r->switch_distance};
    }
    return finite ? count : 0;
}

static void gather_all_levels(distance_state *state, const prom_model *model)
{
    size_t room = 0;
    for (uint32_t p = 0; p < model->prototype_count; p++)
        room += model->prototypes[p].rep_count;
    state->levels = prom_alloc(room, sizeof *state->levels);
    state->first_level =
        prom_alloc((size_t)model->prototype_count + 1, sizeof *state->first_level);
    uint32_t count = 0;
    for (uint32_t p = 0; p < model->prototype_count; p++) {
        state->first_level[p] = count;
        count += gather_levels(model, &model->prototypes[p], state->levels + count);
    }
    state->first_level[model->prototype_count] = count;
    state->is_level = prom_calloc(model->rep_count, sizeof *state->is_level);
    for (uint32_t i = 0; i < count; i++) state->is_level[state->levels[i].rep] = true;
}

// ---- the state

static void *create(const prom_model *model)
{
    distance_state *state = prom_calloc(1, sizeof *state);
    prom_eval_init(&state->eval, model);
    gather_all_levels(state, model);
    state->eval.any_size = state->is_level;
    state->step = prom_alloc(model->tree_count, 1);
    memset(state->step, NO_STEP, model->tree_count);
    state->place = prom_alloc(model->tree_count, 1);
    memset(state->place, NO_STEP, model->tree_count);
    return state;
}

static void destroy(void *pointer)
{
    distance_state *state = pointer;
    if (!state) return;
    prom_eval_finish(&state->eval);
    prom_free(state->levels);
    prom_free(state->first_level);
    prom_free(state->is_level);
    prom_free(state->step);
    prom_free(state->place);
    prom_free(state);
}

// ---- steps

// Takes the step `now` unless the last one is still within what hysteresis allows.
static uint32_t settle(uint8_t *step, uint32_t nearer, uint32_t now, uint32_t farther)
{
    if (*step < nearer || *step > farther) *step = (uint8_t)now;
    return *step;
}

static uint32_t clamp_step(float position)
{
    return position < 0.0f ? 0 : position > STEP_MAX ? STEP_MAX : (uint32_t)position;
}

// 0 within the range, 1 up to twice the range, and so on.
static uint32_t step_of(distance_state *state, uint32_t node, float range)
{
    const prom_eval_node *n = &state->eval.nodes[node];
    float reach = range * state->scale * state->eval.model->radius[node];
    float position = reach > 0.0f ? log2f(fmaxf(n->distance, 1e-6f) / reach) + 1.0f : STEP_MAX;
    return settle(&state->step[node], clamp_step(position - HYSTERESIS), clamp_step(position),
                  clamp_step(position + HYSTERESIS));
}

// The first of an artist's levels that reaches as far, or the last one.
static uint32_t level_at(const artist_level *levels, uint32_t count, float distance)
{
    uint32_t level = 0;
    while (level + 1 < count && !(distance <= levels[level].until)) level++;
    return level;
}

static bool open_cluster(void *user, uint32_t node)
{
    return step_of(user, node, CLUSTER_RANGE) == 0;
}

// ---- representations

// PROM_NONE where the representation is not valid in this view.
static uint32_t option_of_rep(const prom_eval *eval, uint32_t node, uint32_t rep)
{
    const prom_eval_node *n = &eval->nodes[node];
    for (uint32_t i = 0; i < n->option_count; i++)
        if (eval->options[n->first_option + i].rep == rep) return n->first_option + i;
    return PROM_NONE;
}

// The place in its prototype of the coarsest representation up to `most`, of those that may be
// shown at `nearer` times the size; the finest option where there is none.
static uint32_t place_at(const prom_eval *eval, uint32_t node, uint32_t most, float nearer)
{
    const prom_model *m = eval->model;
    const prom_eval_node *n = &eval->nodes[node];
    uint32_t first_rep = m->prototypes[m->prototype[node]].first_rep;
    uint32_t chosen = eval->options[n->first_option].rep - first_rep;
    for (uint32_t i = 1; i < n->option_count; i++) {
        uint32_t rep = eval->options[n->first_option + i].rep;
        const prom_representation *r = &m->reps[rep];
        float limit =
            r->kind == PROM_REP_MESH ? r->max_size_px : fminf(r->max_size_px, BOX_SIZE_PX);
        if (rep - first_rep <= most && n->size_px * nearer <= limit) chosen = rep - first_rep;
    }
    return chosen;
}

// The option `step` places after the finest, or the next finer one that may be shown. The
// limits of size have hysteresis too: what they forbade comes back a little later.
static uint32_t option_at(distance_state *state, uint32_t node, uint32_t step)
{
    const prom_eval *eval = &state->eval;
    const prom_model *m = eval->model;
    uint32_t now = place_at(eval, node, step, 1.0f);
    uint32_t nearer = place_at(eval, node, step, exp2f(HYSTERESIS));
    uint32_t place = settle(&state->place[node], nearer, now, now);
    uint32_t first_rep = m->prototypes[m->prototype[node]].first_rep;
    uint32_t option = option_of_rep(eval, node, first_rep + place);
    return option != PROM_NONE ? option : option_of_rep(eval, node, first_rep + now);
}

static uint32_t leaf_option(distance_state *state, uint32_t node)
{
    const prom_eval *eval = &state->eval;
    uint32_t prototype = eval->model->prototype[node];
    const artist_level *levels = state->levels + state->first_level[prototype];
    uint32_t count = state->first_level[prototype + 1] - state->first_level[prototype];
    if (!count) return option_at(state, node, step_of(state, node, LEAF_RANGE));
    float distance = eval->nodes[node].distance / state->scale, slack = exp2f(HYSTERESIS);
    uint32_t level =
        settle(&state->step[node], level_at(levels, count, distance / slack),
               level_at(levels, count, distance), level_at(levels, count, distance * slack));
    return option_of_rep(eval, node, levels[level].rep);
}

// A closed cluster is beyond its range: its step counts from there.
static uint32_t choose_level(void *user, uint32_t node)
{
    distance_state *state = user;
    bool cluster = state->eval.model->child_count[node];
    return cluster ? option_at(state, node, state->step[node] - 1u) : leaf_option(state, node);
}

static void select_distance(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    distance_state *state = pointer;
    state->scale = prom_rule_scale(selection);
    prom_rule_run(&state->eval, selection, open_cluster, choose_level, state, cut);
}

const prom_selector_class prom_select_distance = {
    .name = "distance",
    .summary =
        "fixed ranges with hysteresis, the artists' own where there are; heeds no budget",
    .has_scale = true,
    .create = create,
    .destroy = destroy,
    .select = select_distance,
};
