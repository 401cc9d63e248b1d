// The tree over the objects, and its cluster prototypes.
#ifndef PROM_BUILDER_TREE_H
#define PROM_BUILDER_TREE_H

#include "builder/objects.h"

// A node before numbering. Leaves name an object; inner nodes a cluster.
typedef struct prom_tree_node {
    uint32_t parent, first_child, child_count;
    uint32_t object;  // leaves; else PROM_NONE
    uint32_t cluster; // inner nodes; else PROM_NONE
    prom_layer layer; // of everything below; PROM_LAYER_OBJECT for a mixed node, see mixed
    bool mixed;       // children of several layers: gets no representation of its own
    double origin[3]; // world position of the cluster's frame (axes are the world's)
} prom_tree_node;

// An arrangement of children that may stand in several places (tiles of a tiled scene): shared
// prototype. `node` is its first place.
typedef struct prom_tree_cluster {
    uint32_t node;
    uint32_t child_count;
    uint32_t instances;
    uint32_t height; // 1 above leaves only, else 1 + the highest child
    prom_layer layer;
    bool mixed;
} prom_tree_cluster;

typedef struct prom_tree {
    PROM_ARRAY(prom_tree_node) nodes; // breadth first, children together: the model's order
    PROM_ARRAY(prom_tree_cluster) clusters; // children before parents
    // Objects of the backdrop are not in the tree; they are listed here. In the model they
    // stand behind the tree's nodes: backdrop_first is the number of these.
    uint32_t backdrop_first;
    PROM_ARRAY(uint32_t) backdrop_objects;
} prom_tree;

typedef enum prom_octree { PROM_OCTREE_LOOSE, PROM_OCTREE_STRICT } prom_octree;

typedef struct prom_tree_options {
    prom_octree octree;
    uint32_t divisions[3]; // strict: cells in x, y, z of the finest level; 0: 8; at most 65536
    double group_radius;   // strict: objects within it are taken as one group first; 0: none
    uint32_t max_children; // loose: 0 means 16
} prom_tree_options;

// Builds the tree over at least one object that is no backdrop; deterministic. Object, surface
// and blended layers are grown apart; a scene with several of them has a mixed root over
// theirs, else the layer's own cluster is the root. Only the root may have a single child.
// Loose: an octree by centroid (looseness 2) per layer, grown from the leaves up, unary chains
// collapsed, nodes of more than max_children split further; groups of one kind get the same
// subtree once (their clusters are shared) and stand in the outer tree as one. Strict: the
// classic (Maciel and Shirley 1995): finest cells first, two or more things wholly inside a
// cell become a cluster that takes their place, divisions are halved (rounded up) down to one
// cell, and the layer's own cluster takes the rest whatever its number; it knows no groups.
void prom_tree_build(const prom_objects *objects, const prom_tree_options *options,
                     prom_tree *tree);
void prom_tree_finish(prom_tree *tree);

#endif
