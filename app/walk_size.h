// How large a model is for someone who walks in it.
#ifndef PROM_APP_WALK_SIZE_H
#define PROM_APP_WALK_SIZE_H

#include "metaobj/model.h"

// The diameter of the part where things stand, scene units; always above 0. Half of the leaves
// count, so that a wide ground or a skyline around a town does not make it large.
double prom_walk_size(const prom_model *model);

#endif
