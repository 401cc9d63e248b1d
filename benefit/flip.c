// FLIP: the bands of a picture become features in blocks of rows that stay in the nearest
// cache.
#include "benefit/flip_private.h"

#include "benefit/bands.h"
#include "benefit/grey.h"
#include "benefit/metric_private.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"

enum { PLANES = 7 };

// Floats of a plane of a block, if that is a row or more; by measurement.
#define BLOCK_FLOATS 2048

typedef struct flip {
    prom_flip_recipe recipe;
    const prom_flip_loops *loops;
    prom_bands *bands;
    float linear_of_byte[256];
} flip;

// A band on its way, with a border of `pad` on all sides.
typedef struct band {
    const flip *flip;
    const prom_picture *picture;
    float *features; // of the whole picture
    uint32_t first, last;
    size_t stride;         // floats of a row, with its border
    float *linear[3];      // a row
    float *opponent[3];    // all rows
    float *planes[PLANES]; // a block of rows each
} band;

// ---- working memory

static size_t stride_of(const flip *f, uint32_t width)
{
    return width + 2 * (size_t)f->recipe.pad;
}

static size_t row_floats(size_t stride)
{
    return stride + PROM_FLIP_LANES;
}

static size_t opponent_floats(const flip *f, size_t stride)
{
    return (PROM_BAND_ROWS + 2 * (size_t)f->recipe.pad) * stride + PROM_FLIP_LANES;
}

static size_t block_floats(size_t stride)
{
    return (stride > BLOCK_FLOATS ? stride : BLOCK_FLOATS) + PROM_FLIP_LANES;
}

static size_t scratch_floats(const flip *f, size_t stride)
{
    return 3 * row_floats(stride) + 3 * opponent_floats(f, stride) +
           PLANES * block_floats(stride);
}

static void divide_scratch(band *b, float *scratch)
{
    for (int i = 0; i < 3; i++, scratch += row_floats(b->stride)) b->linear[i] = scratch;
    for (int i = 0; i < 3; i++, scratch += opponent_floats(b->flip, b->stride))
        b->opponent[i] = scratch;
    for (int i = 0; i < PLANES; i++, scratch += block_floats(b->stride)) b->planes[i] = scratch;
}

static void *create(double ppd, uint32_t max_side, size_t max_pixels, unsigned threads)
{
    (void)max_pixels;
    flip *f = prom_alloc(1, sizeof *f);
    prom_flip_recipe_init(&f->recipe, ppd);
    f->loops = prom_flip_loops_at(0);
    for (int i = 0; i < 256; i++) f->linear_of_byte[i] = prom_srgb8_to_linear((uint8_t)i);
    size_t floats = scratch_floats(f, stride_of(f, max_side));
    f->bands = prom_bands_create(threads, floats * sizeof(float));
    return f;
}

static void destroy(void *state)
{
    flip *f = state;
    prom_bands_destroy(f->bands);
    prom_free(f);
}

static uint32_t radius(const void *state)
{
    return ((const flip *)state)->recipe.pad;
}

// ---- pictures

static void decode_bytes(const float linear_of_byte[256], const uint8_t *pixel,
                         uint32_t channels, size_t count, float *const linear[3])
{
    float *r = linear[0], *g = linear[1], *b = linear[2];
    const uint32_t green = channels > 1 ? 1 : 0, blue = 2 * green;
    for (size_t i = 0; i < count; i++, pixel += channels) {
        r[i] = linear_of_byte[pixel[0]];
        g[i] = linear_of_byte[pixel[green]];
        b[i] = linear_of_byte[pixel[blue]];
    }
}

static float shown(float value)
{
    return value > 0 ? value < 1 ? value : 1 : 0;
}

static void decode_floats(const float *pixel, uint32_t channels, size_t count,
                          float *const linear[3])
{
    float *r = linear[0], *g = linear[1], *b = linear[2];
    const uint32_t green = channels > 1 ? 1 : 0, blue = 2 * green;
    for (size_t i = 0; i < count; i++, pixel += channels) {
        r[i] = shown(pixel[0]);
        g[i] = shown(pixel[green]);
        b[i] = shown(pixel[blue]);
    }
}

// Row y of the picture to a row of the band.
static void convert_row(const band *b, uint32_t y, size_t row)
{
    const prom_picture *p = b->picture;
    const void *pixels = prom_picture_row(p, y);
    const uint32_t pad = b->flip->recipe.pad;
    float *opponent[3];
    for (int i = 0; i < 3; i++) opponent[i] = b->opponent[i] + row * b->stride + pad;
    if (p->floats)
        decode_floats(pixels, p->channels, p->width, b->linear);
    else
        decode_bytes(b->flip->linear_of_byte, pixels, p->channels, p->width, b->linear);
    b->flip->loops->opponents(&b->flip->recipe, (const float *const *)b->linear, p->width,
                              opponent);
    for (int i = 0; i < 3; i++)
        prom_border_row(PROM_BORDER_REPLICATE, opponent[i], p->width, pad);
}

static void copy_row(const band *b, size_t from, size_t to)
{
    for (int i = 0; i < 3; i++)
        memcpy(b->opponent[i] + to * b->stride, b->opponent[i] + from * b->stride,
               b->stride * sizeof(float));
}

// Downwards, so that what a conversion leaves behind the end of its row is overwritten. Above
// and below the picture its border is repeated.
static void convert(const band *b)
{
    const size_t pad = b->flip->recipe.pad, rows = b->last - b->first + 2 * pad;
    const size_t above = b->first < pad ? pad - b->first : 0;
    for (size_t row = above; row < rows; row++) {
        size_t y = b->first + row - pad;
        if (y < b->picture->height)
            convert_row(b, (uint32_t)y, row);
        else
            copy_row(b, row - 1, row);
    }
    for (size_t row = 0; row < above; row++) copy_row(b, above, row);
}

// ---- features

// A part of the band: `rows` of its rows from `first` on.
typedef struct block {
    const band *band;
    size_t first, rows;
} block;

static const prom_flip_taps *taps_of(const block *b, prom_flip_filter filter)
{
    return &b->band->flip->recipe.taps[filter];
}

static size_t pad_of(const block *b)
{
    return b->band->flip->recipe.pad;
}

// Where the block begins among the opponent colours.
static const float *channel_of(const block *b, int channel)
{
    return b->band->opponent[channel] + (b->first + pad_of(b)) * b->band->stride;
}

static void filter_down(const block *b, prom_flip_filter filter, int channel, float *out)
{
    const band *whole = b->band;
    whole->flip->loops->even(taps_of(b, filter), channel_of(b, channel),
                             (ptrdiff_t)whole->stride, b->rows * whole->stride, out);
}

// Values of a block from its first pixel to its last. Loops along the rows go over the borders
// between, where nothing of use comes out.
static size_t inner_floats(const block *b)
{
    return b->rows * b->band->stride - 2 * pad_of(b);
}

static void filter_along(const block *b, prom_flip_filter filter, const float *in, float *out)
{
    b->band->flip->loops->even(taps_of(b, filter), in + pad_of(b), 1, inner_floats(b),
                               out + pad_of(b));
}

static float *feature_row(const block *b, int feature, size_t row)
{
    const prom_picture *p = b->band->picture;
    const size_t y = b->band->first + b->first + row;
    return b->band->features + ((size_t)feature * p->height + y) * p->width;
}

// The strength of a feature from its filters in both directions.
static void put_strengths(const block *b, int feature, const float *horizontal, float *vertical)
{
    const band *whole = b->band;
    const size_t pad = pad_of(b);
    whole->flip->loops->lengths(horizontal + pad, vertical + pad, inner_floats(b),
                                vertical + pad);
    for (size_t row = 0; row < b->rows; row++)
        memcpy(feature_row(b, feature, row), vertical + row * whole->stride + pad,
               whole->picture->width * sizeof(float));
}

static void make_strengths(const block *b)
{
    const band *whole = b->band;
    const prom_flip_loops *loops = whole->flip->loops;
    const prom_flip_taps *point = taps_of(b, PROM_FLIP_POINT);
    const prom_flip_taps *edge = taps_of(b, PROM_FLIP_EDGE);
    const size_t pad = pad_of(b);
    float *const *p = whole->planes;
    filter_down(b, PROM_FLIP_SMOOTH, 0, p[0]);
    loops->both(point, edge, channel_of(b, 0), (ptrdiff_t)whole->stride,
                b->rows * whole->stride, p[1], p[2]);
    loops->both(point, edge, p[0] + pad, 1, inner_floats(b), p[3] + pad, p[4] + pad);
    filter_along(b, PROM_FLIP_SMOOTH, p[1], p[5]);
    filter_along(b, PROM_FLIP_SMOOTH, p[2], p[6]);
    put_strengths(b, PROM_FLIP_POINTS, p[3], p[5]);
    put_strengths(b, PROM_FLIP_EDGES, p[4], p[6]);
}

static void make_colours(const block *b)
{
    static const struct {
        prom_flip_filter filter;
        int channel;
    } blurs[] = {{PROM_FLIP_BLUR_Y, 0},
                 {PROM_FLIP_BLUR_CX, 1},
                 {PROM_FLIP_BLUR_CZ1, 2},
                 {PROM_FLIP_BLUR_CZ2, 2}};
    const band *whole = b->band;
    const uint32_t width = whole->picture->width;
    float *const *p = whole->planes, *const *lab = p + 4;
    for (int i = 0; i < 4; i++) {
        filter_down(b, blurs[i].filter, blurs[i].channel, p[4]);
        filter_along(b, blurs[i].filter, p[4], p[i]);
    }
    for (size_t row = 0; row < b->rows; row++) {
        const size_t at = row * whole->stride + pad_of(b);
        const float *in[4] = {p[0] + at, p[1] + at, p[2] + at, p[3] + at};
        whole->flip->loops->colours(&whole->flip->recipe, in, width, lab);
        for (int i = 0; i < 3; i++)
            memcpy(feature_row(b, PROM_FLIP_L + i, row), lab[i], width * sizeof(float));
    }
}

typedef struct features_run {
    const flip *flip;
    const prom_picture *picture;
    float *features;
} features_run;

static void make_band(void *user, uint32_t first, uint32_t last, void *scratch)
{
    const features_run *run = user;
    band b = {run->flip, run->picture, run->features,
              first,     last,         .stride = stride_of(run->flip, run->picture->width)};
    divide_scratch(&b, scratch);
    convert(&b);
    const size_t height = last - first, most = BLOCK_FLOATS / b.stride, rows = most ? most : 1;
    for (size_t row = 0; row < height; row += rows) {
        block part = {&b, row, height - row < rows ? height - row : rows};
        make_strengths(&part);
        make_colours(&part);
    }
}

static void features(void *state, const prom_picture *picture, float *out)
{
    flip *f = state;
    features_run run = {f, picture, out};
    prom_bands_run(f->bands, picture->height, make_band, &run);
}

// ---- errors

typedef struct errors_run {
    const flip *flip;
    const float *features[2];
    uint32_t width, height;
    float *map;
} errors_run;

static void compare_band(void *user, uint32_t first, uint32_t last, void *scratch)
{
    (void)scratch;
    const errors_run *run = user;
    const size_t plane = (size_t)run->width * run->height, from = (size_t)first * run->width;
    const float *a[PROM_FLIP_PLANES], *b[PROM_FLIP_PLANES];
    for (size_t i = 0; i < PROM_FLIP_PLANES; i++) {
        a[i] = run->features[0] + i * plane + from;
        b[i] = run->features[1] + i * plane + from;
    }
    run->flip->loops->errors(a, b, (size_t)(last - first) * run->width, run->map + from);
}

static void compare(void *state, const float *features_a, const float *features_b,
                    uint32_t width, uint32_t height, float *map)
{
    flip *f = state;
    errors_run run = {f, {features_a, features_b}, width, height, map};
    prom_bands_run(f->bands, height, compare_band, &run);
}

const prom_metric_kind prom_metric_flip = {
    .class = {.name = "flip",
              .summary = "difference seen when flipping between the pictures (FLIP, LDR)",
              .uses_ppd = true},
    .planes = PROM_FLIP_PLANES,
    .create = create,
    .destroy = destroy,
    .radius = radius,
    .features = features,
    .compare = compare,
};
