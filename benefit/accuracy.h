// Accuracy and footprint of representations from the model's tables.
#ifndef PROM_BENEFIT_ACCURACY_H
#define PROM_BENEFIT_ACCURACY_H

#include "metaobj/model.h"

// An accuracy is 1 - error. The error is the sum over all pixels in which a representation
// looks otherwise than the object, divided by the pixels of the object: above 1, and the
// accuracy below 0, where it spoils more of its surroundings than the object has pixels, as a
// box in the place of a lamp post does. It is kept as a byte, in steps that are finest near 1:
//     error = PROM_ERROR_MAX * ((255 - byte) / 255)^2.
#define PROM_ERROR_MAX 4.0f
static inline float prom_accuracy_of_byte(uint8_t byte)
{
    float root = (float)(255 - byte) / 255.0f;
    return 1.0f - PROM_ERROR_MAX * root * root;
}
// Never promises more: the next byte at or below; 0 for errors above PROM_ERROR_MAX.
uint8_t prom_byte_of_accuracy(double accuracy);

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

// Accuracy, at most 1, of representation `rep` at a place: bilinear between the directions,
// linear in log2 of the size between the size bins, the smallest bin's value below. Above
// PROM_SIZE_MAX_PX:
//   meshes: the value there, less what the large sizes' values are lower along the axes; and
//   from
//     PROM_SIZE_MAX_LARGE_PX on, where above 0, times near(e_px) / near(e_px there), with
//     near(e) = 1 / (1 + near_k * e) and e_px = error * size_px / (2 * radius);
//   others: the error grows with the size.
// Continuous; nowhere above what was measured around the place; 1 for full geometry.
// radius: of the prototype (same frame as the representation's error).
float prom_accuracy(const prom_model *model, uint32_t rep, const prom_accuracy_place *place,
                    float radius);

// Fits near_k >= 0 to a mesh level's own rows: how its accuracy falls with e_px, whatever it is
// at e_px = 0. Least squares of s * near(e_px) over (e_px, accuracy) pairs, for the best s in
// [0,1]; 0 where that does not fall.
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
