// Pictures of random colours, and their comparison with a metric of the registry.
#ifndef PROM_TESTS_METRIC_FIXTURE_H
#define PROM_TESTS_METRIC_FIXTURE_H

#include "benefit/metric.h"
#include "benefit/pool.h"
#include "random_model.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { W = 61, H = 37, TALL = 150, PIXELS = 9216 }; // PIXELS: room for W x TALL

#define PPD 22.34

typedef struct pictures {
    uint8_t bytes[2][PIXELS * 4];
    float floats[2][PIXELS * 4];
} pictures;

static pictures memory;

static inline prom_picture byte_picture(const uint8_t *pixels, uint32_t w, uint32_t h,
                                        uint32_t n)
{
    return (prom_picture){.width = w, .height = h, .channels = n, .pixels = pixels};
}

static inline prom_picture float_picture(const float *pixels, uint32_t w, uint32_t h,
                                         uint32_t n)
{
    return (prom_picture){
        .width = w, .height = h, .channels = n, .floats = true, .pixels = pixels};
}

// Blocks of two greys under coloured noise.
static inline void random_picture(uint64_t *seed, uint8_t *rgba, uint32_t w, uint32_t h)
{
    for (uint32_t i = 0; i < w * h * 4; i++)
        rgba[i] = (uint8_t)(random_below(seed, 128) + (i / 28 + i / (20 * w)) % 2 * 128);
}

static inline void run(prom_metric *metric, const prom_picture *a, const prom_picture *b,
                       float *map)
{
    const uint32_t w = a->width, h = a->height;
    const size_t floats = prom_metric_feature_floats(metric, w, h);
    float *features = prom_alloc(2 * floats, sizeof *features);
    prom_metric_features(metric, a, features);
    prom_metric_features(metric, b, features + floats);
    prom_metric_compare(metric, features, features + floats, w, h, map);
    prom_free(features);
}

// The pooled error; the map, if wanted.
static inline double compare_on(unsigned threads, const char *name, prom_picture a,
                                prom_picture b, float *map)
{
    static float own[PIXELS];
    map = map ? map : own;
    const uint32_t side = a.width > a.height ? a.width : a.height;
    const size_t pixels = (size_t)a.width * a.height;
    prom_metric *metric = prom_metric_create(name, PPD, side, pixels, threads);
    run(metric, &a, &b, map);
    prom_pooled pooled;
    prom_errors_pool(prom_metric_class_of(metric), map, pixels, NULL, NULL, &pooled);
    prom_metric_destroy(metric);
    for (size_t i = 0; i < pixels; i++) assert_true(map[i] >= 0.0f && map[i] <= 1.0f);
    return pooled.mean;
}

static inline double compare(const char *name, prom_picture a, prom_picture b, float *map)
{
    return compare_on(1, name, a, b, map);
}

#define FOR_EACH_METRIC(name)                                                                  \
    for (size_t metric_i = 0; metric_i < prom_metric_count(); metric_i++)                      \
        for (const char *name = prom_metric_at(metric_i)->name; name; name = NULL)

static const uint32_t odd_sizes[][2] = {{W, H}, {1, 1}, {1, 9},  {9, 1},
                                        {2, 2}, {3, 5}, {17, 4}, {W, TALL}};

#endif
