// Private to simplification: the edges of a triangle list, with the faces on them.
#ifndef PROM_SIMPLIFY_REPAIR_EDGES_H
#define PROM_SIMPLIFY_REPAIR_EDGES_H

#include "metaobj/base/alloc.h"

#include <stdbool.h>

typedef struct prom_edge {
    uint32_t low, high; // points, low < high
    uint32_t uses;      // by how many faces
    uint32_t half[2];   // the first two uses: corners (3 * triangle + k) where they start
} prom_edge;

// In the order of their first use.
typedef struct prom_edges {
    PROM_ARRAY(prom_edge) edges;
    uint32_t *of; // per corner: the edge from it to the triangle's next; PROM_NONE: left out
} prom_edges;

// points: 3 per triangle, distinct. skip: per triangle, true for those that are left out.
void prom_edges_init(prom_edges *edges, const uint32_t *points, const bool *skip,
                     uint32_t triangles);
void prom_edges_finish(prom_edges *edges);

static inline uint32_t prom_next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

#endif
