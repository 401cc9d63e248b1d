#include "benefit/grey.h"

#include <string.h>

#define RED 0.2126f
#define GREEN 0.7152f
#define BLUE 0.0722f

// The loops' strides are constants, so that they are vectorised.
static void grey_of_bytes(const uint8_t *restrict in, uint32_t channels, uint32_t width,
                          float *restrict out)
{
    const float scale = 1.0f / 255.0f;
    if (channels == 1)
        for (size_t x = 0; x < width; x++) out[x] = scale * (float)in[x];
    else if (channels == 3)
        for (size_t x = 0; x < width; x++)
            out[x] = scale * (RED * (float)in[3 * x] + GREEN * (float)in[3 * x + 1] +
                              BLUE * (float)in[3 * x + 2]);
    else
        for (size_t x = 0; x < width; x++)
            out[x] = scale * (RED * (float)in[4 * x] + GREEN * (float)in[4 * x + 1] +
                              BLUE * (float)in[4 * x + 2]);
}

static void grey_of_floats(const float *restrict in, uint32_t channels, uint32_t width,
                           float *restrict out)
{
    if (channels == 1)
        memcpy(out, in, width * sizeof *out);
    else
        for (size_t x = 0; x < width; x++) {
            const float *p = in + channels * x;
            out[x] = RED * p[0] + GREEN * p[1] + BLUE * p[2];
        }
}

void prom_grey_row(const prom_picture *picture, uint32_t y, float *row)
{
    const uint32_t channels = picture->channels;
    const size_t value = picture->floats ? sizeof(float) : 1;
    const size_t close = picture->width * channels * value;
    const size_t step = picture->row_bytes ? picture->row_bytes : close;
    const uint8_t *in = (const uint8_t *)picture->pixels + y * step;
    if (picture->floats)
        grey_of_floats((const float *)(const void *)in, channels, picture->width, row);
    else
        grey_of_bytes(in, channels, picture->width, row);
}
