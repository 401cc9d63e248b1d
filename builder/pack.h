// Results of work as bytes, for the store: appended in order, taken back with every size
// checked.
#ifndef PROM_BUILDER_PACK_H
#define PROM_BUILDER_PACK_H

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"
#include "metaobj/texture.h"

#include <stdbool.h>
#include <stdint.h>

typedef PROM_ARRAY(uint8_t) prom_pack;

void prom_pack_bytes(prom_pack *pack, const void *data, size_t bytes);
void prom_pack_mesh(prom_pack *pack, const prom_mesh *mesh); // an empty one too
void prom_pack_texture(prom_pack *pack, const prom_texture *texture);

// What is left to be taken. After the first thing that is not as it should be `failed` is set,
// and everything else taken is zero or empty.
typedef struct prom_unpack {
    const uint8_t *at;
    size_t left;
    bool failed;
} prom_unpack;

void prom_unpack_bytes(prom_unpack *unpack, void *data, size_t bytes);
uint32_t prom_unpack_u32(prom_unpack *unpack, uint32_t most); // fails above `most`
// Fails for materials from material_count on. The caller frees the result, failed or not.
void prom_unpack_mesh(prom_unpack *unpack, uint32_t material_count, prom_mesh *mesh);
void prom_unpack_texture(prom_unpack *unpack, prom_texture *texture);
// All was taken, and nothing failed.
bool prom_unpack_end(const prom_unpack *unpack);

#endif
