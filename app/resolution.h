// The drawing resolution in a session: the scales of traverse/resolution.h with what scaling
// loses in this model's pictures, measured at the start, and targets to draw in.
//
//   prom_resolution_init; for every frame prom_resolution_select in place of
//   prom_selector_run, prom_resolution_draw in place of prom_sight_draw
#ifndef PROM_APP_RESOLUTION_H
#define PROM_APP_RESOLUTION_H

#include "app/sight.h"
#include "traverse/resolution.h"

typedef struct prom_resolution {
    prom_session *session;
    prom_scaling scaling; // at 0: the full picture
    prom_selector *trial; // NULL: there is only the full picture
    prom_cut trial_cut;
    uint32_t size_px[2];               // of the full picture that the targets are for
    prom_target *targets[PROM_SCALES]; // [0] is NULL: the session's
} prom_resolution;

// The scales that the session allows; for a selector that heeds no budget none but 1. selector:
// the name of the one that will be used. camera: where to measure what scaling loses; NULL:
// from two places of the session's path. On failure there is nothing to finish.
prom_status prom_resolution_init(prom_resolution *resolution, prom_session *session,
                                 const char *selector, const prom_camera *camera,
                                 prom_error *error);
void prom_resolution_finish(prom_resolution *resolution); // {0} is allowed
// Selects a cut and the scale to draw it at; the selection's cost model is that of the full
// picture.
void prom_resolution_select(prom_resolution *resolution, prom_selector *selector,
                            const prom_selection *selection, prom_cut *cut);
// The same for a single picture: tries all scales.
void prom_resolution_select_best(prom_resolution *resolution, prom_selector *selector,
                                 const prom_selection *selection, prom_cut *cut);
// Draws a cut at the scale in use into the session's target; else as prom_sight_draw.
void prom_resolution_draw(prom_resolution *resolution, prom_sight *sight, const prom_cut *cut,
                          const prom_camera *camera, const prom_frame_options *options);
// The scale in use: 1 is the full picture.
double prom_resolution_scale(const prom_resolution *resolution);

#endif
