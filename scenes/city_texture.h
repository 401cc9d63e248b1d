// The city's pictures, computed: brick, plaster, tiles, grass, leaves and so on. Those of
// walls, roofs, wood and metal are near white, for a material's colour to tint them. Most of
// them repeat.
#ifndef PROM_SCENES_CITY_TEXTURE_H
#define PROM_SCENES_CITY_TEXTURE_H

#include <stdbool.h>
#include <stdint.h>

typedef enum prom_city_texture {
    PROM_CITY_PLAIN, // no picture
    PROM_CITY_BRICK,
    PROM_CITY_PLASTER,
    PROM_CITY_STONE,
    PROM_CITY_TILES,
    PROM_CITY_SLATE,
    PROM_CITY_WOOD,
    PROM_CITY_ASPHALT,
    PROM_CITY_ROAD, // across the carriageway, with parking bays; 11 m long
    PROM_CITY_LANE, // the same without
    PROM_CITY_ZEBRA,
    PROM_CITY_PAVING,
    PROM_CITY_COBBLES,
    PROM_CITY_GRASS,
    PROM_CITY_GRAVEL,
    PROM_CITY_ROWS,
    PROM_CITY_BARK,
    PROM_CITY_PLANE_BARK,
    PROM_CITY_BIRCH,
    PROM_CITY_WINDOW_DARK,
    PROM_CITY_WINDOW_CURTAIN,
    PROM_CITY_WINDOW_WARM,
    PROM_CITY_WINDOW_WIDE,
    PROM_CITY_AWNING,
    PROM_CITY_SIGNS, // PROM_CITY_SIGN_COUNT names, one below the other
    PROM_CITY_CLOCK,
    PROM_CITY_POSTERS,
    PROM_CITY_WATER,
    PROM_CITY_LEAVES_BROAD,
    PROM_CITY_LEAVES_SMALL,
    PROM_CITY_LEAVES_RED,
    PROM_CITY_LEAVES_HANGING,
    PROM_CITY_NEEDLES,
    PROM_CITY_TEXTURE_COUNT
} prom_city_texture;

#define PROM_CITY_SIGN_COUNT 8

const char *prom_city_texture_name(prom_city_texture texture);
// The width and height in pixels; 0 for PROM_CITY_PLAIN.
uint32_t prom_city_texture_size(prom_city_texture texture);
// Has an alpha channel to be tested against 0.5; outside colour goes on.
bool prom_city_texture_masked(prom_city_texture texture);
// Fills size x size x 4 bytes, sRGB with straight alpha, first row on top.
void prom_city_texture_draw(prom_city_texture texture, uint8_t *rgba);

#endif
