#include "scenes/city_parts.h"

#include "builder/image_io.h"
#include "metaobj/base/math.h"

static uint32_t image_of(prom_city *city, prom_city_texture texture)
{
    uint32_t size = prom_city_texture_size(texture);
    if (!size) return PROM_GLB_NONE;
    if (city->images[texture] != PROM_GLB_NONE) return city->images[texture];
    uint8_t *rgba = prom_alloc((size_t)size * size, 4), *png = NULL;
    size_t bytes = 0;
    int channels = prom_city_texture_masked(texture) ? 4 : 3;
    prom_city_texture_draw(texture, rgba);
    for (size_t i = 0; channels == 3 && i < (size_t)size * size; i++)
        memmove(rgba + 3 * i, rgba + 4 * i, 3);
    if (city->error.status ||
        prom_image_encode_png(size, size, channels, rgba, &png, &bytes, &city->error)) {
        // The first failure is kept in city->error; the material goes on without a picture.
        prom_free(rgba);
        return PROM_GLB_NONE;
    }
    city->images[texture] =
        prom_glb_add_png(city->glb, prom_city_texture_name(texture), png, bytes);
    prom_free(png);
    prom_free(rgba);
    return city->images[texture];
}

prom_paint prom_city_paint(prom_city *city, prom_city_texture texture, uint32_t rgb,
                           float repeat)
{
    for (size_t i = 0; i < city->paints.count; i++) {
        const prom_city_paint_record *p = &city->paints.data[i];
        if (p->texture == texture && p->rgb == rgb) return (prom_paint){p->material, repeat};
    }
    char *name = prom_format("%s_%06x", prom_city_texture_name(texture), rgb);
    bool masked = prom_city_texture_masked(texture);
    prom_glb_material material = {
        .name = name,
        .base_color = {prom_srgb_to_linear((float)(rgb >> 16 & 255) / 255),
                       prom_srgb_to_linear((float)(rgb >> 8 & 255) / 255),
                       prom_srgb_to_linear((float)(rgb & 255) / 255), 1},
        .image = image_of(city, texture),
        .alpha = masked ? PROM_GLB_MASK : PROM_GLB_OPAQUE,
        .alpha_cutoff = 0.5f,
        .double_sided = masked,
    };
    uint32_t id = prom_glb_add_material(city->glb, &material);
    prom_free(name);
    prom_array_push(&city->paints, (prom_city_paint_record){texture, rgb, id});
    return (prom_paint){id, repeat};
}

prom_paint prom_city_plain(prom_city *city, uint32_t rgb)
{
    return prom_city_paint(city, PROM_CITY_PLAIN, rgb, 1);
}

int prom_city_sides(const prom_city *city, int at_two)
{
    static const float factor[5] = {1, 0.5f, 1, 1.6f, 2.5f};
    int sides = (int)((float)at_two * factor[city->options.detail]);
    return sides < 3 ? 3 : sides;
}
