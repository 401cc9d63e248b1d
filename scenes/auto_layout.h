// What automatic paths share: the layout of a model's objects, and walks along closed lines.
// Private to scenes/.
#ifndef PROM_SCENES_AUTO_LAYOUT_H
#define PROM_SCENES_AUTO_LAYOUT_H

#include "metaobj/model.h"
#include "scenes/path.h"

typedef struct prom_layout_box {
    double center[3], half[3];
} prom_layout_box;

typedef struct prom_layout {
    PROM_ARRAY(prom_layout_box) objects;  // what stands on the ground
    PROM_ARRAY(prom_layout_box) surfaces; // chunks of the ground and of other large surfaces
    double *tops;                         // of the objects, ascending
    double middle[2], spread[2];          // robust centre and half extents in x and z
    double size;                          // diagonal of the robust extents
    double eye;                           // height above the ground
} prom_layout;

// Of the leaves of a model's tree; no object, if there is none.
void prom_layout_init(prom_layout *layout, const prom_model *model);
void prom_layout_finish(prom_layout *layout);
// How many objects are around a place, each counting less with distance; above 0.
double prom_layout_density(const prom_layout *layout, double x, double z);

// The share of the objects that reach above a height.
double prom_layout_above(const prom_layout *layout, double y);
// The value below which a share of the values lies; sorts them.
double prom_layout_percentile(double *values, size_t count, double share);

// A place of the eye.
typedef struct prom_place {
    double x, y, z;
} prom_place;

// Adds `frames` keys along a closed line of at least 3 places, at one speed and looking ahead:
// once around, or as far as a brisk speed for the layout takes. Starts at the first place.
void prom_loop_walk(const prom_layout *layout, const prom_place *loop, uint32_t count,
                    uint32_t frames, prom_path *path);
// Makes the loop from the objects' boxes alone.
void prom_layout_walk(const prom_layout *layout, uint32_t frames, prom_path *path);
// Makes it from a map of where one can walk; false when there is no such place worth a walk
// (then the path is unchanged).
struct prom_walk_map;
bool prom_map_walk(const struct prom_walk_map *map, const prom_layout *layout, uint32_t frames,
                   prom_path *path);

#endif
