// The model: the tree of meta-objects with their prototypes, representations and tables, held
// in flat arrays. Meshes and texture pixels stay in the container (container.h) until asked
// for.
//
// Order of nodes: breadth first, the root is 0, children of a node stand together, a child's
// index is above its parent's. Nodes from tree_count on are the background layer: placed
// prototypes outside the tree, drawn behind everything.
#ifndef PROM_METAOBJ_MODEL_H
#define PROM_METAOBJ_MODEL_H

#include "metaobj/base/alloc.h"
#include "metaobj/base/math.h"
#include "metaobj/mesh.h"
#include "metaobj/view_bins.h"

#include <stdbool.h>
#include <stdint.h>

typedef enum prom_rep_kind {
    PROM_REP_MESH = 0,         // geometry; level 0 of a leaf is the object itself
    PROM_REP_AVERAGE_BOX = 1,  // six colours
    PROM_REP_TEXTURED_BOX = 2, // six pictures
    PROM_REP_KIND_COUNT
} prom_rep_kind;

const char *prom_rep_kind_name(uint32_t kind); // "mesh", "average-box", "textured-box", "?"

// How the pixels of a draw are shaded: one cost coefficient each.
typedef enum prom_shading {
    PROM_SHADE_PLAIN = 0,    // vertex colour
    PROM_SHADE_TEXTURED = 1, // and a texture
    PROM_SHADE_MASKED = 2,   // and an alpha test
    PROM_SHADE_BLENDED = 3,
    PROM_SHADE_IMPOSTOR = 4, // pictures with coverage
    PROM_SHADE_COUNT
} prom_shading;

enum {
    PROM_REP_UNLIT = 1,  // colours hold the light already
    PROM_REP_ARTIST = 2, // a level that came with the scene
};

// One way to draw a prototype.
typedef struct prom_representation {
    uint32_t kind;     // prom_rep_kind
    uint32_t mesh;     // index into the meshes
    uint32_t texture;  // impostor pictures, or PROM_NONE
    uint32_t flags;    // PROM_REP_UNLIT, PROM_REP_ARTIST
    uint32_t shading;  // prom_shading of most of its pixels
    uint32_t level;    // 0 = finest of its kind
    float error;       // greatest object-space deviation, units of the prototype's frame
    float max_size_px; // largest projected diameter at which it may be shown; INFINITY: any.
                       // Impostors: what was measured; meshes: where their gaps would show
    float near_k;      // accuracy(e_px) = 1 / (1 + near_k * e_px), see benefit/accuracy.h
    float
        switch_distance; // up to which the scene's artist shows it, scene units; INFINITY: any
    uint32_t draws, vertices, triangles; // cost features, with
    float layers; // pixels that its triangles fill for each that it covers, those behind others
                  // included: mean over all directions, at least 1
} prom_representation;

enum {
    PROM_PROTO_CLUSTER = 1,  // stands for everything below an inner node
    PROM_PROTO_SURFACE = 2,  // a chunk, or cluster of chunks, of a large surface
    PROM_PROTO_BLENDED = 4,  // drawn last, back to front
    PROM_PROTO_BACKDROP = 8, // background layer
};

// What all instances of one object (or of one arrangement of objects) share. Representations
// stand from the finest mesh to the cheapest; a leaf has at least one mesh, a cluster may have
// no representation at all. Accuracy, coverage and shares are tables below.
typedef struct prom_prototype {
    uint32_t first_rep, rep_count;
    uint32_t flags;
    uint32_t first_share;     // into shares, child_count rows; PROM_NONE for leaves
    uint32_t child_count;     // of the arrangement; 0 for leaves
    float center[3], half[3]; // bounds in its own frame
    float radius;             // of the sphere around center
    uint64_t triangles;       // full detail, everything below
} prom_prototype;

typedef enum prom_alpha_mode {
    PROM_ALPHA_OPAQUE = 0,
    PROM_ALPHA_MASK = 1,
    PROM_ALPHA_BLEND = 2,
} prom_alpha_mode;

typedef struct prom_material {
    float base_color[4]; // linear
    uint32_t texture;    // PROM_TEXTURE_COLOR, or PROM_NONE
    uint32_t alpha_mode;
    float alpha_cutoff;
    uint32_t double_sided; // 0 or 1
} prom_material;

typedef struct prom_mesh_info {
    uint32_t vertex_count, index_count, submesh_count;
} prom_mesh_info;

typedef struct prom_texture_info {
    uint32_t kind, width, height, layers, levels;
} prom_texture_info;

// Accuracies of a representation per view bin, 255 = 1 (benefit/accuracy.h); 0 where it is not
// to be shown at all.
typedef struct prom_accuracy_row {
    uint8_t bins[PROM_DIRS][PROM_SIZES];
    uint8_t large[PROM_DIRS_LARGE][PROM_SIZES_LARGE]; // of meshes; else 0
} prom_accuracy_row;

// How the accuracies were measured. Values of one metric, or for one ppd, say nothing of
// another.
#define PROM_METRIC_NAME_BYTES 16
#define PROM_PPD_MIN 1.0f // pixels per degree that filters are made for
#define PROM_PPD_MAX 1000.0f
#define PROM_BACKGROUNDS 2 // that each representation is compared over
typedef struct prom_measured {
    char metric[PROM_METRIC_NAME_BYTES]; // benefit/metric.h
    float ppd;                           // pixels per degree of the views
    float background[PROM_BACKGROUNDS];  // linear luminance
    float veto_percentile, veto_error;   // of the footprint's pixels; above it accuracy is 0
} prom_measured;

#define PROM_WEIGHT_MAX 1e6f

typedef struct prom_model {
    uint32_t node_count, tree_count;
    // Per node.
    uint32_t *parent;      // PROM_NONE for the root and the background
    uint32_t *first_child; // PROM_NONE for leaves
    uint32_t *child_count;
    uint32_t *prototype;
    uint32_t *name; // offset into names; 0 is the empty name
    prom_placement *placement;
    double (*center)[3]; // world bounds: centre,
    float (*half)[3];    // half extents,
    float *radius;       // and the sphere around centre
    float *weight; // what a visible pixel of it is worth: semantics, 1 where nothing is said
    // Shared.
    uint32_t prototype_count, rep_count, material_count, mesh_count, texture_count;
    prom_prototype *prototypes;
    prom_representation *reps;
    prom_measured measured;
    prom_accuracy_row *accuracy;     // per representation
    uint16_t (*coverage)[PROM_DIRS]; // per prototype: covered share of the disc of its bounding
                                     // sphere, 65535 = 1
    uint32_t share_count;
    uint16_t (*shares)[PROM_DIRS]; // per child of a cluster prototype, in child order: its
                                   // share of the cluster's visible pixels; sums to 1 over the
                                   // children up to rounding (normalise when used)
    prom_material *materials;
    prom_mesh_info *meshes;
    prom_texture_info *textures;
    char *names; // zero-terminated strings one after the other
    uint32_t names_bytes;
    prom_arena arena; // owns all of the above
} prom_model;

void prom_model_finish(prom_model *model);
// NULL if every index, count and float of the model is in range and the node order holds; else
// a literal that says what is wrong. The index of the offender goes to *row.
const char *prom_model_check(const prom_model *model, uint64_t *row);
// Fills center, half and radius of all nodes from placements and prototypes: leaves from their
// prototype, inner nodes from their children.
void prom_model_update_bounds(prom_model *model);

#endif
