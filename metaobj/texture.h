// Textures: square or rectangular RGBA8 pictures with stored mips, in one or more layers.
#ifndef PROM_METAOBJ_TEXTURE_H
#define PROM_METAOBJ_TEXTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef enum prom_texture_kind {
    PROM_TEXTURE_COLOR = 0,        // 1 layer: a material's sRGB colour with straight alpha
    PROM_TEXTURE_IMPOSTOR_LIT = 1, // 6 layers: sRGB lit colour per face, alpha = coverage
    PROM_TEXTURE_IMPOSTOR_ALBEDO = 2, // 12 layers: per face sRGB albedo, then per face
                                      // object-space normals (n/2 + 1/2, linear)
    PROM_TEXTURE_KIND_COUNT
} prom_texture_kind;

// All levels down to 1x1 follow each other, level by level, in each level layer by layer, in each
// layer row by row from the top, 4 bytes a pixel.
typedef struct prom_texture {
    uint32_t kind;
    uint32_t width, height, layers, levels;
    uint8_t *pixels;
} prom_texture;

#define PROM_TEXTURE_MAX 8192u

// Layers that a kind has; 0 for an unknown kind.
uint32_t prom_texture_kind_layers(uint32_t kind);
// Number of levels down to 1x1.
uint32_t prom_texture_full_levels(uint32_t width, uint32_t height);
// Bytes of all levels; 0 if a size is 0, over PROM_TEXTURE_MAX or inconsistent.
size_t prom_texture_bytes(const prom_texture *texture);
// Bytes before the given level and layer.
size_t prom_texture_offset(const prom_texture *texture, uint32_t level, uint32_t layer);

// Allocates (zeroed) pixels for all levels.
void prom_texture_init(prom_texture *texture, prom_texture_kind kind, uint32_t width,
                       uint32_t height);
void prom_texture_finish(prom_texture *texture);
// Fills levels 1.. from level 0: 2x2 box filter in linear light, alpha-weighted; normal layers
// are averaged and renormalised. With alpha_cutoff > 0 each level's alpha is rescaled so that the
// share of texels at or above the cutoff stays that of level 0 (Castaño 2010).
void prom_texture_make_mips(prom_texture *texture, float alpha_cutoff);
// Spreads the colour (not the alpha) of covered texels of level 0 into uncovered ones, `rings`
// texels far and the rest with the mean, so that filtering finds no foreign colour.
void prom_texture_dilate(prom_texture *texture, int rings);
uint64_t prom_texture_hash(const prom_texture *texture, uint64_t seed);

#endif
