// A picture of a cut, with the pixels that each node shows in it.
#ifndef PROM_APP_COUNTED_PICTURE_H
#define PROM_APP_COUNTED_PICTURE_H

#include "app/session.h"

// Draws a cut into a target of the camera's size; ids: whose the target gets.
void prom_picture_draw(prom_session *session, prom_target *target, const prom_camera *camera,
                       const prom_cut *cut, prom_ids ids);
// The same into a target with ids, and reads it. rgba: 4 bytes a pixel; px: visible pixels of
// each node of the tree; ids: scratch, one a pixel. What is blended hides nothing: a pixel may
// count for a pane and for what is behind it.
void prom_picture_draw_counted(prom_session *session, prom_target *target,
                               const prom_camera *camera, const prom_cut *cut, uint8_t *rgba,
                               uint32_t *px, uint32_t *ids);

#endif
