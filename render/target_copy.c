#include "render/renderer.h"
#include "render/target.h"

void prom_target_copy_colors(prom_target *target, const prom_target *from)
{
    glBlitNamedFramebuffer(
        from->plain, target->plain, 0, 0, (GLint)from->width, (GLint)from->height, 0, 0,
        (GLint)target->width, (GLint)target->height, GL_COLOR_BUFFER_BIT,
        from->width == target->width && from->height == target->height ? GL_NEAREST
                                                                       : GL_LINEAR);
}
