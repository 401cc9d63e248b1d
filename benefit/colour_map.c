#include "benefit/colour_map.h"

#include "metaobj/base/math.h"

#include <string.h>

#define STEPS 4096 // of the curve, to measure it by

// The curve, by taste; all of it lies within sRGB.
static const double dark = 0.14, light = 0.99;
static const double chroma = 0.19;
static const double violet = 275, yellow = 465; // degrees, through red at 360

typedef struct lab {
    double l, a, b;
} lab;

static lab curve(double t)
{
    double hue = (violet + (yellow - violet) * t) * GLM_PI / 180;
    double c = chroma * sin(GLM_PI * t);
    return (lab){dark + (light - dark) * t, c * cos(hue), c * sin(hue)};
}

// OKLab to linear sRGB (Ottosson 2020, with the matrices of 2021).
static void to_linear(lab v, double rgb[3])
{
    double l = v.l + 0.3963377774 * v.a + 0.2158037573 * v.b;
    double m = v.l - 0.1055613458 * v.a - 0.0638541728 * v.b;
    double s = v.l - 0.0894841775 * v.a - 1.2914855480 * v.b;
    l *= l * l;
    m *= m * m;
    s *= s * s;
    rgb[0] = 4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s;
    rgb[1] = -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s;
    rgb[2] = -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s;
}

static double distance(lab p, lab q)
{
    double l = p.l - q.l, a = p.a - q.a, b = p.b - q.b;
    return sqrt(l * l + a * a + b * b);
}

// Length of the curve up to each of its steps.
static void measure(double lengths[STEPS + 1])
{
    lengths[0] = 0;
    for (int i = 1; i <= STEPS; i++)
        lengths[i] =
            lengths[i - 1] + distance(curve((i - 1.0) / STEPS), curve(1.0 * i / STEPS));
}

void prom_colour_map(uint8_t colours[256][3])
{
    double lengths[STEPS + 1], rgb[3];
    measure(lengths);
    for (int i = 0, at = 0; i < 256; i++) {
        while (at < STEPS && lengths[at] < lengths[STEPS] * i / 255) at++;
        to_linear(curve((double)at / STEPS), rgb);
        for (int c = 0; c < 3; c++) colours[i][c] = prom_linear_to_srgb8((float)rgb[c]);
    }
}

void prom_colour_map_paint(const float *errors, size_t count, uint8_t *rgb)
{
    uint8_t colours[256][3];
    prom_colour_map(colours);
    for (size_t i = 0; i < count; i++) {
        float error = fminf(fmaxf(errors[i], 0), 1);
        memcpy(rgb + 3 * i, colours[(int)(error * 255 + 0.5f)], 3);
    }
}
