// A device buffer that grows and keeps its content. Private to render/.
#ifndef PROM_RENDER_GPU_BUFFER_H
#define PROM_RENDER_GPU_BUFFER_H

#include <epoxy/gl.h>
#include <stdbool.h>
#include <stddef.h>

typedef struct gpu_buffer {
    GLuint name; // changes when the buffer grows
    size_t capacity;
} gpu_buffer; // {0} is an empty buffer

// Makes room for `bytes` bytes, of which the first `used` are kept. false when the device has
// no memory left; the buffer is then as before.
bool gpu_buffer_reserve(gpu_buffer *buffer, size_t used, size_t bytes);
// The same in exactly the size asked for, when the final size is known.
bool gpu_buffer_reserve_exact(gpu_buffer *buffer, size_t used, size_t bytes);
void gpu_buffer_finish(gpu_buffer *buffer);

// For data that changes from frame to frame: gives the buffer fresh memory (so that the device
// is never waited for) and fills its first `bytes` bytes.
void gpu_buffer_stream(gpu_buffer *buffer, const void *data, size_t bytes);

#endif
