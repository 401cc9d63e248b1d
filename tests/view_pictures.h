// Synthetic views: the same picture in every direction.
#ifndef PROM_TESTS_VIEW_PICTURES_H
#define PROM_TESTS_VIEW_PICTURES_H

#include "builder/views.h"

// Colour of the pixel at (x, y) in [-1,1], right and down; false: nothing is there.
typedef bool view_painter(const void *user, uint32_t view, float x, float y, uint8_t rgb[3]);

static inline void paint_views(prom_views *views, bool large, view_painter *paint,
                               const void *user)
{
    prom_rgba *picture = prom_alloc(PROM_VIEW_LARGE_PIXELS, sizeof *picture);
    prom_views_clear(views);
    for (uint32_t v = 0; v < (large ? PROM_VIEWS : PROM_DIRS); v++) {
        const uint32_t side = prom_view_px(v);
        for (uint32_t y = 0; y < side; y++)
            for (uint32_t x = 0; x < side; x++) {
                float fx = (2.0f * (float)x + 1.0f) / (float)side - 1.0f;
                float fy = (2.0f * (float)y + 1.0f) / (float)side - 1.0f;
                uint8_t *p = picture[y * side + x];
                memset(p, 0, 4);
                if (paint(user, v, fx, fy, p)) p[3] = 255;
            }
        prom_views_add(views, (const prom_rgba *)picture, side);
    }
    prom_free(picture);
}

#endif
