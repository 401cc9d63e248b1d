// The inside of a render target. Private to render/.
#ifndef PROM_RENDER_TARGET_H
#define PROM_RENDER_TARGET_H

#include "render/context.h"

#include <epoxy/gl.h>

// Two framebuffers over the same colour and depth: blending from two sources of one fragment
// allows no second attachment, so blended draws go to the plain one.
struct prom_target {
    uint32_t width, height;
    bool has_ids;
    GLuint color, depth;       // renderbuffers
    GLuint ids;                // a texture, or 0
    GLuint framebuffer, plain; // the same framebuffer without ids
};

// prom_target_clear, of the ids only if asked for.
void target_clear(prom_target *target, const uint8_t rgba[4], bool ids);

#endif
