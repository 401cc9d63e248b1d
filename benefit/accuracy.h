// Accuracy and footprint of representations from the model's tables.
#ifndef PROM_BENEFIT_ACCURACY_H
#define PROM_BENEFIT_ACCURACY_H

#include "metaobj/model.h"

// Accuracy in [0,1] of representation `rep` seen from direction bin `dir` with its bounding
// sphere's diameter `size_px`: linear in log2 of the size between the size bins, the smallest
// bin's value below; above the largest, for meshes,
//     a(dir, 128 px) * near(e_px) / near(e_px at 128 px),  near(e) = 1 / (1 + near_k * e),
// with e_px = error * size_px / (2 * radius): monotone, continuous, 1 for full geometry.
// radius: of the prototype (same frame as the representation's error).
float prom_accuracy(const prom_model *model, uint32_t rep, uint32_t dir, float size_px,
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
