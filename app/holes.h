// Hole check: where full detail shows the scene and a cut shows the background.
#ifndef PROM_APP_HOLES_H
#define PROM_APP_HOLES_H

#include "app/session.h"

typedef struct prom_holes {
    prom_selector *full;
    prom_cut cut;
    uint8_t *truth, *shown; // RGBA pictures
    uint32_t frames;
    double sum, max; // shares of the pixels that full detail covers
} prom_holes;

prom_status prom_holes_init(prom_holes *holes, const prom_session *session, prom_error *error);
void prom_holes_finish(prom_holes *holes); // {0} is allowed
// Draws full detail and the cut from this camera, compares what they cover and counts.
void prom_holes_check(prom_holes *holes, prom_session *session, const prom_camera *camera,
                      const prom_cut *cut);

#endif
