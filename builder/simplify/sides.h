// Private to simplification: which triangles are the back side of others.
#ifndef PROM_SIMPLIFY_SIDES_H
#define PROM_SIMPLIFY_SIDES_H

#include "builder/simplify/work.h"

typedef enum prom_side {
    PROM_SIDE_KEEP,
    PROM_SIDE_DROP,        // repeats another triangle, or is its back side
    PROM_SIDE_DOUBLE,      // has a back side, which is dropped
    PROM_SIDE_DOUBLE_LIKE, // the same, and the back side has the front's normals
} prom_side;

// marks: per triangle, zeroed. Only where nearly all of a connected component has a back side
// is it a sheet with two sides; single folded triangles in other surfaces (scans have many)
// stay as they are, since cutting them out would cut the surface.
void prom_work_mark_sides(const prom_work *work, uint8_t *marks);

#endif
