// What contexts of both kinds share. Private to render/.
#ifndef PROM_RENDER_CONTEXT_PRIVATE_H
#define PROM_RENDER_CONTEXT_PRIVATE_H

#include "render/context.h"

// Whether to ask for a context that reports errors.
bool context_wants_debug(void);
// Describes the GL context that is current and that someone else owns: destroying the result
// leaves it alone. NULL when it is older than GL 4.5 or of a kind that PROM_GL_DEVICE rules
// out.
prom_context *context_of_current(prom_error *error);

#endif
