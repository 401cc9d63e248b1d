// Private to cluster meshes: mean colours for what is left of a far reduction.
#ifndef PROM_BUILDER_CLUSTER_MESH_COLOR_H
#define PROM_BUILDER_CLUSTER_MESH_COLOR_H

#include "builder/simplify/work.h"

// Gives the vertices of `faces` the area-weighted mean colour of the original triangles nearest
// to them, so that a brick house with windows gets the colour of both and not that of whichever
// vertex was left. keep_border: vertices on open borders keep theirs, as the neighbour's do.
void prom_work_recolor(prom_work *work, const prom_index_array *faces, bool keep_border);

#endif
