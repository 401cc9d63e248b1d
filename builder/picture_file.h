// Pictures from foreign files, with their values kept as they are: for comparing, not for
// drawing (image_io.h is for that). Decoders crash, loop and ask for too much, so each file is
// decoded in a process of its own.
#ifndef PROM_BUILDER_PICTURE_FILE_H
#define PROM_BUILDER_PICTURE_FILE_H

#include "benefit/metric.h"

#define PROM_PICTURE_SIDE_MAX 16384u
#define PROM_PICTURE_PIXELS_MAX ((uint64_t)1 << 26)

typedef struct prom_picture_file {
    prom_picture picture; // of 1 or 3 channels, rows close together
    void *pixels;         // its pixels, owned
    bool transparent;     // its alpha, which is left out, is not 1 everywhere
    uint32_t left_out;    // further channels that are neither colour nor alpha
} prom_picture_file;

// Reads the first picture of a file that OpenImageIO knows. Integers of up to 8 bits stay as
// they are, sRGB-encoded; wider ones become floats in linear light; floats stay as they are, in
// linear light. Palettes are expanded; grey stays one channel; colours are not multiplied by
// alpha; no colour profile is applied. An EXR's pixels are put into its display window.
// PROM_ERR_INPUT: missing, damaged, beyond the limits above, or with values that are not
// finite; the message names the file. Free with prom_picture_file_finish, also after an error.
prom_status prom_picture_file_read(const char *path, prom_picture_file *file,
                                   prom_error *error);
void prom_picture_file_finish(prom_picture_file *file); // {0} is allowed

// Brings two pictures to one form, the richer one: colours if either has some, floats if either
// has.
void prom_picture_files_match(prom_picture_file *a, prom_picture_file *b);

#endif
