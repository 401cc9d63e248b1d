#include "builder/file_io.h"
#include "builder/image_io.h"
#include "builder/import_parts.h"

#include <stdlib.h>

// Mid grey, sRGB-encoded 0.5 of linear light: stands for a picture that is missing.
#define NEUTRAL 188

typedef struct pixels {
    uint32_t width, height;
    uint8_t *rgba;
} pixels;

static const struct aiTexture *find_embedded(const struct aiScene *scene, const char *name)
{
    if (*name == '*') {
        char *end;
        unsigned long index = strtoul(name + 1, &end, 10);
        return end != name + 1 && !*end && index < scene->mNumTextures ? scene->mTextures[index]
                                                                       : NULL;
    }
    for (unsigned i = 0; i < scene->mNumTextures; i++)
        if (scene->mTextures[i]->mFilename.length &&
            !strcmp(scene->mTextures[i]->mFilename.data, name))
            return scene->mTextures[i];
    return NULL;
}

// Texels that a loader decoded itself: BGRA. They go through PNG so that the reduction to
// max_texture_px has one home.
static prom_status read_texels(const prom_import *import, const struct aiTexture *t,
                               const char *name, pixels *out, prom_error *error)
{
    size_t count = (size_t)t->mWidth * t->mHeight;
    if (!count || t->mWidth > 16384 || t->mHeight > 16384)
        return prom_fail(error, PROM_ERR_INPUT, "%s: the embedded picture has no usable size",
                         name);
    uint8_t *rgba = prom_alloc(count, 4), *png = NULL;
    for (size_t i = 0; i < count; i++) {
        const struct aiTexel *p = &t->pcData[i];
        memcpy(rgba + 4 * i, (uint8_t[4]){p->r, p->g, p->b, p->a}, 4);
    }
    size_t bytes = 0;
    prom_status status =
        prom_image_encode_png(t->mWidth, t->mHeight, 4, rgba, &png, &bytes, error);
    prom_free(rgba);
    if (status) return status;
    status = prom_image_read_memory(png, bytes, name, import->options.max_texture_px,
                                    &out->width, &out->height, &out->rgba, error);
    prom_free(png);
    return status;
}

static prom_status read_picture(const prom_import *import, const char *name, pixels *out,
                                prom_error *error)
{
    uint32_t max_px = import->options.max_texture_px;
    const struct aiTexture *embedded = find_embedded(import->scene, name);
    if (embedded && embedded->mHeight) return read_texels(import, embedded, name, out, error);
    if (embedded)
        return prom_image_read_memory(embedded->pcData, embedded->mWidth, name, max_px,
                                      &out->width, &out->height, &out->rgba, error);
    char *path = prom_file_find(import->path, name);
    if (!path) return prom_fail(error, PROM_ERR_INPUT, "%s: not found", name);
    prom_status status =
        prom_image_read(path, max_px, &out->width, &out->height, &out->rgba, error);
    prom_free(path);
    return status;
}

static uint8_t min_alpha(const pixels *p)
{
    uint8_t least = 255;
    for (size_t i = 0; i < (size_t)p->width * p->height; i++)
        if (p->rgba[4 * i + 3] < least) least = p->rgba[4 * i + 3];
    return least;
}

// The opacity that a texel of a mask stands for: its alpha where the picture has one, else its
// brightness.
static float opacity(const pixels *mask, bool alpha, int64_t x, int64_t y)
{
    const uint8_t *p = mask->rgba + 4 * ((size_t)y * mask->width + (size_t)x);
    return alpha ? (float)p[3] : (float)(p[0] + p[1] + p[2]) / 3.0f;
}

// Fills the alpha of `color` from a mask of any size, bilinearly.
static void merge_mask(pixels *color, const pixels *mask)
{
    bool alpha = min_alpha(mask) < 255;
    for (uint32_t y = 0; y < color->height; y++)
        for (uint32_t x = 0; x < color->width; x++) {
            double u = ((double)x + 0.5) / color->width * mask->width - 0.5;
            double v = ((double)y + 0.5) / color->height * mask->height - 0.5;
            int64_t x0 = (int64_t)fmax(u, 0), y0 = (int64_t)fmax(v, 0);
            int64_t x1 = x0 + 1 < mask->width ? x0 + 1 : x0;
            int64_t y1 = y0 + 1 < mask->height ? y0 + 1 : y0;
            float fx = (float)fmax(u - (double)x0, 0), fy = (float)fmax(v - (double)y0, 0);
            float top =
                opacity(mask, alpha, x0, y0) * (1 - fx) + opacity(mask, alpha, x1, y0) * fx;
            float low =
                opacity(mask, alpha, x0, y1) * (1 - fx) + opacity(mask, alpha, x1, y1) * fx;
            color->rgba[4 * ((size_t)y * color->width + x) + 3] =
                (uint8_t)(top * (1 - fy) + low * fy + 0.5f);
        }
}

static pixels plain(uint32_t width, uint32_t height, uint8_t value)
{
    pixels p = {width, height, prom_alloc((size_t)width * height, 4)};
    memset(p.rgba, value, (size_t)width * height * 4);
    for (size_t i = 0; i < (size_t)width * height; i++) p.rgba[4 * i + 3] = 255;
    return p;
}

static char *complaint(const prom_import_picture *picture, const prom_error *error,
                       const char *instead)
{
    return prom_format("%s (material '%s'); %s", error->text, picture->material, instead);
}

static void take(prom_import_picture *picture, const pixels *color)
{
    picture->width = color->width;
    picture->height = color->height;
    picture->rgba = color->rgba;
    picture->min_alpha = min_alpha(color);
}

void prom_import_picture_lost(prom_import_picture *picture, const prom_error *error)
{
    pixels grey = plain(1, 1, NEUTRAL);
    picture->warning = complaint(picture, error, "a neutral grey stands in");
    picture->missing = true;
    take(picture, &grey);
}

void prom_import_picture_decode(const prom_import *import, prom_import_picture *picture)
{
    prom_error error;
    pixels color = {0}, mask = {0};
    if (picture->color && read_picture(import, picture->color, &color, &error)) {
        prom_import_picture_lost(picture, &error);
        return;
    }
    if (picture->mask) {
        bool good = !read_picture(import, picture->mask, &mask, &error);
        if (!good) picture->warning = complaint(picture, &error, "it stays opaque");
        if (!color.rgba) color = good ? plain(mask.width, mask.height, 255) : plain(1, 1, 255);
        if (good) merge_mask(&color, &mask);
        prom_free(mask.rgba);
    }
    take(picture, &color);
}
