// Root mean square error of luma. A map holds |a - b|; its mean is taken over the squares.
#include "benefit/grey.h"
#include "benefit/metric_private.h"

static void *create(double ppd, uint32_t max_side, size_t max_pixels, unsigned threads)
{
    (void)ppd;
    (void)max_side;
    (void)max_pixels;
    return prom_bands_create(threads, 0);
}

static void destroy(void *bands)
{
    prom_bands_destroy(bands);
}

static uint32_t radius(const void *bands)
{
    (void)bands;
    return 0;
}

static void features(void *bands, const prom_picture *picture, float *plane)
{
    prom_grey_plane(bands, picture, plane);
}

static void compare(void *bands, const float *features_a, const float *features_b,
                    uint32_t width, uint32_t height, float *map)
{
    prom_grey_difference(bands, features_a, features_b, width, height, map);
}

const prom_metric_kind prom_metric_rmse = {
    .class = {.name = "rmse", .summary = "root mean square error of luma", .squares = true},
    .planes = 1,
    .create = create,
    .destroy = destroy,
    .radius = radius,
    .features = features,
    .compare = compare,
};
