// Where a person can walk in a model: its geometry in columns over a horizontal grid, in each
// column the floors with headroom above, and which floors connect. Private to scenes/.
//
// After the idea of voxel-based walkable areas in games (Mononen, Recast, 2009), reduced to
// what an automatic camera path needs.
#ifndef PROM_SCENES_WALK_MAP_H
#define PROM_SCENES_WALK_MAP_H

#include "metaobj/base/alloc.h"
#include "metaobj/base/status.h"
#include "metaobj/container.h"
#include "metaobj/model.h"

#include <stdbool.h>
#include <stdint.h>

#define PROM_WALK_CLEAR_MAX 6u

typedef struct prom_walk_floor {
    float y;
    uint32_t column;    // row * columns + column
    uint32_t component; // floors that can be walked between
    uint8_t open;       // nothing above
    uint8_t clear;      // steps to the nearest wall or edge, at most PROM_WALK_CLEAR_MAX
} prom_walk_floor;

typedef struct prom_walk_map {
    double origin[2]; // x, z of the grid's corner
    double cell;
    uint32_t columns, rows;
    uint32_t *first; // columns * rows + 1: the floors of each column, from low to high
    PROM_ARRAY(prom_walk_floor) floors;
    uint32_t component_count;
    double step; // the greatest difference of height between floors that connect
} prom_walk_map;

// Builds the map of x in [low[0], high[0]], z in [low[1], high[1]] for an eye at height `eye`,
// from the tree's leaves, read from the container in as coarse a mesh as the grid allows.
prom_status prom_walk_map_init(prom_walk_map *map, prom_container *container,
                               const prom_model *model, const double low[2],
                               const double high[2], double eye, prom_error *error);
void prom_walk_map_finish(prom_walk_map *map); // {0} is allowed

// The floor of the neighbouring column (0 +x, 1 -x, 2 +z, 3 -z) that connects with a floor, or
// PROM_NONE.
uint32_t prom_walk_map_neighbour(const prom_walk_map *map, uint32_t floor, int side);
// The floor at a point that is nearest to the height y, within the step; PROM_NONE: none.
uint32_t prom_walk_map_at(const prom_walk_map *map, double x, double y, double z);
// The point in the middle of a floor's cell.
void prom_walk_map_point(const prom_walk_map *map, uint32_t floor, double point[3]);

#endif
