// The edge-blur metric, on greys and in steps (metric.h has it on pictures).
#ifndef PROM_BENEFIT_EDGE_BLUR_H
#define PROM_BENEFIT_EDGE_BLUR_H

#include <stddef.h>
#include <stdint.h>

// Radius in pixels up to which one pixel influences the edge-blur error of another.
#define PROM_EDGE_BLUR_RADIUS 3

// The grey that metrics compare: luma (grey.h). rgba: `pixels` of 4 encoded bytes, alpha is not
// looked at; grey: as many floats in [0,1].
void prom_metric_grey(const uint8_t *rgba, size_t pixels, float *grey);

// The error of two pictures (formula in the source). a, b: width x height greys; error: per
// pixel in [0,1], may not alias the inputs; scratch: prom_edge_blur_scratch(width, height)
// floats.
size_t prom_edge_blur_scratch(uint32_t width, uint32_t height);
void prom_edge_blur(const float *a, const float *b, uint32_t width, uint32_t height,
                    float *error, float *scratch);

// The same in two steps, so that a reference is filtered once for many comparisons: features of
// one picture (2 planes of width x height floats: blurred edges, blurred grey), then the error
// of two feature sets.
void prom_edge_blur_features(const float *grey, uint32_t width, uint32_t height,
                             float *features, float *scratch);
void prom_edge_blur_error(const float *features_a, const float *features_b, uint32_t width,
                          uint32_t height, float *error);

#endif
