// Private to simplification: welding by nearness.
#ifndef PROM_SIMPLIFY_WELD_H
#define PROM_SIMPLIFY_WELD_H

#include "metaobj/mesh.h"

#include <stdbool.h>

// first[i]: the earliest vertex within the tolerance in every coordinate that stands for
// itself, where by_normal with a normal on the same side; i where there is none.
void prom_first_near(const prom_vertex *vertices, uint32_t count, float tolerance,
                     bool by_normal, uint32_t *first);
// Lets the pieces of a surface meet: vertices within the tolerance whose normals are on the
// same side become the first of them in all attributes; others share its position.
void prom_mesh_weld_surface(prom_mesh *mesh, float position_tolerance);

#endif
