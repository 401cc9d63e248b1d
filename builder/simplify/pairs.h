// Private to simplification: virtual edges, pairs of points of different pieces of a mesh that
// are close to each other (Garland and Heckbert 1997, section 3.2). Within one piece there are
// none: its edges lead everywhere, and pairs across would only pinch it.
#ifndef PROM_SIMPLIFY_PAIRS_H
#define PROM_SIMPLIFY_PAIRS_H

#include "builder/simplify/collapse_mesh.h"

#include <stdbool.h>

typedef struct prom_pair_link {
    uint32_t other, next; // point, link
} prom_pair_link;

typedef struct prom_pairs {
    PROM_ARRAY(prom_pair_link) links;
    uint32_t *first; // per point: link
    uint32_t *moved; // per point: where it went, itself if it is there
} prom_pairs;        // {0}: none

// Each point gets at most a few of the nearest, so that dense heaps stay linear.
void prom_pairs_init(prom_pairs *pairs, const prom_collapse_mesh *mesh, float distance);
void prom_pairs_finish(prom_pairs *pairs);
bool prom_pairs_any(const prom_pairs *pairs);
size_t prom_pairs_bytes(const prom_pairs *pairs, const prom_collapse_mesh *mesh);
// The point that a point has become.
uint32_t prom_pairs_find(prom_pairs *pairs, uint32_t point);
void prom_pairs_merge(prom_pairs *pairs, uint32_t from, uint32_t to);

#endif
