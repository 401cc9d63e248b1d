// Textures on the device: array textures ("pools") by size, whose layers are
// handed out in order. Private to render/.
#ifndef PROM_RENDER_TEXTURE_STORE_H
#define PROM_RENDER_TEXTURE_STORE_H

#include "metaobj/base/alloc.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"

#include <epoxy/gl.h>

typedef struct texture_pool {
    uint32_t width, height, levels;
    GLuint name;             // GL_TEXTURE_2D_ARRAY, changes when the pool grows; 0 while empty
    uint32_t used, capacity; // layers
} texture_pool;

// Where a texture's layers stand: consecutive in a pool.
typedef struct stored_texture {
    uint32_t kind;
    uint32_t pool, layer; // of the first
} stored_texture;

typedef struct texture_store {
    uint32_t max_layers; // of the device
    PROM_ARRAY(texture_pool) pools;
    PROM_ARRAY(stored_texture) textures;
    stored_texture white; // for materials without a picture in kinds that sample one
} texture_store;

// false when the device has no memory left.
bool texture_store_init(texture_store *store);
void texture_store_finish(texture_store *store);
// Room for all of these, so that loading a model makes no pool larger than it must be.
bool texture_store_reserve(texture_store *store, const prom_texture_info *infos,
                           uint32_t count);
// The new texture's id, or PROM_NONE when the device has no memory left.
uint32_t texture_store_add(texture_store *store, const prom_texture *texture);
void texture_store_truncate(texture_store *store, uint32_t count);
uint64_t texture_store_bytes(const texture_store *store);

#endif
