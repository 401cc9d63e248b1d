#include "builder/textures.h"

#include "builder/image_io.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/log.h"
#include "metaobj/base/threads.h"

#define SIDE_MIN 4u
#define SIDE_MAX 1024u

typedef struct job {
    const prom_source *source;
    const float *cutoffs; // per image; 0: not masked
    prom_texture *textures;
} job;

static uint32_t side_for(uint32_t width, uint32_t height)
{
    uint32_t longer = width > height ? width : height, side = SIDE_MIN;
    while (side < SIDE_MAX && side * 4 <= longer * 3)
        side *= 2; // nearest in the geometric sense
    return side;
}

static void make_one(void *user, size_t i, unsigned thread)
{
    (void)thread;
    const job *j = user;
    const prom_source_image *image = &j->source->images.data[i];
    prom_texture *t = &j->textures[i];
    uint32_t side = side_for(image->width, image->height);
    prom_texture_init(t, PROM_TEXTURE_COLOR, side, side);
    if (!prom_image_resize(image->rgba, image->width, image->height, t->pixels, side, side))
        prom_log(PROM_LOG_WARNING, "%s: the picture cannot be resampled; it is left black",
                 image->name);
    if (j->cutoffs[i] > 0) prom_texture_dilate(t, 8);
    prom_texture_make_mips(t, j->cutoffs[i]);
}

void prom_textures_make(const prom_source *source, prom_texture *textures)
{
    float *cutoffs = prom_calloc(source->images.count, sizeof *cutoffs);
    for (size_t m = 0; m < source->materials.count; m++) {
        const prom_material *material = &source->materials.data[m];
        if (material->texture != PROM_NONE && material->alpha_mode == PROM_ALPHA_MASK)
            cutoffs[material->texture] = material->alpha_cutoff;
    }
    job j = {.source = source, .cutoffs = cutoffs, .textures = textures};
    prom_parallel_for(source->images.count, make_one, &j);
    prom_free(cutoffs);
}
