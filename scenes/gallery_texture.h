// Procedural pictures of the gallery's surfaces. Private to scenes/gallery*.c.
#ifndef PROM_SCENES_GALLERY_TEXTURE_H
#define PROM_SCENES_GALLERY_TEXTURE_H

#include "scenes/gallery_noise.h"

#include <stdbool.h>

// Tileable but the sky, the carpet and the label; grey ones are for tinting.
typedef enum prom_gallery_texture {
    PROM_GALLERY_PLAIN, // no picture
    PROM_GALLERY_HERRINGBONE,
    PROM_GALLERY_PANELS,
    PROM_GALLERY_BOARDS,
    PROM_GALLERY_CHECKER,
    PROM_GALLERY_SLABS,
    PROM_GALLERY_HEXAGONS,
    PROM_GALLERY_TERRAZZO,
    PROM_GALLERY_PLASTER,
    PROM_GALLERY_DAMASK,
    PROM_GALLERY_STRIPES,
    PROM_GALLERY_ASHLAR,
    PROM_GALLERY_WOOD,
    PROM_GALLERY_MARBLE,
    PROM_GALLERY_METAL,
    PROM_GALLERY_FABRIC,
    PROM_GALLERY_CARPET,
    PROM_GALLERY_BOOKS,
    PROM_GALLERY_CERAMIC,
    PROM_GALLERY_BLUE_WHITE,
    PROM_GALLERY_RED_FIGURE,
    PROM_GALLERY_LABEL,
    PROM_GALLERY_GRASS,
    PROM_GALLERY_GRAVEL,
    PROM_GALLERY_LEAVES,
    PROM_GALLERY_SKY,
    PROM_GALLERY_TEXTURE_COUNT
} prom_gallery_texture;

const char *prom_gallery_texture_name(prom_gallery_texture texture);
// Width and height in pixels that show all of it; 0 for PROM_GALLERY_PLAIN.
uint32_t prom_gallery_texture_size(prom_gallery_texture texture);
// Fills size x size x 3 bytes, sRGB, first row on top.
void prom_gallery_texture_draw(prom_gallery_texture texture, uint32_t size, uint8_t *rgb);

// A painting, different for each number: a landscape, a portrait, an abstract composition or a
// still life, for a frame of about width / height = aspect. size x size x 3 bytes.
void prom_gallery_picture_draw(uint64_t seed, uint32_t number, float aspect, uint32_t size,
                               uint8_t *rgb);

#endif
