// Where the parts of a glTF scene stand, and which of them are backdrop.
#ifndef PROM_SCENES_TILE_GLTF_LAYOUT_H
#define PROM_SCENES_TILE_GLTF_LAYOUT_H

#include "scenes/tile_gltf.h"

// A primitive of a placed mesh.
typedef struct prom_tile_gltf_part {
    uint32_t node, mesh, primitive;
    double min[3], max[3]; // world
    bool backdrop;
} prom_tile_gltf_part;

typedef struct prom_tile_gltf_layout {
    PROM_ARRAY(prom_tile_gltf_part) parts; // the parts of a node stand together
    double (*world)[16];                   // per node of the file, column-major
    bool *placed;                          // per node: it is below the scene
    double min[3], max[3];                 // of all parts but the backdrop
    uint32_t backdrops;
} prom_tile_gltf_layout;

// Walks the scene (an array of root nodes). Errors: nodes that do not exist, stand in several
// places or below themselves; no geometry at all.
//
// Backdrop is what is wider than three times the middle of the scene: the range, along the
// wider of x and z, that holds the centres of nine in ten parts. The mean of the bounds would
// not do: a sky and its sea support each other.
prom_status prom_tile_gltf_layout_find(const prom_tile_gltf *gltf, const char *path,
                                       const json_t *roots, prom_tile_gltf_layout *layout,
                                       prom_error *error);
void prom_tile_gltf_layout_finish(prom_tile_gltf_layout *layout);

#endif
