// The state of a running build, handed from stage to stage (pipeline.c gives their order).
#ifndef PROM_BUILDER_BUILD_H
#define PROM_BUILDER_BUILD_H

#include "builder/bake.h"
#include "builder/measure.h"
#include "builder/pipeline.h"
#include "builder/simplify/repair.h"
#include "builder/store.h"
#include "metaobj/base/log.h"
#include "metaobj/base/threads.h"
#include "metaobj/container.h"

#include <pthread.h>

#define PROM_LEVELS_MAX 12
#define PROM_OWN_LEVELS_MAX 8        // of them from simplification; the rest is the artist's
#define PROM_LEVEL_MIN_TRIANGLES 12u // a box has as many
#define PROM_FACE_PX 64              // side of a stored impostor picture
#define PROM_CLUSTER_TRIANGLES 2048u // of a cluster's fine mesh, at most
// Side of an atlas of a cluster's mesh of each level, in texels, at most.
#define PROM_ATLAS_PX(level) (128u >> (level))

typedef struct prom_level {
    prom_mesh mesh; // empty once its representation is written
    float error;
    bool artist;           // came with the scene
    float switch_distance; // as in its representation
    // Known when the prototype is settled:
    bool kept;
    float max_size_px;
    uint32_t device_id; // of the mesh in the renderer
} prom_level;

// The meshes of a leaf's prototype, from fine to cheap.
typedef struct prom_shape_build {
    prom_level levels[PROM_LEVELS_MAX];
    uint32_t level_count;
    prom_mesh merge; // a level with its materials baked to colours, for cluster meshes
    float merge_error;
    prom_repair_report repair;      // of all meshes that came in
    uint64_t hash;                  // of the levels' meshes
    uint64_t levels_key, views_key; // of its units of work
} prom_shape_build;

// The meshes of a cluster's prototype: a fine and a coarse one.
#define PROM_CLUSTER_LEVELS 2
typedef struct prom_cluster_build {
    prom_mesh levels[PROM_CLUSTER_LEVELS];
    float errors[PROM_CLUSTER_LEVELS];
    uint32_t level_count;
    uint64_t hash; // of the levels' meshes
    uint64_t merge_key;
} prom_cluster_build;

typedef struct prom_build_state {
    const prom_build_options *options; // defaults put in
    const char *scene_path, *out_path;
    prom_source source;
    prom_objects objects;
    prom_tree tree;
    prom_texture *textures;       // of the source images
    prom_shape_build *shapes;     // as objects.shapes
    prom_cluster_build *clusters; // as tree.clusters
    prom_repair_report repair;    // of all shapes
    float mean_luminance;         // of the scene, linear
    bool *boxed;                  // per prototype: gets a textured box within the byte budget
    bool *atlased;                // per prototype: its merged meshes get atlases within it

    // What the model will hold. Prototypes: shapes, then clusters.
    prom_model model; // its nodes, once placed; owns nothing else
    prom_prototype *prototypes;
    uint16_t (*coverage)[PROM_DIRS];
    PROM_ARRAY(prom_representation) reps;
    uint32_t gap_meshes; // meshes whose gaps were too large to be kept
    PROM_ARRAY(prom_accuracy_row) accuracy;
    PROM_ARRAY(struct prom_share_row { uint16_t a[PROM_DIRS]; }) shares;
    PROM_ARRAY(prom_mesh_info) mesh_infos;
    PROM_ARRAY(prom_texture_info) texture_infos;
    PROM_ARRAY(prom_material) atlas_materials; // follow the source's

    prom_writer *writer;
    prom_store *store;
    uint64_t program_key, device_key; // what every unit, and every measured unit, depends on
    uint32_t units, units_taken;      // as in the report
    uint32_t views_taken;
    uint64_t views, views_compared; // as in the report
    uint64_t *material_keys;        // per material: its values and its picture
    prom_context *context;
    prom_renderer *renderer;
    prom_baker *baker;
    prom_measure *measure;
    prom_pool *pool;
    pthread_mutex_t lock;
    prom_error failure; // of a unit on some thread, the first; under the lock
} prom_build_state;

// ---- stages, in this order (each in the file of its name)

prom_status prom_stage_textures(prom_build_state *b, prom_error *error);
// Repair, levels, baked colours: on all cores.
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

// Adds a texture to the container.
prom_status prom_build_write_texture(prom_build_state *b, const prom_texture *texture,
                                     uint32_t *id, prom_error *error);
// A prom_fail for a device without memory; `what` as in "meshes".
prom_status prom_build_device_full(const char *what, prom_error *error);

// Keeps a unit of work; may be called from several threads. That it cannot be kept ends the
// build: see prom_build_goes_on.
void prom_build_keep(prom_build_state *b, prom_unit_kind kind, uint64_t key,
                     const prom_pack *pack);
// To be asked before each unit: PROM_OK unless a unit of another thread has failed or all is to
// stop. error: NULL is allowed.
prom_status prom_build_goes_on(prom_build_state *b, prom_error *error);

// Ends a stage's progress and counts its units.
void prom_build_end_progress(prom_build_state *b, prom_progress *progress);

// ---- keys of units: hashes of all that their results depend on (unit_keys.c)

// Of this program with its libraries, and of that on a device.
uint64_t prom_key_of_program(void);
uint64_t prom_key_of_device(const prom_context *context, uint64_t program_key);
// Sets material_keys, once there are textures.
void prom_keys_of_materials(prom_build_state *b);
uint64_t prom_key_of_levels(const prom_build_state *b, uint32_t shape);
// Of what is drawn of a leaf.
uint64_t prom_key_of_leaf_views(const prom_build_state *b, uint32_t shape);
// Of what is made of what a subject's views show.
uint64_t prom_key_of_measured(const prom_build_state *b, uint64_t views_key);
// Of a cluster, but for what it is made of: that is added, part by part, with
// prom_key_add_placed.
uint64_t prom_key_of_merge(const prom_build_state *b, uint32_t cluster);
// Of what is drawn of it, in the same way. Its bounds and its merge_key are set.
uint64_t prom_key_of_cluster_views(const prom_build_state *b, uint32_t cluster);
// Adds the unit `part` and where it stands.
void prom_key_add_placed(uint64_t *key, uint64_t part, const double origin[3],
                         const float basis[9]);

// ---- memory

// Bytes that the work of this process may still take within --memory-mb, at least `least`.
uint64_t prom_build_spare_memory(const prom_build_state *b, uint64_t least);

#endif
