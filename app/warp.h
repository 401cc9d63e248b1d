// Where what a picture shows was in the picture before: from the depths of both, and their
// cameras. Only the camera moves. No GL: it works on arrays.
#ifndef PROM_APP_WARP_H
#define PROM_APP_WARP_H

#include "metaobj/camera.h"

#include <stddef.h>
#include <stdint.h>

// A picture's camera and its depths: reverse z, near / distance along the view, 0 at infinity;
// rows from the top.
typedef struct prom_warp_view {
    prom_camera camera;
    const float *depth;
} prom_warp_view;

// For each pixel of `now`, what place of `before` showed the same point: x and y in pixels from
// the centre of the top left one; x is NAN where none did, because it was outside the picture
// or something else was in front. Both pictures are of one size. from: a pair for each pixel.
// Returns how many have a place.
size_t prom_warp_find(const prom_warp_view *before, const prom_warp_view *now,
                      float (*from)[2]);
// Takes the picture before (RGBA, sRGB-encoded) to where its points are now, in linear light,
// between pixels bilinearly; where they come from nowhere, it is the picture `now`. warped: RGB
// in linear light.
void prom_warp_apply(const float (*from)[2], uint32_t width, uint32_t height,
                     const uint8_t *before, const uint8_t *now, float (*warped)[3]);

#endif
