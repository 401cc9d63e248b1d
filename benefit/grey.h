// What the metrics on greys share: luma, rows with borders, edges, differences.
#ifndef PROM_BENEFIT_GREY_H
#define PROM_BENEFIT_GREY_H

#include "benefit/bands.h"
#include "benefit/metric.h"

// Luma of a row: 0.2126 R + 0.7152 G + 0.0722 B (Rec. 709) of the values as they are stored:
// bytes / 255, floats as they are. `width` floats.
void prom_grey_row(const prom_picture *picture, uint32_t y, float *row);
// All rows into a plane.
void prom_grey_plane(prom_bands *bands, const prom_picture *picture, float *plane);

// What stands beyond the border of a picture.
typedef enum prom_border {
    PROM_BORDER_REPLICATE, // a a a | a b c d | d d d
    PROM_BORDER_REFLECT,   // c b a | a b c d | d c b
} prom_border;

// The index in [0, count) whose value stands at `i`.
uint32_t prom_border_index(prom_border border, int64_t i, uint32_t count);
// Fills `pad` values on both sides of a row of `width`.
void prom_border_row(prom_border border, float *row, uint32_t width, uint32_t pad);

// A band of luma with a border: rows first - pad to last + pad of the picture, each of
// width + 2 pad floats.
size_t prom_grey_band_floats(uint32_t width, uint32_t pad);
void prom_grey_band(const prom_picture *picture, uint32_t first, uint32_t last, uint32_t pad,
                    prom_border border, float *band);

// Strength of the edges in a row: `scale` times the magnitude of the Sobel filter (1 2 1 across
// 1 0 -1). above: the row above this one, `stride` floats before it, as the row below is after
// it; one value on both sides is read too.
void prom_grey_edges(const float *above, size_t stride, uint32_t width, float scale,
                     float *edges);

// |a - b| of two planes.
void prom_grey_difference(prom_bands *bands, const float *a, const float *b, uint32_t width,
                          uint32_t height, float *map);

#endif
