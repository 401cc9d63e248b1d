// Reactive frame-rate control, as engines have it: one global scale on the sizes of `pixels`,
// moved by what the last frames took. Nothing is predicted.
//
// The controller is the dynamic resolution of Unreal Engine in its outline, with detail in the
// place of resolution: each of the last 16 frames says by which scale it would have taken the
// budget less 10 %, were its time proportional to the scale; the newest count most; after two
// frames in a row over the budget all others are forgotten. xeokit and VTK (a quarter of the
// old value, three of the new) differ in how they smooth. Weights and range are by taste.
#include "traverse/rule.h"
#include "traverse/selectors.h"

#include <math.h>

enum { HISTORY = 16, MISSES_TO_PANIC = 2 };
#define HEADROOM 0.1
#define FADING 0.9 // what a frame counts, against the one after it
#define RANGE 32.0 // the scale stays within this factor of where it started

typedef struct feedback_state {
    void *pixels;            // the state of the selector that is steered
    double scale, start;     // of the last frame, and of the first
    double wanted[HISTORY];  // scales that earlier frames asked for, a ring
    uint32_t frames, misses; // in the ring so far; over the budget in a row
} feedback_state;

static void *create(const prom_model *model)
{
    feedback_state *state = prom_calloc(1, sizeof *state);
    state->pixels = prom_select_pixels.create(model);
    return state;
}

static void destroy(void *pointer)
{
    feedback_state *state = pointer;
    if (!state) return;
    prom_select_pixels.destroy(state->pixels);
    prom_free(state);
}

static double mean_wanted(const feedback_state *state)
{
    double sum = 0.0, weights = 0.0, weight = 1.0;
    for (uint32_t age = 0; age < HISTORY && age < state->frames; age++, weight *= FADING) {
        sum += weight * state->wanted[(state->frames - 1 - age) % HISTORY];
        weights += weight;
    }
    return sum / weights;
}

static void learn(feedback_state *state, double measured_ms, double budget_ms)
{
    state->misses = measured_ms > budget_ms ? state->misses + 1 : 0;
    if (state->misses >= MISSES_TO_PANIC) state->frames = 0;
    double ratio = (1.0 - HEADROOM) * budget_ms / measured_ms;
    double low = state->start / RANGE, high = state->start * RANGE;
    state->wanted[state->frames++ % HISTORY] = fmin(fmax(state->scale * ratio, low), high);
    state->scale = mean_wanted(state);
}

static void select_feedback(void *pointer, const prom_selection *selection, prom_cut *cut)
{
    feedback_state *state = pointer;
    double start = (double)prom_rule_scale(selection);
    if (state->start != start)
        *state = (feedback_state){.pixels = state->pixels, .scale = start, .start = start};
    else if (selection->measured_ms > 0.0)
        learn(state, selection->measured_ms, selection->budget_ms);
    prom_selection steered = *selection;
    steered.rule_scale = (float)state->scale;
    prom_select_pixels.select(state->pixels, &steered, cut);
}

const prom_selector_class prom_select_feedback = {
    .name = "feedback",
    .summary = "`pixels`, its scale moved by what the last frames took, as engines do",
    .budgeted = true,
    .has_scale = true,
    .create = create,
    .destroy = destroy,
    .select = select_feedback,
};
