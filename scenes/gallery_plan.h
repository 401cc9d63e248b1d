// The gallery's plan: a grid of columns (along x) and rows (along z) on two storeys, its rooms,
// doors and windows. Metres, y up, the ground floor at 0. Private to scenes/gallery*.c.
//
// The core is always there: column `core` has cabinets, core + 1 the rotunda in the middle row,
// core + 2 the hall over all three core rows, core + 3 more rooms and the stairs. Doors lie on
// the middle lines of rows and columns, so these lines are free to walk in every room.
#ifndef PROM_SCENES_GALLERY_PLAN_H
#define PROM_SCENES_GALLERY_PLAN_H

#include "metaobj/base/alloc.h"
#include "scenes/gallery.h"

#include <stdbool.h>
#include <stdint.h>

#define PROM_GALLERY_WALL 0.5f  // thickness
#define PROM_GALLERY_UPPER 6.0f // height of the upper floor
#define PROM_GALLERY_ROOF 12.0f
#define PROM_GALLERY_BALCONY 2.4f // width of the hall's gallery floor
#define PROM_GALLERY_GRID_MAX 96u

typedef enum prom_gallery_kind {
    PROM_GALLERY_CABINET, // pictures close together
    PROM_GALLERY_SCULPTURES,
    PROM_GALLERY_VITRINES,
    PROM_GALLERY_LIBRARY,
    PROM_GALLERY_SALON, // furniture
    PROM_GALLERY_MODERN,
    PROM_GALLERY_CORRIDOR,
    PROM_GALLERY_HALL,
    PROM_GALLERY_ROTUNDA,
    PROM_GALLERY_STAIRS,
    PROM_GALLERY_COURT, // a garden, open to the sky
    PROM_GALLERY_KIND_COUNT
} prom_gallery_kind;

typedef enum prom_gallery_ceiling {
    PROM_GALLERY_FLAT, // stucco
    PROM_GALLERY_COFFERS,
    PROM_GALLERY_VAULT,
    PROM_GALLERY_BEAMS,
    PROM_GALLERY_SKYLIGHT,
    PROM_GALLERY_OPEN, // none here: the rotunda, courts
} prom_gallery_ceiling;

typedef struct prom_gallery_room {
    prom_gallery_kind kind;
    prom_gallery_ceiling ceiling;
    uint32_t storey; // of its floor; the hall, the rotunda, the stairs and courts span both
    uint32_t column, row, rows; // cells: one column, `rows` rows
    float x0, z0, x1, z1;       // between the walls
    float y0, y1;               // floor, top of the walls
    uint32_t color, floor;      // choices
} prom_gallery_room;

// Also the index of a wall of a room: its inner face, seen from the room.
typedef enum prom_gallery_side {
    PROM_GALLERY_NORTH, // at z0
    PROM_GALLERY_SOUTH,
    PROM_GALLERY_WEST, // at x0
    PROM_GALLERY_EAST,
} prom_gallery_side;

#define PROM_GALLERY_OUTSIDE UINT32_MAX

// A hole through the wall between two rooms, the lower coordinate first, or to the outside.
typedef struct prom_gallery_opening {
    uint32_t rooms[2];
    bool along_x; // one passes it along x: the wall is a plane of constant x
    bool window;
    float from, to; // faces of the wall, from < to, along the passage
    float middle, width;
    float y0, y1;
} prom_gallery_opening;

typedef struct prom_gallery_plan {
    uint32_t columns, rows, core, core_row; // core_row: the first of three
    float column_x[PROM_GALLERY_GRID_MAX][2], row_z[PROM_GALLERY_GRID_MAX][2]; // between walls
    bool corridor[PROM_GALLERY_GRID_MAX]; // a narrow column, one room over all rows
    uint32_t *cells;                      // rooms: [storey][row][column]
    PROM_ARRAY(prom_gallery_room) rooms;
    PROM_ARRAY(prom_gallery_opening) openings;
    uint32_t room_count; // without courts
} prom_gallery_plan;

void prom_gallery_plan_init(prom_gallery_plan *plan, const prom_gallery_options *options);
void prom_gallery_plan_finish(prom_gallery_plan *plan);

uint32_t prom_gallery_room_at(const prom_gallery_plan *plan, uint32_t storey, uint32_t column,
                              uint32_t row);
// Middle lines.
float prom_gallery_column_middle(const prom_gallery_plan *plan, uint32_t column);
float prom_gallery_row_middle(const prom_gallery_plan *plan, uint32_t row);

// A wall seen from its room: a frame with x along it, from its left end, and z into the room.
typedef struct prom_gallery_face {
    float x, z, yaw, length;
} prom_gallery_face;

prom_gallery_face prom_gallery_room_face(const prom_gallery_room *room, prom_gallery_side side);
// The opening's middle along a room's wall, or false when it is not in that wall.
bool prom_gallery_in_face(const prom_gallery_plan *plan, const prom_gallery_opening *opening,
                          uint32_t room, prom_gallery_side side, float *along);

// The stairs. The hall's rise towards -z to its north gallery; those of the stair room go down
// from its north landing along the east wall to a half landing and back along the west wall.
typedef struct prom_gallery_flight {
    float x, width;       // middle
    float z0, z1, y0, y1; // foot and head
    int steps;
} prom_gallery_flight;

// [0]: the hall's, [1]: the upper and [2]: the lower one of the stair room.
void prom_gallery_flights(const prom_gallery_plan *plan, prom_gallery_flight flights[3]);

#endif
