// Colours for a map of errors: from near black for 0 through violet, red and orange to near
// white for 1, such that equal steps of the error look equally large. The lightness only rises,
// so that the picture reads in grey too.
//
// A curve in OKLab (Ottosson 2020, "A perceptual color space for image processing"): its
// lightness rises evenly, its hue turns evenly, its chroma is half a sine wave. It is walked in
// steps of equal length.
#ifndef PROM_BENEFIT_COLOUR_MAP_H
#define PROM_BENEFIT_COLOUR_MAP_H

#include <stddef.h>
#include <stdint.h>

// The colours of the errors i / 255, sRGB.
void prom_colour_map(uint8_t colours[256][3]);

// Paints `count` errors; what is below 0 or above 1 has the colour of the end. rgb: 3 * count.
void prom_colour_map_paint(const float *errors, size_t count, uint8_t *rgb);

#endif
