// What the evaluation needs of a view beyond the public header.
#ifndef PROM_TRAVERSE_VIEW_PRIVATE_H
#define PROM_TRAVERSE_VIEW_PRIVATE_H

#include "traverse/view.h"

// prom_view_appearance for a node whose culling is known already. PROM_INSIDE saves projecting
// its box, unless it is large against its distance: in_view is 1, and overlap_px only bounded
// by the viewport.
void prom_view_appearance_culled(const prom_view *view, const prom_model *model, uint32_t node,
                                 prom_cull cull, prom_appearance *appearance);

// Nearer than this part of its distance a node's perspective is extreme: sizes at the distance
// of the centre say little.
#define PROM_EXTREME_NEAREST 0.65f

// Pixels of the viewport.
float prom_view_screen_px(const prom_view *view);

#endif
