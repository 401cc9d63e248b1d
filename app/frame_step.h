// One frame within a budget: selected, drawn and measured, with what is learnt from frame to
// frame. A frame's time runs from its start to the finished image.
//
//   prom_frame_step_init; then for every frame prom_frame_step_draw and prom_frame_step_feed
//
// In a frozen session nothing is learnt: the same cameras have the same cuts in every run.
#ifndef PROM_APP_FRAME_STEP_H
#define PROM_APP_FRAME_STEP_H

#include "app/comparison.h"
#include "app/popping.h"
#include "app/resolution.h"
#include "app/sight.h"
#include "traverse/guarantee.h"

typedef struct prom_frame_record {
    double t_s;      // on the path
    double start_ms; // when it began, by prom_clock_ms
    double frame_ms, select_ms, draw_ms;
    double display_ms;    // showing it, if that is charged to the budget
    double predicted_ms;  // of draw_ms, as corrected before the frame
    double allowed_ms;    // what the cut might be predicted at, before that correction
    double scale, margin; // of the guarantee, at the frame's start
    double resolution;    // the scale that it was drawn at, see prom_resolution_scale
    double triangles, draws;
    double benefit_px, loss_px;
    double gap; // see prom_cut_gap; NAN: not known
    uint32_t cut_nodes;
    uint64_t cut_hash;          // of the entries' nodes and representations
    prom_switches switches;     // since the frame before
    bool feasible;              // the cheapest cut was within what could be spent
    bool fits;                  // it was expected within the budget less the device's noise
    bool limited;               // more time would have bought a better picture
    bool turned;                // the camera jumped, or turned fast. The caller's
    bool aside;                 // not one of the run, see prom_guarantee_frame. The caller's
    prom_difference difference; // from full detail, where it was looked for
    prom_popped popped;         // since the frame before; valid_share 0: not looked for
} prom_frame_record;

typedef struct prom_frame_step {
    prom_session *session;
    prom_selector *selector;
    prom_guarantee guarantee;
    prom_sight sight;
    prom_resolution resolution;
    prom_cut cut;   // the last frame's
    prom_view view; // and its
    prom_last_cut last;
    bool reacts; // it follows the measured times by itself
    double rule_scale;
    double binds;       // changes of state in the last frame
    double measured_ms; // what the last frame took; 0: there was none
    bool counts;        // the frame's visible pixels are counted
    double
        beyond_ms[2]; // usual time beyond the prediction, not counted and counted; 0: none yet
    // The caller's:
    double dt_s;  // between frames, for how fast things move; 0: nothing does
    bool certify; // a bound is wanted
} prom_frame_step;

// The session must outlive the step. On failure there is nothing to finish.
prom_status prom_frame_step_init(prom_frame_step *step, prom_session *session,
                                 const char *selector, double budget_ms, double rule_scale,
                                 prom_error *error);
void prom_frame_step_finish(prom_frame_step *step);
// To be called before the first frame, with its camera: draws a few for nobody, which touch
// everything for the first time, and learns the machine's pace from the last.
void prom_frame_step_warm(prom_frame_step *step, const prom_camera *camera);
// Selects and draws a frame into the session's target and waits for it. start_ms: when the
// frame began, by prom_clock_ms. What is the caller's in the record, and t_s, stays 0.
prom_frame_record prom_frame_step_draw(prom_frame_step *step, const prom_camera *camera,
                                       double start_ms);
// Lets the guarantee learn from the frame drawn last.
void prom_frame_step_feed(prom_frame_step *step, const prom_frame_record *record);

#endif
