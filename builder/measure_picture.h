// Parts of pictures in linear light: taken from a view, brought to a smaller size by area
// averages, and laid over a background. Private to measuring.
#ifndef PROM_BUILDER_MEASURE_PICTURE_H
#define PROM_BUILDER_MEASURE_PICTURE_H

#include "builder/views.h"
#include "metaobj/model.h"

// What a part of a picture shows: linear colour times coverage, and coverage.
typedef struct prom_patch {
    prom_part part;
    float (*pixels)[4]; // rows from the top
} prom_patch;

static inline size_t prom_part_pixels(const prom_part *part)
{
    return (size_t)part->width * part->height;
}

// The least part that holds both; an empty one (width 0) counts for nothing.
prom_part prom_part_around(prom_part a, prom_part b);
// What a part becomes when the picture is reduced by `step` >= 1, outwards to whole pixels:
// pixel i of the reduced picture covers [i, i + 1) * step.
prom_part prom_part_reduced(prom_part part, float step);

// A part of a view as a patch; the part may reach beyond what the view covers.
void prom_patch_take(const prom_views *views, uint32_t view, prom_part part, prom_patch *patch);
// Area averages; nothing is outside the patch. between: room for patch->part.height rows of the
// result. The result's pixels are there; its part is set.
void prom_patch_reduce(const prom_patch *patch, float step, float (*between)[4],
                       prom_patch *reduced);

// Linear light to bytes, sRGB-encoded, through a table.
#define PROM_ENCODE_STEPS 4096
typedef struct prom_encoder {
    uint8_t bytes[PROM_ENCODE_STEPS + 1];
} prom_encoder;
void prom_encoder_init(prom_encoder *encoder);

// The patch over a grey of linear `background`, with `pad` pixels of that around: rows of
// part.width + 2 * pad encoded pixels.
void prom_patch_compose(const prom_patch *patch, const prom_encoder *encoder, float background,
                        uint32_t pad, uint8_t (*rgba)[4]);

// Pixels that a patch covers, at least 1: what covers less is judged as if it were one.
double prom_patch_area(const prom_patch *patch);
// The error of a padded window: the sum of the map over the area, or where the metric squares,
// the root of the mean square.
double prom_window_error(const float *map, size_t count, double area, bool squares);
// Whether a part of the object is missing or something else is there: more than
// 1 - how->veto_percentile of the area lies within squares of errors above how->veto_error that
// are wider than an outline. Never in small pictures. The map is used up.
bool prom_window_vetoed(const prom_measured *how, float size_px, double area, float *map,
                        uint32_t width, uint32_t height);

#endif
