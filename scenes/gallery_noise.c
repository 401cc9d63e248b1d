#include "scenes/gallery_noise.h"

#include <math.h>

prom_gallery_color prom_color_grey(float tone)
{
    return (prom_gallery_color){tone, tone, tone};
}

prom_gallery_color prom_color_rgb(uint32_t rgb)
{
    return (prom_gallery_color){(float)(rgb >> 16 & 255) / 255, (float)(rgb >> 8 & 255) / 255,
                                (float)(rgb & 255) / 255};
}

prom_gallery_color prom_color_shade(prom_gallery_color c, float factor)
{
    return (prom_gallery_color){c.r * factor, c.g * factor, c.b * factor};
}

prom_gallery_color prom_color_mix(prom_gallery_color a, prom_gallery_color b, float t)
{
    return (prom_gallery_color){a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t,
                                a.b + (b.b - a.b) * t};
}

static float cell(int x, int y, int z, uint32_t seed)
{
    // 32 bits suffice for pictures and are quick.
    uint32_t h = (uint32_t)x * 0x9e3779b1u ^ (uint32_t)y * 0x85ebca77u ^
                 (uint32_t)z * 0xc2b2ae3du ^ seed * 0x27d4eb2fu;
    h = (h ^ h >> 16) * 0x7feb352du;
    h = (h ^ h >> 15) * 0x846ca68bu;
    return (float)(h >> 8 ^ h >> 24) * 0x1p-24f;
}

float prom_noise_cell(int x, int y, uint32_t seed)
{
    return cell(x, y, 0, seed);
}

static float ease(float t)
{
    return t * t * (3 - 2 * t);
}

static float between(float a, float b, float t)
{
    return a + (b - a) * t;
}

static int wrap(int i, int period)
{
    i %= period;
    return i < 0 ? i + period : i;
}

float prom_noise_tile(float x, float y, int cells, uint32_t seed)
{
    x *= (float)cells;
    y *= (float)cells;
    int ix = (int)floorf(x), iy = (int)floorf(y);
    float fx = ease(x - (float)ix), fy = ease(y - (float)iy);
    int x0 = wrap(ix, cells), x1 = x0 + 1 < cells ? x0 + 1 : 0;
    int y0 = wrap(iy, cells), y1 = y0 + 1 < cells ? y0 + 1 : 0;
    return between(between(cell(x0, y0, 0, seed), cell(x1, y0, 0, seed), fx),
                   between(cell(x0, y1, 0, seed), cell(x1, y1, 0, seed), fx), fy);
}

float prom_noise_rough(float x, float y, int cells, uint32_t seed)
{
    float sum = 0, weight = 0.5f;
    for (uint32_t octave = 0; octave < 4; octave++) {
        sum += weight * (prom_noise_tile(x, y, cells, seed + octave) - 0.5f);
        weight *= 0.5f;
        cells *= 2;
    }
    return sum;
}

static float space(float x, float y, float z, uint32_t seed)
{
    int ix = (int)floorf(x), iy = (int)floorf(y), iz = (int)floorf(z);
    float fx = ease(x - (float)ix), fy = ease(y - (float)iy), fz = ease(z - (float)iz), v[2];
    for (int k = 0; k < 2; k++)
        v[k] = between(
            between(cell(ix, iy, iz + k, seed), cell(ix + 1, iy, iz + k, seed), fx),
            between(cell(ix, iy + 1, iz + k, seed), cell(ix + 1, iy + 1, iz + k, seed), fx),
            fy);
    return between(v[0], v[1], fz) - 0.5f;
}

float prom_noise_space(float x, float y, float z, uint32_t seed)
{
    return 0.67f * space(x, y, z, seed) + 0.33f * space(2 * x, 2 * y, 2 * z, seed + 1);
}

float prom_noise_step(float a, float b, float x)
{
    float t = (x - a) / (b - a);
    return t <= 0 ? 0 : t >= 1 ? 1 : ease(t);
}
