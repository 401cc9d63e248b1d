// A small font for pictures: the printable characters of ASCII.
#ifndef PROM_APP_GLYPHS_H
#define PROM_APP_GLYPHS_H

#include <stdbool.h>
#include <stdint.h>

#define PROM_GLYPH_WIDTH 5
#define PROM_GLYPH_HEIGHT 8 // capitals 7; the last row is below the line

// Whether a pixel of a character is set, counted from the upper left; other characters look
// like `?`.
bool prom_glyph_has(char character, uint32_t column, uint32_t row);

#endif
