// The materials' pictures: with mips, on the device and in the container.
#include "builder/build.h"

#include "builder/textures.h"

prom_status prom_build_device_full(const char *what, prom_error *error)
{
    return prom_fail(error, PROM_ERR_UNSUPPORTED,
                     "the device has no memory for more %s; lower --max-texture-px or "
                     "--texture-mb",
                     what);
}

prom_status prom_build_write_texture(prom_build_state *b, const prom_texture *texture,
                                     uint32_t *id, prom_error *error)
{
    prom_status status = prom_writer_add_texture(b->writer, texture, id, error);
    if (status) return status;
    prom_array_push(&b->texture_infos,
                    (prom_texture_info){texture->kind, texture->width, texture->height,
                                        texture->layers, texture->levels});
    return PROM_OK;
}

prom_status prom_stage_textures(prom_build_state *b, prom_error *error)
{
    size_t count = b->source.images.count;
    b->textures = prom_calloc(count, sizeof *b->textures);
    prom_textures_make(&b->source, b->textures);
    for (size_t i = 0; i < count; i++) {
        prom_free(b->source.images.data[i].rgba); // the texture holds it now
        b->source.images.data[i].rgba = NULL;
        uint32_t id; // the materials' number, in the container and on the device
        prom_status status = prom_build_write_texture(b, &b->textures[i], &id, error);
        if (status) return status;
        if (prom_renderer_add_texture(b->renderer, &b->textures[i]) == PROM_NONE)
            return prom_build_device_full("textures", error);
    }
    prom_renderer_set_materials(b->renderer, b->source.materials.data,
                                (uint32_t)b->source.materials.count);
    prom_keys_of_materials(b);
    return PROM_OK;
}
