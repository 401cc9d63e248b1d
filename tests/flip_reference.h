// FLIP once more, in doubles and with two-dimensional filters: slow, and by the word of the
// definitions.
#ifndef PROM_TESTS_FLIP_REFERENCE_H
#define PROM_TESTS_FLIP_REFERENCE_H

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

enum { FLIP_REFERENCE_PIXELS = 64 * 64 };

typedef struct flip_reference {
    int width, height; // FLIP_REFERENCE_PIXELS at most
    double ppd;
    double opponent[2][FLIP_REFERENCE_PIXELS][3];
} flip_reference;

static const double to_xyz[3][3] = {
    {10135552 / 24577794.0, 8788810 / 24577794.0, 4435075 / 24577794.0},
    {2613072 / 12288897.0, 8788810 / 12288897.0, 887015 / 12288897.0},
    {1425312 / 73733382.0, 8788810 / 73733382.0, 70074185 / 73733382.0}};

static double white(int i)
{
    return to_xyz[i][0] + to_xyz[i][1] + to_xyz[i][2];
}

static void xyz_of(const double rgb[3], double xyz[3])
{
    for (int i = 0; i < 3; i++)
        xyz[i] =
            (to_xyz[i][0] * rgb[0] + to_xyz[i][1] * rgb[1] + to_xyz[i][2] * rgb[2]) / white(i);
}

static double determinant(const double m[3][3])
{
    double sum = 0;
    for (int i = 0; i < 3; i++)
        sum += m[0][i] *
               (m[1][(i + 1) % 3] * m[2][(i + 2) % 3] - m[1][(i + 2) % 3] * m[2][(i + 1) % 3]);
    return sum;
}

static void rgb_of(const double xyz[3], double rgb[3])
{
    for (int k = 0; k < 3; k++) { // Cramer's rule
        double m[3][3];
        memcpy(m, to_xyz, sizeof m);
        for (int i = 0; i < 3; i++) m[i][k] = xyz[i] * white(i);
        rgb[k] = determinant(m) / determinant(to_xyz);
    }
}

static void lab_of(const double opponent[3], double lab[3])
{
    double y = (opponent[0] + 16) / 116, rgb[3], f[3];
    rgb_of((double[3]){y + opponent[1] / 500, y, y - opponent[2] / 200}, rgb);
    for (int i = 0; i < 3; i++) rgb[i] = rgb[i] < 0 ? 0 : rgb[i] > 1 ? 1 : rgb[i];
    xyz_of(rgb, f);
    for (int i = 0; i < 3; i++)
        f[i] = f[i] > pow(6 / 29.0, 3) ? cbrt(f[i]) : f[i] * 29 * 29 / 108 + 4 / 29.0;
    lab[0] = 116 * f[1] - 16;
    lab[1] = 500 * (f[0] - f[1]) * lab[0] / 100;
    lab[2] = 200 * (f[1] - f[2]) * lab[0] / 100;
}

static double contrast(int channel, double d)
{
    static const double a[3][2] = {{1}, {1}, {34.1, 13.5}};
    static const double b[3][2] = {{0.0047, 1}, {0.0053, 1}, {0.04, 0.025}};
    double sum = 0;
    for (int i = 0; i < 2; i++)
        sum += a[channel][i] * sqrt(M_PI / b[channel][i]) *
               exp(-M_PI * M_PI * d * d / b[channel][i]);
    return sum;
}

static double pixel_at(const flip_reference *r, int picture, int channel, int x, int y)
{
    x = x < 0 ? 0 : x >= r->width ? r->width - 1 : x;
    y = y < 0 ? 0 : y >= r->height ? r->height - 1 : y;
    return r->opponent[picture][y * r->width + x][channel];
}

static double blurred(const flip_reference *r, int picture, int channel, int x, int y)
{
    int reach = (int)ceil(3 * sqrt(0.04 / (2 * M_PI * M_PI)) * r->ppd);
    double sum = 0, weights = 0;
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++) {
            double w = contrast(channel, hypot(dx, dy) / r->ppd);
            sum += w * pixel_at(r, picture, channel, x + dx, y + dy);
            weights += w;
        }
    return sum / weights;
}

// An edge or a point across (u, v) = (1, 0) or (0, 1).
static double feature_along(const flip_reference *r, int picture, bool point, int x, int y,
                            int u, int v)
{
    double sd = 0.5 * 0.082 * r->ppd, sums[2] = {0, 0}, weights[2] = {0, 0};
    int reach = (int)ceil(3 * sd);
    for (int dy = -reach; dy <= reach; dy++)
        for (int dx = -reach; dx <= reach; dx++) {
            double d = dx * u + dy * v,
                   luma = (pixel_at(r, picture, 0, x + dx, y + dy) + 16) / 116;
            double w = (point ? d * d / (sd * sd) - 1 : -d) *
                       exp(-(dx * dx + dy * dy) / (2 * sd * sd));
            sums[w > 0] += w * luma;
            weights[w > 0] += fabs(w);
        }
    return sums[0] / weights[0] + sums[1] / weights[1];
}

static double feature(const flip_reference *r, int picture, bool point, int x, int y)
{
    return hypot(feature_along(r, picture, point, x, y, 1, 0),
                 feature_along(r, picture, point, x, y, 0, 1));
}

static double flip_reference_error(const flip_reference *r, int x, int y)
{
    double lab[2][3];
    for (int p = 0; p < 2; p++) {
        double opponent[3];
        for (int c = 0; c < 3; c++) opponent[c] = blurred(r, p, c, x, y);
        lab_of(opponent, lab[p]);
    }
    double e = pow(
        fabs(lab[0][0] - lab[1][0]) + hypot(lab[0][1] - lab[1][1], lab[0][2] - lab[1][2]), 0.7);
    const double most = 41.27610, bend = 0.4 * most;
    e = e < bend ? 0.95 / bend * e : 0.95 + (e - bend) / (most - bend) * 0.05;
    double edges = fabs(feature(r, 0, false, x, y) - feature(r, 1, false, x, y));
    double points = fabs(feature(r, 0, true, x, y) - feature(r, 1, true, x, y));
    return pow(e, 1 - sqrt(fmax(edges, points) / sqrt(2)));
}

// rgba: 4 bytes a pixel.
static void flip_reference_set(flip_reference *r, int picture, const uint8_t *rgba)
{
    for (int i = 0; i < r->width * r->height; i++) {
        double rgb[3], xyz[3];
        for (int c = 0; c < 3; c++) {
            double v = rgba[4 * i + c] / 255.0;
            rgb[c] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
        }
        xyz_of(rgb, xyz);
        double *opponent = r->opponent[picture][i];
        opponent[0] = 116 * xyz[1] - 16;
        opponent[1] = 500 * (xyz[0] - xyz[1]);
        opponent[2] = 200 * (xyz[1] - xyz[2]);
    }
}

#endif
