#include "benefit/metric.h"

#include "benefit/metric_private.h"
#include "metaobj/base/alloc.h"
#include "metaobj/model.h"

#include <assert.h>
#include <string.h>

struct prom_metric {
    const prom_metric_kind *kind;
    void *state;
    uint32_t max_side;
    size_t max_pixels;
};

// In the order of the help text.
static const prom_metric_kind *const kinds[] = {&prom_metric_flip, &prom_metric_ssim,
                                                &prom_metric_rmse, &prom_metric_sobel,
                                                &prom_metric_edge_blur};

size_t prom_metric_count(void)
{
    return sizeof kinds / sizeof *kinds;
}

const prom_metric_class *prom_metric_at(size_t i)
{
    assert(i < prom_metric_count());
    return &kinds[i]->class;
}

static const prom_metric_kind *kind_named(const char *name)
{
    for (size_t i = 0; i < prom_metric_count(); i++)
        if (!strcmp(kinds[i]->class.name, name)) return kinds[i];
    return NULL;
}

const prom_metric_class *prom_metric_named(const char *name)
{
    const prom_metric_kind *kind = kind_named(name);
    return kind ? &kind->class : NULL;
}

prom_metric *prom_metric_create(const char *name, double ppd, uint32_t max_side,
                                size_t max_pixels, unsigned threads)
{
    const prom_metric_kind *kind = kind_named(name);
    assert(kind && max_side && max_pixels);
    assert(ppd >= PROM_PPD_MIN && ppd <= PROM_PPD_MAX);
    prom_metric *metric = prom_alloc(1, sizeof *metric);
    void *state = kind->create(ppd, max_side, max_pixels, threads);
    *metric = (prom_metric){kind, state, max_side, max_pixels};
    return metric;
}

void prom_metric_destroy(prom_metric *metric)
{
    if (!metric) return;
    metric->kind->destroy(metric->state);
    prom_free(metric);
}

const prom_metric_class *prom_metric_class_of(const prom_metric *metric)
{
    return &metric->kind->class;
}

uint32_t prom_metric_radius(const prom_metric *metric)
{
    return metric->kind->radius(metric->state);
}

uint32_t prom_metric_radius_of(const char *name, double ppd)
{
    prom_metric *metric = prom_metric_create(name, ppd, 1, 1, 1);
    uint32_t radius = prom_metric_radius(metric);
    prom_metric_destroy(metric);
    return radius;
}

size_t prom_metric_feature_floats(const prom_metric *metric, uint32_t width, uint32_t height)
{
    return (size_t)metric->kind->planes * width * height;
}

static void check_size(const prom_metric *metric, uint32_t width, uint32_t height)
{
    assert(width && height && width <= metric->max_side && height <= metric->max_side);
    assert((size_t)width * height <= metric->max_pixels);
    (void)metric, (void)width, (void)height;
}

void prom_metric_features(prom_metric *metric, const prom_picture *picture, float *features)
{
    check_size(metric, picture->width, picture->height);
    assert(picture->channels == 1 || picture->channels == 3 || picture->channels == 4);
    metric->kind->features(metric->state, picture, features);
}

void prom_metric_compare(prom_metric *metric, const float *features_a, const float *features_b,
                         uint32_t width, uint32_t height, float *map)
{
    check_size(metric, width, height);
    metric->kind->compare(metric->state, features_a, features_b, width, height, map);
}

const void *prom_picture_row(const prom_picture *picture, uint32_t y)
{
    const size_t value_bytes = picture->floats ? sizeof(float) : 1;
    const size_t close = (size_t)picture->width * picture->channels * value_bytes;
    return (const uint8_t *)picture->pixels +
           y * (picture->row_bytes ? picture->row_bytes : close);
}
