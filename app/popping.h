// Popping: what changes in the picture from one frame to the next although nothing but the
// camera moved. The frame before is taken to where its points are now, with full detail's
// motion, and compared with this one by FLIP. Taking a picture elsewhere blurs it and moves its
// highlights, also when nothing pops: the same of full detail's own two pictures is the floor.
//
// Only pixels whose point was in view in the frame before are looked at (app/warp.h).
#ifndef PROM_APP_POPPING_H
#define PROM_APP_POPPING_H

#include "app/session.h"
#include "benefit/metric.h"

typedef struct prom_popping_frame {
    uint8_t *full, *shown; // pictures of full detail, and of the cut
    float *depth;          // of full detail
} prom_popping_frame;

typedef struct prom_popping {
    prom_selector *select_full;
    prom_cut full;
    prom_target *target;
    prom_metric *metric;
    prom_popping_frame before, now;
    float (*from)[2];   // see prom_warp_find
    float (*warped)[3]; // the last frame that was taken elsewhere
    float *features[2];
    float *errors; // of each pixel: of the cut's pictures
} prom_popping;

typedef struct prom_popped {
    double flip;        // mean over the valid pixels, of the cut's two pictures
    double floor;       // the same of full detail's: what the cut pops is the difference
    double valid_share; // of the frame's pixels
} prom_popped;

// ppd: pixels per degree. On failure there is still prom_popping_finish to call.
prom_status prom_popping_init(prom_popping *popping, const prom_session *session, double ppd,
                              prom_error *error);
void prom_popping_finish(prom_popping *popping); // {0} is allowed
// Draws both cuts and full detail from both cameras into a target of its own. The cameras'
// pictures are of the session's size.
prom_popped prom_popping_look(prom_popping *popping, prom_session *session,
                              const prom_cut *cut_before, const prom_camera *camera_before,
                              const prom_cut *cut, const prom_camera *camera);

#endif
