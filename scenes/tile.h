// Larger worlds from a glTF scene, repeated as instances on a grid.
#ifndef PROM_SCENES_TILE_H
#define PROM_SCENES_TILE_H

#include "metaobj/base/status.h"

#include <stdint.h>

typedef struct prom_tile_options {
    uint32_t columns, rows; // along x and z; the original is the centre tile
    double spacing[2];      // 0: the layout without its backdrop
} prom_tile_options;

// Copies the nodes in the JSON (meshes, extras and artists' levels survive), one parent node
// per tile; the backdrop stands once. Output .glb with buffers and pictures embedded.
prom_status prom_tile_write(const char *scene_path, const char *glb_path,
                            const prom_tile_options *options, prom_error *error);

#endif
