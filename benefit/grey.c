#include "benefit/grey.h"

#include "benefit/metric_private.h"

#include <math.h>
#include <string.h>

#define RED 0.2126f
#define GREEN 0.7152f
#define BLUE 0.0722f

// ---- luma

// The number of channels is a constant to each loop, so that it is vectorised.
static void grey_of_bytes(const uint8_t *restrict in, uint32_t channels, uint32_t width,
                          float *restrict out)
{
    const float red = RED / 255, green = GREEN / 255, blue = BLUE / 255;
    if (channels == 1)
        for (size_t x = 0; x < width; x++) out[x] = (float)in[x] / 255.0f;
    else if (channels == 3)
        for (size_t x = 0; x < width; x++)
            out[x] = red * (float)in[3 * x] + green * (float)in[3 * x + 1] +
                     blue * (float)in[3 * x + 2];
    else
        for (size_t x = 0; x < width; x++)
            out[x] = red * (float)in[4 * x] + green * (float)in[4 * x + 1] +
                     blue * (float)in[4 * x + 2];
}

static void grey_of_floats(const float *restrict in, uint32_t channels, uint32_t width,
                           float *restrict out)
{
    if (channels == 1)
        memcpy(out, in, width * sizeof *out);
    else
        for (size_t x = 0; x < width; x++, in += channels)
            out[x] = RED * in[0] + GREEN * in[1] + BLUE * in[2];
}

void prom_grey_row(const prom_picture *picture, uint32_t y, float *row)
{
    const void *in = prom_picture_row(picture, y);
    if (picture->floats)
        grey_of_floats(in, picture->channels, picture->width, row);
    else
        grey_of_bytes(in, picture->channels, picture->width, row);
}

typedef struct plane_job {
    const prom_picture *picture;
    float *plane;
} plane_job;

static void plane_band(void *user, uint32_t first, uint32_t last, void *scratch)
{
    (void)scratch;
    const plane_job *job = user;
    for (uint32_t y = first; y < last; y++)
        prom_grey_row(job->picture, y, job->plane + (size_t)y * job->picture->width);
}

void prom_grey_plane(prom_bands *bands, const prom_picture *picture, float *plane)
{
    prom_bands_run(bands, picture->height, plane_band, &(plane_job){picture, plane});
}

// ---- borders

uint32_t prom_border_index(prom_border border, int64_t i, uint32_t count)
{
    const int64_t n = count;
    if (i >= 0 && i < n) return (uint32_t)i;
    if (border == PROM_BORDER_REPLICATE) return i < 0 ? 0 : count - 1;
    i = (i % (2 * n) + 2 * n) % (2 * n);
    return (uint32_t)(i < n ? i : 2 * n - 1 - i);
}

void prom_border_row(prom_border border, float *row, uint32_t width, uint32_t pad)
{
    for (int64_t i = 1; i <= pad; i++) {
        const int64_t after = (int64_t)width - 1 + i;
        row[-i] = row[prom_border_index(border, -i, width)];
        row[after] = row[prom_border_index(border, after, width)];
    }
}

size_t prom_grey_band_floats(uint32_t width, uint32_t pad)
{
    return (PROM_BAND_ROWS + 2 * (size_t)pad) * (width + 2 * (size_t)pad);
}

void prom_grey_band(const prom_picture *picture, uint32_t first, uint32_t last, uint32_t pad,
                    prom_border border, float *band)
{
    const uint32_t width = picture->width;
    float *row = band + pad;
    for (int64_t y = (int64_t)first - pad; y < (int64_t)last + pad; y++) {
        prom_grey_row(picture, prom_border_index(border, y, picture->height), row);
        prom_border_row(border, row, width, pad);
        row += width + 2 * (size_t)pad;
    }
}

// ---- edges, differences

void prom_grey_edges(const float *above, size_t stride, uint32_t width, float scale,
                     float *edges)
{
    const float *restrict a = above, *restrict h = above + stride, *restrict b = h + stride;
    float *restrict out = edges;
    for (int64_t x = 0; x < width; x++) {
        float rising = b[x + 1] - a[x - 1], falling = a[x + 1] - b[x - 1];
        float gx = rising + falling + 2.0f * (h[x + 1] - h[x - 1]);
        float gy = rising - falling + 2.0f * (b[x] - a[x]);
        out[x] = scale * sqrtf(gx * gx + gy * gy);
    }
}

typedef struct difference_job {
    const float *a, *b;
    uint32_t width;
    float *map;
} difference_job;

static void difference_band(void *user, uint32_t first, uint32_t last, void *scratch)
{
    (void)scratch;
    const difference_job *job = user;
    const float *restrict a = job->a, *restrict b = job->b;
    float *restrict map = job->map;
    const size_t end = (size_t)last * job->width;
    for (size_t i = (size_t)first * job->width; i < end; i++) map[i] = fabsf(a[i] - b[i]);
}

void prom_grey_difference(prom_bands *bands, const float *a, const float *b, uint32_t width,
                          uint32_t height, float *map)
{
    prom_bands_run(bands, height, difference_band, &(difference_job){a, b, width, map});
}
