// A camera made ready for culling and for sizes on the screen.
#ifndef PROM_TRAVERSE_VIEW_H
#define PROM_TRAVERSE_VIEW_H

#include "metaobj/base/math.h"
#include "metaobj/camera.h"
#include "metaobj/model.h"

#include <stdbool.h>

typedef struct prom_view {
    prom_camera camera;
    float planes[5][4]; // near, left, right, bottom, top; relative to the eye, inside >= 0
    float axes[9];      // world to camera rotation, column-major
    float f_px;         // focal length in pixels: height / 2 / tan(fov_y / 2)
} prom_view;

void prom_view_init(prom_view *view, const prom_camera *camera);

typedef enum prom_cull { PROM_OUTSIDE, PROM_CROSSING, PROM_INSIDE } prom_cull;
// Against the box of a node. Conservative: never PROM_OUTSIDE for a visible box.
prom_cull prom_view_cull(const prom_view *view, const double center[3], const float half[3]);

// How a node appears: sizes are those of its bounding sphere.
typedef struct prom_appearance {
    float distance;   // eye to the sphere's centre
    float nearest;    // eye to the nearest point of the box; 0 inside
    float size_px;    // projected diameter at that distance: 2 * radius * f_px / distance
    float in_view;    // part of its screen rectangle inside the viewport, (0,1]
    float overlap_px; // pixels of the viewport that its screen rectangle covers
    float uv[2];      // direction to the eye in the node's own frame, on the octahedral map
    uint32_t dir;     // its direction bin
    float extreme;    // how little its centre and the share of its rectangle say of what it
                      // covers, for being near: from 0 to 1
    bool near_case;   // holds the eye or crosses the near plane: only meshes, clusters open
} prom_appearance;
void prom_view_appearance(const prom_view *view, const prom_model *model, uint32_t node,
                          prom_appearance *appearance);

#endif
