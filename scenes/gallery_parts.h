// What the gallery's sources share: the gallery under construction, its paints, its walls and
// its things. Private to scenes/gallery*.c.
#ifndef PROM_SCENES_GALLERY_PARTS_H
#define PROM_SCENES_GALLERY_PARTS_H

#include "scenes/gallery_plan.h"
#include "scenes/gallery_texture.h"
#include "scenes/path.h"
#include "scenes/random.h"
#include "scenes/solid.h"

// ---- things: objects that stand in many places, in variants

typedef enum prom_gallery_thing {
    // Sculptures, without pedestals.
    PROM_GALLERY_STATUE,
    PROM_GALLERY_BUST,
    PROM_GALLERY_ABSTRACT,
    PROM_GALLERY_MODEL, // small
    // Exhibits for vitrines, up to 0.3 m.
    PROM_GALLERY_VASE,
    PROM_GALLERY_BOWL,
    PROM_GALLERY_CRYSTAL,
    PROM_GALLERY_SHELL,
    PROM_GALLERY_COINS,
    PROM_GALLERY_MASK,
    // Stands. A vitrine's floor is at a height of its own.
    PROM_GALLERY_PEDESTAL, // 1 m high
    PROM_GALLERY_PLINTH,   // 0.5 m high
    PROM_GALLERY_TABLE_VITRINE,
    PROM_GALLERY_TALL_VITRINE,
    // Furniture.
    PROM_GALLERY_BENCH,
    PROM_GALLERY_CHAIR,
    PROM_GALLERY_ARMCHAIR,
    PROM_GALLERY_DESK,
    PROM_GALLERY_TABLE,
    PROM_GALLERY_CONSOLE,
    PROM_GALLERY_BOOKCASE,
    PROM_GALLERY_PLANT,
    PROM_GALLERY_COLUMN, // of the hall, up to the slab of its gallery
    PROM_GALLERY_ROPES,  // a square of barriers, 2.4 m
    PROM_GALLERY_LAMP,
    PROM_GALLERY_RADIATOR,
    PROM_GALLERY_RUG,
    PROM_GALLERY_GLOBE,
    // Hanging from their origin.
    PROM_GALLERY_CHANDELIER,
    PROM_GALLERY_PENDANT,
    PROM_GALLERY_SCONCE,
    // Outside.
    PROM_GALLERY_TREE,
    PROM_GALLERY_HEDGE,
    PROM_GALLERY_FOUNTAIN,
    PROM_GALLERY_THING_COUNT
} prom_gallery_thing;

#define PROM_GALLERY_VARIANTS_MAX 32u
#define PROM_GALLERY_SLAB 0.5f       // thickness of the hall's gallery floor
#define PROM_GALLERY_TABLE_TOP 0.86f // floors of the vitrines
#define PROM_GALLERY_TALL_TOP 0.62f
#define PROM_GALLERY_TALL_SHELF 1.24f

typedef struct prom_gallery_paint_record {
    prom_gallery_texture texture;
    uint32_t rgb, material;
    float alpha;
} prom_gallery_paint_record;

// A painting with its frame.
typedef struct prom_gallery_painting {
    float width, height; // of the canvas
    uint32_t mesh;
} prom_gallery_painting;

// Something worth a look: where, and how much.
typedef struct prom_gallery_sight {
    float position[3];
    uint32_t room;
} prom_gallery_sight;

typedef struct prom_gallery {
    prom_gallery_options options; // without zeros
    prom_gallery_plan plan;
    prom_glb *glb;
    prom_error error; // of a picture that could not be encoded
    uint32_t root;    // node
    uint32_t images[PROM_GALLERY_TEXTURE_COUNT];
    PROM_ARRAY(prom_gallery_paint_record) paints;
    uint32_t meshes[PROM_GALLERY_THING_COUNT][PROM_GALLERY_VARIANTS_MAX];
    PROM_ARRAY(prom_gallery_painting) paintings;
    uint32_t painting_limit, next_painting;
    PROM_ARRAY(prom_gallery_sight) sights;
    uint32_t count; // of placed things, for their names
} prom_gallery;

// ---- paints (gallery_paint.c)

// A texture with a tint (0xRRGGBB, sRGB); `repeat` metres a picture. Equal ones share a
// material.
prom_paint prom_gallery_paint(prom_gallery *g, prom_gallery_texture texture, uint32_t rgb,
                              float repeat);
// Clear glass, seen from both sides.
prom_paint prom_gallery_glass(prom_gallery *g);
// A painting as a picture of its own, for prom_solid_picture.
prom_paint prom_gallery_canvas(prom_gallery *g, uint32_t number, float aspect, uint32_t size);

// ---- shapes (gallery_shape.c)

// A point of a surface: u around or along, v upwards, both in [0,1]. Seen from outside u goes
// to the right and v up.
typedef void (*prom_gallery_point)(const void *context, float u, float v, float p[3]);

enum {
    PROM_GALLERY_CLOSED_U = 1, // u = 1 is u = 0, without a crease
    PROM_GALLERY_CLOSED_V = 2,
    PROM_GALLERY_LIT = 4, // shines: its normals face the scene's light
};

// nu x nv cells; the picture is repeated repeat_u and repeat_v times over it. Triangles without
// area (at poles) are left out.
void prom_gallery_surface(prom_solid *s, prom_gallery_point point, const void *context, int nu,
                          int nv, float repeat_u, float repeat_v, int flags);
// A ball with half axes, its centre at (x, y, z).
void prom_gallery_ball(prom_solid *s, float x, float y, float z, float rx, float ry, float rz,
                       int sides, int flags);
// A wall or slab seen from +z of the frame: the grid that `holes` (u0, v0, u1, v1) leave of
// [0,length] x [y0,y1]. Below each of `bands` (ascending heights) it is of the paint of that
// number; `paints` has bands + 1.
typedef struct prom_gallery_hole {
    float u0, v0, u1, v1;
} prom_gallery_hole;

void prom_gallery_wall(prom_solid *s, float length, float y0, float y1,
                       const prom_gallery_hole *holes, int hole_count, const float *bands,
                       int band_count, const prom_paint *paints);
// The same lying, over x and z; a hole is (x0, z0, x1, z1). It faces up, or down.
void prom_gallery_slab(prom_solid *s, float x0, float z0, float x1, float z1, float y,
                       const prom_gallery_hole *holes, int hole_count, bool up);
// The steps of a curved surface that has `most` of them at the highest detail; at least 2.
int prom_gallery_steps(const prom_gallery *g, int most);
// The same around a thing: at least 6, from 8 on a multiple of 4.
int prom_gallery_sides(const prom_gallery *g, int most);
// Writes it under a parent as one node of its own, unless it is empty.
void prom_gallery_add(prom_gallery *g, uint32_t parent, const char *name, prom_solid *s);

// ---- the building

// Each writes nodes under `parent`.
void prom_gallery_build_shell(prom_gallery *g, uint32_t room, uint32_t parent); // walls, doors
void prom_gallery_build_ceiling(prom_gallery *g, uint32_t room, uint32_t parent);
void prom_gallery_build_hall(prom_gallery *g, uint32_t room, uint32_t parent);
void prom_gallery_build_rotunda(prom_gallery *g, uint32_t room, uint32_t parent);
void prom_gallery_build_stairs(prom_gallery *g, uint32_t room, uint32_t parent);
void prom_gallery_build_outside(prom_gallery *g, uint32_t parent);
// A lantern of glass over a hole of a roof, from y up; the frame's x and z.
void prom_gallery_lantern(prom_gallery *g, prom_solid *s, float x0, float z0, float x1,
                          float z1, float y);
// Steps and balustrades (gallery_stairs.c).
void prom_gallery_flight_of(prom_gallery *g, prom_solid *s, const prom_gallery_flight *flight);
// A balustrade from a to b (x, floor, z); level or along a flight.
void prom_gallery_balustrade(prom_gallery *g, prom_solid *s, const float a[3],
                             const float b[3]);

// ---- things (gallery_thing.c)

const char *prom_gallery_thing_name(prom_gallery_thing thing);
uint32_t prom_gallery_variants(const prom_gallery *g, prom_gallery_thing thing);
// Places a variant (taken modulo the number that there are). Its front faces +z at yaw 0.
void prom_gallery_place(prom_gallery *g, uint32_t parent, prom_gallery_thing thing,
                        uint32_t variant, const float at[3], float yaw, float scale);
void prom_gallery_see(prom_gallery *g, uint32_t room, float x, float y, float z);
// Builders of meshes.
typedef void (*prom_gallery_maker)(prom_gallery *g, prom_solid *s, uint32_t variant,
                                   prom_random *random);
void prom_gallery_make_statue(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_bust(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_abstract(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_model(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_vase(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_bowl(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_crystal(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_shell(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_coins(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_mask(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_pedestal(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_plinth(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_table_vitrine(prom_gallery *g, prom_solid *s, uint32_t v,
                                     prom_random *r);
void prom_gallery_make_tall_vitrine(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_bench(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_chair(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_armchair(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_desk(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_table(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_console(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_bookcase(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_column(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_plant(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_ropes(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_lamp(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_radiator(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_rug(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_globe(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_chandelier(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_pendant(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_sconce(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_tree(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_hedge(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);
void prom_gallery_make_fountain(prom_gallery *g, prom_solid *s, uint32_t v, prom_random *r);

// ---- furnishing (gallery_furnish.c, gallery_hang.c)

void prom_gallery_furnish(prom_gallery *g, uint32_t room, uint32_t parent);
// Pictures and what stands below them along the walls of a room.
void prom_gallery_hang(prom_gallery *g, uint32_t room, uint32_t parent, prom_random *random);

// ---- the walk (gallery_walk.c)

void prom_gallery_walk(const prom_gallery *g, prom_path *path);

#endif
