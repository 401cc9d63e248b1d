#include "render/target.h"

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"
#include "render/renderer.h"

#include <assert.h>
#include <string.h>

static GLuint make_renderbuffer(GLenum format, uint32_t width, uint32_t height)
{
    GLuint name;
    glCreateRenderbuffers(1, &name);
    glNamedRenderbufferStorage(name, format, (GLsizei)width, (GLsizei)height);
    return name;
}

// A texture, so that shaders can read it; integers allow no filter but the nearest.
static GLuint make_id_texture(uint32_t width, uint32_t height)
{
    GLuint name;
    glCreateTextures(GL_TEXTURE_2D, 1, &name);
    glTextureStorage2D(name, 1, GL_R32UI, (GLsizei)width, (GLsizei)height);
    glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    return name;
}

static GLuint make_framebuffer(const prom_target *t, bool with_ids)
{
    static const GLenum buffers[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    GLuint name;
    glCreateFramebuffers(1, &name);
    glNamedFramebufferRenderbuffer(name, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, t->color);
    glNamedFramebufferRenderbuffer(name, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, t->depth);
    if (with_ids) glNamedFramebufferTexture(name, GL_COLOR_ATTACHMENT1, t->ids, 0);
    glNamedFramebufferDrawBuffers(name, with_ids ? 2 : 1, buffers);
    return name;
}

static bool is_complete(const prom_target *t)
{
    return glGetError() == GL_NO_ERROR &&
           glCheckNamedFramebufferStatus(t->framebuffer, GL_FRAMEBUFFER) ==
               GL_FRAMEBUFFER_COMPLETE &&
           glCheckNamedFramebufferStatus(t->plain, GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

prom_target *prom_target_create(uint32_t width, uint32_t height, bool with_ids,
                                prom_error *error)
{
    GLint limit = 0;
    glGetIntegerv(GL_MAX_RENDERBUFFER_SIZE, &limit);
    if (!width || !height || width > (uint32_t)limit || height > (uint32_t)limit) {
        prom_fail(
            error, PROM_ERR_USAGE,
            "a picture of %u x %u pixels cannot be drawn: this device takes 1 to %d a side",
            width, height, limit);
        return NULL;
    }
    while (glGetError() != GL_NO_ERROR) {
    } // what is checked below is ours
    prom_target *t = prom_calloc(1, sizeof *t);
    t->width = width;
    t->height = height;
    t->has_ids = with_ids;
    t->color = make_renderbuffer(GL_RGBA8, width, height);
    t->depth = make_renderbuffer(GL_DEPTH_COMPONENT32F, width, height);
    if (with_ids) t->ids = make_id_texture(width, height);
    t->framebuffer = make_framebuffer(t, with_ids);
    t->plain = with_ids ? make_framebuffer(t, false) : t->framebuffer;
    if (!is_complete(t)) {
        prom_target_destroy(t);
        prom_fail(
            error, PROM_ERR_UNSUPPORTED,
            "the device has no memory for a picture of %u x %u pixels: ask for a smaller one",
            width, height);
        return NULL;
    }
    return t;
}

void prom_target_destroy(prom_target *target)
{
    if (!target) return;
    if (target->plain != target->framebuffer) glDeleteFramebuffers(1, &target->plain);
    glDeleteFramebuffers(1, &target->framebuffer);
    glDeleteRenderbuffers(2, (GLuint[]){target->color, target->depth});
    glDeleteTextures(1, &target->ids);
    prom_free(target);
}

void target_clear(prom_target *target, const uint8_t rgba[4], bool ids)
{
    GLfloat color[4];
    for (int i = 0; i < 4; i++) color[i] = (GLfloat)rgba[i] / 255.0f;
    const GLuint none[4] = {PROM_NONE, PROM_NONE, PROM_NONE, PROM_NONE};
    const GLfloat far = 0.0f; // reverse z
    ids = ids && target->has_ids;
    glBindFramebuffer(GL_FRAMEBUFFER, ids ? target->framebuffer : target->plain);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glDepthMask(GL_TRUE);
    glClearBufferfv(GL_COLOR, 0, color);
    glClearBufferfv(GL_DEPTH, 0, &far);
    if (ids) glClearBufferuiv(GL_COLOR, 1, none);
}

void prom_target_clear(prom_target *target, const uint8_t rgba[4])
{
    target_clear(target, rgba, true);
}

static void flip_rows(void *pixels, uint32_t width, uint32_t height)
{
    size_t row = (size_t)width * 4;
    char *top = pixels, *bottom = top + row * (height - 1);
    char swap[1024];
    for (; top < bottom; top += row, bottom -= row)
        for (size_t done = 0; done < row; done += sizeof swap) {
            size_t part = row - done < sizeof swap ? row - done : sizeof swap;
            memcpy(swap, top + done, part);
            memcpy(top + done, bottom + done, part);
            memcpy(bottom + done, swap, part);
        }
}

static void read_pixels(prom_target *t, GLenum attachment, GLenum format, GLenum type,
                        uint32_t x, uint32_t y, uint32_t width, uint32_t height, void *pixels)
{
    assert(x <= t->width && width <= t->width - x);
    assert(y <= t->height && height <= t->height - y);
    if (!width || !height) return;
    glNamedFramebufferReadBuffer(t->framebuffer, attachment);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, t->framebuffer);
    glReadPixels((GLint)x, (GLint)y, (GLsizei)width, (GLsizei)height, format, type, pixels);
    flip_rows(pixels, width, height);
}

void prom_target_read_rgba(prom_target *target, uint32_t x, uint32_t y, uint32_t width,
                           uint32_t height, uint8_t *rgba)
{
    read_pixels(target, GL_COLOR_ATTACHMENT0, GL_RGBA, GL_UNSIGNED_BYTE, x, y, width, height,
                rgba);
}

void prom_target_read_ids(prom_target *target, uint32_t x, uint32_t y, uint32_t width,
                          uint32_t height, uint32_t *ids)
{
    assert(target->has_ids);
    read_pixels(target, GL_COLOR_ATTACHMENT1, GL_RED_INTEGER, GL_UNSIGNED_INT, x, y, width,
                height, ids);
}

void prom_target_read_depth(prom_target *target, uint32_t x, uint32_t y, uint32_t width,
                            uint32_t height, float *depth)
{
    read_pixels(target, GL_COLOR_ATTACHMENT0, GL_DEPTH_COMPONENT, GL_FLOAT, x, y, width, height,
                depth);
}
