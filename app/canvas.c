#include "app/canvas.h"

#include "app/glyphs.h"
#include "metaobj/base/alloc.h"

#define TEXT_ZOOM 2

_Static_assert(PROM_TEXT_WIDTH == TEXT_ZOOM * (PROM_GLYPH_WIDTH + 1) &&
                   PROM_TEXT_HEIGHT == TEXT_ZOOM * PROM_GLYPH_HEIGHT,
               "characters are whole pixels of the font");

void prom_canvas_init(prom_canvas *canvas, uint32_t width, uint32_t height,
                      const uint8_t rgb[3])
{
    *canvas = (prom_canvas){width, height, prom_alloc((size_t)width * height, 3)};
    prom_canvas_fill(canvas, 0, 0, width, height, rgb);
}

void prom_canvas_finish(prom_canvas *canvas)
{
    prom_free(canvas->rgb);
    *canvas = (prom_canvas){0};
}

static uint32_t clipped(uint32_t from, uint32_t extent, uint32_t end)
{
    return from >= end ? 0 : extent < end - from ? extent : end - from;
}

void prom_canvas_fill(prom_canvas *canvas, uint32_t x, uint32_t y, uint32_t width,
                      uint32_t height, const uint8_t rgb[3])
{
    width = clipped(x, width, canvas->width);
    height = clipped(y, height, canvas->height);
    for (uint32_t row = y; row < y + height; row++)
        for (uint32_t column = x; column < x + width; column++)
            memcpy(canvas->rgb[(size_t)row * canvas->width + column], rgb, 3);
}

void prom_canvas_picture(prom_canvas *canvas, uint32_t x, uint32_t y, uint32_t width,
                         uint32_t height, uint32_t zoom, const uint8_t (*rgb)[3])
{
    for (uint32_t row = 0; row < height; row++)
        for (uint32_t column = 0; column < width; column++)
            prom_canvas_fill(canvas, x + column * zoom, y + row * zoom, zoom, zoom,
                             rgb[(size_t)row * width + column]);
}

void prom_canvas_text(prom_canvas *canvas, uint32_t x, uint32_t y, const uint8_t rgb[3],
                      const char *text)
{
    for (const char *c = text; *c; c++) {
        if (((unsigned char)*c & 0xc0) == 0x80) continue; // the rest of a character
        for (uint32_t row = 0; row < PROM_GLYPH_HEIGHT; row++)
            for (uint32_t column = 0; column < PROM_GLYPH_WIDTH; column++)
                if (prom_glyph_has(*c, column, row))
                    prom_canvas_fill(canvas, x + column * TEXT_ZOOM, y + row * TEXT_ZOOM,
                                     TEXT_ZOOM, TEXT_ZOOM, rgb);
        x += PROM_TEXT_WIDTH;
    }
}
