#include "app/warp.h"

#include "metaobj/base/math.h"

#include <math.h>
#include <string.h>

// How far two depths of one point may be apart, as a share. Interpolated depths are exact on
// planes; what is left is curvature, and edges that are mixed no further (chosen by taste).
#define DEPTH_TOLERANCE 0.01
// The same of places, in pixels: rounding must not push a border out of the picture.
#define PLACE_TOLERANCE 1e-4

typedef struct pinhole {
    double rotation[3][3]; // camera to world, by columns
    double eye[3];
    double focal; // in pixels
    double near, center[2];
} pinhole;

static void pinhole_init(pinhole *p, const prom_camera *camera)
{
    double q[4], length = 0;
    for (int i = 0; i < 4; i++)
        length += (double)camera->orientation[i] * (double)camera->orientation[i];
    for (int i = 0; i < 4; i++) q[i] = (double)camera->orientation[i] / sqrt(length);
    double x = q[0], y = q[1], z = q[2], w = q[3];
    const double columns[3][3] = {
        {1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y)},
        {2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)},
        {2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)},
    };
    memcpy(p->rotation, columns, sizeof columns);
    memcpy(p->eye, camera->eye, sizeof p->eye);
    p->focal = 0.5 * camera->height / tan((double)camera->fov_y * 0.5);
    p->near = (double)camera->z_near;
    p->center[0] = 0.5 * camera->width - 0.5;
    p->center[1] = 0.5 * camera->height - 0.5;
}

// The point of a pixel relative to the eye, in the world's axes, times its inverse distance
// along the view, so that infinity needs no case of its own.
static void direction_of(const pinhole *p, double x, double y, double direction[3])
{
    const double view[3] = {(x - p->center[0]) / p->focal, (p->center[1] - y) / p->focal, -1};
    for (int i = 0; i < 3; i++)
        direction[i] = p->rotation[0][i] * view[0] + p->rotation[1][i] * view[1] +
                       p->rotation[2][i] * view[2];
}

// Where a point is seen, and its inverse distance for one that was `inverse`; false: behind.
static bool project(const pinhole *p, const double point[3], double inverse, double place[2],
                    double *inverse_there)
{
    double view[3];
    for (int i = 0; i < 3; i++)
        view[i] = p->rotation[i][0] * point[0] + p->rotation[i][1] * point[1] +
                  p->rotation[i][2] * point[2];
    if (!(-view[2] > 1e-9)) return false;
    place[0] = p->center[0] + p->focal * view[0] / -view[2];
    place[1] = p->center[1] - p->focal * view[1] / -view[2];
    *inverse_there = inverse / -view[2];
    return true;
}

// The four pixels around a place, and the parts that they have in it.
typedef struct taps {
    size_t at[4];
    double part[4];
} taps;

static taps taps_of(double x, double y, uint32_t width, uint32_t height)
{
    uint32_t left = (uint32_t)x, top = (uint32_t)y;
    uint32_t right = left + 1 < width ? left + 1 : left;
    uint32_t bottom = top + 1 < height ? top + 1 : top;
    double u = x - left, v = y - top;
    size_t upper = (size_t)top * width, lower = (size_t)bottom * width;
    return (taps){{upper + left, upper + right, lower + left, lower + right},
                  {(1 - u) * (1 - v), u * (1 - v), (1 - u) * v, u * v}};
}

// Within the picture, up to rounding; the place is put inside.
static bool put_inside(double *place, uint32_t size)
{
    double last = (double)size - 1;
    if (!(*place >= -PLACE_TOLERANCE && *place <= last + PLACE_TOLERANCE)) return false;
    *place = fmin(fmax(*place, 0), last);
    return true;
}

// Whether what is there is as far as expected, compared with the nearest pixel around.
static bool depth_agrees(const float *depth, const taps *around, double expected)
{
    double found = 0, nearest = 0;
    for (int i = 0; i < 4; i++) {
        double tap = (double)depth[around->at[i]];
        found += around->part[i] * tap;
        nearest = fmax(nearest, tap);
    }
    return fabs(found - expected) <= DEPTH_TOLERANCE * nearest;
}

static bool find_place(const pinhole *before, const pinhole *now, const prom_warp_view *there,
                       const double direction[3], double depth, double place[2])
{
    uint32_t width = there->camera.width, height = there->camera.height;
    double inverse = depth / now->near, point[3], expected;
    for (int i = 0; i < 3; i++)
        point[i] = direction[i] + inverse * (now->eye[i] - before->eye[i]);
    if (!project(before, point, inverse, place, &expected)) return false;
    if (!put_inside(&place[0], width) || !put_inside(&place[1], height)) return false;
    taps around = taps_of(place[0], place[1], width, height);
    return depth_agrees(there->depth, &around, expected * before->near);
}

size_t prom_warp_find(const prom_warp_view *before, const prom_warp_view *now, float (*from)[2])
{
    pinhole p, q;
    pinhole_init(&p, &before->camera);
    pinhole_init(&q, &now->camera);
    uint32_t width = now->camera.width, height = now->camera.height;
    size_t i = 0, found = 0;
    for (uint32_t y = 0; y < height; y++)
        for (uint32_t x = 0; x < width; x++, i++) {
            double direction[3], place[2];
            direction_of(&q, x, y, direction);
            bool there = find_place(&p, &q, before, direction, (double)now->depth[i], place);
            from[i][0] = there ? (float)place[0] : NAN;
            from[i][1] = there ? (float)place[1] : NAN;
            found += there;
        }
    return found;
}

static void sample(const taps *around, const uint8_t *rgba, float rgb[3])
{
    for (int c = 0; c < 3; c++) {
        double sum = 0;
        for (int i = 0; i < 4; i++)
            sum += around->part[i] * (double)prom_srgb8_to_linear(rgba[4 * around->at[i] + c]);
        rgb[c] = (float)sum;
    }
}

void prom_warp_apply(const float (*from)[2], uint32_t width, uint32_t height,
                     const uint8_t *before, const uint8_t *now, float (*warped)[3])
{
    size_t pixels = (size_t)width * height;
    for (size_t i = 0; i < pixels; i++) {
        if (isnan(from[i][0])) {
            for (int c = 0; c < 3; c++) warped[i][c] = prom_srgb8_to_linear(now[4 * i + c]);
            continue;
        }
        taps around = taps_of((double)from[i][0], (double)from[i][1], width, height);
        sample(&around, before, warped[i]);
    }
}
