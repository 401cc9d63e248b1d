// Accuracy and footprint of representations from the model's tables.
#ifndef PROM_BENEFIT_ACCURACY_H
#define PROM_BENEFIT_ACCURACY_H

#include "metaobj/model.h"

// A place in the tables: what all representations of a node seen in one view have in common.
typedef struct prom_accuracy_place {
    float uv[2];   // direction towards the eye, on the octahedral map
    float size_px; // diameter of the bounding sphere, in pixels as those of the tables
    prom_direction_weights around;
    uint32_t size;          // bins size and size + 1, below the large ones,
    float t;                // and where between them
    prom_axis_weights axes; // from PROM_SIZE_MAX_PX on
} prom_accuracy_place;

// uv: prom_octahedral_encode of the direction in the prototype's frame.
void prom_accuracy_place_init(prom_accuracy_place *place, const float uv[2], float size_px);

// Accuracy in [0,1] of representation `rep` at a place: bilinear between the directions, linear
// in log2 of the size between the size bins, the smallest bin's value below. Above
// PROM_SIZE_MAX_PX:
//   meshes: the value there times the ratio, at most 1, of the large sizes' values to it along
//   the
//     axes; and from PROM_SIZE_MAX_LARGE_PX on times near(e_px) / near(e_px there), with
//     near(e) = 1 / (1 + near_k * e) and e_px = error * size_px / (2 * radius);
//   others: the error grows with the size.
// Continuous; nowhere above what was measured around the place; 1 for full geometry.
// radius: of the prototype (same frame as the representation's error).
float prom_accuracy(const prom_model *model, uint32_t rep, const prom_accuracy_place *place,
                    float radius);

// Fits near_k >= 0 to a mesh level's own rows: least squares over (e_px, accuracy) pairs.
float prom_accuracy_fit_near(const float *e_px, const float *accuracy, size_t count);

// Pixels that a prototype's outline covers, seen from `dir` with the given diameter:
// coverage * pi/4 * size_px^2.
float prom_footprint_px(const prom_model *model, uint32_t prototype, uint32_t dir,
                        float size_px);

// Splits the visible pixels of a cluster among its children by the shares baked for direction
// bin `dir`, each scaled by the part of the child that is inside the view (in_view, [0,1]):
//     px[c] = pixels * share_c * in_view_c / sum_k share_k * in_view_k,
// so that sum px = pixels whenever any child is in view (DESIGN: comparability invariant).
// Where all shares of the children in view are 0 they are taken as equal.
void prom_split_pixels(const prom_model *model, uint32_t prototype, uint32_t dir, float pixels,
                       const float *in_view, float *px);

#endif
