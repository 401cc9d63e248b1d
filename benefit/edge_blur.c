// The edge-blur metric.
//
//   E(p) = |Sobel of the grey picture| / 4, at most 1 (a full step between flat areas gives 1)
//   B(x) = x blurred by the binomial kernel 1 4 6 4 1 / 16 in both directions (a Gaussian of
//          standard deviation 1 pixel)
//   error = min(1, EDGE_GAIN |B(E_a) - B(E_b)| + GREY_GAIN |B(grey_a) - B(grey_b)|)
//
// The sequence grey, edges, blur, comparison is that of the classic (Maciel and Shirley 1995);
// kernels and gains are ours. GREY_GAIN: a grey 0.1 off (some 20 % of brightness) costs a
// quarter of the pixel, about what FLIP says of it, and a contrast of 0.4, an object that is
// missing, costs all of it. EDGE_GAIN: by taste; lost texture of contrast 0.3 costs about a
// third.
#include "benefit/edge_blur.h"

#include "benefit/grey.h"
#include "benefit/metric_private.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"

#include <assert.h>
#include <math.h>

#define EDGE_GAIN 1.0f
#define GREY_GAIN 2.5f

enum { PAD = 2 }; // radius of the blur; the Sobel filter adds 1

void prom_metric_grey(const uint8_t *rgba, size_t pixels, float *grey)
{
    for (size_t i = 0; i < pixels; i++) {
        const uint8_t *p = rgba + 4 * i;
        float luminance = 0.2126f * prom_srgb8_to_linear(p[0]) +
                          0.7152f * prom_srgb8_to_linear(p[1]) +
                          0.0722f * prom_srgb8_to_linear(p[2]);
        grey[i] = prom_linear_to_srgb(fminf(luminance, 1.0f));
    }
}

static size_t row_floats(uint32_t width)
{
    return (size_t)width + 2 * PAD;
}

// One feature pass needs a plane of edges and two padded rows.
static size_t features_scratch(uint32_t width, uint32_t height)
{
    return (size_t)width * height + 2 * row_floats(width);
}

size_t prom_edge_blur_scratch(uint32_t width, uint32_t height)
{
    return 4 * (size_t)width * height + features_scratch(width, height);
}

static uint32_t clamp_row(int64_t y, uint32_t height)
{
    return y < 0 ? 0 : y >= height ? height - 1 : (uint32_t)y;
}

// Repeats the border values of a row that starts PAD floats into its memory.
static void pad_row(float *row, uint32_t width)
{
    for (int i = 1; i <= PAD; i++) {
        row[-i] = row[0];
        row[(size_t)width - 1 + (size_t)i] = row[width - 1];
    }
}

static void edge_row(const float *restrict above, const float *restrict here,
                     const float *restrict below, uint32_t width, float *restrict smooth,
                     float *restrict slope, float *restrict edges)
{
    for (uint32_t x = 0; x < width; x++) {
        smooth[x] = above[x] + 2.0f * here[x] + below[x];
        slope[x] = below[x] - above[x];
    }
    pad_row(smooth, width);
    pad_row(slope, width);
    const float *sl = smooth - 1, *sr = smooth + 1, *dl = slope - 1, *dr = slope + 1;
    for (uint32_t x = 0; x < width; x++) {
        float gx = sr[x] - sl[x];
        float gy = dl[x] + 2.0f * slope[x] + dr[x];
        float magnitude = 0.25f * sqrtf(gx * gx + gy * gy);
        edges[x] = magnitude < 1.0f ? magnitude : 1.0f;
    }
}

static void blur_row(const float *const rows[5], uint32_t width, float *restrict padded,
                     float *restrict out)
{
    const float *restrict r0 = rows[0], *restrict r1 = rows[1], *restrict r2 = rows[2];
    const float *restrict r3 = rows[3], *restrict r4 = rows[4];
    for (uint32_t x = 0; x < width; x++)
        padded[x] = (r0[x] + r4[x]) + 4.0f * (r1[x] + r3[x]) + 6.0f * r2[x];
    pad_row(padded, width);
    const float *p0 = padded - 2, *p1 = padded - 1, *p3 = padded + 1, *p4 = padded + 2;
    for (uint32_t x = 0; x < width; x++)
        out[x] =
            ((p0[x] + p4[x]) + 4.0f * (p1[x] + p3[x]) + 6.0f * padded[x]) * (1.0f / 256.0f);
}

static void blur_plane(const float *plane, uint32_t width, uint32_t height, float *padded,
                       float *out)
{
    for (uint32_t y = 0; y < height; y++) {
        const float *rows[5];
        for (int k = 0; k < 5; k++)
            rows[k] = plane + (size_t)clamp_row((int64_t)y + k - 2, height) * width;
        blur_row(rows, width, padded, out + (size_t)y * width);
    }
}

void prom_edge_blur_features(const float *grey, uint32_t width, uint32_t height,
                             float *features, float *scratch)
{
    assert(width > 0 && height > 0);
    const size_t plane = (size_t)width * height;
    float *edges = scratch;
    float *first = scratch + plane + PAD, *second = first + row_floats(width);
    for (uint32_t y = 0; y < height; y++) {
        const float *above = grey + (size_t)clamp_row((int64_t)y - 1, height) * width;
        const float *below = grey + (size_t)clamp_row((int64_t)y + 1, height) * width;
        edge_row(above, grey + (size_t)y * width, below, width, first, second,
                 edges + (size_t)y * width);
    }
    blur_plane(edges, width, height, first, features);
    blur_plane(grey, width, height, first, features + plane);
}

void prom_edge_blur_error(const float *features_a, const float *features_b, uint32_t width,
                          uint32_t height, float *error)
{
    const size_t plane = (size_t)width * height;
    const float *restrict edges_a = features_a, *restrict edges_b = features_b;
    const float *restrict grey_a = features_a + plane, *restrict grey_b = features_b + plane;
    float *restrict out = error;
    for (size_t i = 0; i < plane; i++) {
        float e = EDGE_GAIN * fabsf(edges_a[i] - edges_b[i]) +
                  GREY_GAIN * fabsf(grey_a[i] - grey_b[i]);
        out[i] = e < 1.0f ? e : 1.0f;
    }
}

void prom_edge_blur(const float *a, const float *b, uint32_t width, uint32_t height,
                    float *error, float *scratch)
{
    const size_t plane = (size_t)width * height;
    float *features_a = scratch, *features_b = scratch + 2 * plane;
    float *rest = scratch + 4 * plane;
    prom_edge_blur_features(a, width, height, features_a, rest);
    prom_edge_blur_features(b, width, height, features_b, rest);
    prom_edge_blur_error(features_a, features_b, width, height, error);
}

// ---- as a metric

typedef struct edge_blur {
    float *grey, *scratch;
} edge_blur;

static void *create(double ppd, uint32_t max_side, size_t max_pixels, unsigned threads)
{
    (void)ppd;
    (void)threads;
    edge_blur *state = prom_alloc(1, sizeof *state);
    state->grey = prom_alloc(max_pixels, sizeof(float));
    state->scratch = prom_alloc(max_pixels + 2 * row_floats(max_side), sizeof(float));
    return state;
}

static void destroy(void *user)
{
    edge_blur *state = user;
    prom_free(state->grey);
    prom_free(state->scratch);
    prom_free(state);
}

static uint32_t radius(const void *user)
{
    (void)user;
    return PROM_EDGE_BLUR_RADIUS;
}

static void features(void *user, const prom_picture *picture, float *planes)
{
    edge_blur *state = user;
    for (uint32_t y = 0; y < picture->height; y++)
        prom_grey_row(picture, y, state->grey + (size_t)y * picture->width);
    prom_edge_blur_features(state->grey, picture->width, picture->height, planes,
                            state->scratch);
}

static void compare(void *user, const float *features_a, const float *features_b,
                    uint32_t width, uint32_t height, float *map)
{
    (void)user;
    prom_edge_blur_error(features_a, features_b, width, height, map);
}

const prom_metric_kind prom_metric_edge_blur = {
    .class = {.name = "edge-blur", .summary = "blurred edges and greys, cheap to compare"},
    .planes = 2,
    .create = create,
    .destroy = destroy,
    .radius = radius,
    .features = features,
    .compare = compare,
};
