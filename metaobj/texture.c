#include "metaobj/texture.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/hash.h"

#include <assert.h>

uint32_t prom_texture_kind_layers(uint32_t kind)
{
    switch (kind) {
    case PROM_TEXTURE_COLOR:
        return 1;
    case PROM_TEXTURE_IMPOSTOR_LIT:
        return 6;
    case PROM_TEXTURE_IMPOSTOR_ALBEDO:
        return 12;
    default:
        return 0;
    }
}

uint32_t prom_texture_full_levels(uint32_t width, uint32_t height)
{
    uint32_t levels = 1;
    for (uint32_t size = width > height ? width : height; size > 1; size /= 2) levels++;
    return levels;
}

static size_t layer_bytes(const prom_texture *texture, uint32_t level)
{
    size_t w = texture->width >> level, h = texture->height >> level;
    return (w ? w : 1) * (h ? h : 1) * 4;
}

// At most 8192^2 * 4 * 12 * 4/3 bytes: no overflow in 64 bits once the sizes are checked.
size_t prom_texture_offset(const prom_texture *texture, uint32_t level, uint32_t layer)
{
    size_t bytes = 0;
    for (uint32_t l = 0; l < level; l++) bytes += layer_bytes(texture, l) * texture->layers;
    return bytes + layer_bytes(texture, level) * layer;
}

size_t prom_texture_bytes(const prom_texture *texture)
{
    uint32_t w = texture->width, h = texture->height;
    if (!w || !h || w > PROM_TEXTURE_MAX || h > PROM_TEXTURE_MAX) return 0;
    if (!texture->layers || texture->layers != prom_texture_kind_layers(texture->kind))
        return 0;
    if (texture->levels != prom_texture_full_levels(w, h)) return 0;
    return prom_texture_offset(texture, texture->levels, 0);
}

void prom_texture_init(prom_texture *texture, prom_texture_kind kind, uint32_t width,
                       uint32_t height)
{
    *texture = (prom_texture){
        .kind = kind,
        .width = width,
        .height = height,
        .layers = prom_texture_kind_layers(kind),
        .levels = prom_texture_full_levels(width, height),
    };
    size_t bytes = prom_texture_bytes(texture);
    assert(bytes);
    texture->pixels = prom_calloc(bytes, 1);
}

void prom_texture_finish(prom_texture *texture)
{
    prom_free(texture->pixels);
    *texture = (prom_texture){0};
}

uint64_t prom_texture_hash(const prom_texture *texture, uint64_t seed)
{
    uint32_t head[5] = {texture->kind, texture->width, texture->height, texture->layers,
                        texture->levels};
    uint64_t h = prom_hash(head, sizeof head, seed);
    return prom_hash(texture->pixels, prom_texture_bytes(texture), h);
}
