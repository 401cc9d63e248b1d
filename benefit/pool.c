#include "benefit/pool.h"

#include "benefit/metric_private.h"
#include "metaobj/base/alloc.h"

#include <assert.h>
#include <math.h>

// ---- order

enum { DIGIT_BITS = 11, DIGITS = 3, DIGIT_VALUES = 1 << DIGIT_BITS };

static uint32_t digit_of(float value, int digit)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits >> (digit * DIGIT_BITS) & (DIGIT_VALUES - 1);
}

static void sort_by_digit(const float *in, size_t count, int digit, float *out)
{
    size_t starts[DIGIT_VALUES + 1] = {0};
    for (size_t i = 0; i < count; i++) starts[digit_of(in[i], digit) + 1]++;
    for (size_t d = 1; d < DIGIT_VALUES; d++) starts[d] += starts[d - 1];
    for (size_t i = 0; i < count; i++) out[starts[digit_of(in[i], digit)]++] = in[i];
}

// Radix sort: floats of one sign are ordered as their bits are. The result stands in `between`
// since the digits are odd in number.
static const float *sorted(float *values, size_t count, float *between)
{
    sort_by_digit(values, count, 0, between);
    sort_by_digit(between, count, 1, values);
    sort_by_digit(values, count, 2, between);
    return between;
}

// Linear between the values at both sides.
static double percentile(const float *sorted_values, size_t count, double share)
{
    double place = share * (double)(count - 1);
    size_t i = (size_t)place, next = i + 1 < count ? i + 1 : i;
    double low = sorted_values[i], high = sorted_values[next];
    return low + (place - (double)i) * (high - low);
}

static double weighted_median(const float *sorted_values, size_t count)
{
    double sum = 0, below = 0;
    for (size_t i = 0; i < count; i++) sum += sorted_values[i];
    for (size_t i = 0; i < count; i++)
        if ((below += sorted_values[i]) >= sum / 2) return sorted_values[i];
    return 0;
}

// ---- pooling

typedef struct sums {
    double all, differing;
    size_t pixels, different;
} sums;

static double mean_of(const prom_metric_class *metric, double sum, size_t count)
{
    double mean = count ? sum / (double)count : 0;
    return metric->squares ? sqrt(mean) : mean;
}

void prom_errors_pool(const prom_metric_class *metric, const float *map, size_t count,
                      const uint8_t *footprint, const uint8_t *differs, prom_pooled *pooled)
{
    sums s = {0};
    float *memory = prom_alloc(2 * count, sizeof *memory);
    for (size_t i = 0; i < count; i++) {
        if (footprint && !footprint[i]) continue;
        double error = metric->squares ? (double)map[i] * map[i] : (double)map[i];
        bool different = differs ? differs[i] : map[i] > 0;
        s.all += error;
        s.differing += different ? error : 0;
        s.different += different;
        memory[s.pixels++] = map[i];
    }
    *pooled = (prom_pooled){.mean = mean_of(metric, s.all, s.pixels), .pixels = s.pixels};
    pooled->differing_mean = mean_of(metric, s.differing, s.different);
    if (s.pixels) {
        const float *values = sorted(memory, s.pixels, memory + count);
        pooled->differing = (double)s.different / (double)s.pixels;
        pooled->weighted_median = weighted_median(values, s.pixels);
        pooled->median = percentile(values, s.pixels, 0.5);
        pooled->p75 = percentile(values, s.pixels, 0.75);
        pooled->p95 = percentile(values, s.pixels, 0.95);
        pooled->p99 = percentile(values, s.pixels, 0.99);
        pooled->max = values[s.pixels - 1];
    }
    prom_free(memory);
}

// ---- what differs

// In values, not in bits: the two zeros are equal.
static bool float_pixel_differs(const float *a, const float *b, uint32_t colours)
{
    bool differs = false;
    for (uint32_t i = 0; i < colours; i++) differs |= a[i] != b[i];
    return differs;
}

void prom_picture_differs(const prom_picture *a, const prom_picture *b, uint8_t *differs)
{
    assert(a->width == b->width && a->height == b->height);
    assert(a->channels == b->channels && a->floats == b->floats);
    const uint32_t channels = a->channels, colours = channels < 3 ? 1 : 3;
    for (uint32_t y = 0; y < a->height; y++) {
        const void *row_a = prom_picture_row(a, y), *row_b = prom_picture_row(b, y);
        for (size_t i = 0; i < (size_t)a->width * channels; i += channels)
            *differs++ = a->floats ? float_pixel_differs((const float *)row_a + i,
                                                         (const float *)row_b + i, colours)
                                   : memcmp((const uint8_t *)row_a + i,
                                            (const uint8_t *)row_b + i, colours) != 0;
    }
}
