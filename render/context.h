// GL contexts and render targets. Headless through EGL (surfaceless, then pbuffer); one context
// at a time is current, on the thread that made it; all of render/ runs on that thread.
#ifndef PROM_RENDER_CONTEXT_H
#define PROM_RENDER_CONTEXT_H

#include "metaobj/base/status.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct prom_context prom_context;

// A current GL 4.5 core context without a window; NULL with PROM_ERR_UNSUPPORTED and a hint.
prom_context *prom_context_create_headless(prom_error *error);
void prom_context_destroy(prom_context *context); // NULL is allowed
// GL_RENDERER and GL_VERSION.
const char *prom_context_renderer(const prom_context *context);
const char *prom_context_version(const prom_context *context);
// A rasteriser on the CPU (llvmpipe, softpipe, SwiftShader), by renderer string.
bool prom_context_is_software(const prom_context *context);

// An off-screen picture: RGBA8 colour, sRGB-encoded, 32-bit float depth (reverse z) and, if
// asked for, one R32UI id per pixel (PROM_NONE where nothing was drawn).
typedef struct prom_target prom_target;

prom_target *prom_target_create(uint32_t width, uint32_t height, bool with_ids,
                                prom_error *error);
void prom_target_destroy(prom_target *target);
// Reads a rectangle back, first row on top; x and y count from the bottom left, as in
// prom_pass. rgba: 4 bytes a pixel, sRGB-encoded; ids: 1 word a pixel; depth: near / distance
// along the view, 0 where nothing is, the background layer's times 2^-40. Waits for the drawing
// to end.
void prom_target_read_rgba(prom_target *target, uint32_t x, uint32_t y, uint32_t width,
                           uint32_t height, uint8_t *rgba);
void prom_target_read_ids(prom_target *target, uint32_t x, uint32_t y, uint32_t width,
                          uint32_t height, uint32_t *ids);
void prom_target_read_depth(prom_target *target, uint32_t x, uint32_t y, uint32_t width,
                            uint32_t height, float *depth);

#endif
