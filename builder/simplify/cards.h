// Private to simplification: connected components, and foliage made of many small ones.
//
// Edge collapse destroys leaf cards: a card loses a triangle and then vanishes, and trees go
// bald. Cards are thinned instead: a share of them goes, evenly in space, and the others grow
// about their centres so that the area stays (Cook et al. 2007, "Stochastic Simplification of
// Aggregate Detail", keep the area in this way).
#ifndef PROM_SIMPLIFY_CARDS_H
#define PROM_SIMPLIFY_CARDS_H

#include "builder/simplify/work.h"

typedef struct prom_component {
    uint32_t triangles;
    uint32_t submesh;
    float area;
    float facing[3]; // sum of the triangles' area vectors: 0 where the component is closed
    float volume;    // signed, of closed components
    float origin[3]; // one of its points
    float center[3]; // area-weighted
    prom_box box;
} prom_component;

// Components by shared positions within a submesh, numbered by first appearance. of[t]: the
// component of triangle t. Returns their count; *components is to be freed.
uint32_t prom_work_components(const prom_work *work, const prom_index_array *faces,
                              uint32_t *of, prom_component **components);

// Parts the triangles into leaf cards and the rest. Cards: open or flat components of at most
// 16 triangles, small against the mesh, at least 12 of them in a submesh; where `mostly`, also
// at least half of the submesh's triangles. Returns the cards' mean extent (0 without cards).
float prom_work_split_cards(const prom_work *work, bool mostly, prom_index_array *solid,
                            prom_index_array *cards);

// Thins cards to about `target` triangles and makes the others grow by `growth` more (of the
// area; what was lost before); appends the grown ones' vertices to the work.
void prom_work_thin_cards(prom_work *work, const prom_index_array *cards, uint32_t target,
                          float growth, prom_index_array *out);

// Removes the smallest components while more than `target` triangles are left and they are
// smaller than max_extent.
void prom_work_drop_specks(const prom_work *work, uint32_t target, float max_extent,
                           prom_index_array *faces);

#endif
