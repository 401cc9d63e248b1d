// The objects of a model that a person names.
#ifndef PROM_APP_INFO_OBJECT_H
#define PROM_APP_INFO_OBJECT_H

#include "metaobj/base/status.h"
#include "metaobj/model.h"

typedef PROM_ARRAY(uint32_t) prom_node_list;

// One node for each prototype that `name` means, in the model's order: those that are called
// so; if there are none, prototype N for `#N` (clusters have no names), else those whose name
// fits the pattern (fnmatch). PROM_ERR_INPUT with the nearest names if there is none.
prom_status prom_find_objects(const prom_model *model, const char *name, prom_node_list *nodes,
                              prom_error *error);
// What to call a prototype of which `node` is one: "name (#12)", or "#12". Free it. No control
// characters.
char *prom_object_title(const prom_model *model, uint32_t node);
// The first node of each prototype; PROM_NONE where there is none. Free it.
uint32_t *prom_first_nodes(const prom_model *model);

#endif
