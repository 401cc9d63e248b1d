// Refinement at rest: while the camera stands still the picture gets better, first by frames of
// growing budgets, then by full detail. Each step takes about the rest's budget at most, so
// that input is answered soon; full detail that takes longer is drawn in parts, aside, and
// shown when it is complete. Nothing that is learnt from frames within the budget is touched:
// the first frame of a movement is chosen as if there had been no rest.
//
//   prom_rest_init; while the camera stands still prom_rest_step until prom_rest_is_done; when
//   it moves, or the picture changes its size, prom_rest_end
#ifndef PROM_APP_REST_H
#define PROM_APP_REST_H

#include "app/frame_step.h"

typedef enum prom_rest_phase {
    PROM_REST_NONE,    // the camera moves
    PROM_REST_GROWING, // frames with more and more time
    PROM_REST_PARTS,   // full detail is being drawn
    PROM_REST_DONE,
} prom_rest_phase;

typedef struct prom_rest {
    prom_frame_step *step;
    double budget_ms; // of a step; 0: nothing is refined
    prom_rest_phase phase;
    prom_selector *selector, *full;
    prom_cut grown, detail; // the last growing frame's, and full detail's
    double grown_ms;        // its budget
    double triangles;       // of the picture drawn last, or being drawn
    // Full detail in parts.
    prom_target *aside, *into; // into: the session's target where one part is all
    size_t next;               // draw
    double pace;               // of the budget, what a part may be predicted at; at most 1
} prom_rest;

// The step must outlive the rest. budget_ms 0, or a selector that heeds no budget: there is
// nothing to refine. On failure there is nothing to finish.
prom_status prom_rest_init(prom_rest *rest, prom_frame_step *step, const char *selector,
                           double budget_ms, prom_error *error);
void prom_rest_finish(prom_rest *rest);
// Whether there is nothing more to do until the camera moves.
bool prom_rest_is_done(const prom_rest *rest);
// Whether the session's target shows full detail.
bool prom_rest_shows_all(const prom_rest *rest);
// Takes the next step; the camera is the same in all steps of a rest. True if the session's
// target has got another picture, of rest->triangles.
bool prom_rest_step(prom_rest *rest, const prom_camera *camera);
void prom_rest_end(prom_rest *rest);

#endif
