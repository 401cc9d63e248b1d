// How a house looks, drawn by lot from the city's seed. Private to scenes/city*.c.
#ifndef PROM_SCENES_CITY_STYLE_H
#define PROM_SCENES_CITY_STYLE_H

#include "scenes/city_parts.h"

// What is drawn by lot for a house.
typedef struct prom_house_style {
    prom_house_class class;
    int tower_side;
    float width, depth;
    uint32_t storeys, bays, door_bay, wall_rgb, trim_rgb, roof_rgb, door_rgb, shutter_rgb;
    float floors[7];
    prom_city_texture wall, cover;
    float pitch;
    prom_roof_kind roof;
    bool corner, shop, shutters, pediments, keystones, surrounds, courses, quoins, flowers;
    uint32_t balconies, balcony_top;
    int bars_across, bars_up;
    uint32_t dormers, chimneys;
} prom_house_style;

// Of the house or villa that a prototype is.
prom_house_style prom_city_draw_style(const prom_city *city, const prom_city_prototype *house);

#endif
