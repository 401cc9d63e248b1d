// The noise floor: how even the frames of one fixed cut are that costs about what a frame may
// take. No way to choose cuts makes frames more even than the machine draws the same one.
//
//   prom_noise_floor_init chooses the cut; prom_noise_floor_draw times it once more
//
// Its frames are drawn between those of a walk, so that both meet the same disturbances and
// the same caches. They are selected from nothing and write no ids: only the drawing is timed.
#ifndef PROM_APP_NOISE_FLOOR_H
#define PROM_APP_NOISE_FLOOR_H

#include "app/session.h"

typedef struct prom_noise_floor {
    prom_cut cut;
    prom_camera camera;
    uint32_t frame;        // of the path, that the cut is of
    double target_ms;      // that was looked for
    double chosen_ms;      // median of the draws that it was chosen by
    PROM_ARRAY(double) ms; // of the draws since then
} prom_noise_floor;

// Looks for a cut of `greedy` in the path's middle, then before and after that, whose median
// time is nearest to the part of the budget that a steady frame may take. On failure there is
// nothing to finish.
prom_status prom_noise_floor_init(prom_noise_floor *floor, prom_session *session,
                                  double budget_ms, uint32_t path_frames, prom_error *error);
void prom_noise_floor_finish(prom_noise_floor *floor); // {0} is allowed
// Draws the cut into the session's target and keeps how long that took.
void prom_noise_floor_draw(prom_noise_floor *floor, prom_session *session);

#endif
