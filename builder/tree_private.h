// What the builders of the tree share.
//
// The tree is grown as branches with lists of twigs. A branch is a cluster; a group's branches
// are grown once, where the first group of its kind stands, and hang in the outer tree once for
// each group of the kind. Numbering the nodes (tree.c) unfolds that.
#ifndef PROM_BUILDER_TREE_PRIVATE_H
#define PROM_BUILDER_TREE_PRIVATE_H

#include "builder/objects_box.h"
#include "builder/tree.h"
#include "metaobj/base/alloc.h"

// What hangs on a branch: an object, or another branch.
typedef struct prom_twig {
    uint32_t object; // or PROM_NONE
    uint32_t branch; // or PROM_NONE
    uint32_t group;  // the group that stands here, where the branch heads one; else PROM_NONE
} prom_twig;

typedef struct prom_branch {
    uint32_t first_twig, twig_count;
    uint32_t height;
    uint32_t home; // the group for which it was grown, or PROM_NONE
    prom_layer layer;
    bool mixed;
    double center[3];
} prom_branch;

// A twig that has no place yet.
typedef struct prom_bud {
    prom_twig twig;
    prom_wbox bounds;
    double center[3], radius;
    double key;     // for sorting
    uint32_t order; // breaks ties
} prom_bud;
typedef PROM_ARRAY(prom_bud) prom_buds;

typedef struct prom_grower {
    const prom_objects *objects;
    prom_tree_options options; // defaults filled in
    uint32_t home;             // of the branches being grown
    PROM_ARRAY(prom_branch) branches;
    PROM_ARRAY(prom_twig) twigs;
} prom_grower;

prom_bud prom_bud_make(prom_twig twig, const prom_wbox *bounds);
// Makes a branch that bears the buds, and returns it as a bud.
prom_bud prom_bud_bind(prom_grower *grower, const prom_bud *buds, size_t count,
                       prom_layer layer, bool mixed);

// Each reduces the buds of a layer to those that hang on the layer's own branch. The buds are
// reordered; `out` is filled.
void prom_grow_loose(prom_grower *grower, prom_bud *buds, size_t count, prom_layer layer,
                     prom_buds *out);
// bounds: of the whole tree, which is what is divided.
void prom_grow_strict(prom_grower *grower, prom_bud *buds, size_t count, prom_layer layer,
                      const prom_wbox *bounds, prom_buds *out);

#endif
