// Visibility: of each node, the share of its footprint that is not hidden behind others, from
// what earlier frames have shown and, where the model has them, from view cells.
//
//   every frame: prom_visibility_feed with what has been counted of the last one (or, late, of
//   one before), prom_visibility_begin with its camera, select a cut with the visibility, draw
//
// Plain arrays in, no GL: any renderer that can count pixels per drawn node can feed it. Memory
// is allocated once; the work of a call grows with the cut, that of entering a cell with what
// the cell shows.
#ifndef PROM_TRAVERSE_VISIBILITY_H
#define PROM_TRAVERSE_VISIBILITY_H

#include "metaobj/cut.h"
#include "metaobj/view_cells.h"
#include "traverse/view.h"

// No share is smaller: of a full screen less than a pixel.
#define PROM_VISIBILITY_LEAST (1.0f / (1 << 20))
// Nor larger. Footprints are estimates: of some nodes more shows than they promise.
#define PROM_VISIBILITY_MOST ((float)(1 << 20))

typedef struct prom_visibility prom_visibility;

// cells: NULL or those of the model; model and cells must outlive the visibility. All shares
// are 1 at first.
prom_visibility *prom_visibility_create(const prom_model *model, const prom_view_cells *cells);
void prom_visibility_destroy(prom_visibility *visibility); // NULL is allowed

// A frame of this camera is about to be selected: shares that are old, or were seen from
// elsewhere, move towards what is known without them; the eye's cell is looked up.
void prom_visibility_begin(prom_visibility *visibility, const prom_camera *camera);

// What was counted of one entry of a cut in the picture drawn from it.
typedef struct prom_visible_count {
    prom_cut_entry entry; // as the selector gave it
    float px;             // visible pixels; below 0: they were not counted
} prom_visible_count;
// The counts of a whole cut, drawn from this camera. Nodes above the entries get the sums;
// nodes below keep what they had, and share in their ancestor's pixels.
void prom_visibility_feed(prom_visibility *visibility, const prom_camera *camera,
                          const prom_visible_count *counts, size_t count);

// Visible pixels of a node against prom_own_px of it, in [PROM_VISIBILITY_LEAST,
// PROM_VISIBILITY_MOST]; 1 where nothing is known.
float prom_visibility_share(const prom_visibility *visibility, uint32_t node);
// Visible pixels of a node that would have own_px by itself, as far as is known; false where
// nothing is.
bool prom_visibility_px(const prom_visibility *visibility, uint32_t node, float own_px,
                        float *px);
// How far the camera has come so far: moved, in units of the distance to what it sees, and
// turned, in units of its angle of view.
double prom_visibility_way(const prom_visibility *visibility);

#endif
