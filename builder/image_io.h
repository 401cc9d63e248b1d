// Pictures in and out through OpenImageIO. Decode foreign files only in the import child.
#ifndef PROM_BUILDER_IMAGE_IO_H
#define PROM_BUILDER_IMAGE_IO_H

#include "metaobj/base/status.h"

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// Decodes to sRGB RGBA8 (grey and paletted expanded, float clamped, first row on top), reduced
// by a filter so that neither side exceeds max_px. *rgba is to be freed with prom_free.
prom_status prom_image_read(const char *path, uint32_t max_px, uint32_t *width,
                            uint32_t *height, uint8_t **rgba, prom_error *error);
// The same from memory (an embedded picture); `name` is for messages and the format's hint.
prom_status prom_image_read_memory(const void *data, size_t bytes, const char *name,
                                   uint32_t max_px, uint32_t *width, uint32_t *height,
                                   uint8_t **rgba, prom_error *error);
// Resamples an sRGB RGBA8 picture in linear light, alpha-weighted. out: out_width x out_height
// x 4 bytes. False when memory ends.
bool prom_image_resize(const uint8_t *rgba, uint32_t width, uint32_t height, uint8_t *out,
                       uint32_t out_width, uint32_t out_height);
// Writes a PNG atomically. channels: 3 or 4 (input is packed accordingly).
prom_status prom_image_write_png(const char *path, uint32_t width, uint32_t height,
                                 int channels, const uint8_t *pixels, prom_error *error);
// Encodes a PNG into memory (for .glb). Free with prom_free.
prom_status prom_image_encode_png(uint32_t width, uint32_t height, int channels,
                                  const uint8_t *pixels, uint8_t **png, size_t *bytes,
                                  prom_error *error);

#ifdef __cplusplus
}
#endif

#endif
