// FLIP's filters and colours. Constants without a reason beside them are the paper's.
#include "benefit/flip_private.h"

#include <assert.h>
#include <math.h>

// ---- colours

// Linear sRGB to XYZ: each row over its sum, the white point, so without common denominators.
static const double xyz_numerators[3][3] = {
    {10135552, 8788810, 4435075}, {2613072, 8788810, 887015}, {1425312, 8788810, 70074185}};

static void invert(const double m[3][3], float inverse[3][3])
{
    double cofactors[3][3], determinant = 0;
    for (int i = 0; i < 3; i++) {
        const double *a = m[(i + 1) % 3], *b = m[(i + 2) % 3];
        for (int j = 0; j < 3; j++)
            cofactors[i][j] = a[(j + 1) % 3] * b[(j + 2) % 3] - a[(j + 2) % 3] * b[(j + 1) % 3];
    }
    for (int j = 0; j < 3; j++) determinant += m[0][j] * cofactors[0][j];
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) inverse[i][j] = (float)(cofactors[j][i] / determinant);
}

static void make_colours(prom_flip_recipe *recipe)
{
    double xyz[3][3], opponent[3][3];
    for (int i = 0; i < 3; i++) {
        const double *row = xyz_numerators[i];
        for (int j = 0; j < 3; j++) xyz[i][j] = row[j] / (row[0] + row[1] + row[2]);
    }
    for (int j = 0; j < 3; j++) {
        opponent[0][j] = xyz[1][j];
        opponent[1][j] = xyz[0][j] - xyz[1][j];
        opponent[2][j] = xyz[1][j] - xyz[2][j];
    }
    invert(opponent, recipe->rgb_of_opponent);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            recipe->xyz_of_rgb[i][j] = (float)xyz[i][j];
            recipe->opponent_of_rgb[i][j] = (float)opponent[i][j];
        }
}

// ---- filters

// In doubles, for the outer taps may be too small for floats before they are scaled.
typedef struct kernel {
    int radius;
    double at[PROM_FLIP_RADIUS_MAX + 1];
} kernel;

static kernel new_kernel(double radius)
{
    kernel k = {.radius = (int)ceil(radius)};
    assert(k.radius >= 1 && k.radius <= PROM_FLIP_RADIUS_MAX);
    return k;
}

// Contrast sensitivity: sqrt(a sqrt(pi / b)) exp(-pi^2 d^2 / b), d in degrees, is one direction
// of a term of the two-dimensional filter. The radius is that of the widest term, b = 0.04.
static kernel blur_kernel(double ppd, double a, double b)
{
    kernel k = new_kernel(3 * sqrt(0.04 / (2 * M_PI * M_PI)) * ppd);
    for (int i = 0; i <= k.radius; i++) {
        double d = i / ppd;
        k.at[i] = sqrt(a * sqrt(M_PI / b)) * exp(-M_PI * M_PI * d * d / b);
    }
    return k;
}

static double sum_of(const kernel *k)
{
    double sum = k->at[0];
    for (int i = 1; i <= k->radius; i++) sum += 2 * k->at[i];
    return sum;
}

// Taps that add nothing to a sum of floats are left out.
static void set_taps(prom_flip_recipe *recipe, prom_flip_filter filter, const kernel *k,
                     double scale)
{
    const double least = 1e-8;
    prom_flip_taps *taps = &recipe->taps[filter];
    taps->radius = k->radius;
    while (taps->radius > 1 && fabs(k->at[taps->radius] * scale) < least) taps->radius--;
    for (int i = 0; i <= taps->radius; i++) taps->at[i] = (float)(k->at[i] * scale);
}

static void make_blurs(prom_flip_recipe *recipe, double ppd)
{
    kernel y = blur_kernel(ppd, 1, 0.0047), cx = blur_kernel(ppd, 1, 0.0053);
    kernel cz1 = blur_kernel(ppd, 34.1, 0.04), cz2 = blur_kernel(ppd, 13.5, 0.025);
    double both = hypot(sum_of(&cz1), sum_of(&cz2));
    set_taps(recipe, PROM_FLIP_BLUR_Y, &y, 1 / sum_of(&y));
    set_taps(recipe, PROM_FLIP_BLUR_CX, &cx, 1 / sum_of(&cx));
    set_taps(recipe, PROM_FLIP_BLUR_CZ1, &cz1, 1 / both);
    set_taps(recipe, PROM_FLIP_BLUR_CZ2, &cz2, 1 / both);
    recipe->pad = (uint32_t)y.radius;
}

// The positive taps to a sum of 1, the negative ones, of which the centre is one, to -1.
static void balance(kernel *point)
{
    double positive = 0, negative = -point->at[0];
    for (int i = 1; i <= point->radius; i++)
        *(point->at[i] > 0 ? &positive : &negative) += 2 * fabs(point->at[i]);
    for (int i = 0; i <= point->radius; i++)
        point->at[i] /= point->at[i] > 0 ? positive : negative;
}

// Features: a Gaussian as wide as the eye's own response to an edge, 0.082 degrees, and
// its first and second derivative.
static void make_features(prom_flip_recipe *recipe, double ppd)
{
    double sd = 0.5 * 0.082 * ppd, slope = 0;
    kernel smooth = new_kernel(3 * sd), edge = smooth, point = smooth;
    for (int u = 0; u <= smooth.radius; u++) {
        double square = u * u / (sd * sd), gauss = exp(-square / 2);
        smooth.at[u] = gauss;
        edge.at[u] = u * gauss;
        point.at[u] = (square - 1) * gauss;
        slope += edge.at[u];
    }
    balance(&point);
    set_taps(recipe, PROM_FLIP_SMOOTH, &smooth, 1 / sum_of(&smooth));
    set_taps(recipe, PROM_FLIP_EDGE, &edge, 1 / slope);
    set_taps(recipe, PROM_FLIP_POINT, &point, 1);
    assert(recipe->taps[PROM_FLIP_EDGE].radius == recipe->taps[PROM_FLIP_POINT].radius);
    if ((uint32_t)smooth.radius > recipe->pad) recipe->pad = (uint32_t)smooth.radius;
}

void prom_flip_recipe_init(prom_flip_recipe *recipe, double ppd)
{
    make_colours(recipe);
    make_blurs(recipe, ppd);
    make_features(recipe, ppd);
}
