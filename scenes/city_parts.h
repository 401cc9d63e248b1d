// What the city's sources share: the city under construction, its paints and prototypes.
// Private to scenes/city*.c.
#ifndef PROM_SCENES_CITY_PARTS_H
#define PROM_SCENES_CITY_PARTS_H

#include "scenes/city.h"
#include "scenes/city_texture.h"
#include "scenes/path.h"
#include "scenes/random.h"
#include "scenes/solid.h"

#include <stdbool.h>

typedef enum prom_city_kind {
    PROM_CITY_HOUSE,
    PROM_CITY_TREE,        // broad, for parks and gardens
    PROM_CITY_STREET_TREE, // slim enough for a pavement
    PROM_CITY_SHRUB,
    PROM_CITY_LAMP,
    PROM_CITY_BENCH,
    PROM_CITY_CAR,
    PROM_CITY_BIN,
    PROM_CITY_FOUNTAIN,
    PROM_CITY_STALL,
    PROM_CITY_KIND_COUNT
} prom_city_kind;

// An object that stands in many places. Its mesh is made when it is placed first.
typedef struct prom_city_prototype {
    prom_city_kind kind;
    uint32_t number;    // within its kind
    float width, depth; // of a house: its front, and what is behind
    bool corner;        // a house with windows to all sides
    uint32_t mesh;      // PROM_GLB_NONE until then
    uint32_t uses;
} prom_city_prototype;

typedef struct prom_city_paint_record {
    prom_city_texture texture;
    uint32_t rgb, material;
} prom_city_paint_record;

// A ground mesh, shared by all blocks and streets of its size.
typedef struct prom_city_ground {
    int use;
    float width, depth;
    uint32_t mesh;
} prom_city_ground;

typedef struct prom_city {
    prom_city_options options; // without zeros
    prom_glb *glb;
    prom_error error; // of a picture that could not be encoded
    uint32_t images[PROM_CITY_TEXTURE_COUNT];
    PROM_ARRAY(prom_city_paint_record) paints;
    PROM_ARRAY(prom_city_prototype) prototypes; // by kind
    uint32_t first[PROM_CITY_KIND_COUNT + 1];   // of each kind
    PROM_ARRAY(prom_city_ground) grounds;
} prom_city;

// ---- paints (city_paint.c)

// A texture with a tint (0xRRGGBB, sRGB); `repeat` metres a picture. Equal ones share a
// material.
prom_paint prom_city_paint(prom_city *city, prom_city_texture texture, uint32_t rgb,
                           float repeat);

// ---- prototypes (city_house.c, city_tree.c, city_street.c): each adds its geometry to an
// empty shape; the origin is on the ground, the front faces +z

void prom_city_build_house(prom_city *city, const prom_city_prototype *which,
                           prom_solid *shape);
void prom_city_build_tree(prom_city *city, const prom_city_prototype *which, prom_solid *shape);
void prom_city_build_thing(prom_city *city, const prom_city_prototype *which,
                           prom_solid *shape);
// Of a tree or shrub, for its name.
const char *prom_city_species(prom_city_kind kind, uint32_t number);
// Fills width, depth and corner of a house's prototype.
void prom_city_measure_house(const prom_city *city, prom_city_prototype *house);

// ---- facades (city_facade.c)

typedef struct prom_facade {
    float width;
    uint32_t bays, storeys;
    const float *floors; // storeys + 1 heights, the first 0
    prom_paint wall, trim, frame, door, shutter;
    bool has_door, has_shop; // in the lowest storey
    uint32_t door_bay;
    bool surrounds, shutters, pediments, keystones, balcony;
    int bars_across, bars_up; // glazing bars
    int detail;
} prom_facade;

// A wall with windows from (0,0) to (width, top) in the frame's x and y, its outside to +z.
void prom_city_build_facade(prom_city *city, prom_solid *shape, const prom_facade *facade,
                            prom_random *random);
// A glazed window in the opening [x0,x1] x [y0,y1] of a wall at z = 0, with its reveal.
void prom_city_build_window(prom_city *city, prom_solid *shape, const prom_facade *facade,
                            const float opening[4], prom_random *random);

// ---- roofs (city_roof.c)

typedef enum prom_roof_kind {
    PROM_ROOF_GABLE, // ridge along the street
    PROM_ROOF_FRONT_GABLE,
    PROM_ROOF_STEPPED_GABLE,
    PROM_ROOF_HIP, // only where all sides are free
    PROM_ROOF_MANSARD,
    PROM_ROOF_FLAT,
    PROM_ROOF_KIND_COUNT
} prom_roof_kind;

typedef struct prom_roof {
    prom_roof_kind kind;
    float width, depth, base; // of the house; height of its walls
    float pitch;              // rise / run
    float side_overhang;      // hardly any in a row, but no face may lie in another's plane
    prom_paint cover, wall, trim, brick;
    uint32_t dormers, chimneys;
    prom_facade window; // of dormers
    int detail;
} prom_roof;

// Over x in [-width/2, width/2], z in [-depth, 0].
void prom_city_build_roof(prom_city *city, prom_solid *shape, const prom_roof *roof,
                          prom_random *random);

// ---- layout (city_layout.c)

// Streets' centre lines and blocks; crossing (i, j) is at (street_x[i], street_z[j]).
typedef struct prom_city_plan {
    uint32_t blocks;
    float *street_x, *street_z; // blocks + 1 each
} prom_city_plan;

#define PROM_CITY_ROAD_WIDTH 8.0f
#define PROM_CITY_PAVEMENT 3.5f
#define PROM_CITY_KERB 0.12f // height of blocks above the carriageway

void prom_city_plan_init(prom_city_plan *plan, const prom_city_options *options);
void prom_city_plan_finish(prom_city_plan *plan);
// All nodes.
void prom_city_lay_out(prom_city *city, const prom_city_plan *plan);
// Places a prototype: a node under `parent`.
void prom_city_place(prom_city *city, uint32_t prototype, uint32_t parent, float x, float y,
                     float z, float yaw, float scale);
// The houses, or the trees and seats, of one block (city_block.c); its inner ground, without
// the pavement, is [0, width] x [0, depth] at (x, z) of the block's node.
typedef enum prom_city_use {
    PROM_CITY_USE_HOUSES,
    PROM_CITY_USE_PARK,
    PROM_CITY_USE_SQUARE,
} prom_city_use;
void prom_city_fill_block(prom_city *city, uint32_t node, prom_city_use use, float width,
                          float depth, prom_random *random);

// ---- the ground (city_ground.c): mesh numbers, made once per size

// A block with its pavement and kerb: [0, width] x [0, depth], carriageway at y = 0.
uint32_t prom_city_block_ground(prom_city *city, prom_city_use use, float width, float depth);
// A carriageway along z of the given length, centred; prom_city_crossing: the square where two
// meet.
uint32_t prom_city_street_ground(prom_city *city, float length);
uint32_t prom_city_crossing_ground(prom_city *city);
// The land around the city, outside of [x0, x1] x [z0, z1]: four meshes.
void prom_city_land(prom_city *city, float x0, float z0, float x1, float z1, uint32_t parent);

// ---- the walk (city_walk.c)

// 600 keys along the streets in the middle of the city.
void prom_city_walk(const prom_city_plan *plan, prom_path *path);

#endif
