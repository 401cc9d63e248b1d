// Root mean square error between the edges of two pictures: the magnitudes of the Sobel filter
// on luma, on borders that replicate. Scaled as scikit-image does, so that a full step between
// flat areas gives sqrt(1/2), and no picture within [0,1] more than sqrt(5/8).
#include "benefit/grey.h"
#include "benefit/metric_private.h"

#include <math.h>

enum { RADIUS = 1 };

static void *create(double ppd, uint32_t max_side, size_t max_pixels, unsigned threads)
{
    (void)ppd;
    (void)max_pixels;
    return prom_bands_create(threads, prom_grey_band_floats(max_side, RADIUS) * sizeof(float));
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

typedef struct job {
    const prom_picture *picture;
    float *edges;
} job;

static void edges_of_band(void *user, uint32_t first, uint32_t last, void *scratch)
{
    const job *j = user;
    const uint32_t width = j->picture->width;
    const size_t stride = width + 2 * RADIUS;
    const float *above = (float *)scratch + RADIUS;
    prom_grey_band(j->picture, first, last, RADIUS, PROM_BORDER_REPLICATE, scratch);
    for (uint32_t y = first; y < last; y++, above += stride)
        prom_grey_edges(above, stride, width, 0.25f * (float)M_SQRT1_2,
                        j->edges + (size_t)y * width);
}

static void features(void *bands, const prom_picture *picture, float *plane)
{
    prom_bands_run(bands, picture->height, edges_of_band, &(job){picture, plane});
}

static void compare(void *bands, const float *features_a, const float *features_b,
                    uint32_t width, uint32_t height, float *map)
{
    prom_grey_difference(bands, features_a, features_b, width, height, map);
}

const prom_metric_kind prom_metric_sobel = {
    .class = {.name = "sobel",
              .summary = "root mean square error of edges in luma",
              .squares = true},
    .planes = 1,
    .create = create,
    .destroy = destroy,
    .radius = radius,
    .features = features,
    .compare = compare,
};
