// Pixels that nodes, and the boxes drawn in their place, cover in a view.
#ifndef PROM_TRAVERSE_FOOTPRINT_H
#define PROM_TRAVERSE_FOOTPRINT_H

#include "traverse/view.h"

// Pixels of the viewport that a node covers by itself, from its appearance. *in_view becomes
// the part of the node that is in view: that of the appearance, but more where perspective is
// extreme and the screen rectangle says little.
float prom_footprint_in_view(const prom_view *view, const prom_model *model, uint32_t node,
                             const prom_appearance *appearance, float *in_view);
// The same of a node that nothing is known of yet: 0 where it is out of view.
float prom_own_px(const prom_view *view, const prom_model *model, uint32_t node);
// Pixels that the box around a node covers where the node itself covers `px` of them: a box is
// shaded all over.
float prom_box_px(const prom_view *view, const prom_model *model, uint32_t node, uint32_t dir,
                  float px);

#endif
