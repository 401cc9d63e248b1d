// Stored mips: box filter in linear light, alpha-weighted, coverage kept (Castaño, "Computing
// alpha mipmaps", 2010).
#include "metaobj/texture.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"

// The source texels of one target texel along one axis. An odd size 2n+1 shrinks to n with
// three overlapping taps, so that no row is lost and the picture does not shift.
typedef struct taps {
    uint32_t first, count;
    float weight[3];
} taps;

typedef struct level_view {
    uint8_t *pixels; // of one layer
    uint32_t width, height;
} level_view;

static level_view view_of(const prom_texture *t, uint32_t level, uint32_t layer)
{
    uint32_t w = t->width >> level, h = t->height >> level;
    return (level_view){t->pixels + prom_texture_offset(t, level, layer), w ? w : 1, h ? h : 1};
}

static taps taps_of(uint32_t i, uint32_t source)
{
    if (source == 1) return (taps){0, 1, {1, 0, 0}};
    if (source % 2 == 0) return (taps){2 * i, 2, {0.5f, 0.5f, 0}};
    float n = (float)(source / 2), total = (float)source;
    return (taps){2 * i, 3, {(n - (float)i) / total, n / total, ((float)i + 1) / total}};
}

// Sums over the texels under a target texel. `plain` serves where all alphas are 0.
typedef struct sums {
    float plain[3], weighted[3], alpha;
} sums;

static sums gather(const level_view *from, const taps *tx, const taps *ty,
                   const float decode[256])
{
    sums s = {0};
    for (uint32_t y = 0; y < ty->count; y++) {
        const uint8_t *p =
            from->pixels + 4 * ((size_t)(ty->first + y) * from->width + tx->first);
        for (uint32_t x = 0; x < tx->count; x++, p += 4) {
            float w = tx->weight[x] * ty->weight[y], wa = w * p[3];
            s.alpha += wa;
            for (int c = 0; c < 3; c++) {
                float v = decode[p[c]];
                s.plain[c] += w * v;
                s.weighted[c] += wa * v;
            }
        }
    }
    if (s.alpha > 0)
        for (int c = 0; c < 3; c++) s.plain[c] = s.weighted[c] / s.alpha;
    return s;
}

static void store_color(const sums *s, uint8_t *p)
{
    for (int c = 0; c < 3; c++) p[c] = prom_linear_to_srgb8(s->plain[c]);
}

static uint8_t to_byte(float value)
{
    int i = (int)(value + 0.5f);
    return (uint8_t)(i < 0 ? 0 : i > 255 ? 255 : i);
}

static void store_normal(const sums *s, uint8_t *p)
{
    float x = s->plain[0], y = s->plain[1], z = s->plain[2];
    float length = sqrtf(x * x + y * y + z * z);
    float k = length > 1e-6f ? 1 / length : 0; // opposite normals cancel: no direction
    p[0] = to_byte((x * k + 1) * 127.5f);
    p[1] = to_byte((y * k + 1) * 127.5f);
    p[2] = to_byte((z * k + 1) * 127.5f);
}

static void shrink(const level_view *from, const level_view *to, const taps *columns,
                   bool normals, const float decode[256])
{
    for (uint32_t y = 0; y < to->height; y++) {
        taps ty = taps_of(y, from->height);
        uint8_t *p = to->pixels + 4 * (size_t)y * to->width;
        for (uint32_t x = 0; x < to->width; x++, p += 4) {
            sums s = gather(from, &columns[x], &ty, decode);
            if (normals)
                store_normal(&s, p);
            else
                store_color(&s, p);
            p[3] = to_byte(s.alpha);
        }
    }
}

static void histogram(const level_view *v, uint64_t counts[256])
{
    memset(counts, 0, 256 * sizeof *counts);
    size_t n = (size_t)v->width * v->height;
    for (size_t i = 0; i < n; i++) counts[v->pixels[4 * i + 3]]++;
}

// The alpha at or above which the share of texels is nearest to `share`; among equals the one
// nearest to `cutoff`, which changes least.
static int best_threshold(const uint64_t counts[256], double texels, double share, int cutoff)
{
    double best_error = INFINITY;
    uint64_t above = 0;
    int best = cutoff;
    for (int t = 255; t > 0; t--) {
        above += counts[t];
        double error = fabs((double)above / texels - share);
        if (error > best_error) continue;
        if (error == best_error && abs(t - cutoff) >= abs(best - cutoff)) continue;
        best_error = error;
        best = t;
    }
    return best;
}

static void rescale_alpha(const level_view *v, int threshold, int cutoff)
{
    uint8_t map[256];
    for (int a = 0; a < 256; a++) {
        int scaled = (2 * a * cutoff + threshold) / (2 * threshold);
        // Rounding must not carry a texel over the cutoff.
        if (a < threshold && scaled >= cutoff) scaled = cutoff - 1;
        map[a] = (uint8_t)(scaled > 255 ? 255 : scaled);
    }
    size_t n = (size_t)v->width * v->height;
    for (size_t i = 0; i < n; i++) v->pixels[4 * i + 3] = map[v->pixels[4 * i + 3]];
}

static void keep_coverage(const prom_texture *t, uint32_t layer, float alpha_cutoff)
{
    int cutoff = (int)ceilf(fminf(alpha_cutoff, 1) * 255 - 1e-3f);
    if (cutoff < 1) cutoff = 1;
    uint64_t counts[256];
    level_view v = view_of(t, 0, layer);
    histogram(&v, counts);
    uint64_t covered = 0;
    for (int a = cutoff; a < 256; a++) covered += counts[a];
    double share = (double)covered / ((double)v.width * v.height);
    for (uint32_t level = 1; level < t->levels; level++) {
        v = view_of(t, level, layer);
        histogram(&v, counts);
        int threshold = best_threshold(counts, (double)v.width * v.height, share, cutoff);
        if (threshold != cutoff) rescale_alpha(&v, threshold, cutoff);
    }
}

void prom_texture_make_mips(prom_texture *texture, float alpha_cutoff)
{
    float srgb[256], normal[256];
    for (int i = 0; i < 256; i++) {
        srgb[i] = prom_srgb8_to_linear((uint8_t)i);
        normal[i] = (float)i / 127.5f - 1;
    }
    taps *columns = prom_alloc(texture->width, sizeof *columns);
    for (uint32_t level = 1; level < texture->levels; level++) {
        for (uint32_t layer = 0; layer < texture->layers; layer++) {
            bool normals = texture->kind == PROM_TEXTURE_IMPOSTOR_ALBEDO && layer >= 6;
            level_view from = view_of(texture, level - 1, layer);
            level_view to = view_of(texture, level, layer);
            for (uint32_t x = 0; x < to.width; x++) columns[x] = taps_of(x, from.width);
            shrink(&from, &to, columns, normals, normals ? normal : srgb);
        }
    }
    prom_free(columns);
    if (alpha_cutoff > 0)
        for (uint32_t layer = 0; layer < texture->layers; layer++)
            keep_coverage(texture, layer, alpha_cutoff);
}
