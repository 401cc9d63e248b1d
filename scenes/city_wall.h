// Pieces of facades. Private to scenes/city*.c; walls stand at z = 0 and look to +z, openings
// are rectangles {x0, y0, x1, y1}.
#ifndef PROM_SCENES_CITY_WALL_H
#define PROM_SCENES_CITY_WALL_H

#include "scenes/city_parts.h"

#define PROM_REVEAL 0.14f
#define PROM_DOOR_STEP 0.16f
#define PROM_OPENINGS_MAX 64u

typedef enum prom_opening_kind {
    PROM_OPENING_WINDOW,
    PROM_OPENING_DOOR,
    PROM_OPENING_SHOP,
    PROM_OPENING_LOADING,
} prom_opening_kind;

typedef struct prom_opening {
    float x0, y0, x1, y1;
    prom_opening_kind kind;
    uint32_t storey, bay;
} prom_opening;

// One connected grid with the openings left out: no edge ends in the middle of another.
void prom_wall_build(prom_solid *shape, float width, float bottom, float top,
                     const prom_opening *openings, uint32_t count);
// The sides of an opening from z = 0 to z = -depth, facing inwards.
void prom_wall_reveal(prom_solid *shape, const float o[4], float depth, bool bottom);
// A mitred frame of thickness t inside a rectangle, from z0 out to z1: front and inner faces.
void prom_wall_ring(prom_solid *shape, const float o[4], float t, float z0, float z1);
void prom_wall_glass(prom_city *city, prom_solid *shape, const float o[4], float z, bool wide,
                     prom_random *random);
void prom_wall_bars(prom_solid *shape, const float o[4], int across, int up, float z);
void prom_wall_shutter(prom_solid *shape, const prom_facade *f, float x0, float y0, float x1,
                       float y1);
void prom_wall_surround(prom_solid *shape, const prom_facade *f, const float o[4],
                        bool pediment);

// In city_front.c
void prom_front_door(prom_city *city, prom_solid *shape, const prom_facade *f, const float o[4],
                     prom_random *random);
void prom_front_shop(prom_city *city, prom_solid *shape, const prom_facade *f, const float o[4],
                     bool awning, prom_random *random);
// A warehouse's doors through which goods are hoisted.
void prom_front_loading(prom_solid *shape, const prom_facade *f, const float o[4]);

#endif
