#include "scenes/gallery_parts.h"

#include "builder/image_io.h"
#include "metaobj/base/math.h"

// The first failure is kept in g->error; the material goes on without a picture.
static uint32_t add_image(prom_gallery *g, const char *name, uint32_t size, const uint8_t *rgb)
{
    uint8_t *png = NULL;
    size_t bytes = 0;
    if (g->error.status || prom_image_encode_png(size, size, 3, rgb, &png, &bytes, &g->error))
        return PROM_GLB_NONE;
    uint32_t id = prom_glb_add_png(g->glb, name, png, bytes);
    prom_free(png);
    return id;
}

static uint32_t image_of(prom_gallery *g, prom_gallery_texture texture)
{
    uint32_t size = prom_gallery_texture_size(texture);
    if (!size) return PROM_GLB_NONE;
    if (g->images[texture] != PROM_GLB_NONE) return g->images[texture];
    if (g->options.detail == 1) size /= 2;
    uint8_t *rgb = prom_alloc((size_t)size * size, 3);
    prom_gallery_texture_draw(texture, size, rgb);
    g->images[texture] = add_image(g, prom_gallery_texture_name(texture), size, rgb);
    prom_free(rgb);
    return g->images[texture];
}

static uint32_t add_material(prom_gallery *g, const char *name, uint32_t image, uint32_t rgb,
                             float alpha)
{
    prom_glb_material material = {
        .name = name,
        .base_color = {prom_srgb_to_linear((float)(rgb >> 16 & 255) / 255),
                       prom_srgb_to_linear((float)(rgb >> 8 & 255) / 255),
                       prom_srgb_to_linear((float)(rgb & 255) / 255), alpha},
        .image = image,
        .alpha = alpha < 1 ? PROM_GLB_BLEND : PROM_GLB_OPAQUE,
        .double_sided = alpha < 1,
    };
    return prom_glb_add_material(g->glb, &material);
}

static prom_paint find_paint(prom_gallery *g, prom_gallery_texture texture, uint32_t rgb,
                             float alpha, float repeat)
{
    for (size_t i = 0; i < g->paints.count; i++) {
        const prom_gallery_paint_record *p = &g->paints.data[i];
        if (p->texture == texture && p->rgb == rgb && p->alpha == alpha)
            return (prom_paint){p->material, repeat};
    }
    char *name = prom_format("%s_%06x", prom_gallery_texture_name(texture), rgb);
    uint32_t id = add_material(g, name, image_of(g, texture), rgb, alpha);
    prom_free(name);
    prom_array_push(&g->paints, (prom_gallery_paint_record){texture, rgb, id, alpha});
    return (prom_paint){id, repeat};
}

prom_paint prom_gallery_paint(prom_gallery *g, prom_gallery_texture texture, uint32_t rgb,
                              float repeat)
{
    return find_paint(g, texture, rgb, 1, repeat);
}

prom_paint prom_gallery_glass(prom_gallery *g)
{
    return find_paint(g, PROM_GALLERY_PLAIN, 0xdcecf0, 0.13f, 1);
}

prom_paint prom_gallery_canvas(prom_gallery *g, uint32_t number, float aspect, uint32_t size)
{
    uint8_t *rgb = prom_alloc((size_t)size * size, 3);
    prom_gallery_picture_draw(g->options.seed, number, aspect, size, rgb);
    char *name = prom_format("painting_%03u", number);
    uint32_t id = add_material(g, name, add_image(g, name, size, rgb), 0xffffff, 1);
    prom_free(name);
    prom_free(rgb);
    return (prom_paint){id, 1};
}
