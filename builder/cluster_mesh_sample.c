#include "builder/cluster_mesh_sample.h"

#include <math.h>

// Points of a triangle that are tested for coverage (error about 2 %).
enum { MIN_POINTS = 16, MAX_POINTS = 256 };

prom_sampler prom_sampler_init(const prom_material *material, const prom_texture *textures)
{
    prom_sampler s = {.base = {1, 1, 1, 1}};
    if (!material) return s;
    memcpy(s.base, material->base_color, sizeof s.base);
    s.masked = material->alpha_mode == PROM_ALPHA_MASK;
    s.cutoff = material->alpha_cutoff;
    if (textures && material->texture != PROM_NONE && textures[material->texture].pixels)
        s.texture = &textures[material->texture];
    return s;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

// Greatest extent of the triangle in texels of level 0.
static float extent_texels(const prom_sampler *s, const float *uv[3])
{
    float extent = 0;
    for (int a = 0; a < 2; a++) {
        float low = fminf(uv[0][a], fminf(uv[1][a], uv[2][a]));
        float high = fmaxf(uv[0][a], fmaxf(uv[1][a], uv[2][a]));
        float texels = (high - low) * (float)(a ? s->texture->height : s->texture->width);
        if (isfinite(texels)) extent = fmaxf(extent, texels);
    }
    return extent;
}

uint32_t prom_sampler_level(const prom_sampler *s, const float *uv[3])
{
    if (!s->texture) return 0;
    float half = extent_texels(s, uv) / 2;
    if (half <= 1) return 0;
    uint32_t level = (uint32_t)lroundf(log2f(half));
    return level < s->texture->levels ? level : s->texture->levels - 1;
}

// A coordinate that repeats, in texels of a level; [0, size).
static float wrapped(float coordinate, uint32_t size)
{
    if (!isfinite(coordinate)) return 0;
    float f = (coordinate - floorf(coordinate)) * (float)size;
    return f < (float)size ? f : 0;
}

void prom_sampler_color(const prom_sampler *s, uint32_t level, const float uv[2], float rgb[3])
{
    memcpy(rgb, s->base, 3 * sizeof *rgb);
    if (!s->texture) return;
    const prom_texture *t = s->texture;
    const uint8_t *pixels = t->pixels + prom_texture_offset(t, level, 0);
    uint32_t w = level_size(t->width, level), h = level_size(t->height, level);
    float x = wrapped(uv[0], w) - 0.5f, y = wrapped(uv[1], h) - 0.5f;
    float fx = x - floorf(x), fy = y - floorf(y);
    uint32_t x0 = x < 0 ? w - 1 : (uint32_t)x, y0 = y < 0 ? h - 1 : (uint32_t)y;
    const uint32_t xs[2] = {x0, (x0 + 1) % w}, ys[2] = {y0, (y0 + 1) % h};
    float sum[3] = {0}, total = 0;
    for (int i = 0; i < 4; i++) {
        const uint8_t *p = pixels + 4 * ((size_t)ys[i / 2] * w + xs[i % 2]);
        float weight = (i % 2 ? fx : 1 - fx) * (i / 2 ? fy : 1 - fy);
        // Dilated colour counts next to nothing, but is there where nothing is covered.
        if (s->masked) weight *= (float)p[3] / 255 + 1e-3f;
        total += weight;
        for (int c = 0; c < 3; c++) sum[c] += weight * prom_srgb8_to_linear(p[c]);
    }
    for (int c = 0; c < 3 && total > 0; c++) rgb[c] *= sum[c] / total;
}

float prom_sampler_coverage(const prom_sampler *s, const float *uv[3], float alpha)
{
    alpha *= s->base[3];
    if (!s->texture) return alpha >= s->cutoff;
    const prom_texture *t = s->texture;
    float extent = extent_texels(s, uv);
    int points = (int)glm_clamp(extent * extent, MIN_POINTS, MAX_POINTS), passed = 0;
    for (int i = 0; i < points; i++) {
        // A low-discrepancy sequence (Roberts 2018, "R2"), folded into the triangle: unlike a
        // grid it does not beat with a texture that repeats.
        float a = 0.5f + 0.7548776662f * (float)i, b = 0.5f + 0.5698402910f * (float)i;
        a -= floorf(a), b -= floorf(b);
        if (a + b > 1) a = 1 - a, b = 1 - b;
        float u = uv[0][0] + a * (uv[1][0] - uv[0][0]) + b * (uv[2][0] - uv[0][0]);
        float v = uv[0][1] + a * (uv[1][1] - uv[0][1]) + b * (uv[2][1] - uv[0][1]);
        uint32_t x = (uint32_t)wrapped(u, t->width), y = (uint32_t)wrapped(v, t->height);
        float texel = (float)t->pixels[4 * ((size_t)y * t->width + x) + 3] / 255;
        passed += texel * alpha >= s->cutoff;
    }
    return (float)passed / (float)points;
}
