// Panoramas: which leaf of a model an eye sees in which direction, as ids on the six faces of a
// cube around it, and what that makes of each leaf. Private to builder/.
#ifndef PROM_BUILDER_PANORAMA_H
#define PROM_BUILDER_PANORAMA_H

#include "render/renderer.h"

#define PROM_PANORAMA_FACES 6

// Face after face, size_px * size_px each; PROM_NONE where there is nothing.
typedef struct prom_panorama {
    double eye[3];
    uint32_t size_px;
    uint32_t *opaque;                      // what is blended left out
    uint32_t *blended;                     // the same with what is blended over it
    bool has_blended[PROM_PANORAMA_FACES]; // else a face has no picture in `blended`
} prom_panorama;

void prom_panorama_init(prom_panorama *panorama, uint32_t size_px);
void prom_panorama_finish(prom_panorama *panorama); // {0} is allowed

// ---- drawing, on the device's thread

typedef struct prom_panorama_camera prom_panorama_camera;

// The renderer has the model loaded; both must outlive the camera.
prom_panorama_camera *prom_panorama_camera_create(prom_renderer *renderer,
                                                  const prom_model *model, uint32_t size_px,
                                                  prom_error *error);
void prom_panorama_camera_destroy(prom_panorama_camera *camera); // NULL is allowed
// Draws what is seen from panorama->eye: every leaf by the coarsest mesh that is within half a
// pixel of it, the background left out.
void prom_panorama_take(prom_panorama_camera *camera, prom_panorama *panorama);

// ---- counting, on any thread (panorama_shares.c)

// Solid angle, in steradians, of each pixel of a face, size_px * size_px; the same for all six.
float *prom_panorama_angles(uint32_t size_px);

// Of each node of the tree the share of its footprint that shows, in [0,1]; of an inner node
// the mean of what is below. A leaf that is too small for the pixels shows as its parent does.
// solid, footprint: scratch for tree_count numbers each.
void prom_panorama_shares(const prom_panorama *panorama, const prom_model *model,
                          const float *angles, double *solid, double *footprint, float *shares);

#endif
