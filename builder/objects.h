// From a source scene to objects: what the leaves of the tree will be.
#ifndef PROM_BUILDER_OBJECTS_H
#define PROM_BUILDER_OBJECTS_H

#include "builder/source.h"

// Where an object goes.
typedef enum prom_layer {
    PROM_LAYER_OBJECT = 0,  // a thing: instances, clusters with impostors
    PROM_LAYER_SURFACE = 1, // chunks of large connected surfaces: merged meshes, no impostors
    PROM_LAYER_BLENDED = 2, // see-through: never inside a cluster's picture
    PROM_LAYER_BACKDROP = 3,
    PROM_LAYER_COUNT
} prom_layer;

// A coarser mesh by the scene's artist, in the frame of the shape.
typedef struct prom_shape_level {
    prom_mesh mesh;
    float until; // as in prom_source_level
} prom_shape_level;

// Geometry shared by instances: the future prototype of a leaf. In its own frame.
typedef struct prom_shape {
    prom_mesh mesh; // submeshes by material
    prom_layer layer;
    bool lock_border; // its open border meets a neighbour's: no level may move it
    prom_box bounds;  // of the mesh and of the artist's levels
    uint32_t instances;
    prom_shape_level *levels; // by the artist, from fine to coarse, below `mesh`; or NULL
    uint32_t level_count;
    float until; // of `mesh`; INFINITY without levels
} prom_shape;

typedef struct prom_object {
    uint32_t shape;
    uint32_t name;  // offset into names
    uint32_t node;  // of the source, that it goes by: that of most of its faces
    uint32_t group; // index into groups, or PROM_NONE
    prom_placement placement;
} prom_object;

// A repeated assembly: the source has several equal subtrees (same shapes, same placements up
// to a translation); the tree builds one and instances the rest. Objects of the k-th member
// stand in the same order as those of the first.
typedef struct prom_group {
    uint32_t kind;                       // groups of one kind are equal up to translation
    double origin[3];                    // the translation
    uint32_t first_object, object_count; // objects of a group stand together
} prom_group;

#define PROM_OBJECT_TRIANGLES_MAX 4096u
#define PROM_OBJECT_TRIANGLES_MIN 256u

typedef struct prom_object_options {
    uint32_t max_triangles; // larger objects are split; 0: PROM_OBJECT_TRIANGLES_MAX, or more
    uint32_t min_triangles; // unique neighbours smaller than this are gathered; 0:
                            // PROM_OBJECT_TRIANGLES_MIN, or less
    double chunk_size;      // edge of a surface chunk in scene units; 0: from the layout
} prom_object_options;

// The options with the defaults put in.
prom_object_options prom_object_options_resolved(prom_object_options options);

typedef struct prom_objects {
    PROM_ARRAY(prom_shape) shapes;
    PROM_ARRAY(prom_object) objects;
    PROM_ARRAY(prom_group) groups;
    PROM_ARRAY(char) names; // starts with one zero: offset 0 is the empty name
    prom_box layout;        // bounds of all objects but the backdrop (world)
    // What was found, for `info`: source objects that were split, objects that came from
    // gathering, objects by layer, objects that share their shape.
    uint32_t split, gathered, chunks, backdrops, blended, instanced;
} prom_objects;

// Steps: flatten the hierarchy; instances share a shape and are never cut or gathered (a
// non-uniform scale beyond 1.05 makes a shape of its own); neither are nodes with levels by the
// artist, which share a shape when meshes, levels and distances are equal; blended submeshes
// become objects of their own; the others are looked at in connected pieces. Against the layout
// (where the better part of the objects is) and the median object, pieces far beyond it are
// backdrops, large ones surfaces, which become locked chunks. A part of more than
// max_triangles, or one that sprawls over the scene, is split into its pieces; of these, the
// large ones are halved in space and the tiny ones gathered with their neighbours, across
// source nodes.
//
// What is connected, or a scene of few triangles in few parts (a chair), stays whole up to 16
// times max_triangles; a lone model beyond that is cut into chunks like a surface. A repeated
// assembly is measured by itself: its first member is treated like a scene, the others repeat
// it.
//
// NULL options: the defaults. PROM_ERR_INPUT when nothing in the scene has an extent,
// PROM_ERR_USAGE for options that contradict each other; *objects is empty then. Nodes whose
// matrix is not finite or that have no extent are left out with a warning.
prom_status prom_objects_find(const prom_source *source, const prom_object_options *options,
                              prom_objects *objects, prom_error *error);
void prom_objects_finish(prom_objects *objects);

#endif
