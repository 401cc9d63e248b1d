// Private to simplification: welding by nearness.
#ifndef PROM_SIMPLIFY_WELD_H
#define PROM_SIMPLIFY_WELD_H

#include "metaobj/mesh.h"

#include <stdbool.h>

// first[i]: the earliest vertex within the tolerance in every coordinate that stands for
// itself, where by_normal with a normal on the same side; i where there is none.
void prom_first_near(const prom_vertex *vertices, uint32_t count, float tolerance,
                     bool by_normal, uint32_t *first);
// Moves every vertex to the earliest one that prom_first_near finds for it; *moved of them were
// elsewhere. Tolerance: object units, in every coordinate; at least what a float tells apart at
// the mesh's distance from the origin. Returns false, and leaves the mesh alone, if a position
// is not finite or there is no tolerance.
bool prom_mesh_snap(prom_mesh *mesh, float tolerance, uint32_t *moved);
// Lets the pieces of a surface meet: vertices within the tolerance whose normals are on the
// same side become the first of them in all attributes; others share its position.
void prom_mesh_weld_surface(prom_mesh *mesh, float position_tolerance);

#endif
