// What becomes of the pixels that nodes really show, as id buffers count them.
#ifndef PROM_APP_PIXEL_SHARES_H
#define PROM_APP_PIXEL_SHARES_H

#include "metaobj/cut.h"
#include "metaobj/model.h"

// Adds each id's pixels to px, an entry for each node of the tree; other ids are left out.
void prom_count_pixels(const uint32_t *ids, size_t pixels, uint32_t tree_count, uint32_t *px);

// The share of the leaves' pixels that the cut shows wrong, above 1 where it spoils more: each
// leaf's times 1 - the accuracy of the entry that stands for it (its own or that of a node
// above; all of them where there is none), over all of them; 0 where no leaf shows any.
// leaf_px: per node of the tree, from a picture of full detail; scratch: as many floats.
double prom_loss_share(const prom_model *model, const prom_cut *cut, const uint32_t *leaf_px,
                       float *scratch);

// Of a cut, the part that belongs to entries without a visible pixel, each in [0,1].
typedef struct prom_hidden_share {
    double cost;  // of the sum of cost_ms; 0 where nothing has a cost
    double nodes; // of the number of entries; 0 where there is none
} prom_hidden_share;

// px: per node of the tree, from a picture of the cut.
prom_hidden_share prom_hidden_share_of(const prom_cut *cut, const uint32_t *px);

#endif
