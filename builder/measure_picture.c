#include "builder/measure_picture.h"

#include "metaobj/base/math.h"

#include <string.h>

static uint32_t least(uint32_t a, uint32_t b)
{
    return a < b ? a : b;
}

static uint32_t most(uint32_t a, uint32_t b)
{
    return a > b ? a : b;
}

prom_part prom_part_around(prom_part a, prom_part b)
{
    if (!a.width) return b;
    if (!b.width) return a;
    prom_part all = {.x = least(a.x, b.x), .y = least(a.y, b.y)};
    all.width = most(a.x + a.width, b.x + b.width) - all.x;
    all.height = most(a.y + a.height, b.y + b.height) - all.y;
    return all;
}

prom_part prom_part_reduced(prom_part part, float step)
{
    prom_part r = {.x = (uint32_t)((float)part.x / step),
                   .y = (uint32_t)((float)part.y / step)};
    r.width = (uint32_t)ceilf((float)(part.x + part.width) / step) - r.x;
    r.height = (uint32_t)ceilf((float)(part.y + part.height) / step) - r.y;
    return r;
}

static void take_pixel(const uint8_t *rgba, float *out)
{
    if (rgba[3] < PROM_COVERED) return;
    for (int c = 0; c < 3; c++) out[c] = prom_srgb8_to_linear(rgba[c]);
    out[3] = 1.0f;
}

void prom_patch_take(const prom_views *views, uint32_t view, prom_part part, prom_patch *patch)
{
    const prom_part *from = &views->at[view].part;
    const prom_rgba *rgba = views->pixels.data + views->at[view].first;
    patch->part = part;
    memset(patch->pixels, 0, prom_part_pixels(&part) * sizeof *patch->pixels);
    const uint32_t left = most(part.x, from->x), top = most(part.y, from->y);
    const uint32_t right = least(part.x + part.width, from->x + from->width);
    const uint32_t bottom = least(part.y + part.height, from->y + from->height);
    for (uint32_t y = top; y < bottom; y++)
        for (uint32_t x = left; x < right; x++)
            take_pixel(rgba[(size_t)(y - from->y) * from->width + x - from->x],
                       patch->pixels[(size_t)(y - part.y) * part.width + x - part.x]);
}

// ---- area averages

// The input pixels [first, end) of a row or column that an output pixel covers, of the first
// and the last of them a part.
typedef struct span {
    uint32_t first, end;
    float head, tail; // weights of these; of the others: scale
} span;

// Of output pixel `i`, in an input of `count` pixels from `start` on.
static span span_of(uint32_t i, float step, uint32_t start, uint32_t count)
{
    float from = fmaxf((float)i * step - (float)start, 0.0f);
    float to = fminf((float)(i + 1) * step - (float)start, (float)count);
    span s = {.first = (uint32_t)from, .end = (uint32_t)ceilf(to)};
    s.head = ((float)(s.first + 1) - from) / step;
    s.tail = (to - (float)(s.end - 1)) / step;
    if (s.first + 1 == s.end) s.head += s.tail - 1.0f / step;
    return s;
}

static float weight_in(const span *s, float scale, uint32_t i)
{
    return i == s->first ? s->head : i + 1 == s->end ? s->tail : scale;
}

static void average_rows(const prom_patch *in, float step, const prom_part *part,
                         float (*out)[4])
{
    const float scale = 1.0f / step;
    span spans[PROM_VIEW_LARGE_PX];
    for (uint32_t x = 0; x < part->width; x++)
        spans[x] = span_of(part->x + x, step, in->part.x, in->part.width);
    const float(*row)[4] = (const float(*)[4])in->pixels;
    for (uint32_t y = 0; y < in->part.height; y++, row += in->part.width, out += part->width)
        for (uint32_t x = 0; x < part->width; x++) {
            const span *s = &spans[x];
            float sum[4] = {0};
            for (uint32_t i = s->first; i < s->end; i++) {
                const float weight = weight_in(s, scale, i);
                for (int c = 0; c < 4; c++) sum[c] += weight * row[i][c];
            }
            memcpy(out[x], sum, sizeof sum);
        }
}

static void average_columns(const float (*in)[4], const prom_part *from, float step,
                            const prom_part *part, float (*out)[4])
{
    const size_t row_floats = 4 * (size_t)part->width;
    for (uint32_t y = 0; y < part->height; y++) {
        const span s = span_of(part->y + y, step, from->y, from->height);
        float *sum = out[(size_t)y * part->width];
        memset(sum, 0, row_floats * sizeof *sum);
        for (uint32_t i = s.first; i < s.end; i++) {
            const float *row = in[(size_t)i * part->width];
            const float weight = weight_in(&s, 1.0f / step, i);
            for (size_t k = 0; k < row_floats; k++) sum[k] += weight * row[k];
        }
    }
}

void prom_patch_reduce(const prom_patch *patch, float step, float (*between)[4],
                       prom_patch *reduced)
{
    reduced->part = prom_part_reduced(patch->part, step);
    average_rows(patch, step, &reduced->part, between);
    average_columns((const float(*)[4])between, &patch->part, step, &reduced->part,
                    reduced->pixels);
}

// ---- over a background

void prom_encoder_init(prom_encoder *encoder)
{
    for (int i = 0; i <= PROM_ENCODE_STEPS; i++)
        encoder->bytes[i] = prom_linear_to_srgb8((float)i / PROM_ENCODE_STEPS);
}

static uint8_t encoded(const prom_encoder *encoder, float linear)
{
    const float most = linear < 1.0f ? linear : 1.0f;
    return encoder->bytes[(int)(most * PROM_ENCODE_STEPS + 0.5f)];
}

void prom_patch_compose(const prom_patch *patch, const prom_encoder *encoder, float background,
                        uint32_t pad, uint8_t (*rgba)[4])
{
    const uint32_t width = patch->part.width, height = patch->part.height;
    const size_t wide = width + 2 * pad;
    const uint8_t grey = encoded(encoder, background);
    memset(rgba, grey, wide * (height + 2 * pad) * sizeof *rgba);
    const float(*in)[4] = (const float(*)[4])patch->pixels;
    for (uint32_t y = 0; y < height; y++, in += width) {
        uint8_t(*out)[4] = rgba + (y + pad) * wide + pad;
        for (uint32_t x = 0; x < width; x++) {
            if (in[x][3] <= 0.0f) continue;
            const float behind = (1.0f - in[x][3]) * background;
            for (int c = 0; c < 3; c++) out[x][c] = encoded(encoder, in[x][c] + behind);
        }
    }
}

// ---- errors

double prom_patch_area(const prom_patch *patch)
{
    double area = 0.0;
    for (size_t i = 0; i < prom_part_pixels(&patch->part); i++)
        area += (double)patch->pixels[i][3];
    return fmax(area, 1.0);
}

double prom_window_error(const float *map, size_t count, double area, bool squares)
{
    double sum = 0.0;
    if (!squares) {
        for (size_t i = 0; i < count; i++) sum += (double)map[i];
        return sum / area;
    }
    for (size_t i = 0; i < count; i++) sum += (double)(map[i] * map[i]);
    return sqrt(sum / area);
}

// In smaller pictures there are too few pixels for a veto.
#define VETO_SIZE_PX 32.0f

// Pixels count that end a square of wrong ones which no edge of an outline fills. The map
// becomes the sides of the largest such squares.
bool prom_window_vetoed(const prom_measured *how, float size_px, double area, float *map,
                        uint32_t width, uint32_t height)
{
    if (size_px < VETO_SIZE_PX) return false;
    const float side = 1.0f + 2.0f * roundf(size_px / VETO_SIZE_PX);
    uint32_t ends = 0;
    for (uint32_t y = 0; y < height; y++) {
        float *row = map + (size_t)y * width;
        const float *above = y ? row - width : NULL;
        for (uint32_t x = 0; x < width; x++) {
            bool wrong = row[x] > how->veto_error;
            row[x] = 0.0f;
            if (!wrong) continue;
            bool inner = x > 0 && y > 0;
            row[x] = 1.0f + (inner ? fminf(fminf(row[x - 1], above[x]), above[x - 1]) : 0.0f);
            ends += row[x] >= side;
        }
    }
    return ends > (1.0 - (double)how->veto_percentile) * area;
}
