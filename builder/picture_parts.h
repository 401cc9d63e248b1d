// Private to picture_file.h: what runs in the child (picture_decode.cpp), and what the parent
// makes of its result.
#ifndef PROM_BUILDER_PICTURE_PARTS_H
#define PROM_BUILDER_PICTURE_PARTS_H

#ifdef __cplusplus
extern "C" {
#endif

#include "builder/picture_file.h"

#include <stdio.h>

// Decodes in this process.
prom_status prom_picture_decode(const char *path, prom_picture_file *file, prom_error *error);

// The picture, or the error that kept it from being read, as bytes. False when `to` cannot take
// them.
bool prom_picture_pack(FILE *to, const prom_picture_file *file, const prom_error *error);
// Trusts nothing: sizes, forms and values are checked. `path` is for messages.
prom_status prom_picture_unpack(const uint8_t *data, size_t bytes, const char *path,
                                prom_picture_file *file, prom_error *error);

// Called in the child before it decodes, for tests that simulate a crash or a hang. NULL.
extern void (*prom_picture_child_hook)(void);

#ifdef __cplusplus
}
#endif

#endif
