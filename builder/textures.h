// Material textures from source images: square powers of two with stored mips.
#ifndef PROM_BUILDER_TEXTURES_H
#define PROM_BUILDER_TEXTURES_H

#include "builder/source.h"

// Makes textures[i] (zeroed, source->images.count of them) of every image, on all cores. Sides
// are the power of two nearest to the image's longer side, from 4 to 1024; images of masked
// materials keep their alpha's coverage over the mips.
void prom_textures_make(const prom_source *source, prom_texture *textures);

#endif
