// Off-screen pictures of a prototype: its views from every direction bin, and its six sides.
#ifndef PROM_BUILDER_BAKE_H
#define PROM_BUILDER_BAKE_H

#include "metaobj/base/status.h"
#include "metaobj/view_bins.h"
#include "render/renderer.h"

#include <stdbool.h>

// Pixels along a side of a view: the largest measured size.
#define PROM_VIEW_PX 128
#define PROM_VIEW_PIXELS (PROM_VIEW_PX * PROM_VIEW_PX)

// Orthographic views in which the diameter of the subject's bounding sphere is PROM_VIEW_PX, as
// they come from the device: one atlas, rows from the top, the view of direction bin d at
// column d % PROM_ATLAS_COLUMNS and row d / PROM_ATLAS_COLUMNS.
#define PROM_ATLAS_COLUMNS 9
#define PROM_ATLAS_ROWS ((PROM_DIRS + PROM_ATLAS_COLUMNS - 1) / PROM_ATLAS_COLUMNS)
#define PROM_ATLAS_WIDTH (PROM_VIEW_PX * PROM_ATLAS_COLUMNS)
#define PROM_ATLAS_HEIGHT (PROM_VIEW_PX * PROM_ATLAS_ROWS)
#define PROM_ATLAS_PIXELS ((size_t)PROM_ATLAS_WIDTH * PROM_ATLAS_HEIGHT)

typedef struct prom_views {
    uint8_t (*rgba)[4]; // sRGB-encoded; alpha of at least 128 is covered
    uint32_t *ids;      // of the items; PROM_NONE where nothing is. NULL: not wanted
} prom_views;

void prom_views_init(prom_views *views, bool with_ids);
void prom_views_finish(prom_views *views); // {0} is allowed
// The first pixel of a view in the atlas.
static inline size_t prom_view_start(uint32_t dir)
{
    return (size_t)(dir / PROM_ATLAS_COLUMNS) * PROM_VIEW_PX * PROM_ATLAS_WIDTH +
           dir % PROM_ATLAS_COLUMNS * PROM_VIEW_PX;
}

typedef struct prom_baker prom_baker;

prom_baker *prom_baker_create(prom_renderer *renderer, prom_error *error);
void prom_baker_destroy(prom_baker *baker);

// Sets what is pictured: items placed relative to the subject's centre, kept until the next
// call.
void prom_baker_set_subject(prom_baker *baker, const prom_draw_item *items, size_t count);

// Fills views (ids only if views->ids) for a sphere of `radius` around the centre.
void prom_baker_take_views(prom_baker *baker, float radius, prom_views *views);

// The six sides of the box of half extents `half`, each size_px x size_px RGBA from the top, in
// the face order and orientation of prom_mesh_init_box. size_px <= PROM_VIEW_PX.
void prom_baker_take_faces(prom_baker *baker, const float half[3], prom_output output,
                           uint32_t size_px, uint8_t *rgba);

#endif
