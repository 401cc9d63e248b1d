// Places of eyes from which it is worth knowing what can be seen: along camera paths, or over
// the walkable floors of a box.
#ifndef PROM_SCENES_EYES_H
#define PROM_SCENES_EYES_H

#include "metaobj/container.h"
#include "metaobj/model.h"
#include "scenes/path.h"

// Height of an eye above the floor that it stands on, scene units (metres after import).
#define PROM_EYE_HEIGHT 1.6

typedef double prom_eye[3]; // scene units
typedef PROM_ARRAY(prom_eye) prom_eyes;

// Adds eyes along a path, `spacing` (above 0, scene units) apart by distance whatever the
// speed, its first and last key among them. PROM_ERR_USAGE where that would be millions.
prom_status prom_eyes_along(const prom_path *path, double spacing, prom_eyes *eyes,
                            prom_error *error);
// Adds eyes above the floors with headroom that lie in the box [low, high], over a grid of
// `spacing` (above 0, scene units) or the map's own cells, whichever is coarser. What is too
// small to walk on, such as a table, does not count; the ground in a hollow thing that stands
// on it does, as a room without a door would. The floors are found in the model's geometry in
// `container`, which takes a second or so. PROM_ERR_INPUT when there are none.
prom_status prom_eyes_in_box(prom_container *container, const prom_model *model,
                             const double low[3], const double high[3], double spacing,
                             prom_eyes *eyes, prom_error *error);

#endif
