// One frame within a budget: selected, drawn and measured, with what is learnt from frame to
// frame. A frame's time runs from its start to the finished image.
//
//   prom_frame_step_init; then for every frame prom_frame_step_draw and prom_frame_step_feed
#ifndef PROM_APP_FRAME_STEP_H
#define PROM_APP_FRAME_STEP_H

#include "app/comparison.h"
#include "app/sight.h"
#include "traverse/governor.h"

typedef struct prom_frame_record {
    double t_s; // on the path
    double frame_ms, select_ms, draw_ms;
    double predicted_ms; // of draw_ms, as corrected before the frame
    double triangles, draws;
    double benefit_px, loss_px;
    uint32_t cut_nodes;
    prom_switches switches;     // since the frame before
    bool feasible;              // the cheapest cut was within what could be spent
    prom_difference difference; // from full detail, where it was looked for
} prom_frame_record;

typedef struct prom_frame_step {
    prom_session *session;
    prom_selector *selector;
    prom_governor governor;
    prom_sight sight;
    prom_cut cut;   // the last frame's
    prom_view view; // and its
    prom_last_cut last;
    double budget_ms, rule_scale;
    double dt_s; // between frames, for how fast things move; 0: nothing does. The caller's
} prom_frame_step;

// The session must outlive the step. On failure there is nothing to finish.
prom_status prom_frame_step_init(prom_frame_step *step, prom_session *session,
                                 const char *selector, double budget_ms, double rule_scale,
                                 prom_error *error);
void prom_frame_step_finish(prom_frame_step *step);
// Selects and draws a frame into the session's target and waits for it. start_ms: when the
// frame began, by prom_clock_ms. record.t_s stays 0.
prom_frame_record prom_frame_step_draw(prom_frame_step *step, const prom_camera *camera,
                                       double start_ms);
// Lets the governor learn from the frame drawn last.
void prom_frame_step_feed(prom_frame_step *step, const prom_frame_record *record);

#endif
