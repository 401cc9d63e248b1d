// FLIP in two passes over rows: pixels to the opponent space YCxCz, then each row filtered for
// both pictures and compared. Constants without a reason beside them are the paper's.
#include "benefit/flip.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"
#include "metaobj/base/threads.h"

#include <assert.h>
#include <math.h>

// A one-dimensional filter of 2 * radius + 1 taps.
typedef struct kernel {
    int radius;
    double *taps; // the outer ones may be too small for floats
} kernel;

typedef enum filter {
    BLUR_Y, // contrast sensitivity of the three channels; that of Cz is a sum of two
    BLUR_CX,
    BLUR_CZ1,
    BLUR_CZ2,
    SMOOTH, // features: along an edge, across an edge, and across a line or point
    EDGE,
    POINT,
    FILTER_COUNT
} filter;

enum { LUMA, RED_GREEN, BLUE_YELLOW, CHANNELS }; // Y, Cx, Cz

struct prom_flip {
    uint32_t width, height;
    float xyz_of_rgb[3][3], rgb_of_xyz[3][3]; // linear RGB, XYZ over its white
    float greatest;                           // colour difference: cmax
    kernel filters[FILTER_COUNT];
    int pad;            // the greatest radius
    float *opponent[2]; // of both pictures: a plane for each channel
    float *scratch;     // scratch_floats for each thread
    double *row_sums;
    // Of the run under way.
    const uint8_t *pictures[2];
    uint32_t stride;
    float *map;
};

// What a thread needs for a row.
typedef struct scratch {
    float *padded, *filtered;
    float *channels[CHANNELS]; // of one picture, filtered
    float *lab[2][3];
    float *edges[2], *points[2]; // strengths of features
} scratch;

// ---- colours

// Linear sRGB to XYZ: each row over its sum, the white point, so without common denominators.
static const double xyz_numerators[3][3] = {
    {10135552, 8788810, 4435075}, {2613072, 8788810, 887015}, {1425312, 8788810, 70074185}};

static void make_matrices(prom_flip *f)
{
    double m[3][3], cofactors[3][3];
    for (int i = 0; i < 3; i++) {
        const double *row = xyz_numerators[i];
        for (int j = 0; j < 3; j++) m[i][j] = row[j] / (row[0] + row[1] + row[2]);
    }
    for (int i = 0; i < 3; i++) {
        const double *a = m[(i + 1) % 3], *b = m[(i + 2) % 3];
        for (int j = 0; j < 3; j++)
            cofactors[i][j] = a[(j + 1) % 3] * b[(j + 2) % 3] - a[(j + 2) % 3] * b[(j + 1) % 3];
    }
    double det =
        m[0][0] * cofactors[0][0] + m[0][1] * cofactors[0][1] + m[0][2] * cofactors[0][2];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            f->xyz_of_rgb[i][j] = (float)m[i][j];
            f->rgb_of_xyz[i][j] = (float)(cofactors[j][i] / det);
        }
}

static void transform(const float m[3][3], const float in[3], float out[3])
{
    for (int i = 0; i < 3; i++) out[i] = m[i][0] * in[0] + m[i][1] * in[1] + m[i][2] * in[2];
}

static void opponent_of_rgb(const prom_flip *f, const float rgb[3], float opponent[CHANNELS])
{
    float xyz[3];
    transform(f->xyz_of_rgb, rgb, xyz);
    opponent[LUMA] = 116 * xyz[1] - 16;
    opponent[RED_GREEN] = 500 * (xyz[0] - xyz[1]);
    opponent[BLUE_YELLOW] = 200 * (xyz[1] - xyz[2]);
}

static float lab_curve(float t)
{
    const float delta = 6.0f / 29;
    return t > delta * delta * delta ? cbrtf(t) : t / (3 * delta * delta) + 4.0f / 29;
}

// CIELAB of what can be shown of a colour, its chroma less where it is dark (Hunt's effect).
static void lab_of_opponent(const prom_flip *f, const float opponent[CHANNELS], float lab[3])
{
    float y = (opponent[LUMA] + 16) / 116;
    float xyz[3] = {y + opponent[RED_GREEN] / 500, y, y - opponent[BLUE_YELLOW] / 200};
    float rgb[3];
    transform(f->rgb_of_xyz, xyz, rgb);
    for (int i = 0; i < 3; i++) rgb[i] = fminf(fmaxf(rgb[i], 0), 1);
    transform(f->xyz_of_rgb, rgb, xyz);
    for (int i = 0; i < 3; i++) xyz[i] = lab_curve(xyz[i]);
    lab[0] = 116 * xyz[1] - 16;
    lab[1] = 0.01f * lab[0] * 500 * (xyz[0] - xyz[1]);
    lab[2] = 0.01f * lab[0] * 200 * (xyz[1] - xyz[2]);
}

// HyAB, compressed.
static float lab_distance(const float a[3], const float b[3])
{
    float da = a[1] - b[1], db = a[2] - b[2];
    return powf(fabsf(a[0] - b[0]) + sqrtf(da * da + db * db), 0.7f);
}

// The greatest difference: between pure green and pure blue, 41.276.
static float greatest_distance(const prom_flip *f)
{
    float opponent[CHANNELS], green[3], blue[3];
    opponent_of_rgb(f, (float[3]){0, 1, 0}, opponent);
    lab_of_opponent(f, opponent, green);
    opponent_of_rgb(f, (float[3]){0, 0, 1}, opponent);
    lab_of_opponent(f, opponent, blue);
    return lab_distance(green, blue);
}

// Most differences are small: those below 0.4 of the greatest get 0.95 of the range.
static float redistributed(const prom_flip *f, float distance)
{
    float bend = 0.4f * f->greatest;
    return distance < bend ? 0.95f / bend * distance
                           : 0.95f + (distance - bend) / (f->greatest - bend) * 0.05f;
}

// ---- filters

static kernel new_kernel(double radius)
{
    int r = (int)ceil(radius);
    return (kernel){r, prom_calloc((size_t)(2 * r + 1), sizeof(double))};
}

// Contrast sensitivity: sqrt(a sqrt(pi / b)) exp(-pi^2 d^2 / b), d in degrees, is one direction
// of a term of the two-dimensional filter. The radius is that of the widest term, b = 0.04.
static kernel blur_kernel(double ppd, double a, double b)
{
    kernel k = new_kernel(3 * sqrt(0.04 / (2 * M_PI * M_PI)) * ppd);
    for (int i = -k.radius; i <= k.radius; i++) {
        double d = i / ppd;
        k.taps[i + k.radius] = sqrt(a * sqrt(M_PI / b)) * exp(-M_PI * M_PI * d * d / b);
    }
    return k;
}

static double kernel_sum(const kernel *k)
{
    double sum = 0;
    for (int i = 0; i <= 2 * k->radius; i++) sum += k->taps[i];
    return sum;
}

static void scale_kernel(kernel *k, double factor)
{
    for (int i = 0; i <= 2 * k->radius; i++) k->taps[i] *= factor;
}

static void make_blurs(prom_flip *f, double ppd)
{
    f->filters[BLUR_Y] = blur_kernel(ppd, 1, 0.0047);
    f->filters[BLUR_CX] = blur_kernel(ppd, 1, 0.0053);
    f->filters[BLUR_CZ1] = blur_kernel(ppd, 34.1, 0.04);
    f->filters[BLUR_CZ2] = blur_kernel(ppd, 13.5, 0.025);
    scale_kernel(&f->filters[BLUR_Y], 1 / kernel_sum(&f->filters[BLUR_Y]));
    scale_kernel(&f->filters[BLUR_CX], 1 / kernel_sum(&f->filters[BLUR_CX]));
    double both = hypot(kernel_sum(&f->filters[BLUR_CZ1]), kernel_sum(&f->filters[BLUR_CZ2]));
    scale_kernel(&f->filters[BLUR_CZ1], 1 / both);
    scale_kernel(&f->filters[BLUR_CZ2], 1 / both);
}

// Positive taps to a sum of 1, negative ones to one of -1.
static void balance_kernel(kernel *k)
{
    double sums[2] = {0, 0};
    for (int i = 0; i <= 2 * k->radius; i++) sums[k->taps[i] > 0] += fabs(k->taps[i]);
    for (int i = 0; i <= 2 * k->radius; i++) k->taps[i] /= sums[k->taps[i] > 0];
}

// Features: a Gaussian as wide as the eye's own response to an edge, 0.082 degrees, and
// its first and second derivative.
static void make_features(prom_flip *f, double ppd)
{
    double sd = 0.5 * 0.082 * ppd;
    for (int i = SMOOTH; i <= POINT; i++) f->filters[i] = new_kernel(3 * sd);
    int radius = f->filters[SMOOTH].radius;
    for (int u = -radius; u <= radius; u++) {
        double square = u * u / (sd * sd), gauss = exp(-square / 2);
        f->filters[SMOOTH].taps[u + radius] = gauss;
        f->filters[EDGE].taps[u + radius] = -u * gauss;
        f->filters[POINT].taps[u + radius] = (square - 1) * gauss;
    }
    scale_kernel(&f->filters[SMOOTH], 1 / kernel_sum(&f->filters[SMOOTH]));
    balance_kernel(&f->filters[EDGE]);
    balance_kernel(&f->filters[POINT]);
}

static void add_weighted(const float *restrict in, double weight, uint32_t count,
                         float *restrict out)
{
    for (uint32_t i = 0; i < count; i++) out[i] += (float)weight * in[i];
}

static const float *plane_row(const prom_flip *f, const float *plane, int64_t y)
{
    int64_t last = (int64_t)f->height - 1;
    return plane + (size_t)(y < 0 ? 0 : y > last ? last : y) * f->width;
}

// Adds to `out` row y of a plane, filtered down its columns and along its rows. Borders
// replicate.
static void add_filtered(const prom_flip *f, const float *plane, uint32_t y, filter down,
                         filter along, float *padded, float *out)
{
    const kernel *v = &f->filters[down], *h = &f->filters[along];
    float *row = padded + f->pad;
    memset(row, 0, f->width * sizeof *row);
    for (int i = -v->radius; i <= v->radius; i++)
        add_weighted(plane_row(f, plane, (int64_t)y + i), v->taps[i + v->radius], f->width,
                     row);
    for (int i = 1; i <= h->radius; i++) {
        row[-i] = row[0];
        row[(int64_t)f->width - 1 + i] = row[f->width - 1];
    }
    for (int i = -h->radius; i <= h->radius; i++)
        add_weighted(row + i, h->taps[i + h->radius], f->width, out);
}

static void filter_row(const prom_flip *f, const float *plane, uint32_t y, filter down,
                       filter along, float *padded, float *out)
{
    memset(out, 0, f->width * sizeof *out);
    add_filtered(f, plane, y, down, along, padded, out);
}

// ---- rows

static size_t scratch_floats(const prom_flip *f)
{
    const size_t rows = 1 + CHANNELS + 2 * 3 + 2 * 2; // of scratch, without the padded one
    return (rows + 1) * f->width + 2 * (size_t)f->pad;
}

static scratch scratch_of(const prom_flip *f, unsigned thread)
{
    scratch s;
    float *next = f->scratch + thread * scratch_floats(f);
    s.padded = next;
    next += f->width + 2 * (size_t)f->pad;
    float **rows[] = {&s.filtered,  &s.channels[0], &s.channels[1], &s.channels[2],
                      &s.lab[0][0], &s.lab[0][1],   &s.lab[0][2],   &s.lab[1][0],
                      &s.lab[1][1], &s.lab[1][2],   &s.edges[0],    &s.edges[1],
                      &s.points[0], &s.points[1]};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++, next += f->width) *rows[i] = next;
    return s;
}

static void colours_of_row(const prom_flip *f, uint32_t y, int picture, const scratch *s)
{
    const size_t plane = (size_t)f->width * f->height;
    const float *planes = f->opponent[picture];
    const float *blue_yellow = planes + BLUE_YELLOW * plane;
    filter_row(f, planes + LUMA * plane, y, BLUR_Y, BLUR_Y, s->padded, s->channels[LUMA]);
    filter_row(f, planes + RED_GREEN * plane, y, BLUR_CX, BLUR_CX, s->padded,
               s->channels[RED_GREEN]);
    filter_row(f, blue_yellow, y, BLUR_CZ1, BLUR_CZ1, s->padded, s->channels[BLUE_YELLOW]);
    add_filtered(f, blue_yellow, y, BLUR_CZ2, BLUR_CZ2, s->padded, s->channels[BLUE_YELLOW]);
    for (uint32_t x = 0; x < f->width; x++) {
        float opponent[CHANNELS], lab[3];
        for (int i = 0; i < CHANNELS; i++) opponent[i] = s->channels[i][x];
        lab_of_opponent(f, opponent, lab);
        for (int i = 0; i < 3; i++) s->lab[picture][i][x] = lab[i];
    }
}

// Strength of a feature, over both directions. The derivatives sum to 0, so of y = (Y + 16) /
// 116 only the divisor counts.
static void feature_of_row(const prom_flip *f, uint32_t y, int picture, filter derivative,
                           const scratch *s, float *strength)
{
    const float *luma = f->opponent[picture] + LUMA * (size_t)f->width * f->height;
    filter_row(f, luma, y, SMOOTH, derivative, s->padded, s->filtered);
    filter_row(f, luma, y, derivative, SMOOTH, s->padded, strength);
    for (uint32_t x = 0; x < f->width; x++)
        strength[x] = sqrtf(s->filtered[x] * s->filtered[x] + strength[x] * strength[x]) / 116;
}

static float pixel_error(const prom_flip *f, const scratch *s, uint32_t x)
{
    const float a[3] = {s->lab[0][0][x], s->lab[0][1][x], s->lab[0][2][x]};
    const float b[3] = {s->lab[1][0][x], s->lab[1][1][x], s->lab[1][2][x]};
    float colour = redistributed(f, lab_distance(a, b));
    float edges = fabsf(s->edges[0][x] - s->edges[1][x]);
    float points = fabsf(s->points[0][x] - s->points[1][x]);
    float feature = sqrtf(fminf(fmaxf(edges, points) * (float)M_SQRT1_2, 1));
    return fminf(powf(colour, 1 - feature), 1);
}

static void compare_row(void *user, size_t row, unsigned thread)
{
    const prom_flip *f = user;
    const scratch s = scratch_of(f, thread);
    uint32_t y = (uint32_t)row;
    for (int picture = 0; picture < 2; picture++) {
        colours_of_row(f, y, picture, &s);
        feature_of_row(f, y, picture, EDGE, &s, s.edges[picture]);
        feature_of_row(f, y, picture, POINT, &s, s.points[picture]);
    }
    float *map = f->map + row * f->width;
    double sum = 0;
    for (uint32_t x = 0; x < f->width; x++) sum += map[x] = pixel_error(f, &s, x);
    f->row_sums[row] = sum;
}

static void convert_row(void *user, size_t y, unsigned thread)
{
    (void)thread;
    const prom_flip *f = user;
    const size_t plane = (size_t)f->width * f->height;
    for (int picture = 0; picture < 2; picture++) {
        const uint8_t *pixel = f->pictures[picture] + y * f->width * f->stride;
        float *out = f->opponent[picture] + y * f->width;
        for (uint32_t x = 0; x < f->width; x++, pixel += f->stride, out++) {
            float rgb[3], opponent[CHANNELS];
            for (int i = 0; i < 3; i++) rgb[i] = prom_srgb8_to_linear(pixel[i]);
            opponent_of_rgb(f, rgb, opponent);
            for (int i = 0; i < CHANNELS; i++) out[(size_t)i * plane] = opponent[i];
        }
    }
}

// ---- the whole

prom_flip *prom_flip_create(uint32_t width, uint32_t height, double ppd)
{
    assert(width > 0 && height > 0 && ppd >= PROM_PPD_MIN && ppd <= PROM_PPD_MAX);
    prom_flip *f = prom_calloc(1, sizeof *f);
    f->width = width;
    f->height = height;
    make_matrices(f);
    f->greatest = greatest_distance(f);
    make_blurs(f, ppd);
    make_features(f, ppd);
    for (int i = 0; i < FILTER_COUNT; i++)
        if (f->filters[i].radius > f->pad) f->pad = f->filters[i].radius;
    for (int i = 0; i < 2; i++)
        f->opponent[i] = prom_alloc((size_t)width * height, CHANNELS * sizeof(float));
    f->scratch = prom_alloc(prom_thread_count(), scratch_floats(f) * sizeof(float));
    f->row_sums = prom_alloc(height, sizeof *f->row_sums);
    return f;
}

void prom_flip_destroy(prom_flip *flip)
{
    if (!flip) return;
    for (int i = 0; i < FILTER_COUNT; i++) prom_free(flip->filters[i].taps);
    for (int i = 0; i < 2; i++) prom_free(flip->opponent[i]);
    prom_free(flip->scratch);
    prom_free(flip->row_sums);
    prom_free(flip);
}

// Compares what stands in the opponent planes.
static double compare_planes(prom_flip *f, float *map)
{
    f->map = map;
    prom_parallel_for(f->height, compare_row, f);
    double sum = 0;
    for (uint32_t y = 0; y < f->height; y++) sum += f->row_sums[y];
    return sum / ((double)f->width * f->height);
}

double prom_flip_run(prom_flip *flip, const uint8_t *a, const uint8_t *b, uint32_t stride,
                     float *map)
{
    assert(stride == 3 || stride == 4);
    flip->pictures[0] = a;
    flip->pictures[1] = b;
    flip->stride = stride;
    prom_parallel_for(flip->height, convert_row, flip);
    return compare_planes(flip, map);
}
