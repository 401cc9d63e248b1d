#include "render/gpu_buffer.h"

#define MIN_BYTES ((size_t)1 << 16)

bool gpu_buffer_reserve_exact(gpu_buffer *buffer, size_t used, size_t bytes)
{
    if (bytes <= buffer->capacity) return true;
    GLuint grown;
    while (glGetError() != GL_NO_ERROR) {
    } // what is checked below is ours
    glCreateBuffers(1, &grown);
    glNamedBufferStorage(grown, (GLsizeiptr)bytes, NULL, GL_DYNAMIC_STORAGE_BIT);
    if (glGetError() != GL_NO_ERROR) {
        glDeleteBuffers(1, &grown);
        return false;
    }
    if (used) glCopyNamedBufferSubData(buffer->name, grown, 0, 0, (GLsizeiptr)used);
    glDeleteBuffers(1, &buffer->name);
    *buffer = (gpu_buffer){.name = grown, .capacity = bytes};
    return true;
}

bool gpu_buffer_reserve(gpu_buffer *buffer, size_t used, size_t bytes)
{
    if (bytes <= buffer->capacity) return true;
    size_t grown = buffer->capacity + buffer->capacity / 2;
    if (grown < bytes) grown = bytes;
    if (grown < MIN_BYTES) grown = MIN_BYTES;
    return gpu_buffer_reserve_exact(buffer, used, grown) ||
           gpu_buffer_reserve_exact(buffer, used, bytes);
}

void gpu_buffer_finish(gpu_buffer *buffer)
{
    glDeleteBuffers(1, &buffer->name);
    *buffer = (gpu_buffer){0};
}

void gpu_buffer_stream(gpu_buffer *buffer, const void *data, size_t bytes)
{
    if (!bytes) return;
    if (!buffer->name) glCreateBuffers(1, &buffer->name);
    if (bytes > buffer->capacity) {
        size_t grown = buffer->capacity + buffer->capacity / 2;
        buffer->capacity = grown < bytes ? bytes : grown;
        if (buffer->capacity < MIN_BYTES) buffer->capacity = MIN_BYTES;
    }
    glNamedBufferData(buffer->name, (GLsizeiptr)buffer->capacity, NULL, GL_STREAM_DRAW);
    glNamedBufferSubData(buffer->name, 0, (GLsizeiptr)bytes, data);
}
