// LINK: prom_benefit prom_metaobj
// Megapixels a second of each metric, on one thread and on all: of a pair (features of both and
// their comparison), and with a reference that was looked at before (features of one, and the
// comparison). One thread is measured in time of the processor, all of them by the
// clock.
//
// Usage: bench_metrics [METRIC [PPD]]
#include "benefit/metric.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/threads.h"

#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { WIDTH_MAX = 1280, HEIGHT_MAX = 720, ROUNDS = 60 };
#define ROUND_MS 4.0

static const uint32_t sizes[][2] = {{64, 64}, {512, 512}, {WIDTH_MAX, HEIGHT_MAX}};

typedef struct bench {
    prom_metric *metric;
    prom_picture a, b;
    float *features_a, *features_b, *map;
} bench;

static void fill(uint8_t *rgba, size_t pixels, uint32_t salt)
{
    for (size_t i = 0; i < 4 * pixels; i++)
        rgba[i] = (uint8_t)(i / 97 * 31 + (i * 2654435761u >> 27) * salt);
}

static void compare(bench *b, bool cached)
{
    if (!cached) prom_metric_features(b->metric, &b->a, b->features_a);
    prom_metric_features(b->metric, &b->b, b->features_b);
    prom_metric_compare(b->metric, b->features_a, b->features_b, b->a.width, b->a.height,
                        b->map);
}

// One thread's time is not that of others who use the machine.
static double now_ms(bool alone)
{
    return alone ? (double)clock() * 1e3 / CLOCKS_PER_SEC : prom_clock_ms();
}

// The best of many short rounds.
static double megapixels_a_second(bench *b, unsigned threads, bool cached)
{
    const double megapixels = (double)b->a.width * b->a.height * 1e-6;
    double best = 0;
    compare(b, false);
    for (int round = 0; round < ROUNDS; round++) {
        double start = now_ms(threads == 1), spent = 0;
        int runs = 0;
        for (; spent < ROUND_MS; runs++, spent = now_ms(threads == 1) - start)
            compare(b, cached);
        double speed = megapixels * runs / spent * 1e3;
        if (speed > best) best = speed;
    }
    return best;
}

static void measure(const char *name, double ppd, const uint8_t *a, const uint8_t *b)
{
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        const uint32_t w = sizes[i][0], h = sizes[i][1];
        const size_t pixels = (size_t)w * h;
        printf("| %-9s | %4u x %-4u |", name, w, h);
        for (unsigned threads = 2; threads-- > 0;) {
            prom_metric *metric = prom_metric_create(name, ppd, w > h ? w : h, pixels, threads);
            const size_t floats = prom_metric_feature_floats(metric, w, h);
            bench run = {.metric = metric,
                         .a = {.width = w, .height = h, .channels = 4, .pixels = a},
                         .b = {.width = w, .height = h, .channels = 4, .pixels = b},
                         .features_a = prom_alloc(floats, sizeof(float)),
                         .features_b = prom_alloc(floats, sizeof(float)),
                         .map = prom_alloc(pixels, sizeof(float))};
            printf(" %7.1f | %7.1f |", megapixels_a_second(&run, threads, false),
                   megapixels_a_second(&run, threads, true));
            prom_free(run.features_a);
            prom_free(run.features_b);
            prom_free(run.map);
            prom_metric_destroy(metric);
        }
        printf("\n");
    }
}

int main(int argc, char **argv)
{
    const char *only = argc > 1 ? argv[1] : NULL;
    const double ppd = argc > 2 ? atof(argv[2]) : 22.34;
    const size_t pixels = (size_t)WIDTH_MAX * HEIGHT_MAX;
    uint8_t *a = prom_alloc(pixels, 4), *b = prom_alloc(pixels, 4);
    fill(a, pixels, 3);
    fill(b, pixels, 5);
    printf("Megapixels a second at %g pixels per degree; 1 thread, and %u\n\n", ppd,
           prom_thread_count());
    printf("| metric    | pixels      |  pair 1 | cached 1| pair all| cached  |\n"
           "|-----------|-------------|---------|---------|---------|---------|\n");
    for (size_t i = 0; i < prom_metric_count(); i++) {
        const char *name = prom_metric_at(i)->name;
        if (!only || !strcmp(name, only)) measure(name, ppd, a, b);
    }
    prom_free(a);
    prom_free(b);
    return 0;
}
