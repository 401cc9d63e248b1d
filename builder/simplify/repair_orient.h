// Private to simplification: which side of a face is its front.
#ifndef PROM_SIMPLIFY_REPAIR_ORIENT_H
#define PROM_SIMPLIFY_REPAIR_ORIENT_H

#include "builder/simplify/repair.h"

// Turns faces (see prom_repair_orient) and counts faces, edges and patches as they are then.
// points: 3 per triangle of the mesh, distinct. May append vertices.
void prom_mesh_orient(prom_mesh *mesh, const uint32_t *points, prom_repair_orient how,
                      prom_repair_report *report);

#endif
