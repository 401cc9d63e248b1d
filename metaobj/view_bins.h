// The view bins for which accuracy, coverage and visible-pixel shares are stored: directions on
// an octahedral grid times sizes in pixels.
#ifndef PROM_METAOBJ_VIEW_BINS_H
#define PROM_METAOBJ_VIEW_BINS_H

#include <stdint.h>

#define PROM_DIR_GRID 6                              // cells along a side of the square
#define PROM_DIRS (PROM_DIR_GRID * PROM_DIR_GRID)    // directions
#define PROM_SIZES 5                                 // 8, 16, 32, 64, 128 px
#define PROM_SIZE_MIN_PX 8.0f
#define PROM_SIZE_MAX_PX 128.0f

// The unit vector of a bin's centre, from the object towards the eye, in the prototype's frame.
void prom_direction_of_bin(uint32_t bin, float direction[3]);
// The bin whose cell holds the direction (any length > 0).
uint32_t prom_bin_of_direction(const float direction[3]);
// Diameter in pixels of size bin s: PROM_SIZE_MIN_PX * 2^s.
float prom_size_of_bin(uint32_t s);

#endif
