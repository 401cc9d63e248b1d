// The state of a running build, handed from stage to stage (pipeline.c gives their order).
#ifndef PROM_BUILDER_BUILD_H
#define PROM_BUILDER_BUILD_H

#include "builder/bake.h"
#include "builder/measure.h"
#include "builder/pipeline.h"
#include "metaobj/container.h"

#define PROM_LEVELS_MAX 8
#define PROM_FACE_PX 64              // side of a stored impostor picture
#define PROM_CLUSTER_TRIANGLES 2048u // of a cluster's fine mesh, at most

// The meshes of a leaf's prototype.
typedef struct prom_shape_build {
    prom_mesh levels[PROM_LEVELS_MAX];
    float errors[PROM_LEVELS_MAX];
    uint32_t level_count;
    float max_size_px[PROM_LEVELS_MAX]; // as in its representation
    uint32_t mesh_ids[PROM_LEVELS_MAX]; // container and renderer ids; PROM_NONE: not kept
    prom_mesh merge; // a level with its materials baked to colours, for cluster meshes
    float merge_error;
} prom_shape_build;

// The meshes of a cluster's prototype: a fine and a coarse one.
#define PROM_CLUSTER_LEVELS 2
typedef struct prom_cluster_build {
    prom_mesh levels[PROM_CLUSTER_LEVELS];
    float errors[PROM_CLUSTER_LEVELS];
    uint32_t level_count;
} prom_cluster_build;

typedef struct prom_build_state {
    const prom_build_options *options; // defaults put in
    const char *scene_path;
    prom_source source;
    prom_objects objects;
    prom_tree tree;
    prom_texture *textures;       // of the source images
    prom_shape_build *shapes;     // as objects.shapes
    prom_cluster_build *clusters; // as tree.clusters
    float mean_luminance;         // of the scene, linear
    bool *boxed;                  // per prototype: gets a textured box within the byte budget

    // What the model will hold. Prototypes: shapes, then clusters.
    prom_model model; // its nodes, once placed; owns nothing else
    prom_prototype *prototypes;
    uint16_t (*coverage)[PROM_DIRS];
    PROM_ARRAY(prom_representation) reps;
    uint32_t gap_meshes; // meshes whose gaps were too large to be kept
    PROM_ARRAY(struct prom_accuracy_row { uint8_t a[PROM_DIRS][PROM_SIZES]; }) accuracy;
    PROM_ARRAY(struct prom_share_row { uint16_t a[PROM_DIRS]; }) shares;
    PROM_ARRAY(prom_mesh_info) mesh_infos;
    PROM_ARRAY(prom_texture_info) texture_infos;

    prom_writer *writer;
    prom_context *context;
    prom_renderer *renderer;
    prom_baker *baker;
    prom_measure *measure;
    prom_views truth, views;
} prom_build_state;

// ---- stages, in this order (each in the file of its name)

prom_status prom_stage_textures(prom_build_state *b, prom_error *error);
// Weld, levels, baked colours: on all cores.
prom_status prom_stage_levels(prom_build_state *b, prom_error *error);
// Representations of leaves: upload, impostors, accuracy.
prom_status prom_stage_leaves(prom_build_state *b, prom_error *error);
// Merged meshes, impostors, accuracy and shares of clusters, upwards.
prom_status prom_stage_clusters(prom_build_state *b, prom_error *error);
// Nodes of the model from the tree and the leaves' prototypes; sets b->model and the bounds of
// cluster prototypes. Called by the cluster stage.
void prom_build_place_nodes(prom_build_state *b);
// The tree and its tables into the container.
prom_status prom_stage_model(prom_build_state *b, prom_error *error);

// ---- shared by the stages

// Adds a texture to the container and the renderer, under the same id.
prom_status prom_build_add_texture(prom_build_state *b, const prom_texture *texture,
                                   uint32_t *id, prom_error *error);
// A mesh in its prototype's frame, moved so that the views look at the bounds' centre.
prom_draw_item prom_build_item_around(uint32_t mesh, const float center[3]);

// How a representation comes into the model.
typedef enum prom_admission {
    PROM_ADMIT_UNMEASURED, // as it is: accuracy 1, no views taken
    PROM_ADMIT_TRUTH, // it is the object: coverage and the truth of what follows come from it
    PROM_ADMIT_MEASURED, // kept if it is closed enough to be shown at some size
} prom_admission;

// Adds a representation to prototype `p`, which must be the last one that got any: uploads the
// mesh (in the frame of the prototype), measures it, and if it is admitted writes it. `rep` has
// kind, texture, flags, level, error; the rest is filled in. *mesh_id (NULL allowed) gets its
// id, or PROM_NONE if it was not kept.
prom_status prom_build_add_rep(prom_build_state *b, uint32_t p, const prom_mesh *mesh,
                               const prom_representation *rep, prom_admission admission,
                               uint32_t *mesh_id, prom_error *error);

// Average-colour box and, if `textured`, textured box of the subject set in the baker (items
// relative to the bounds' centre). lit: bake the light in (clusters). Each is added to
// prototype `p` and measured.
prom_status prom_build_add_boxes(prom_build_state *b, uint32_t p, const float center[3],
                                 const float half[3], float radius, bool lit, bool textured,
                                 prom_error *error);

#endif
