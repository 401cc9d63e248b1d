// Area and volume of a triangle mesh.
#ifndef PROM_SIMPLIFY_MESH_VOLUME_H
#define PROM_SIMPLIFY_MESH_VOLUME_H

#include "metaobj/mesh.h"

#include <stdbool.h>

double prom_mesh_area(const prom_mesh *mesh); // square object units

// Whether the mesh is closed and turned one way: welded by position (within 1e-5 of the bounds'
// half diagonal), every edge is run through as often one way as the other. *volume: then what
// it encloses, cubic object units, below 0 where it is inside out (the divergence theorem);
// else untouched. An empty mesh is not closed.
bool prom_mesh_volume(const prom_mesh *mesh, double *volume);

#endif
