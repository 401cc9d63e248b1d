// A picture to put a diagram together in: rectangles, other pictures, text in a font of its
// own. Everything is clipped to the picture.
#ifndef PROM_APP_CANVAS_H
#define PROM_APP_CANVAS_H

#include <stdint.h>

typedef struct prom_canvas {
    uint32_t width, height;
    uint8_t (*rgb)[3]; // sRGB-encoded, rows from the top
} prom_canvas;

// Filled with a colour.
void prom_canvas_init(prom_canvas *canvas, uint32_t width, uint32_t height,
                      const uint8_t rgb[3]);
void prom_canvas_finish(prom_canvas *canvas); // {0} is allowed
void prom_canvas_fill(prom_canvas *canvas, uint32_t x, uint32_t y, uint32_t width,
                      uint32_t height, const uint8_t rgb[3]);
// A picture of width x height pixels, rows from the top, each drawn as zoom x zoom.
void prom_canvas_picture(prom_canvas *canvas, uint32_t x, uint32_t y, uint32_t width,
                         uint32_t height, uint32_t zoom, const uint8_t (*rgb)[3]);

// Text: PROM_TEXT_WIDTH x PROM_TEXT_HEIGHT pixels a character, from the upper left corner.
#define PROM_TEXT_WIDTH 12
#define PROM_TEXT_HEIGHT 16
// UTF-8, of which ASCII can be shown; all else becomes `?`.
void prom_canvas_text(prom_canvas *canvas, uint32_t x, uint32_t y, const uint8_t rgb[3],
                      const char *text);

#endif
