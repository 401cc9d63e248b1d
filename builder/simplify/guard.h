// Private to simplification: what a collapse must not do to the mesh, whatever it costs.
#ifndef PROM_SIMPLIFY_GUARD_H
#define PROM_SIMPLIFY_GUARD_H

#include "builder/simplify/collapse_mesh.h"

#include <stdbool.h>

// Points marked for the while: mark[p] >= epoch.
typedef struct prom_marks {
    uint32_t *mark; // per point
    uint32_t epoch, points;
} prom_marks;

void prom_marks_init(prom_marks *marks, uint32_t points);
void prom_marks_finish(prom_marks *marks);
// Takes all marks away; epoch and epoch + 1 are there to be given.
uint32_t prom_marks_begin(prom_marks *marks);

typedef enum prom_verdict {
    PROM_VERDICT_GOOD,
    PROM_VERDICT_LINK,       // the surface's connections would change, or a triangle be doubled
    PROM_VERDICT_FLIP,       // a face would turn by about a right angle or more
    PROM_VERDICT_DEGENERATE, // a face would become a sliver or nothing
} prom_verdict;

// The link condition (Dey, Edelsbrunner, Guha and Nekhayev 1999, "Topology preserving edge
// contraction", with a vertex at infinity behind borders), in a form that lets meshes that are
// no manifold be: every point next to both must be one of the edge's triangles, and a border is
// not pinched. Points that have no triangle in common (virtual edges) are merged whatever the
// connections, if no triangle comes twice. `borders`: whether both are on open borders.
prom_verdict prom_guard_link(const prom_collapse_mesh *mesh, prom_marks *marks, uint32_t from,
                             uint32_t to, bool borders);
// Whether the points have no triangles but those of their edge: a part would vanish.
bool prom_guard_last(const prom_collapse_mesh *mesh, uint32_t from, uint32_t to);
// Whether what goes is small: the points and all edges of the triangles that go are within a
// distance, given squared.
bool prom_guard_small(const prom_collapse_mesh *mesh, uint32_t from, uint32_t to,
                      float squared);
// The faces around both, if the merged point is at `place`.
prom_verdict prom_guard_faces(const prom_collapse_mesh *mesh, uint32_t from, uint32_t to,
                              const float place[3]);

#endif
