// Colours and noise that the city's pictures are computed from. Private to
// scenes/city_texture*.c.
#ifndef PROM_SCENES_CITY_COLOR_H
#define PROM_SCENES_CITY_COLOR_H

#include "scenes/random.h"

#include <math.h>

#define PI 3.14159265f

typedef struct color {
    float r, g, b, a;
} color;

static inline float cell_random(int x, int y, uint32_t seed)
{
    uint64_t h = prom_random_mix(((uint64_t)(uint32_t)x << 32 | (uint32_t)y) +
                                 seed * 0x9e3779b97f4a7c15u);
    return (float)(h >> 40) * 0x1p-24f;
}

static inline int wrap(int i, int period)
{
    return ((i % period) + period) % period;
}

// Value noise that repeats after `period` cells; in [0,1].
static inline float noise(float x, float y, int period, uint32_t seed)
{
    x *= (float)period;
    y *= (float)period;
    int ix = (int)floorf(x), iy = (int)floorf(y);
    float fx = x - (float)ix, fy = y - (float)iy;
    fx = fx * fx * (3 - 2 * fx);
    fy = fy * fy * (3 - 2 * fy);
    int x0 = wrap(ix, period), x1 = wrap(ix + 1, period);
    int y0 = wrap(iy, period), y1 = wrap(iy + 1, period);
    float low = cell_random(x0, y0, seed) * (1 - fx) + cell_random(x1, y0, seed) * fx;
    float high = cell_random(x0, y1, seed) * (1 - fx) + cell_random(x1, y1, seed) * fx;
    return low * (1 - fy) + high * fy;
}

// Three octaves around 0, about [-1,1].
static inline float rough(float x, float y, int period, uint32_t seed)
{
    return (noise(x, y, period, seed) - 0.5f) +
           0.5f * (noise(x, y, 2 * period, seed + 1) - 0.5f) +
           0.35f * (noise(x, y, 4 * period, seed + 2) - 0.5f);
}

static inline color grey(float v)
{
    return (color){v, v, v, 1};
}

static inline color shade(color c, float factor)
{
    return (color){c.r * factor, c.g * factor, c.b * factor, c.a};
}

static inline color mix(color a, color b, float t)
{
    return (color){a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t,
                   a.a + (b.a - a.a) * t};
}

// Distance to the border of the unit cell that a coordinate is in, in cells.
static inline float border(float t)
{
    t -= floorf(t);
    return fminf(t, 1 - t);
}

// ---- pictures in city_texture_sign.c; picture coordinates in [0,1), y down

color prom_city_sign_color(float x, float y);
color prom_city_clock_color(float x, float y);
color prom_city_poster_color(float x, float y);

#endif
