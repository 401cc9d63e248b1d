// The loop of `promenade walk`: input, motion, a frame within the budget, the window. At rest
// the picture is
// refined up to full detail; then it waits for the user.
#ifndef PROM_APP_WALK_LOOP_H
#define PROM_APP_WALK_LOOP_H

#include "app/session.h"
#include "render/window.h"

typedef struct prom_walk_options {
    const char *name, *selector; // name: the model's, for the title
    double budget_ms, rule_scale;
    double rest_budget_ms; // of a step while the camera stands still; 0: no refinement then
    bool play;             // start on the path
    uint64_t frames; // 0: until the user ends it; else no rests, and a key of the path each
} prom_walk_options;

typedef struct prom_walk_result {
    uint64_t frames, misses;   // a miss: over the budget
    double frame_ms, worst_ms; // mean and greatest
    double present_ms;         // mean, of a frame's time: showing it
    prom_camera camera;        // the last frame's
} prom_walk_result;

// Walks from the start of the session's path until the user ends it. The session draws for this
// window; its target keeps the last frame's picture.
prom_status prom_walk_run(prom_session *session, prom_window *window,
                          const prom_walk_options *options, prom_walk_result *result,
                          prom_error *error);
// A point that the camera looks at: for `shot --look-at`.
void prom_walk_look_at(const prom_camera *camera, double point[3]);

#endif
