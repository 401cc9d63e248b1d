// The build: from a scene file to a .prom container, stage by stage.
#ifndef PROM_BUILDER_PIPELINE_H
#define PROM_BUILDER_PIPELINE_H

#include "benefit/weights.h"
#include "builder/measure.h"
#include "builder/objects.h"
#include "builder/source.h"
#include "builder/tree.h"

// From where on nothing is taken over from earlier builds. Import, objects, tree and textures
// are quick and done each time.
typedef enum prom_build_from {
    PROM_BUILD_FROM_NOWHERE, // all that is still right is taken over
    PROM_BUILD_FROM_START,
    PROM_BUILD_FROM_LEAVES,
    PROM_BUILD_FROM_CLUSTERS,
    PROM_BUILD_FROM_VIEW_CELLS, // see builder/view_cells.h
} prom_build_from;

typedef struct prom_build_options {
    prom_import_options import;
    prom_object_options objects;
    prom_tree_options tree;
    prom_measure_options measure;
    // By names of the scene's nodes, of which only leaves are in the model: what is below a
    // named one is weighed like it.
    prom_weight_rules weights;
    uint32_t texture_mb; // bytes of impostor pictures on the device, in MiB; 0: 256
    const char *profile; // cost profile that the content names; NULL: none
    // That the work may take, beside what the device's driver does; 0: any. It changes nothing
    // in the model, and so is no limit on import, which has its own.
    uint32_t memory_mb;
    // What earlier builds left in X.prom.work:
    prom_build_from from;   // stages from this one on are done anew
    bool keep_views;        // pictures that are drawn are kept: other metrics need not draw
    bool drop_work;         // it is deleted when the build has succeeded
    bool view_cells_follow; // prom_view_cells_build will be called for the model: what earlier
                            // calls of it left is kept
} prom_build_options;

typedef struct prom_build_report {
    uint64_t source_triangles; // instanced
    uint32_t objects, prototypes, nodes, max_children, representations;
    uint32_t units, units_taken; // of work: all, and those taken from earlier builds
    uint32_t views_taken;        // prototypes measured anew in pictures from earlier builds
    // Directions from which representations were measured in this build, and in how many of
    // them pictures were compared; in the others accuracies are interpolated.
    uint64_t views, views_compared;
    uint64_t file_bytes, work_bytes, peak_bytes;
} prom_build_report;

// Builds scene_path into out_path. On failure the model is as it was before, and what was done
// so far is kept beside it in out_path.work: the next build goes on from there, whatever
// stopped this one (prom_stop_request: PROM_ERR_STOPPED). Finished, the work file serves builds
// with other settings; it may be deleted at any time. Uses prom_thread_count() cores.
prom_status prom_build(const char *scene_path, const char *out_path,
                       const prom_build_options *options, prom_build_report *report,
                       prom_error *error);

#endif
