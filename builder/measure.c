#include "builder/measure.h"

#include "benefit/metric.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"
#include "metaobj/base/threads.h"

#define PAD PROM_EDGE_BLUR_RADIUS
#define BACKGROUNDS 2
#define WINDOW_MAX (PROM_VIEW_PX + 2 * PAD)
#define ENCODE_STEPS 4096
#define GAP_SIZE 3
_Static_assert(PROM_VIEW_PX >> (PROM_SIZES - 1 - GAP_SIZE) == PROM_GAP_PX,
               "gaps have a size bin");

// One picture at one size.
typedef struct level {
    float luminance[PROM_VIEW_PIXELS], coverage[PROM_VIEW_PIXELS];
} level;

// What a thread works in.
typedef struct scratch {
    level levels[2];
    float grey[WINDOW_MAX * WINDOW_MAX], error[WINDOW_MAX * WINDOW_MAX];
    float features[2 * WINDOW_MAX * WINDOW_MAX];
    float *metric;
} scratch;

struct prom_measure {
    float background[BACKGROUNDS]; // linear luminance
    float encode[ENCODE_STEPS + 1];
    size_t features_of_size[PROM_SIZES + 1]; // offsets of a size's features in a direction's
    size_t coverage_of_size[PROM_SIZES + 1];
    float *features; // of the truth: direction, size, background
    float *coverage; // of the truth: direction, size
    scratch *scratches;
    unsigned threads;
    uint32_t gaps[PROM_DIRS]; // pixels at PROM_GAP_PX
    const prom_views *views;  // of the running call
    uint16_t *coverage_out;
    uint8_t (*accuracy_out)[PROM_SIZES];
};

static uint32_t size_px(uint32_t s)
{
    return PROM_VIEW_PX >> (PROM_SIZES - 1 - s);
}

static size_t window_pixels(uint32_t s)
{
    size_t side = size_px(s) + 2 * PAD;
    return side * side;
}

prom_measure *prom_measure_create(float mean_luminance)
{
    prom_measure *m = prom_calloc(1, sizeof *m);
    m->background[0] = mean_luminance;
    m->background[1] = prom_linear_to_srgb(mean_luminance) > 0.5f ? 0.02f : 0.8f;
    for (int i = 0; i <= ENCODE_STEPS; i++)
        m->encode[i] = prom_linear_to_srgb((float)i / ENCODE_STEPS);
    for (uint32_t s = 0; s < PROM_SIZES; s++) {
        m->features_of_size[s + 1] =
            m->features_of_size[s] + BACKGROUNDS * 2 * window_pixels(s);
        m->coverage_of_size[s + 1] = m->coverage_of_size[s] + (size_t)size_px(s) * size_px(s);
    }
    m->features = prom_alloc(PROM_DIRS * m->features_of_size[PROM_SIZES], sizeof(float));
    m->coverage = prom_alloc(PROM_DIRS * m->coverage_of_size[PROM_SIZES], sizeof(float));
    m->threads = prom_thread_count();
    m->scratches = prom_alloc(m->threads, sizeof *m->scratches);
    for (unsigned t = 0; t < m->threads; t++)
        m->scratches[t].metric =
            prom_alloc(prom_edge_blur_scratch(WINDOW_MAX, WINDOW_MAX), sizeof(float));
    return m;
}

void prom_measure_destroy(prom_measure *m)
{
    if (!m) return;
    for (unsigned t = 0; t < m->threads; t++) prom_free(m->scratches[t].metric);
    prom_free(m->scratches);
    prom_free(m->features);
    prom_free(m->coverage);
    prom_free(m);
}

static void halve(const float *in, uint32_t side, float *out)
{
    uint32_t half = side / 2;
    for (uint32_t y = 0; y < half; y++) {
        const float *a = in + (size_t)2 * y * side, *b = a + side;
        for (uint32_t x = 0; x < half; x++)
            out[y * half + x] = 0.25f * (a[2 * x] + a[2 * x + 1] + b[2 * x] + b[2 * x + 1]);
    }
}

// The picture over a background, encoded, in a window padded with the background.
static void composite(const prom_measure *m, const level *in, uint32_t side, float background,
                      float *grey)
{
    uint32_t wide = side + 2 * PAD;
    float empty = m->encode[(int)(background * ENCODE_STEPS + 0.5f)];
    for (size_t i = 0; i < (size_t)wide * wide; i++) grey[i] = empty;
    for (uint32_t y = 0; y < side; y++) {
        const float *l = in->luminance + (size_t)y * side, *c = in->coverage + (size_t)y * side;
        float *g = grey + (size_t)(y + PAD) * wide + PAD;
        for (uint32_t x = 0; x < side; x++) {
            float v = l[x] + (1.0f - c[x]) * background;
            v = v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v;
            g[x] = m->encode[(int)(v * ENCODE_STEPS + 0.5f)];
        }
    }
}

// Walks the sizes of one direction from the largest down, halving as it goes.
static void each_size(prom_measure *m, size_t dir, scratch *s,
                      void (*visit)(prom_measure *, size_t, uint32_t, const level *, scratch *))
{
    memcpy(s->levels[0].luminance, m->views->luminance[dir], sizeof s->levels[0].luminance);
    memcpy(s->levels[0].coverage, m->views->coverage[dir], sizeof s->levels[0].coverage);
    int now = 0;
    for (uint32_t size = PROM_SIZES; size-- > 0;) {
        visit(m, dir, size, &s->levels[now], s);
        halve(s->levels[now].luminance, size_px(size), s->levels[!now].luminance);
        halve(s->levels[now].coverage, size_px(size), s->levels[!now].coverage);
        now = !now;
    }
}

static void keep_truth(prom_measure *m, size_t dir, uint32_t size, const level *in, scratch *s)
{
    uint32_t side = size_px(size), wide = side + 2 * PAD;
    float *features =
        m->features + dir * m->features_of_size[PROM_SIZES] + m->features_of_size[size];
    for (int b = 0; b < BACKGROUNDS; b++, features += 2 * window_pixels(size)) {
        composite(m, in, side, m->background[b], s->grey);
        prom_edge_blur_features(s->grey, wide, wide, features, s->metric);
    }
    memcpy(m->coverage + dir * m->coverage_of_size[PROM_SIZES] + m->coverage_of_size[size],
           in->coverage, (size_t)side * side * sizeof(float));
}

static void truth_of_direction(void *user, size_t dir, unsigned thread)
{
    prom_measure *m = user;
    each_size(m, dir, &m->scratches[thread], keep_truth);
    double covered = 0;
    for (size_t i = 0; i < PROM_VIEW_PIXELS; i++) covered += m->views->coverage[dir][i];
    double share = covered / (GLM_PI / 4.0 * PROM_VIEW_PIXELS);
    m->coverage_out[dir] = (uint16_t)(65535.0 * (share > 1 ? 1 : share) + 0.5);
}

void prom_measure_set_truth(prom_measure *m, const prom_views *truth,
                            uint16_t coverage[PROM_DIRS])
{
    m->views = truth;
    m->coverage_out = coverage;
    prom_parallel_for(PROM_DIRS, truth_of_direction, m);
}

static uint32_t count_gaps(const float *truth, const float *other, size_t count)
{
    uint32_t gaps = 0;
    for (size_t i = 0; i < count; i++) gaps += truth[i] >= 0.9f && other[i] <= 0.1f;
    return gaps;
}

static void compare_size(prom_measure *m, size_t dir, uint32_t size, const level *in,
                         scratch *s)
{
    uint32_t side = size_px(size), wide = side + 2 * PAD;
    const float *truth =
        m->features + dir * m->features_of_size[PROM_SIZES] + m->features_of_size[size];
    const float *covered =
        m->coverage + dir * m->coverage_of_size[PROM_SIZES] + m->coverage_of_size[size];
    const size_t window = window_pixels(size);
    double area = 0, error = 0;
    for (size_t i = 0; i < (size_t)side * side; i++) area += fmaxf(covered[i], in->coverage[i]);
    for (int b = 0; b < BACKGROUNDS; b++, truth += 2 * window) {
        composite(m, in, side, m->background[b], s->grey);
        prom_edge_blur_features(s->grey, wide, wide, s->features, s->metric);
        prom_edge_blur_error(truth, s->features, wide, wide, s->error);
        float sum = 0; // of one window: small enough for a float
        for (size_t i = 0; i < window; i++) sum += s->error[i];
        error += sum;
    }
    if (size == GAP_SIZE) m->gaps[dir] = count_gaps(covered, in->coverage, (size_t)side * side);
    // Less than a pixel covered: its error is judged as if it were one.
    double accuracy = 1.0 - error / BACKGROUNDS / (area > 1.0 ? area : 1.0);
    m->accuracy_out[dir][size] = (uint8_t)(255.0 * (accuracy > 0 ? accuracy : 0) + 0.5);
}

static void compare_direction(void *user, size_t dir, unsigned thread)
{
    prom_measure *m = user;
    each_size(m, dir, &m->scratches[thread], compare_size);
}

float prom_measure_compare(prom_measure *m, const prom_views *views,
                           uint8_t accuracy[PROM_DIRS][PROM_SIZES])
{
    m->views = views;
    m->accuracy_out = accuracy;
    prom_parallel_for(PROM_DIRS, compare_direction, m);
    uint32_t most = 0;
    for (uint32_t d = 0; d < PROM_DIRS; d++)
        if (m->gaps[d] > most) most = m->gaps[d];
    return (float)most;
}

void prom_measure_shares(const prom_views *views, uint32_t item_count,
                         uint16_t (*shares)[PROM_DIRS])
{
    uint32_t *counts = prom_alloc(item_count, sizeof *counts);
    for (uint32_t dir = 0; dir < PROM_DIRS; dir++) {
        memset(counts, 0, item_count * sizeof *counts);
        uint64_t sum = 0;
        for (size_t i = 0; i < PROM_VIEW_PIXELS; i++) {
            uint32_t id = views->ids[dir][i];
            if (id < item_count) counts[id]++, sum++;
        }
        for (uint32_t c = 0; c < item_count; c++)
            shares[c][dir] = sum ? (uint16_t)(65535.0 * counts[c] / (double)sum + 0.5) : 0;
    }
    prom_free(counts);
}
