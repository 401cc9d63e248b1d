// Structural similarity: Wang, Bovik, Sheikh, Simoncelli: Image Quality Assessment: From Error
// Visibility to Structural Similarity, 2004. Luma, 11 x 11 Gaussian of standard deviation 1.5,
// K1 = 0.01, K2 = 0.03, range 1, borders reflect. A map holds (1 - SSIM) / 2.
//
// With d = a - b, cov(a, b) = (var a + var b - var d) / 2, so that SSIM = (1 - p)(1 - q) with
//   p = (mean d)^2 / ((mean a)^2 + (mean b)^2 + C1),  q = var d / (var a + var b + C2),
// which is exactly 1 where nothing differs, and needs one filtered picture besides the
// features.
#include "benefit/grey.h"
#include "benefit/metric_private.h"
#include "metaobj/base/alloc.h"

#include <math.h>
#include <string.h>

enum { RADIUS = 5, FEATURES = 3 }; // features: luma, its local mean and variance

#define DEVIATION 1.5
#define C1 (0.01f * 0.01f)
#define C2 (0.03f * 0.03f)

typedef struct ssim {
    double taps[RADIUS + 1]; // from the middle outwards
    prom_bands *bands;
} ssim;

// A band of what is filtered, with its border, and one row of it on its way.
typedef struct scratch {
    float *band;
    double *first, *second; // moments, filtered down the columns; with a border
    float *mean, *variance;
} scratch;

static size_t padded(uint32_t width)
{
    return width + 2 * (size_t)RADIUS;
}

static size_t scratch_bytes(uint32_t width)
{
    return 2 * padded(width) * sizeof(double) +
           (prom_grey_band_floats(width, RADIUS) + 2 * (size_t)width) * sizeof(float);
}

static scratch divide(void *memory, uint32_t width)
{
    scratch s;
    s.first = memory;
    s.second = s.first + padded(width);
    s.mean = (float *)(s.second + padded(width));
    s.variance = s.mean + width;
    s.band = s.variance + width;
    return s;
}

static void *create(double ppd, uint32_t max_side, size_t max_pixels, unsigned threads)
{
    (void)ppd;
    (void)max_pixels;
    ssim *state = prom_alloc(1, sizeof *state);
    double sum = 0;
    for (int i = -RADIUS; i <= RADIUS; i++) sum += exp(-i * i / (2 * DEVIATION * DEVIATION));
    for (int i = 0; i <= RADIUS; i++)
        state->taps[i] = exp(-i * i / (2 * DEVIATION * DEVIATION)) / sum;
    state->bands = prom_bands_create(threads, scratch_bytes(max_side));
    return state;
}

static void destroy(void *user)
{
    ssim *state = user;
    prom_bands_destroy(state->bands);
    prom_free(state);
}

static uint32_t radius(const void *state)
{
    (void)state;
    return RADIUS;
}

// ---- the filter

// In doubles: the variance is a small difference of large numbers (and not below 0 but for
// rounding).
static void filter_down(const double *taps, const float *top, size_t stride, scratch *s)
{
    const int64_t step = (int64_t)stride;
    const double *restrict t = taps;
    const float *restrict middle = top + RADIUS * step;
    double *restrict first = s->first, *restrict second = s->second;
    for (int64_t x = 0; x < step; x++) {
        double value = middle[x], sum = t[0] * value, squares = t[0] * value * value;
        for (int i = 1; i <= RADIUS; i++) {
            double up = middle[x - i * step], down = middle[x + i * step];
            sum += t[i] * (up + down);
            squares += t[i] * (up * up + down * down);
        }
        first[x] = sum;
        second[x] = squares;
    }
}

static void filter_along(const double *taps, const scratch *s, uint32_t width, float *mean,
                         float *variance)
{
    const double *restrict t = taps;
    const double *restrict first = s->first + RADIUS, *restrict second = s->second + RADIUS;
    float *restrict to_mean = mean, *restrict to_variance = variance;
    for (int64_t x = 0; x < width; x++) {
        double sum = t[0] * first[x], squares = t[0] * second[x];
        for (int i = 1; i <= RADIUS; i++) {
            sum += t[i] * (first[x - i] + first[x + i]);
            squares += t[i] * (second[x - i] + second[x + i]);
        }
        to_mean[x] = (float)sum;
        to_variance[x] = (float)fabs(squares - sum * sum);
    }
}

// Mean and variance around the pixels of row y of a band.
static void filter_row(const ssim *state, scratch *s, uint32_t y, uint32_t width, float *mean,
                       float *variance)
{
    filter_down(state->taps, s->band + y * padded(width), padded(width), s);
    filter_along(state->taps, s, width, mean, variance);
}

// ---- features

typedef struct features_job {
    const ssim *state;
    const prom_picture *picture;
    float *features;
} features_job;

static void features_of_band(void *user, uint32_t first, uint32_t last, void *memory)
{
    const features_job *job = user;
    const uint32_t width = job->picture->width;
    const size_t plane = (size_t)width * job->picture->height;
    scratch s = divide(memory, width);
    prom_grey_band(job->picture, first, last, RADIUS, PROM_BORDER_REFLECT, s.band);
    for (uint32_t y = 0; y < last - first; y++) {
        float *luma = job->features + (size_t)(first + y) * width;
        memcpy(luma, s.band + (y + RADIUS) * padded(width) + RADIUS, width * sizeof *luma);
        filter_row(job->state, &s, y, width, luma + plane, luma + 2 * plane);
    }
}

static void features(void *user, const prom_picture *picture, float *planes)
{
    const ssim *state = user;
    prom_bands_run(state->bands, picture->height, features_of_band,
                   &(features_job){state, picture, planes});
}

// ---- comparison

typedef struct compare_job {
    const ssim *state;
    const float *a, *b;
    uint32_t width, height;
    float *map;
} compare_job;

static void difference_band(const compare_job *job, uint32_t first, uint32_t last, float *band)
{
    const uint32_t width = job->width;
    float *restrict row = band + RADIUS;
    for (int64_t y = (int64_t)first - RADIUS; y < (int64_t)last + RADIUS; y++) {
        const size_t from =
            (size_t)prom_border_index(PROM_BORDER_REFLECT, y, job->height) * width;
        const float *restrict a = job->a + from, *restrict b = job->b + from;
        for (size_t x = 0; x < width; x++) row[x] = a[x] - b[x];
        prom_border_row(PROM_BORDER_REFLECT, row, width, RADIUS);
        row += padded(width);
    }
}

static void errors_of_row(const compare_job *job, const scratch *s, uint32_t y)
{
    const size_t plane = (size_t)job->width * job->height, row = (size_t)y * job->width;
    const float *restrict mean_a = job->a + plane + row, *restrict var_a = mean_a + plane;
    const float *restrict mean_b = job->b + plane + row, *restrict var_b = mean_b + plane;
    const float *restrict mean_d = s->mean, *restrict var_d = s->variance;
    float *restrict map = job->map + row;
    for (size_t x = 0; x < job->width; x++) {
        float p = mean_d[x] * mean_d[x] / (mean_a[x] * mean_a[x] + mean_b[x] * mean_b[x] + C1);
        float q = var_d[x] / (var_a[x] + var_b[x] + C2);
        float error = 0.5f * (p + q - p * q);
        map[x] = error < 1.0f ? error : 1.0f;
    }
}

static void compare_band(void *user, uint32_t first, uint32_t last, void *memory)
{
    const compare_job *job = user;
    scratch s = divide(memory, job->width);
    difference_band(job, first, last, s.band);
    for (uint32_t y = 0; y < last - first; y++) {
        filter_row(job->state, &s, y, job->width, s.mean, s.variance);
        errors_of_row(job, &s, first + y);
    }
}

static void compare(void *user, const float *features_a, const float *features_b,
                    uint32_t width, uint32_t height, float *map)
{
    const ssim *state = user;
    prom_bands_run(state->bands, height, compare_band,
                   &(compare_job){state, features_a, features_b, width, height, map});
}

const prom_metric_kind prom_metric_ssim = {
    .class = {.name = "ssim", .summary = "structural similarity, as (1 - SSIM) / 2"},
    .planes = FEATURES,
    .create = create,
    .destroy = destroy,
    .radius = radius,
    .features = features,
    .compare = compare,
};
