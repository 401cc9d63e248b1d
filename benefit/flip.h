// FLIP, LDR: how different two pictures look to a person who flips between them.
// Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild: FLIP: A Difference
// Evaluator for Alternating Images, HPG 2020.
//
// A value says nothing without its pixels per degree: keep them with it. On a screen of
// `screen_px` across `screen_m`, seen from `distance_m` away, these are
// distance_m * screen_px / screen_m * pi / 180.
#ifndef PROM_BENEFIT_FLIP_H
#define PROM_BENEFIT_FLIP_H

#include "metaobj/model.h"

#include <stdint.h>

// Pixels per degree of a screen 0.7 m wide with PROM_FLIP_SCREEN_PX pixels, 0.7 m away: the
// authors' default. A picture shown over the whole width of that screen has its part of them.
#define PROM_FLIP_PPD 67.0206
#define PROM_FLIP_SCREEN_PX 3840
typedef struct prom_flip prom_flip;

// Scratch memory for pictures of this size, and the filters for `ppd` pixels per degree, from
// PROM_PPD_MIN to PROM_PPD_MAX.
prom_flip *prom_flip_create(uint32_t width, uint32_t height, double ppd);
void prom_flip_destroy(prom_flip *flip); // NULL is allowed
// Error of each pixel in [0,1] into `map` (width * height), and returned, its mean. Pictures:
// width * height sRGB pixels of `stride` bytes each (3, or 4 with a fourth that is ignored).
// Symmetric in a and b, 0 for equal ones. On all cores; the result depends on no order.
double prom_flip_run(prom_flip *flip, const uint8_t *a, const uint8_t *b, uint32_t stride,
                     float *map);

#endif
