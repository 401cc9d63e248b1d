#include "builder/measure_private.h"

#include "benefit/accuracy.h"
#include "metaobj/base/math.h"

#include <string.h>

#define SIZES (PROM_SIZES + PROM_SIZES_LARGE)

// What a thread works in.
struct measure_scratch {
    prom_metric *metric;
    float (*patches)[4];       // the truth's, of all sizes
    float (*other_patches)[4]; // a representation's
    float (*between)[4];       // while it is reduced
    prom_rgba *rgba;           // over a background
    float *truth;              // features of the truth, of all sizes and backgrounds,
    float *other;              // and of a representation
    float *map;                // of errors
    prom_patch sizes[SIZES], other_sizes[SIZES]; // in patches
    size_t features[SIZES];                      // in truth, of the first background
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

// Sizes of the memory for a whole view and all that is made of it.
typedef struct room {
    size_t view, patches, truth, other;
} room;

static room room_for(const prom_measure *m, const prom_metric *metric, uint32_t view)
{
    const size_range sizes = sizes_of_view(view);
    room r = {0};
    for (uint32_t size = sizes.first; size < sizes.first + sizes.count; size++) {
        r.view = size_pixels(size);
        r.patches += r.view;
        r.other = window_floats(m, metric, size);
        r.truth += PROM_BACKGROUNDS * r.other;
    }
    return r;
}

// What is not used of it takes no memory: the pages of large blocks come when touched.
measure_scratch *measure_scratch_create(const prom_measure *m)
{
    measure_scratch *s = prom_calloc(1, sizeof *s);
    const uint32_t side = PROM_VIEW_LARGE_PX + 2 * m->pad;
    const size_t window = (size_t)side * side;
    s->metric = prom_metric_create(m->how.metric, m->how.ppd, side, window, 1);
    const room r = room_for(m, s->metric, PROM_DIRS), small = room_for(m, s->metric, 0);
    s->patches = prom_alloc(r.patches, sizeof *s->patches);
    s->other_patches = prom_alloc(r.patches, sizeof *s->other_patches);
    s->between = prom_alloc(r.view, sizeof *s->between);
    s->rgba = prom_alloc(window, sizeof *s->rgba);
    // With a wide metric the windows of many small pictures are larger than those of two.
    s->truth = prom_alloc(r.truth > small.truth ? r.truth : small.truth, sizeof *s->truth);
    s->other = prom_alloc(r.other, sizeof *s->other);
    s->map = prom_alloc(window, sizeof *s->map);
    return s;
}

void measure_scratch_destroy(measure_scratch *s)
{
    prom_metric_destroy(s->metric);
    prom_free(s->patches);
    prom_free(s->other_patches);
    prom_free(s->between);
    prom_free(s->rgba);
    prom_free(s->truth);
    prom_free(s->other);
    prom_free(s->map);
    prom_free(s);
}

// ---- errors

// The features of the patch over a background.
static void take_features(const prom_measure *m, const prom_patch *patch, float background,
                          measure_scratch *s, float *features)
{
    prom_picture picture = {.width = patch->part.width + 2 * m->pad,
                            .height = patch->part.height + 2 * m->pad,
                            .channels = 4,
                            .pixels = s->rgba};
    prom_patch_compose(patch, &m->encoder, background, m->pad, s->rgba);
    prom_metric_features(s->metric, &picture, features);
}

// What a size is reduced from: the one an octave above, where there is one, since halving again
// averages the same pixels; else the largest.
static uint32_t source_of(uint32_t size, uint32_t largest)
{
    const float octave = 2.0f * prom_size_of_bin(size);
    for (uint32_t source = size + 1; source < largest; source++)
        if (fabsf(prom_size_of_bin(source) / octave - 1.0f) < 1e-3f) return source;
    return largest;
}

// A part of a view at all sizes that are made of it.
static void take_sizes(measure_scratch *s, const prom_views *views, uint32_t view,
                       prom_part part, float (*pixels)[4], prom_patch *patches)
{
    const size_range sizes = sizes_of_view(view);
    const uint32_t largest = sizes.first + sizes.count - 1;
    patches[largest].pixels = pixels;
    prom_patch_take(views, view, part, &patches[largest]);
    for (uint32_t size = largest; size-- > sizes.first;) {
        const uint32_t source = source_of(size, largest);
        const float step =
            source == largest ? (float)prom_view_px(view) / prom_size_of_bin(size) : 2.0f;
        pixels += prom_part_pixels(&patches[size + 1].part);
        patches[size].pixels = pixels;
        prom_patch_reduce(&patches[source], step, s->between, &patches[size]);
    }
}

void measure_take_truth(const prom_measure *m, measure_scratch *s, const prom_views *views,
                        uint32_t view, prom_part part)
{
    const size_range sizes = sizes_of_view(view);
    float *features = s->truth;
    take_sizes(s, views, view, part, s->patches, s->sizes);
    for (uint32_t size = sizes.first; size < sizes.first + sizes.count; size++) {
        const prom_patch *patch = &s->sizes[size];
        s->features[size] = (size_t)(features - s->truth);
        for (int b = 0; b < PROM_BACKGROUNDS; b++) {
            take_features(m, patch, m->how.background[b], s, features);
            features += prom_metric_feature_floats(s->metric, patch->part.width + 2 * m->pad,
                                                   patch->part.height + 2 * m->pad);
        }
    }
}

// Accuracy of a patch against the truth's of that size.
static uint8_t compare_size(const prom_measure *m, uint32_t size, const prom_patch *patch,
                            measure_scratch *s)
{
    const uint32_t wide = patch->part.width + 2 * m->pad;
    const uint32_t high = patch->part.height + 2 * m->pad;
    const size_t window = (size_t)wide * high;
    const float *features = s->truth + s->features[size], size_px = prom_size_of_bin(size);
    const double area = prom_patch_area(&s->sizes[size]);
    double error = 0.0;
    for (int b = 0; b < PROM_BACKGROUNDS; b++) {
        take_features(m, patch, m->how.background[b], s, s->other);
        prom_metric_compare(s->metric, features, s->other, wide, high, s->map);
        features += prom_metric_feature_floats(s->metric, wide, high);
        error += prom_window_error(s->map, window, area, m->metric->squares);
        if (prom_window_vetoed(&m->how, size_px, area, s->map, wide, high)) return 0;
    }
    return prom_byte_of_accuracy(1.0 - error / PROM_BACKGROUNDS);
}

void measure_compare(const prom_measure *m, measure_scratch *s, const prom_views *views,
                     uint32_t view, prom_part part, uint8_t *accuracies)
{
    const size_range sizes = sizes_of_view(view);
    take_sizes(s, views, view, part, s->other_patches, s->other_sizes);
    for (uint32_t i = 0; i < sizes.count; i++)
        accuracies[i] = compare_size(m, sizes.first + i, &s->other_sizes[sizes.first + i], s);
}
