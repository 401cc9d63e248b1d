// The sRGB transfer curve (IEC 61966-2-1) and its 8-bit tables.
#include "metaobj/base/math.h"

#define BUCKETS 4096

// Filled once before main and only read afterwards.
static struct {
    float linear[256];          // of each 8-bit value
    float threshold[257];       // least linear value that rounds to this 8-bit value
    uint8_t guess[BUCKETS + 1]; // 8-bit value at a bucket's low end
} tables;

float prom_srgb_to_linear(float encoded)
{
    if (!(encoded > 0)) return 0;
    if (encoded >= 1) return 1;
    return encoded <= 0.04045f ? encoded / 12.92f : powf((encoded + 0.055f) / 1.055f, 2.4f);
}

float prom_linear_to_srgb(float linear)
{
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 1;
    return linear <= 0.0031308f ? linear * 12.92f : 1.055f * powf(linear, 1 / 2.4f) - 0.055f;
}

__attribute__((constructor)) static void fill_tables(void)
{
    for (int i = 0; i < 256; i++) tables.linear[i] = prom_srgb_to_linear((float)i / 255.0f);
    tables.threshold[0] = 0;
    for (int i = 1; i < 256; i++)
        tables.threshold[i] = prom_srgb_to_linear(((float)i - 0.5f) / 255.0f);
    tables.threshold[256] = INFINITY;
    int value = 0;
    for (int b = 0; b <= BUCKETS; b++) {
        while (tables.threshold[value + 1] <= (float)b / BUCKETS) value++;
        tables.guess[b] = (uint8_t)value;
    }
}

float prom_srgb8_to_linear(uint8_t encoded)
{
    return tables.linear[encoded];
}

// A bucket is narrower than the steepest step of the curve (255 * 12.92 / 4096 < 1), so the
// guess is at most one too low.
uint8_t prom_linear_to_srgb8(float linear)
{
    if (!(linear > 0)) return 0;
    if (linear >= 1) return 255;
    unsigned guess = tables.guess[(int)(linear * BUCKETS)];
    return (uint8_t)(guess + (linear >= tables.threshold[guess + 1]));
}
