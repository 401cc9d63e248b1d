// Noise and colours for the gallery's pictures and sculptures. Private to scenes/gallery*.c.
#ifndef PROM_SCENES_GALLERY_NOISE_H
#define PROM_SCENES_GALLERY_NOISE_H

#include <stdint.h>

// sRGB-encoded.
typedef struct prom_gallery_color {
    float r, g, b;
} prom_gallery_color;

prom_gallery_color prom_color_grey(float tone);
prom_gallery_color prom_color_rgb(uint32_t rgb); // 0xRRGGBB
prom_gallery_color prom_color_shade(prom_gallery_color c, float factor);
prom_gallery_color prom_color_mix(prom_gallery_color a, prom_gallery_color b, float t);

// In [0,1), from whole coordinates.
float prom_noise_cell(int x, int y, uint32_t seed);
// Value noise of [0,1): over the unit square, repeating after 1; `cells` along each side.
float prom_noise_tile(float x, float y, int cells, uint32_t seed);
// Four octaves of it, about [-0.5, 0.5].
float prom_noise_rough(float x, float y, int cells, uint32_t seed);
// Two octaves of value noise in space, about [-0.5, 0.5]; cells of 1.
float prom_noise_space(float x, float y, float z, uint32_t seed);
// 0 below a, 1 above b, smooth between; a < b.
float prom_noise_step(float a, float b, float x);

#endif
