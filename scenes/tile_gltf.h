// A glTF 2 file as JSON plus one block of bytes, to be changed and written as .glb.
#ifndef PROM_SCENES_TILE_GLTF_H
#define PROM_SCENES_TILE_GLTF_H

#include "metaobj/base/alloc.h"
#include "metaobj/base/status.h"

#include <jansson.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct prom_tile_gltf {
    json_t *root;
    PROM_ARRAY(uint8_t) bin; // all buffers, one after the other; bufferViews point into it
} prom_tile_gltf;

// Reads .gltf (buffers in files or data URIs) or .glb; every bufferView lies within `bin`.
prom_status prom_tile_gltf_load(const char *path, prom_tile_gltf *gltf, prom_error *error);
// Moves pictures from files and data URIs into `bin`; one that cannot be found is a warning and
// stays as it is. `path` is that of the scene.
void prom_tile_gltf_embed_images(prom_tile_gltf *gltf, const char *path);
// Writes a .glb atomically.
prom_status prom_tile_gltf_save(const prom_tile_gltf *gltf, const char *path,
                                prom_error *error);
void prom_tile_gltf_finish(prom_tile_gltf *gltf);

// The array `key` of an object; an empty one is made where it is missing.
json_t *prom_tile_gltf_array(json_t *object, const char *key);
// A non-negative integer below `limit`; false if missing or something else.
bool prom_tile_gltf_index(const json_t *object, const char *key, size_t limit, size_t *out);
// A byte count or offset, `missing` where the key is missing; UINT64_MAX if it is no count.
uint64_t prom_tile_gltf_bytes(const json_t *object, const char *key, uint64_t missing);

#endif
