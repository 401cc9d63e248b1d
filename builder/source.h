// The source scene: what import reads from a file, before any decision about objects.
#ifndef PROM_BUILDER_SOURCE_H
#define PROM_BUILDER_SOURCE_H

#include "metaobj/base/status.h"
#include "metaobj/mesh.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"

#include <stdbool.h>

// A decoded picture: sRGB RGBA8, first row on top, at most max_texture_px on a side.
typedef struct prom_source_image {
    char *name;             // as the scene names it
    char *mask;             // the picture that its alpha came from, if another; else ""
    uint32_t width, height; // 1x1 neutral grey when it was missing or broken
    uint8_t *rgba;
    bool missing;
} prom_source_image;

// A level of detail that came with the scene (glTF: MSFT_lod, or extras.lods). It stands for
// the node's own meshes.
typedef struct prom_source_level {
    uint32_t first_mesh, mesh_count; // range in mesh_refs
    float until; // distance up to which it is shown, scene units; INFINITY: any
} prom_source_level;

// A node of the file's hierarchy; parents come before children.
typedef struct prom_source_node {
    char *name;
    uint32_t parent;                   // PROM_NONE for the root
    double local[16];                  // column-major, to the parent
    double world[16];                  // the product up to the root
    uint32_t first_mesh, mesh_count;   // range in mesh_refs
    uint32_t first_level, level_count; // range in levels: coarser ones, from fine to coarse
    float until;                       // of its own meshes, as in prom_source_level
} prom_source_node;

typedef struct prom_source {
    PROM_ARRAY(prom_source_node) nodes;
    PROM_ARRAY(uint32_t) mesh_refs;
    PROM_ARRAY(prom_source_level) levels;
    PROM_ARRAY(prom_mesh) meshes; // one submesh each, normals present, unused vertices removed
    PROM_ARRAY(prom_material) materials; // equal ones merged; texture = index into images
    PROM_ARRAY(prom_source_image) images;
    uint64_t file_bytes;
    uint64_t content_hash; // of the file and what it refers to, as imported
    prom_arena strings;
} prom_source;

// Which axis of the file points upwards. In a source it is always y.
typedef enum prom_up_axis {
    PROM_UP_FROM_FILE = 0, // what it says, or what is usual in its format (3DS: z; else y)
    PROM_UP_Y = 1,
    PROM_UP_Z = 2,
} prom_up_axis;

typedef struct prom_import_options {
    uint32_t max_texture_px; // pictures are reduced to this; 0: 1024
    uint64_t memory_bytes;   // address space of each process that reads; 0: 8 GiB
    uint32_t time_s;         // processor time of the child; 0: 300
    prom_up_axis up;
    double unit_m; // metres that a unit of the file stands for; 0: what it says, or 1
} prom_import_options;

// Reads a scene through assimp in a child process, pictures in children of that. Missing or
// broken textures are warnings; a file without triangles, a crash, a hang or a lack of memory
// in the loader is an error with the file's name. PROM_ERR_USAGE for a unit that is no length.
prom_status prom_source_import(const char *path, const prom_import_options *options,
                               prom_source *source, prom_error *error);
void prom_source_finish(prom_source *source);

#endif
