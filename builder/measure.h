// Accuracy tables: pictures of a representation against pictures of the true object, per view
// bin, over two backgrounds (DESIGN: benefit).
//
// Smaller sizes are area averages of the largest: a table says what a well-filtered picture of
// that size would show, not which of its samples happened to hit.
#ifndef PROM_BUILDER_MEASURE_H
#define PROM_BUILDER_MEASURE_H

#include "builder/bake.h"

// Diameter in pixels at which gaps are counted.
#define PROM_GAP_PX 64

typedef struct prom_measure prom_measure;

// mean_luminance: linear, of the scene; the first background. The second one contrasts with it.
prom_measure *prom_measure_create(float mean_luminance);
void prom_measure_destroy(prom_measure *measure);

// Sets the true object; coverage gets its covered share of the bounding sphere's disc per
// direction, 65535 = 1.
void prom_measure_set_truth(prom_measure *measure, const prom_views *truth,
                            uint16_t coverage[PROM_DIRS]);

// Accuracy of a representation against the truth set last: 1 - error summed over the padded
// window / area covered in either picture, mean of both backgrounds; 255 = 1.
// Returns the size of its gaps: the pixels, at PROM_GAP_PX and in the worst direction, that the
// object covers whole (9 tenths) and the representation hardly (1 tenth), through which the
// background would show.
float prom_measure_compare(prom_measure *measure, const prom_views *views,
                           uint8_t accuracy[PROM_DIRS][PROM_SIZES]);

// Each item's share of the visible pixels per direction: shares[item][dir], summing to 65535
// over the items up to rounding where anything is visible. counts come from views->ids <
// item_count.
void prom_measure_shares(const prom_views *views, uint32_t item_count,
                         uint16_t (*shares)[PROM_DIRS]);

#endif
