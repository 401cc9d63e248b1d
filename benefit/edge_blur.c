// The edge-blur metric, on luma.
//
//   E(p) = |Sobel of the luma| / 4 (a full step between flat areas gives 1)
//   B(x) = x blurred by the binomial kernel 1 4 6 4 1 / 16 in both directions (a Gaussian of
//          standard deviation 1 pixel)
//   error = min(1, EDGE_GAIN |B(E_a) - B(E_b)| + GREY_GAIN |B(luma_a) - B(luma_b)|)
//
// The border of a picture replicates. The sequence luma, edges, blur, comparison is that of the
// classic (Maciel and Shirley 1995), to which we add the blurred luma, since edges alone are
// blind to flat changes; kernels and gains are ours. GREY_GAIN: a grey 0.1 off (some 20 % of
// brightness) costs a quarter of the pixel, about what FLIP says of it, and a contrast of 0.4,
// an object that is missing, costs all of it. EDGE_GAIN: by taste; lost texture of contrast 0.3
// costs about a third.
#include "benefit/grey.h"
#include "benefit/metric_private.h"

#include <math.h>

#define EDGE_GAIN 1.0f
#define GREY_GAIN 2.5f

enum { RADIUS = 3, BLUR = 2, FEATURES = 2 };

// Working memory for a band: luma with a border of RADIUS, edges with one of BLUR, and a row of
// either.
static size_t scratch_floats(uint32_t width)
{
    return prom_grey_band_floats(width, RADIUS) + prom_grey_band_floats(width, BLUR) + width +
           2 * BLUR;
}

// A row of `width`, blurred, from five rows of width + 2 BLUR that stand `stride` apart.
static void blur_row(const float *top, size_t stride, uint32_t width, float *padded,
                     float *blurred)
{
    const float *restrict r0 = top, *restrict r1 = r0 + stride, *restrict r2 = r1 + stride;
    const float *restrict r3 = r2 + stride, *restrict r4 = r3 + stride;
    float *restrict p = padded, *restrict out = blurred;
    for (size_t x = 0; x < width + 2 * BLUR; x++)
        p[x] = (r0[x] + r4[x]) + 4.0f * (r1[x] + r3[x]) + 6.0f * r2[x];
    for (size_t x = 0; x < width; x++)
        out[x] = ((p[x] + p[x + 4]) + 4.0f * (p[x + 1] + p[x + 3]) + 6.0f * p[x + 2]) *
                 (1.0f / 256.0f);
}

typedef struct features_job {
    const prom_picture *picture;
    float *features;
} features_job;

static void features_of_band(void *user, uint32_t first, uint32_t last, void *scratch)
{
    const features_job *job = user;
    const uint32_t width = job->picture->width, rows = last - first;
    const size_t wide = (size_t)width + 2 * RADIUS, narrow = (size_t)width + 2 * BLUR;
    float *luma = scratch, *edges = luma + prom_grey_band_floats(width, RADIUS);
    float *padded = edges + prom_grey_band_floats(width, BLUR);
    prom_grey_band(job->picture, first, last, RADIUS, PROM_BORDER_REPLICATE, luma);
    for (uint32_t y = 0; y < rows + 2 * BLUR; y++)
        prom_grey_edges(luma + y * wide + 1, wide, width + 2 * BLUR, 0.25f, edges + y * narrow);
    float *out = job->features + (size_t)first * width;
    float *out_luma = out + (size_t)width * job->picture->height;
    for (uint32_t y = 0; y < rows; y++, out += width, out_luma += width) {
        blur_row(edges + y * narrow, narrow, width, padded, out);
        blur_row(luma + (y + 1) * wide + 1, wide, width, padded, out_luma);
    }
}

typedef struct compare_job {
    const float *a, *b;
    size_t width, plane;
    float *map;
} compare_job;

static void compare_band(void *user, uint32_t first, uint32_t last, void *scratch)
{
    (void)scratch;
    const compare_job *job = user;
    const float *restrict edges_a = job->a, *restrict luma_a = job->a + job->plane;
    const float *restrict edges_b = job->b, *restrict luma_b = job->b + job->plane;
    float *restrict map = job->map;
    for (size_t i = first * job->width; i < last * job->width; i++) {
        float e = EDGE_GAIN * fabsf(edges_a[i] - edges_b[i]) +
                  GREY_GAIN * fabsf(luma_a[i] - luma_b[i]);
        map[i] = e < 1.0f ? e : 1.0f;
    }
}

// ---- as a metric

static void *create(double ppd, uint32_t max_side, size_t max_pixels, unsigned threads)
{
    (void)ppd;
    (void)max_pixels;
    return prom_bands_create(threads, scratch_floats(max_side) * sizeof(float));
}

static void destroy(void *bands)
{
    prom_bands_destroy(bands);
}

static uint32_t radius(const void *bands)
{
    (void)bands;
    return RADIUS;
}

static void features(void *bands, const prom_picture *picture, float *planes)
{
    prom_bands_run(bands, picture->height, features_of_band, &(features_job){picture, planes});
}

static void compare(void *bands, const float *features_a, const float *features_b,
                    uint32_t width, uint32_t height, float *map)
{
    prom_bands_run(bands, height, compare_band,
                   &(compare_job){features_a, features_b, width, (size_t)width * height, map});
}

const prom_metric_kind prom_metric_edge_blur = {
    .class = {.name = "edge-blur", .summary = "blurred edges and luma, cheap to compare"},
    .planes = FEATURES,
    .create = create,
    .destroy = destroy,
    .radius = radius,
    .features = features,
    .compare = compare,
};
