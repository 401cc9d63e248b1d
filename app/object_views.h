// Pictures of an object of a model from all directions, as the builder takes them: its true
// look, and its representations.
#ifndef PROM_APP_OBJECT_VIEWS_H
#define PROM_APP_OBJECT_VIEWS_H

#include "builder/bake.h"
#include "metaobj/container.h"

typedef struct prom_object_views {
    const prom_model *model;
    prom_context *context;
    prom_renderer *renderer; // holds the model
    prom_baker *baker;
} prom_object_views;

// Loads the model on a headless device. On failure *views is {0}.
prom_status prom_object_views_init(prom_object_views *views, prom_container *container,
                                   const prom_model *model, prom_error *error);
void prom_object_views_finish(prom_object_views *views); // {0} is allowed

// The true look of a node: a leaf's finest mesh; of a cluster all leaves below it, each by a
// mesh that errs less than half a pixel. large: the large views too.
void prom_object_views_take_truth(prom_object_views *views, uint32_t node, bool large,
                                  prom_views *out);
// The look of a representation of a prototype.
void prom_object_views_take(prom_object_views *views, uint32_t prototype, uint32_t rep,
                            bool large, prom_views *out);

#endif
