// The build: from a scene file to a .prom container, stage by stage.
#ifndef PROM_BUILDER_PIPELINE_H
#define PROM_BUILDER_PIPELINE_H

#include "builder/objects.h"
#include "builder/source.h"
#include "builder/tree.h"

typedef struct prom_build_options {
    prom_import_options import;
    prom_object_options objects;
    prom_tree_options tree;
    uint32_t texture_mb; // bytes of impostor pictures on the device, in MiB; 0: 256
    const char *profile; // cost profile that the content names; NULL: none
} prom_build_options;

typedef struct prom_build_report {
    uint64_t source_triangles; // instanced
    uint32_t objects, prototypes, nodes, max_children, representations;
    uint64_t file_bytes, peak_bytes;
} prom_build_report;

// Builds scene_path into out_path. Nothing is left behind on failure.
prom_status prom_build(const char *scene_path, const char *out_path,
                       const prom_build_options *options, prom_build_report *report,
                       prom_error *error);

#endif
