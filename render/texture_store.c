#include "render/texture_store.h"

#include "metaobj/mesh.h"

#include <assert.h>

// A pool grows by copying, so that for a moment it exists twice; larger sets get further pools.
#define MAX_POOL_BYTES ((uint64_t)256 << 20)
#define MIN_POOL_LAYERS 12u // a texture of any kind must fit
#define WHITE_SIZE 8        // as many mips as other pictures have: one sampling variant for all

static uint64_t layer_bytes(uint32_t width, uint32_t height)
{
    uint64_t bytes = 0;
    for (;; width = width > 1 ? width / 2 : 1, height = height > 1 ? height / 2 : 1) {
        bytes += (uint64_t)width * height * 4;
        if (width == 1 && height == 1) return bytes;
    }
}

static uint32_t pool_limit(const texture_store *store, const texture_pool *pool)
{
    uint64_t limit = MAX_POOL_BYTES / layer_bytes(pool->width, pool->height);
    if (limit < MIN_POOL_LAYERS) limit = MIN_POOL_LAYERS;
    return limit < store->max_layers ? (uint32_t)limit : store->max_layers;
}

static GLuint make_array(const texture_pool *pool, uint32_t layers)
{
    GLuint name;
    while (glGetError() != GL_NO_ERROR) {
    } // what is checked below is ours
    glCreateTextures(GL_TEXTURE_2D_ARRAY, 1, &name);
    glTextureStorage3D(name, (GLsizei)pool->levels, GL_RGBA8, (GLsizei)pool->width,
                       (GLsizei)pool->height, (GLsizei)layers);
    if (glGetError() == GL_NO_ERROR) return name;
    glDeleteTextures(1, &name);
    return 0;
}

static uint32_t level_size(uint32_t size, uint32_t level)
{
    return size >> level ? size >> level : 1;
}

static bool grow_to(texture_pool *pool, uint32_t layers)
{
    GLuint grown = make_array(pool, layers);
    if (!grown) return false;
    for (uint32_t level = 0; pool->used && level < pool->levels; level++)
        glCopyImageSubData(pool->name, GL_TEXTURE_2D_ARRAY, (GLint)level, 0, 0, 0, grown,
                           GL_TEXTURE_2D_ARRAY, (GLint)level, 0, 0, 0,
                           (GLsizei)level_size(pool->width, level),
                           (GLsizei)level_size(pool->height, level), (GLsizei)pool->used);
    glDeleteTextures(1, &pool->name);
    pool->name = grown;
    pool->capacity = layers;
    return true;
}

// Room for `layers` more layers, which the pool's limit allows.
static bool pool_reserve(const texture_store *store, texture_pool *pool, uint32_t layers,
                         bool exact)
{
    uint32_t needed = pool->used + layers, limit = pool_limit(store, pool);
    if (needed <= pool->capacity) return true;
    uint32_t doubled = pool->capacity * 2;
    if (exact || doubled < needed) doubled = needed;
    if (doubled > limit) doubled = limit;
    return grow_to(pool, doubled) || (doubled > needed && grow_to(pool, needed));
}

// The first pool of a class that can still hold `layers` layers; made if there is none.
static uint32_t find_pool(texture_store *store, uint32_t width, uint32_t height,
                          uint32_t layers)
{
    for (uint32_t i = 0; i < store->pools.count; i++) {
        const texture_pool *p = &store->pools.data[i];
        if (p->width == width && p->height == height &&
            p->used + layers <= pool_limit(store, p))
            return i;
    }
    prom_array_push(&store->pools,
                    (texture_pool){.width = width,
                                   .height = height,
                                   .levels = prom_texture_full_levels(width, height)});
    return (uint32_t)store->pools.count - 1;
}

// Uploads all layers of a texture, to `layer` and the following ones.
static void upload(const texture_pool *pool, const prom_texture *texture, uint32_t layer)
{
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    for (uint32_t level = 0; level < texture->levels; level++)
        glTextureSubImage3D(pool->name, (GLint)level, 0, 0, (GLint)layer,
                            (GLsizei)level_size(texture->width, level),
                            (GLsizei)level_size(texture->height, level),
                            (GLsizei)texture->layers, GL_RGBA, GL_UNSIGNED_BYTE,
                            texture->pixels + prom_texture_offset(texture, level, 0));
}

static void drop_from(texture_pool *pool, uint32_t layer)
{
    if (layer < pool->used) pool->used = layer;
    if (pool->used) return;
    glDeleteTextures(1, &pool->name);
    pool->name = 0;
    pool->capacity = 0;
}

static bool store_texture(texture_store *store, const prom_texture *texture, stored_texture *s)
{
    uint32_t index = find_pool(store, texture->width, texture->height, texture->layers);
    texture_pool *pool = &store->pools.data[index];
    if (!pool_reserve(store, pool, texture->layers, false)) return false;
    *s = (stored_texture){.kind = texture->kind, .pool = index, .layer = pool->used};
    pool->used += texture->layers;
    upload(pool, texture, s->layer);
    return true;
}

bool texture_store_init(texture_store *store)
{
    GLint layers = 0;
    glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &layers);
    *store = (texture_store){.max_layers = (uint32_t)layers};
    prom_texture white;
    prom_texture_init(&white, PROM_TEXTURE_COLOR, WHITE_SIZE, WHITE_SIZE);
    memset(white.pixels, 255, prom_texture_bytes(&white));
    bool ok = store_texture(store, &white, &store->white);
    prom_texture_finish(&white);
    return ok;
}

void texture_store_finish(texture_store *store)
{
    for (size_t i = 0; i < store->pools.count; i++)
        glDeleteTextures(1, &store->pools.data[i].name);
    prom_array_finish(&store->pools);
    prom_array_finish(&store->textures);
}

bool texture_store_reserve(texture_store *store, const prom_texture_info *infos, uint32_t count)
{
    // Hand out the layers without memory, note what each pool came to, and take them back.
    size_t known = store->pools.count;
    uint32_t *before = prom_calloc(known, sizeof *before);
    for (size_t i = 0; i < known; i++) before[i] = store->pools.data[i].used;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t layers = prom_texture_kind_layers(infos[i].kind);
        uint32_t pool = find_pool(store, infos[i].width, infos[i].height, layers);
        store->pools.data[pool].used += layers;
    }
    bool ok = true;
    for (size_t i = 0; i < store->pools.count; i++) {
        texture_pool *p = &store->pools.data[i];
        uint32_t layers = p->used - (i < known ? before[i] : 0);
        p->used -= layers;
        ok = ok && pool_reserve(store, p, layers, true);
    }
    prom_free(before);
    return ok;
}

uint32_t texture_store_add(texture_store *store, const prom_texture *texture)
{
    assert(texture->layers == prom_texture_kind_layers(texture->kind));
    assert(texture->levels == prom_texture_full_levels(texture->width, texture->height));
    stored_texture s;
    if (!store_texture(store, texture, &s)) return PROM_NONE;
    prom_array_push(&store->textures, s);
    return (uint32_t)store->textures.count - 1;
}

void texture_store_truncate(texture_store *store, uint32_t count)
{
    while (store->textures.count > count) {
        const stored_texture *s = &store->textures.data[--store->textures.count];
        drop_from(&store->pools.data[s->pool], s->layer);
    }
}

uint64_t texture_store_bytes(const texture_store *store)
{
    uint64_t bytes = 0;
    for (size_t i = 0; i < store->pools.count; i++) {
        const texture_pool *p = &store->pools.data[i];
        bytes += p->capacity * layer_bytes(p->width, p->height);
    }
    return bytes;
}
