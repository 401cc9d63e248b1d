#include "builder/measure.h"

#include "benefit/metric.h"
#include "builder/measure_picture.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/hash.h"
#include "metaobj/base/math.h"
#include "metaobj/base/threads.h"

#include <stdio.h>
#include <string.h>

#define BACKGROUNDS 2
#define GAP_STEP (PROM_VIEW_PX / PROM_GAP_PX)

// More than one in twenty of a footprint's pixels this wrong, and a part of the object is
// missing or of another colour (by taste; seen on the scenes). In smaller pictures there are
// too few pixels to say so.
#define VETO_PERCENTILE 0.95f
#define VETO_ERROR 0.8f
#define VETO_SIZE_PX 32.0f

// What a thread works in.
typedef struct scratch {
    prom_metric *metric;
    float (*patches)[4];          // the truth's, of all sizes
    float (*whole)[4];            // a representation's at full size,
    float (*small)[4];            // and at another
    float (*between)[4];          // while it is reduced
    uint8_t (*rgba)[4];           // over a background
    float *truth;                 // features of the truth, of all sizes and backgrounds,
    float *other;                 // and of a representation
    float *map;                   // of errors
    prom_patch sizes[PROM_SIZES]; // in patches
    size_t features[PROM_SIZES];  // in truth, of the first background
} scratch;

struct prom_measure {
    prom_measured how;
    const prom_metric_class *metric; // NULL: constant
    uint32_t pad;                    // pixels around a picture that the metric looks at
    prom_encoder encoder;
    scratch *scratches;
    unsigned threads;
};

// ---- memory

static size_t size_pixels(uint32_t size)
{
    size_t side = (size_t)ceilf(prom_size_of_bin(size));
    return side * side;
}

static size_t window_floats(const prom_measure *m, const prom_metric *metric, uint32_t size)
{
    uint32_t side = (uint32_t)ceilf(prom_size_of_bin(size)) + 2 * m->pad;
    return prom_metric_feature_floats(metric, side, side);
}

static void init_scratch(const prom_measure *m, scratch *s)
{
    const uint32_t side = PROM_VIEW_PX + 2 * m->pad;
    const size_t window = (size_t)side * side;
    size_t pixels = 0, floats = 0;
    s->metric = prom_metric_create(m->how.metric, m->how.ppd, side, window, 1);
    for (uint32_t size = 0; size < PROM_SIZES; size++) {
        pixels += size_pixels(size);
        floats += BACKGROUNDS * window_floats(m, s->metric, size);
    }
    s->patches = prom_alloc(pixels, sizeof *s->patches);
    s->whole = prom_alloc(PROM_VIEW_PIXELS, sizeof *s->whole);
    s->small = prom_alloc(PROM_VIEW_PIXELS, sizeof *s->small);
    s->between = prom_alloc(PROM_VIEW_PIXELS, sizeof *s->between);
    s->rgba = prom_alloc(window, sizeof *s->rgba);
    s->truth = prom_alloc(floats, sizeof *s->truth);
    s->other = prom_alloc(window_floats(m, s->metric, PROM_SIZES - 1), sizeof *s->other);
    s->map = prom_alloc(window, sizeof *s->map);
}

static void finish_scratch(scratch *s)
{
    prom_metric_destroy(s->metric);
    prom_free(s->patches);
    prom_free(s->whole);
    prom_free(s->small);
    prom_free(s->between);
    prom_free(s->rgba);
    prom_free(s->truth);
    prom_free(s->other);
    prom_free(s->map);
}

static uint32_t radius_of(const char *metric, float ppd)
{
    prom_metric *m = prom_metric_create(metric, ppd, 1, 1, 1);
    uint32_t radius = prom_metric_radius(m);
    prom_metric_destroy(m);
    return radius;
}

prom_measure *prom_measure_create(const prom_measure_options *options, float mean_luminance)
{
    prom_measure *m = prom_calloc(1, sizeof *m);
    const char *name = options->metric ? options->metric : PROM_MEASURE_METRIC;
    m->how = (prom_measured){
        .ppd = options->ppd > 0.0f ? options->ppd : PROM_MEASURE_PPD,
        .background = {mean_luminance,
                       prom_linear_to_srgb(mean_luminance) > 0.5f ? 0.02f : 0.8f},
        .veto_percentile = VETO_PERCENTILE,
        .veto_error = VETO_ERROR};
    snprintf(m->how.metric, sizeof m->how.metric, "%s", name);
    m->metric = prom_metric_named(name);
    if (!m->metric) return m;
    m->pad = radius_of(name, m->how.ppd);
    prom_encoder_init(&m->encoder);
    m->threads = prom_thread_count();
    m->scratches = prom_calloc(m->threads, sizeof *m->scratches);
    for (unsigned t = 0; t < m->threads; t++) init_scratch(m, &m->scratches[t]);
    return m;
}

void prom_measure_destroy(prom_measure *m)
{
    if (!m) return;
    for (unsigned t = 0; t < m->threads; t++) finish_scratch(&m->scratches[t]);
    prom_free(m->scratches);
    prom_free(m);
}

void prom_measure_tell(const prom_measure *m, prom_measured *measured)
{
    *measured = m->how;
}

uint64_t prom_measure_key(const prom_measure *m)
{
    prom_measured how = m->how;
    if (!m->metric || !m->metric->uses_ppd) how.ppd = 0.0f;
    return prom_hash(&how, sizeof how, 0);
}
_Static_assert(sizeof(prom_measured) == PROM_METRIC_NAME_BYTES + 5 * sizeof(float),
               "hashed without padding");

// ---- the part of a view in which something is to be seen: all else is background in every
// picture and cannot err

static prom_part covered_part(const prom_views *views, uint32_t dir)
{
    uint32_t x0 = PROM_VIEW_PX, y0 = PROM_VIEW_PX, x1 = 0, y1 = 0;
    for (uint32_t y = 0; y < PROM_VIEW_PX; y++) {
        const uint8_t(*p)[4] =
            views->rgba + prom_view_start(dir) + (size_t)y * PROM_ATLAS_WIDTH;
        uint32_t first = 0, last = PROM_VIEW_PX;
        while (first < last && p[first][3] < 128) first++;
        if (first == last) continue;
        while (p[last - 1][3] < 128) last--;
        if (first < x0) x0 = first;
        if (last > x1) x1 = last;
        if (y < y0) y0 = y;
        y1 = y + 1;
    }
    return x1 ? (prom_part){x0, y0, x1 - x0, y1 - y0} : (prom_part){0};
}

static prom_part part_of_all(const prom_views *truth, prom_comparison *const *others,
                             size_t count, uint32_t dir)
{
    prom_part part = covered_part(truth, dir);
    for (size_t i = 0; i < count; i++)
        part = prom_part_around(part, covered_part(others[i]->views, dir));
    return part.width ? part : (prom_part){0, 0, 1, 1};
}

static void take_view(const prom_views *views, uint32_t dir, prom_part part, prom_patch *patch)
{
    prom_patch_take((const uint8_t(*)[4])views->rgba + prom_view_start(dir), PROM_ATLAS_WIDTH,
                    part, patch);
}

// ---- coverage

static uint16_t covered_share(const prom_views *views, uint32_t dir)
{
    uint32_t covered = 0;
    for (uint32_t y = 0; y < PROM_VIEW_PX; y++) {
        const uint8_t(*p)[4] =
            views->rgba + prom_view_start(dir) + (size_t)y * PROM_ATLAS_WIDTH;
        for (uint32_t x = 0; x < PROM_VIEW_PX; x++) covered += p[x][3] >= 128;
    }
    double share = covered / (GLM_PI / 4.0 * PROM_VIEW_PIXELS);
    return (uint16_t)(65535.0 * (share > 1 ? 1 : share) + 0.5);
}

// Pixels of a view that are covered, of the GAP_STEP x GAP_STEP at a place.
static uint32_t covered_around(const uint8_t (*rgba)[4])
{
    uint32_t covered = 0;
    for (uint32_t y = 0; y < GAP_STEP; y++)
        for (uint32_t x = 0; x < GAP_STEP; x++)
            covered += rgba[y * PROM_ATLAS_WIDTH + x][3] >= 128;
    return covered;
}

static uint32_t count_gaps(const prom_views *truth, const prom_views *other, uint32_t dir)
{
    uint32_t gaps = 0;
    for (uint32_t y = 0; y < PROM_VIEW_PX; y += GAP_STEP)
        for (uint32_t x = 0; x < PROM_VIEW_PX; x += GAP_STEP) {
            size_t at = prom_view_start(dir) + (size_t)y * PROM_ATLAS_WIDTH + x;
            gaps +=
                !covered_around((const uint8_t(*)[4])other->rgba + at) &&
                covered_around((const uint8_t(*)[4])truth->rgba + at) == GAP_STEP * GAP_STEP;
        }
    return gaps;
}

// ---- errors

// The features of the patch over a background.
static void take_features(const prom_measure *m, const prom_patch *patch, float background,
                          scratch *s, float *features)
{
    prom_picture picture = {.width = patch->part.width + 2 * m->pad,
                            .height = patch->part.height + 2 * m->pad,
                            .channels = 4,
                            .pixels = s->rgba};
    prom_patch_compose(patch, &m->encoder, background, m->pad, s->rgba);
    prom_metric_features(s->metric, &picture, features);
}

// The true object from one direction, at all sizes, into the scratch.
static void take_truth(const prom_measure *m, const prom_views *views, uint32_t dir,
                       prom_part part, scratch *s)
{
    float(*pixels)[4] = s->patches, *features = s->truth;
    for (uint32_t size = PROM_SIZES; size-- > 0;) {
        prom_patch *patch = &s->sizes[size];
        patch->pixels = pixels;
        if (size == PROM_SIZES - 1)
            take_view(views, dir, part, patch);
        else
            prom_patch_reduce(&s->sizes[PROM_SIZES - 1], PROM_VIEW_PX / prom_size_of_bin(size),
                              s->between, patch);
        pixels += prom_part_pixels(&patch->part);
        s->features[size] = (size_t)(features - s->truth);
        for (int b = 0; b < BACKGROUNDS; b++) {
            take_features(m, patch, m->how.background[b], s, features);
            features += prom_metric_feature_floats(s->metric, patch->part.width + 2 * m->pad,
                                                   patch->part.height + 2 * m->pad);
        }
    }
}

static float larger_coverage(const prom_patch *a, const prom_patch *b, size_t i)
{
    return fmaxf(a->pixels[i][3], b->pixels[i][3]);
}

// The sum of the errors over the window, or of their squares.
static double sum_errors(const prom_measure *m, const float *map, size_t count)
{
    double sum = 0.0;
    for (size_t i = 0; i < count; i++) sum += m->metric->squares ? map[i] * map[i] : map[i];
    return sum;
}

// Whether more of the footprint's pixels are too wrong than may be.
static bool is_vetoed(const prom_measure *m, const prom_patch *a, const prom_patch *b,
                      const float *map)
{
    const uint32_t width = a->part.width;
    size_t footprint = 0, wrong = 0;
    for (uint32_t y = 0; y < a->part.height; y++) {
        const float *row = map + (size_t)(y + m->pad) * (width + 2 * m->pad) + m->pad;
        for (uint32_t x = 0; x < width; x++) {
            if (larger_coverage(a, b, (size_t)y * width + x) < 0.5f) continue;
            footprint++;
            wrong += row[x] > m->how.veto_error;
        }
    }
    return (double)wrong > (1.0 - (double)m->how.veto_percentile) * (double)footprint;
}

// Accuracy of a patch against the truth's of that size.
static uint8_t compare_size(const prom_measure *m, uint32_t size, const prom_patch *patch,
                            scratch *s)
{
    const prom_patch *truth = &s->sizes[size];
    const uint32_t wide = patch->part.width + 2 * m->pad;
    const uint32_t high = patch->part.height + 2 * m->pad;
    const float *features = s->truth + s->features[size];
    double area = 0.0, error = 0.0;
    for (size_t i = 0; i < prom_part_pixels(&patch->part); i++)
        area += larger_coverage(truth, patch, i);
    if (area < 1.0) area = 1.0; // less than a pixel is judged as if it were one
    for (int b = 0; b < BACKGROUNDS; b++) {
        take_features(m, patch, m->how.background[b], s, s->other);
        prom_metric_compare(s->metric, features, s->other, wide, high, s->map);
        features += prom_metric_feature_floats(s->metric, wide, high);
        if (prom_size_of_bin(size) >= VETO_SIZE_PX && is_vetoed(m, truth, patch, s->map))
            return 0;
        double mean = sum_errors(m, s->map, (size_t)wide * high) / area;
        error += (m->metric->squares ? sqrt(mean) : mean) / BACKGROUNDS;
    }
    return (uint8_t)(255.0 * (error < 1.0 ? 1.0 - error : 0.0));
}

static void compare(const prom_measure *m, uint32_t dir, prom_part part, prom_comparison *other,
                    scratch *s)
{
    prom_patch whole = {.pixels = s->whole}, small = {.pixels = s->small};
    take_view(other->views, dir, part, &whole);
    for (uint32_t size = 0; size < PROM_SIZES; size++) {
        if (size < PROM_SIZES - 1)
            prom_patch_reduce(&whole, PROM_VIEW_PX / prom_size_of_bin(size), s->between,
                              &small);
        other->accuracy.bins[dir][size] =
            compare_size(m, size, size < PROM_SIZES - 1 ? &small : &whole, s);
    }
}

void prom_measure_direction(prom_measure *m, unsigned thread, uint32_t dir,
                            const prom_views *truth, uint16_t *coverage,
                            prom_comparison *const *others, size_t count)
{
    *coverage = covered_share(truth, dir);
    for (size_t i = 0; i < count; i++) {
        others[i]->gaps[dir] = count_gaps(truth, others[i]->views, dir);
        memset(others[i]->accuracy.bins[dir], 127, PROM_SIZES);
    }
    if (!m->metric || !count) return;
    scratch *s = &m->scratches[thread];
    const prom_part part = part_of_all(truth, others, count, dir);
    take_truth(m, truth, dir, part, s);
    for (size_t i = 0; i < count; i++) compare(m, dir, part, others[i], s);
}

void prom_measure_shares(const prom_views *views, uint32_t dir, uint32_t item_count,
                         uint16_t (*shares)[PROM_DIRS])
{
    uint32_t *counts = prom_calloc(item_count, sizeof *counts);
    uint64_t sum = 0;
    for (uint32_t y = 0; y < PROM_VIEW_PX; y++) {
        const uint32_t *ids = views->ids + prom_view_start(dir) + (size_t)y * PROM_ATLAS_WIDTH;
        for (uint32_t x = 0; x < PROM_VIEW_PX; x++)
            if (ids[x] < item_count) counts[ids[x]]++, sum++;
    }
    for (uint32_t c = 0; c < item_count; c++)
        shares[c][dir] = sum ? (uint16_t)(65535.0 * counts[c] / (double)sum + 0.5) : 0;
    prom_free(counts);
}
