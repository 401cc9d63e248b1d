#include "builder/measure.h"

#include "benefit/edge_blur.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"
#include "metaobj/base/threads.h"

#define PAD PROM_EDGE_BLUR_RADIUS
#define BACKGROUNDS 2
#define WINDOW_MAX (PROM_VIEW_PX + 2 * PAD)
#define ENCODE_STEPS 4096
#define GAP_SIZE 6 // prom_size_of_bin: PROM_GAP_PX

// The part of a view in which something is to be seen: all else is background in every picture
// and cannot err. In whole pixels of the smallest size, so that halving stays within it.
typedef struct frame {
    uint32_t x, y, width, height; // at the largest size
} frame;

// One picture at one size, of the frame's part alone.
typedef struct level {
    float luminance[PROM_VIEW_PIXELS], coverage[PROM_VIEW_PIXELS];
} level;

// What a thread works in.
typedef struct scratch {
    frame frame;     // of the present direction
    level levels[2]; // the largest, and a smaller one
    float between[PROM_VIEW_PIXELS];
    float grey[WINDOW_MAX * WINDOW_MAX], error[WINDOW_MAX * WINDOW_MAX];
    float features[2 * WINDOW_MAX * WINDOW_MAX];
    float *metric;
    float *truth;              // features of the true object in one direction: size, background
    level covered[PROM_SIZES]; // and its pictures
} scratch;

struct prom_measure {
    float background[BACKGROUNDS]; // linear luminance
    float encode[ENCODE_STEPS + 1];
    size_t features_of_size[PROM_SIZES + 1]; // offsets into scratch.truth
    scratch *scratches;
    unsigned threads;
};

// Pixels along what is `extent` at the largest size.
static uint32_t at_size(uint32_t extent, uint32_t size)
{
    return (uint32_t)ceilf((float)extent * prom_size_of_bin(size) / PROM_VIEW_PX);
}

static size_t window_pixels(uint32_t s)
{
    size_t side = at_size(PROM_VIEW_PX, s) + 2 * PAD;
    return side * side;
}

prom_measure *prom_measure_create(float mean_luminance)
{
    prom_measure *m = prom_calloc(1, sizeof *m);
    m->background[0] = mean_luminance;
    m->background[1] = prom_linear_to_srgb(mean_luminance) > 0.5f ? 0.02f : 0.8f;
    for (int i = 0; i <= ENCODE_STEPS; i++)
        m->encode[i] = prom_linear_to_srgb((float)i / ENCODE_STEPS);
    for (uint32_t s = 0; s < PROM_SIZES; s++)
        m->features_of_size[s + 1] =
            m->features_of_size[s] + BACKGROUNDS * 2 * window_pixels(s);
    m->threads = prom_thread_count();
    m->scratches = prom_alloc(m->threads, sizeof *m->scratches);
    for (unsigned t = 0; t < m->threads; t++) {
        scratch *s = &m->scratches[t];
        s->metric = prom_alloc(prom_edge_blur_scratch(WINDOW_MAX, WINDOW_MAX), sizeof(float));
        s->truth = prom_alloc(m->features_of_size[PROM_SIZES], sizeof(float));
    }
    return m;
}

void prom_measure_destroy(prom_measure *m)
{
    if (!m) return;
    for (unsigned t = 0; t < m->threads; t++) {
        prom_free(m->scratches[t].metric);
        prom_free(m->scratches[t].truth);
    }
    prom_free(m->scratches);
    prom_free(m);
}

void prom_measure_tell(const prom_measure *m, prom_measured *measured)
{
    *measured = (prom_measured){.metric = "edge-blur",
                                .ppd = 22.34f,
                                .background = {m->background[0], m->background[1]},
                                .veto_percentile = 1.0f,
                                .veto_error = 1.0f};
}

// ---- the frame

// Grows box (x0, y0, x1, y1) by what a view covers.
static void add_covered(const prom_views *views, uint32_t dir, uint32_t box[4])
{
    for (uint32_t y = 0; y < PROM_VIEW_PX; y++) {
        const uint8_t(*p)[4] =
            views->rgba + prom_view_start(dir) + (size_t)y * PROM_ATLAS_WIDTH;
        uint32_t first = 0, last = PROM_VIEW_PX;
        while (first < last && p[first][3] < 128) first++;
        if (first == last) continue;
        while (p[last - 1][3] < 128) last--;
        if (first < box[0]) box[0] = first;
        if (last > box[2]) box[2] = last;
        if (y < box[1]) box[1] = y;
        box[3] = y + 1;
    }
}

static frame frame_of(const prom_views *truth, prom_comparison *const *others, size_t count,
                      uint32_t dir)
{
    uint32_t low[2] = {PROM_VIEW_PX, PROM_VIEW_PX}, high[2] = {0, 0};
    for (size_t i = 0; i <= count; i++) {
        uint32_t box[4] = {PROM_VIEW_PX, PROM_VIEW_PX, 0, 0};
        add_covered(i < count ? others[i]->views : truth, dir, box);
        for (int k = 0; k < 2; k++) {
            if (box[k] < low[k]) low[k] = box[k];
            if (box[k + 2] > high[k]) high[k] = box[k + 2];
        }
    }
    for (int k = 0; k < 2; k++) {
        if (low[k] >= high[k]) low[k] = 0; // nothing at all
        if (high[k] <= low[k]) high[k] = low[k] + 1;
    }
    return (frame){low[0], low[1], high[0] - low[0], high[1] - low[1]};
}

static size_t pixels_of(const frame *f, uint32_t size)
{
    return (size_t)at_size(f->width, size) * at_size(f->height, size);
}

// ---- pictures

// The frame's part of a view as linear luminance times coverage, and coverage.
static void unpack_view(const prom_views *views, uint32_t dir, const frame *f, level *out)
{
    for (uint32_t y = 0; y < f->height; y++) {
        const uint8_t(*p)[4] =
            views->rgba + prom_view_start(dir) + (size_t)(y + f->y) * PROM_ATLAS_WIDTH + f->x;
        float *luminance = out->luminance + (size_t)y * f->width;
        float *coverage = out->coverage + (size_t)y * f->width;
        for (uint32_t x = 0; x < f->width; x++) {
            bool covered = p[x][3] >= 128;
            coverage[x] = covered ? 1.0f : 0.0f;
            luminance[x] = covered ? 0.2126f * prom_srgb8_to_linear(p[x][0]) +
                                         0.7152f * prom_srgb8_to_linear(p[x][1]) +
                                         0.0722f * prom_srgb8_to_linear(p[x][2])
                                   : 0.0f;
        }
    }
}

// Area averages: pixel i of the output covers [i, i + 1) * step of the input, which is 0
// outside.
static void average_rows(const float *in, uint32_t width, uint32_t height, float step,
                         uint32_t out_width, float *out)
{
    for (uint32_t y = 0; y < height; y++, in += width, out += out_width) {
        for (uint32_t i = 0; i < out_width; i++) {
            float from = (float)i * step, to = fminf(from + step, (float)width), sum = 0.0f;
            for (uint32_t x = (uint32_t)from; (float)x < to; x++)
                sum += in[x] * (fminf((float)x + 1.0f, to) - fmaxf((float)x, from));
            out[i] = sum / step;
        }
    }
}

static void average_columns(const float *in, uint32_t width, uint32_t height, float step,
                            uint32_t out_height, float *out)
{
    for (uint32_t i = 0; i < out_height; i++, out += width) {
        float from = (float)i * step, to = fminf(from + step, (float)height);
        for (uint32_t x = 0; x < width; x++) out[x] = 0.0f;
        for (uint32_t y = (uint32_t)from; (float)y < to; y++) {
            float part = (fminf((float)y + 1.0f, to) - fmaxf((float)y, from)) / step;
            const float *row = in + (size_t)y * width;
            for (uint32_t x = 0; x < width; x++) out[x] += part * row[x];
        }
    }
}

static void average_plane(const float *in, const frame *f, uint32_t size, float *between,
                          float *out)
{
    float step = PROM_VIEW_PX / prom_size_of_bin(size);
    uint32_t width = at_size(f->width, size), height = at_size(f->height, size);
    average_rows(in, f->width, f->height, step, width, between);
    average_columns(between, width, f->height, step, height, out);
}

// The largest picture at another size.
static void reduce(const level *largest, const frame *f, uint32_t size, float *between,
                   level *out)
{
    average_plane(largest->luminance, f, size, between, out->luminance);
    average_plane(largest->coverage, f, size, between, out->coverage);
}

// The features of the picture over a background, encoded, padded with the background.
static void take_features(const prom_measure *m, const level *in, uint32_t size,
                          float background, scratch *s, float *features)
{
    uint32_t width = at_size(s->frame.width, size), wide = width + 2 * PAD;
    uint32_t height = at_size(s->frame.height, size), high = height + 2 * PAD;
    float empty = m->encode[(int)(background * ENCODE_STEPS + 0.5f)];
    for (size_t i = 0; i < (size_t)wide * high; i++) s->grey[i] = empty;
    for (uint32_t y = 0; y < height; y++) {
        const float *l = in->luminance + (size_t)y * width;
        const float *c = in->coverage + (size_t)y * width;
        float *g = s->grey + (size_t)(y + PAD) * wide + PAD;
        for (uint32_t x = 0; x < width; x++) {
            if (c[x] <= 0.0f) continue;
            float v = l[x] + (1.0f - c[x]) * background;
            v = v < 0.0f ? 0.0f : v > 1.0f ? 1.0f : v;
            g[x] = m->encode[(int)(v * ENCODE_STEPS + 0.5f)];
        }
    }
    prom_edge_blur_features(s->grey, wide, high, features, s->metric);
}

// ---- measuring

// The true object from one direction, at all sizes, into the scratch.
static void take_truth(const prom_measure *m, const prom_views *views, uint32_t dir, scratch *s)
{
    unpack_view(views, dir, &s->frame, &s->covered[PROM_SIZES - 1]);
    for (uint32_t size = PROM_SIZES; size-- > 0;) {
        float *features = s->truth + m->features_of_size[size];
        if (size < PROM_SIZES - 1)
            reduce(&s->covered[PROM_SIZES - 1], &s->frame, size, s->between, &s->covered[size]);
        for (int b = 0; b < BACKGROUNDS; b++, features += 2 * window_pixels(size))
            take_features(m, &s->covered[size], size, m->background[b], s, features);
    }
}

static uint16_t covered_share(const level *largest, size_t pixels)
{
    double covered = 0;
    for (size_t i = 0; i < pixels; i++) covered += largest->coverage[i];
    double share = covered / (GLM_PI / 4.0 * PROM_VIEW_PIXELS);
    return (uint16_t)(65535.0 * (share > 1 ? 1 : share) + 0.5);
}

static uint32_t count_gaps(const float *truth, const float *other, size_t count)
{
    uint32_t gaps = 0;
    for (size_t i = 0; i < count; i++) gaps += truth[i] >= 0.9f && other[i] <= 0.1f;
    return gaps;
}

static uint8_t compare_size(const prom_measure *m, uint32_t size, const level *in, scratch *s)
{
    uint32_t wide = at_size(s->frame.width, size) + 2 * PAD;
    uint32_t high = at_size(s->frame.height, size) + 2 * PAD;
    const float *truth = s->truth + m->features_of_size[size];
    const float *covered = s->covered[size].coverage;
    const size_t pixels = pixels_of(&s->frame, size), window = (size_t)wide * high;
    double area = 0, error = 0;
    for (size_t i = 0; i < pixels; i++)
        area += covered[i] > in->coverage[i] ? covered[i] : in->coverage[i];
    for (int b = 0; b < BACKGROUNDS; b++, truth += 2 * window_pixels(size)) {
        take_features(m, in, size, m->background[b], s, s->features);
        prom_edge_blur_error(truth, s->features, wide, high, s->error);
        float sum = 0; // of one window: small enough for a float
        for (size_t i = 0; i < window; i++) sum += s->error[i];
        error += sum;
    }
    // Less than a pixel covered: its error is judged as if it were one.
    double accuracy = 1.0 - error / BACKGROUNDS / (area > 1.0 ? area : 1.0);
    return (uint8_t)(255.0 * (accuracy > 0 ? accuracy : 0) + 0.5);
}

static void compare(const prom_measure *m, uint32_t dir, prom_comparison *other, scratch *s)
{
    unpack_view(other->views, dir, &s->frame, &s->levels[0]);
    for (uint32_t size = PROM_SIZES; size-- > 0;) {
        const level *in = &s->levels[size < PROM_SIZES - 1];
        if (size < PROM_SIZES - 1)
            reduce(&s->levels[0], &s->frame, size, s->between, &s->levels[1]);
        other->accuracy.bins[dir][size] = compare_size(m, size, in, s);
        if (size == GAP_SIZE)
            other->gaps[dir] =
                count_gaps(s->covered[size].coverage, in->coverage, pixels_of(&s->frame, size));
    }
}

void prom_measure_direction(prom_measure *m, unsigned thread, uint32_t dir,
                            const prom_views *truth, uint16_t *coverage,
                            prom_comparison *const *others, size_t count)
{
    scratch *s = &m->scratches[thread];
    s->frame = frame_of(truth, others, count, dir);
    take_truth(m, truth, dir, s);
    *coverage =
        covered_share(&s->covered[PROM_SIZES - 1], pixels_of(&s->frame, PROM_SIZES - 1));
    for (size_t i = 0; i < count; i++) compare(m, dir, others[i], s);
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
