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
    PROM_CITY_VILLA,       // with a garden around
    PROM_CITY_TREE,        // for parks, gardens and the land around
    PROM_CITY_STREET_TREE, // slim enough for a pavement
    PROM_CITY_QUAY_TREE,
    PROM_CITY_WILLOW,
    PROM_CITY_SHRUB,
    PROM_CITY_GROVE, // many trees, for far hills
    PROM_CITY_LAMP,  // on old posts
    PROM_CITY_MAST,  // modern ones
    PROM_CITY_BENCH,
    PROM_CITY_BIN,
    PROM_CITY_BOLLARD,
    PROM_CITY_SIGN,
    PROM_CITY_COLUMN, // for posters
    PROM_CITY_STALL,
    PROM_CITY_CAFE,
    PROM_CITY_FOUNTAIN,
    PROM_CITY_MONUMENT,
    PROM_CITY_CAR,
    PROM_CITY_BICYCLE,
    PROM_CITY_BOAT,
    PROM_CITY_TERRACE, // of a hillside, with vines
    PROM_CITY_TOWN_HALL,
    PROM_CITY_CHURCH,
    PROM_CITY_STONE_BRIDGE,
    PROM_CITY_FOOT_BRIDGE,
    PROM_CITY_KIND_COUNT
} prom_city_kind;

typedef enum prom_house_class {
    PROM_HOUSE_TOWN,
    PROM_HOUSE_TOWER, // with a tower at a corner
    PROM_HOUSE_ARCADE,
    PROM_HOUSE_WAREHOUSE,
    PROM_HOUSE_MODERN,
    PROM_HOUSE_VILLA,
} prom_house_class;

// An object that stands in many places. Its mesh is made when it is placed first.
typedef struct prom_city_prototype {
    prom_city_kind kind;
    uint32_t number;    // within its kind
    float width, depth; // of a house: its front, and what is behind
    bool corner;        // a house with windows to all sides
    prom_house_class class;
    int tower_side; // of a tower, as seen from the street: -1 left, 1 right
    uint32_t mesh;  // PROM_GLB_NONE until then
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
// A colour without a picture.
prom_paint prom_city_plain(prom_city *city, uint32_t rgb);
// `at_two` sides of something round at detail 2; fewer or more at others.
int prom_city_sides(const prom_city *city, int at_two);

// ---- prototypes: each adds its geometry to an empty shape; the origin is on the ground, the
// front faces +z

void prom_city_build_house(prom_city *city, const prom_city_prototype *which,
                           prom_solid *shape);
void prom_city_build_tree(prom_city *city, const prom_city_prototype *which, prom_solid *shape);
void prom_city_build_wood(prom_city *city, const prom_city_prototype *which, prom_solid *shape);
void prom_city_build_terrace(prom_city *city, const prom_city_prototype *which,
                             prom_solid *shape);
void prom_city_build_thing(prom_city *city, const prom_city_prototype *which,
                           prom_solid *shape);
void prom_city_build_square_thing(prom_city *city, const prom_city_prototype *which,
                                  prom_solid *shape);
void prom_city_build_car(prom_city *city, const prom_city_prototype *which, prom_solid *shape);
void prom_city_build_bicycle(prom_city *city, const prom_city_prototype *which,
                             prom_solid *shape);
void prom_city_build_boat(prom_city *city, const prom_city_prototype *which, prom_solid *shape);
void prom_city_build_landmark(prom_city *city, const prom_city_prototype *which,
                              prom_solid *shape);
void prom_city_build_bridge(prom_city *city, const prom_city_prototype *which,
                            prom_solid *shape);
// Of a tree or shrub, for its name.
const char *prom_city_species(prom_city_kind kind, uint32_t number);
// Fills width, depth, corner, class and tower_side of a house's prototype.
void prom_city_measure_house(const prom_city *city, prom_city_prototype *house);

// ---- kinds (city_kind.c)

void prom_city_list_prototypes(prom_city *city);
// Places a prototype: a node under `parent`.
void prom_city_place(prom_city *city, uint32_t prototype, uint32_t parent, float x, float y,
                     float z, float yaw, float scale);
// One of a kind, by lot.
void prom_city_place_any(prom_city *city, prom_city_kind kind, uint32_t parent, float x,
                         float y, float z, float yaw, float scale, prom_random *random);
uint32_t prom_city_add_group(prom_city *city, const char *name, uint32_t parent, float x,
                             float z, float yaw);
void prom_city_add_mesh(prom_city *city, const char *name, uint32_t parent, uint32_t mesh,
                        float x, float z, float yaw);

// ---- facades (city_facade.c, city_front.c)

typedef struct prom_facade {
    float width;
    uint32_t bays, storeys;
    const float *floors; // storeys + 1 heights, the first 0
    uint32_t from;       // storeys below are left out
    prom_paint wall, trim, frame, door, shutter;
    bool has_door, has_shop; // in the lowest storey
    uint32_t door_bay;
    bool surrounds, shutters, pediments, keystones;
    bool wide;          // windows of a modern house
    bool arched;        // round heads over the windows, applied
    uint32_t balconies; // bays with one, a bit each; storeys from 1 to balcony_top
    uint32_t balcony_top;
    bool flowers;             // boxes at some windows
    bool loading;             // a door in the middle of each storey
    int bars_across, bars_up; // glazing bars
    int detail;
} prom_facade;

// A wall with windows from (0,0) to (width, top) in the frame's x and y, its outside to +z.
void prom_city_build_facade(prom_city *city, prom_solid *shape, const prom_facade *facade,
                            prom_random *random);
// A glazed window in the opening [x0,x1] x [y0,y1] of a wall at z = 0, with its reveal.
void prom_city_build_window(prom_city *city, prom_solid *shape, const prom_facade *facade,
                            const float opening[4], prom_random *random);
// Before the opening `o` of a wall: a balcony, a box of flowers, a sign over a shop.
void prom_city_build_balcony(prom_city *city, prom_solid *shape, const prom_facade *facade,
                             const float o[4]);
void prom_city_build_flowers(prom_city *city, prom_solid *shape, const float o[4],
                             prom_random *random);
void prom_city_build_sign(prom_city *city, prom_solid *shape, const prom_facade *facade,
                          const float o[4], prom_random *random);

// ---- arches (city_arch.c)

#define PROM_ARCH_POINTS_MAX 40

// The outline of an opening with a round head, counter-clockwise from the lower left; `points`
// for the head. Pointed: the sides' circles have the opening's width as their radius. Returns
// the number of points.
int prom_city_arch_outline(float x0, float y0, float x1, float spring, int points, bool pointed,
                           float (*outline)[2]);
// A window on a wall at z = 0: a pane before it and a frame around that.
void prom_city_build_arch_window(prom_city *city, prom_solid *shape, prom_paint frame,
                                 const float o[4], bool pointed);
// A wall of arches at z = 0 from y = 0 to `height`, `thick` deep: its two faces and soffits.
void prom_city_build_arcade(prom_solid *shape, float width, uint32_t bays, float height,
                            float thick, int points);

// ---- roofs (city_roof.c, city_gable.c)

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

// ---- the plan (city_plan.c)

typedef enum prom_city_use {
    PROM_CITY_USE_HOUSES,
    PROM_CITY_USE_PARK,
    PROM_CITY_USE_SQUARE,
    PROM_CITY_USE_CHURCH,
} prom_city_use;

// Streets' centre lines; crossing (i, j) is at (street_x[i], street_z[j]), block (i, j) between
// the lines i and i + 1, j and j + 1. One row is the river's.
typedef struct prom_city_plan {
    uint32_t columns, rows;
    float *street_x, *street_z; // columns + 1, rows + 1
    uint32_t river;             // a row, or PROM_GLB_NONE
    uint32_t middle;            // the line of the first bridge
    prom_city_use *uses;        // columns x rows
    uint32_t square;            // the block of the town hall, or PROM_GLB_NONE; people come
                                // to it over a passage in the quay road's middle
} prom_city_plan;

#define PROM_CITY_ROAD_WIDTH 8.0f
#define PROM_CITY_PAVEMENT 3.5f
#define PROM_CITY_KERB 0.12f // height of blocks above the carriageway
#define PROM_CITY_QUAY 7.0f  // from the quay road's edge to the wall
#define PROM_CITY_WATER_WIDTH 30.0f
#define PROM_CITY_WATER_LEVEL (-2.8f)
#define PROM_CITY_BRIDGE_HALF 7.4f // width of a stone bridge, half
#define PROM_CITY_BRIDGE_RISE 1.2f
#define PROM_CITY_BRIDGE_REACH 16.5f // the deck rises within this distance of its middle
#define PROM_CITY_BAY 5.5f           // of a parked car

typedef enum prom_city_crossing {
    PROM_CITY_NO_BRIDGE,
    PROM_CITY_BRIDGE_FOR_CARS,
    PROM_CITY_BRIDGE_ON_FOOT,
} prom_city_crossing;

void prom_city_plan_init(prom_city_plan *plan, const prom_city_options *options);
void prom_city_plan_finish(prom_city_plan *plan);
// How line i gets over the river.
prom_city_crossing prom_city_bridge_at(const prom_city_plan *plan, uint32_t line);
// Height of a stone bridge's carriageway at a distance from its middle.
float prom_city_deck_height(float z);
// Height of what a person walks on at a place in the city.
float prom_city_ground_height(const prom_city_plan *plan, float x, float z);

// ---- layout (city_layout.c, city_block.c, city_square.c, city_river.c, city_land.c)

// All nodes.
void prom_city_lay_out(prom_city *city, const prom_city_plan *plan);
// What stands on a block; its ground is [0, width] x [0, depth] at the block's node.
typedef struct prom_city_site {
    prom_city *city;
    uint32_t node;
    float width, depth; // inside of the pavement
    prom_random *random;
    bool warehouses_to_south, warehouses_to_north; // rows that face the river
    bool gate;                                     // the middle of the north side is kept free
} prom_city_site;
void prom_city_fill_houses(prom_city_site *site);
void prom_city_fill_park(prom_city_site *site);
void prom_city_fill_square(prom_city_site *site, bool with_town_hall);
void prom_city_fill_church(prom_city_site *site);
// Trees, lamps and parked cars along the block's four sides.
void prom_city_fill_pavements(prom_city_site *site);
// A car, parked with its long side along the yaw's +x.
void prom_city_park_car(prom_city *city, uint32_t node, float x, float z, float yaw,
                        prom_random *random);
// The river within the city: quays, bridges, boats.
void prom_city_lay_river(prom_city *city, const prom_city_plan *plan, uint32_t root);
// The land around the city, its river and roads.
void prom_city_lay_land(prom_city *city, const prom_city_plan *plan, uint32_t root);

// ---- the ground (city_ground.c): mesh numbers, made once per size

// A block with its pavement and kerb: [0, width] x [0, depth], carriageway at y = 0.
uint32_t prom_city_block_ground(prom_city *city, prom_city_use use, float width, float depth);
// A carriageway along z of the given length, centred; prom_city_crossing: the square where two
// meet.
// `passage`: with a crossing for people on foot in its middle.
uint32_t prom_city_street_ground(prom_city *city, float length, bool passage);
uint32_t prom_city_crossing_ground(prom_city *city);
// Parking bays along a street between two crossings of this distance: their number, and the
// middle of bay i from the street's middle.
uint32_t prom_city_bays(float length);
float prom_city_bay(float length, uint32_t i);
#define PROM_CITY_PASSAGE 3.4f // half of what is kept free at a passage

// ---- grids of ground cells with a paint each (city_grid.c)

#define PROM_CUTS_MAX 512u

typedef struct prom_cuts {
    float at[PROM_CUTS_MAX];
    uint32_t count;
} prom_cuts;

// Adds cuts from the last one (or from `from`, the first) to `to`, about `cell` apart.
void prom_cut_to(prom_cuts *cuts, float from, float to, float cell);

typedef struct prom_grid {
    const prom_cuts *x, *z;
    // Paint number of the cell at a point; negative: none.
    int (*paint_of)(const void *user, float x, float z);
    float (*height_of)(const void *user, float x, float z); // NULL: `y`
    // Moves a corner after its height is known; NULL: not at all.
    void (*shift)(const void *user, float *x, float *z);
    float y;
    const void *user;
} prom_grid;

// The cells of one paint, connected where they touch. Neighbours of another paint have the same
// corners, so that no gap can show.
void prom_grid_build(prom_solid *shape, const prom_grid *grid, int paint);

// ---- ways (city_walk.c)

// 600 keys through streets, over the river, along the quay and into the square, at a person's
// height; and in the air, around the city.
void prom_city_walk(const prom_city_plan *plan, prom_path *path);
void prom_city_flight(const prom_city_plan *plan, prom_path *path);

#endif
