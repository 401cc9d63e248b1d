// Off-screen pictures of a prototype: its views from every direction bin, and its six sides.
#ifndef PROM_BUILDER_BAKE_H
#define PROM_BUILDER_BAKE_H

#include "builder/views.h"
#include "metaobj/base/status.h"
#include "render/renderer.h"

#include <stdbool.h>

typedef struct prom_baker prom_baker;

prom_baker *prom_baker_create(prom_renderer *renderer, prom_error *error);
void prom_baker_destroy(prom_baker *baker);

// Sets what is pictured: items placed relative to the subject's centre, kept until the next
// call.
void prom_baker_set_subject(prom_baker *baker, const prom_draw_item *items, size_t count);

// The views of a sphere of `radius` around the centre, orthographic, its diameter a view's
// side. They are drawn beside each other and come back from the device at once:
//   prom_baker_draw_views, prom_baker_draw_large_views or not, prom_baker_read_views.
// Another subject may be set in between, for more detail.
void prom_baker_draw_views(prom_baker *baker, float radius);
void prom_baker_draw_large_views(prom_baker *baker, float radius);
void prom_baker_read_views(prom_baker *baker, prom_views *views);
// Of the items in what was drawn last: prom_view_shares in every direction.
void prom_baker_read_shares(prom_baker *baker, uint32_t item_count,
                            uint16_t (*shares)[PROM_DIRS]);
// Draws and reads.
void prom_baker_take_views(prom_baker *baker, float radius, bool large, prom_views *views);

// The six sides of the box of half extents `half`, each size_px x size_px RGBA from the top, in
// the face order and orientation of prom_mesh_init_box. size_px <= PROM_VIEW_PX.
void prom_baker_take_faces(prom_baker *baker, const float half[3], prom_output output,
                           uint32_t size_px, uint8_t *rgba);

// A stretch of the subject seen straight on, to a rectangle of a picture of several.
typedef struct prom_patch {
    float right[3], up[3], out[3]; // orthonormal: to the right, up, to the viewer
    float center[3];               // of the rectangle, relative to the subject's
    float half_width, half_height; // along right and up
    float front, back;             // along out, from the centre: nothing beyond shows
    uint32_t x, y, width, height;  // pixels from the top left
} prom_patch;

// Side of the largest square of patches.
#define PROM_PATCHES_PX 1024

// Lit patches, beside each other: begin, set a subject and draw for each, then read the
// square of size_px, RGBA from the top.
void prom_baker_begin_patches(prom_baker *baker);
void prom_baker_draw_patch(prom_baker *baker, const prom_patch *patch);
void prom_baker_read_patches(prom_baker *baker, uint32_t size_px, uint8_t *rgba);

#endif
