// Private to import: what is read from a glTF file before assimp gets it. assimp drops meshes
// and nodes that are referenced only as levels of detail, and gives the same error whether a
// file has no triangles or its buffers are missing; this looks at the JSON for both.
//
// Steps: prom_gltf_read; give assimp `text` where there is one (import_file.c); read the nodes
// (import_scene.c takes their names from `names`); prom_import_levels_attach; prom_gltf_finish.
#ifndef PROM_BUILDER_IMPORT_GLTF_H
#define PROM_BUILDER_IMPORT_GLTF_H

#include "builder/file_io.h"
#include "metaobj/base/alloc.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

// A coarser level: the node that holds it, and up to where it is shown.
typedef struct prom_gltf_level {
    uint32_t node;
    double until; // see prom_gltf_lod
} prom_gltf_level;

// A node with levels.
typedef struct prom_gltf_lod {
    uint32_t node;
    uint32_t first_level, level_count; // range in levels, from fine to coarse
    double until;                      // of the node itself
    bool coverage; // limits are least shares of the picture (MSFT_lod), else distances
    bool in_frame; // levels stand in the node's frame, else in its parent's
} prom_gltf_lod;

typedef struct prom_gltf {
    prom_bytes file;    // as it lies on the disk
    const uint8_t *bin; // GLB: the binary chunk, in `file`
    size_t bin_bytes;   // 0: none
    bool glb, has_bin;
    json_t *root;
    uint32_t node_count;      // of the file itself
    bool tangled;             // a node has several parents, against the rules
    bool changed;             // root is no longer what the file says
    bool numbered;            // nodes are named PROM_GLTF_NODE and their number
    PROM_ARRAY(char *) names; // what the nodes are called; while numbered
    PROM_ARRAY(prom_gltf_lod) lods;
    PROM_ARRAY(prom_gltf_level) levels;
    prom_bytes text; // what assimp is to read instead of the file; .data NULL: the file
} prom_gltf;

#define PROM_GLTF_NODE "promenade-node-"

struct prom_import;

// Reads a file that ends in .gltf or .glb; any other, and glTF 1, leave *gltf empty. Errors:
// broken JSON with line and column, nothing to be drawn, missing buffers. *gltf is to be
// finished in any case.
prom_status prom_gltf_read(struct prom_import *import, prom_gltf *gltf, prom_error *error);
void prom_gltf_finish(prom_gltf *gltf);

// import_gltf_check.c: that arrays are arrays and indices in range, that the nodes are a
// forest, and that there are triangles with data. Sees to it that there is a default scene.
prom_status prom_gltf_check(struct prom_import *import, prom_gltf *gltf, prom_error *error);

// import_gltf_lod.c: takes the levels out of the JSON and hangs their nodes into the scene.
void prom_gltf_take_lods(struct prom_import *import, prom_gltf *gltf);

// ---- JSON, in import_gltf.c: values of the wrong type count as absent

// The element of an array member of the root, or NULL.
json_t *prom_gltf_element(const json_t *root, const char *array, uint32_t index);
// A non-negative integer below `limit` (3.0 counts as 3); false if there is none.
bool prom_gltf_index(const json_t *value, uint64_t limit, uint64_t *index);

#endif
