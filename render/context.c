#include "render/context_private.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/log.h"

#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#define MAX_DEVICES 16
#define MIN_VERSION 45

struct prom_context {
    EGLDisplay display; // EGL_NO_DISPLAY: the GL context is a window's
    EGLContext gl;
    EGLSurface surface; // 1x1 pbuffer where contexts need one, else EGL_NO_SURFACE
    const char *renderer, *version;
    bool software;
};

typedef enum preference { ANY_DEVICE, ONLY_HARDWARE, ONLY_SOFTWARE } preference;

static bool has_word(const char *list, const char *word)
{
    size_t length = strlen(word);
    for (const char *p = list; p && (p = strstr(p, word)); p += length)
        if ((p == list || p[-1] == ' ') && (p[length] == ' ' || !p[length])) return true;
    return false;
}

static bool is_software_name(const char *renderer)
{
    static const char *const names[] = {"llvmpipe", "softpipe", "swrast", "SwiftShader",
                                        "Software Rasterizer"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++)
        if (strcasestr(renderer, names[i])) return true;
    return false;
}

bool context_wants_debug(void)
{
#if defined PROM_SANITIZE || !defined __OPTIMIZE__
    return true;
#else
    return getenv("PROM_GL_DEBUG") != NULL;
#endif
}

static void GLAPIENTRY on_gl_message(GLenum source, GLenum type, GLuint id, GLenum severity,
                                     GLsizei length, const GLchar *text, const void *user)
{
    (void)source, (void)id, (void)length, (void)user;
    if (type == GL_DEBUG_TYPE_ERROR)
        prom_log(PROM_LOG_ERROR, "GL: %s", text);
    else if (severity == GL_DEBUG_SEVERITY_HIGH || severity == GL_DEBUG_SEVERITY_MEDIUM)
        prom_log(PROM_LOG_WARNING, "GL: %s", text);
}

static void listen_to_gl(void)
{
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_gl_message, NULL);
}

static EGLConfig choose_config(EGLDisplay display, bool pbuffer)
{
    const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE,
                             pbuffer ? EGL_PBUFFER_BIT : EGL_DONT_CARE, EGL_NONE};
    EGLConfig config;
    EGLint count = 0;
    if (!eglChooseConfig(display, wanted, &config, 1, &count) || count < 1)
        return EGL_NO_CONFIG_KHR;
    return config;
}

static bool make_current(prom_context *c, EGLDisplay display)
{
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                 4,
                                 EGL_CONTEXT_MINOR_VERSION,
                                 5,
                                 EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                 EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                 EGL_CONTEXT_OPENGL_DEBUG,
                                 context_wants_debug(),
                                 EGL_NONE};
    const EGLint one_pixel[] = {EGL_WIDTH, 1, EGL_HEIGHT, 1, EGL_NONE};
    const char *extensions = eglQueryString(display, EGL_EXTENSIONS);
    bool pbuffer = !has_word(extensions, "EGL_KHR_surfaceless_context");
    EGLConfig config = choose_config(display, pbuffer);
    if (config == EGL_NO_CONFIG_KHR &&
        (pbuffer || !has_word(extensions, "EGL_KHR_no_config_context")))
        return false;
    if (!eglBindAPI(EGL_OPENGL_API)) return false;
    c->gl = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes);
    if (c->gl == EGL_NO_CONTEXT) return false;
    if (pbuffer) c->surface = eglCreatePbufferSurface(display, config, one_pixel);
    return (!pbuffer || c->surface != EGL_NO_SURFACE) &&
           eglMakeCurrent(display, c->surface, c->surface, c->gl);
}

// The display stays initialised: EGL hands out one per platform and device to the whole
// process, so that terminating it would end the contexts of others too.
static void leave(prom_context *c)
{
    if (c->display == EGL_NO_DISPLAY) return;
    eglMakeCurrent(c->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (c->surface != EGL_NO_SURFACE) eglDestroySurface(c->display, c->surface);
    if (c->gl != EGL_NO_CONTEXT) eglDestroyContext(c->display, c->gl);
}

// Fills in what the current GL context is; whether it is of the wanted kind and version.
static bool describe(prom_context *c, preference wanted)
{
    if (epoxy_gl_version() < MIN_VERSION) return false;
    c->renderer = (const char *)glGetString(GL_RENDERER);
    c->version = (const char *)glGetString(GL_VERSION);
    c->software = is_software_name(c->renderer);
    return wanted == ANY_DEVICE || c->software == (wanted == ONLY_SOFTWARE);
}

static prom_context *keep(const prom_context *c)
{
    prom_context *context = prom_alloc(1, sizeof *context);
    *context = *c;
    context->renderer = prom_strdup(c->renderer);
    context->version = prom_strdup(c->version);
    if (context_wants_debug()) listen_to_gl();
    prom_log(PROM_LOG_DEBUG, "GL device: %s, OpenGL %s", context->renderer, context->version);
    return context;
}

// A context on a display, or NULL if it has no GL 4.5 core or is not the wanted kind of device.
static prom_context *try_display(EGLDisplay display, preference wanted)
{
    if (display == EGL_NO_DISPLAY || !eglInitialize(display, NULL, NULL)) return NULL;
    prom_context c = {.display = display, .gl = EGL_NO_CONTEXT, .surface = EGL_NO_SURFACE};
    if (!make_current(&c, display) || !describe(&c, wanted)) {
        leave(&c);
        return NULL;
    }
    return keep(&c);
}

static prom_context *try_surfaceless(const char *extensions, preference wanted)
{
    if (!has_word(extensions, "EGL_MESA_platform_surfaceless")) return NULL;
    return try_display(
        eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL),
        wanted);
}

// The devices of one kind, in EGL's order.
static prom_context *try_devices(const char *extensions, bool software, preference wanted)
{
    if (!has_word(extensions, "EGL_EXT_platform_device") ||
        !(has_word(extensions, "EGL_EXT_device_base") ||
          has_word(extensions, "EGL_EXT_device_enumeration")))
        return NULL;
    EGLDeviceEXT devices[MAX_DEVICES];
    EGLint count = 0;
    if (!eglQueryDevicesEXT(MAX_DEVICES, devices, &count)) return NULL;
    for (EGLint i = 0; i < count; i++) {
        const char *of_device = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
        if (has_word(of_device, "EGL_MESA_device_software") != software) continue;
        prom_context *context = try_display(
            eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, devices[i], NULL), wanted);
        if (context) return context;
    }
    return NULL;
}

static prom_status read_preference(preference *wanted, prom_error *error)
{
    const char *text = getenv("PROM_GL_DEVICE");
    *wanted = ANY_DEVICE;
    if (!text || !*text) return PROM_OK;
    if (!strcmp(text, "hardware"))
        *wanted = ONLY_HARDWARE;
    else if (!strcmp(text, "software"))
        *wanted = ONLY_SOFTWARE;
    else
        return prom_fail(
            error, PROM_ERR_USAGE,
            "PROM_GL_DEVICE is \"%s\": use \"software\" or \"hardware\", or unset it", text);
    return PROM_OK;
}

prom_context *prom_context_create_headless(prom_error *error)
{
    preference wanted;
    if (read_preference(&wanted, error)) return NULL;
    const char *extensions = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    prom_context *context = NULL;
    if (extensions && has_word(extensions, "EGL_EXT_platform_base")) {
        if (wanted != ONLY_SOFTWARE) context = try_devices(extensions, false, wanted);
        if (!context) context = try_surfaceless(extensions, wanted);
        if (!context && wanted != ONLY_HARDWARE)
            context = try_devices(extensions, true, wanted);
    }
    if (!context) {
        prom_fail(error, PROM_ERR_UNSUPPORTED,
                  "no %sOpenGL 4.5 core context through EGL: install a driver (Debian: libegl1 "
                  "libgl1-mesa-dri)%s",
                  wanted == ONLY_HARDWARE   ? "hardware "
                  : wanted == ONLY_SOFTWARE ? "software "
                                            : "",
                  wanted == ANY_DEVICE ? "" : " or unset PROM_GL_DEVICE");
        return NULL;
    }
    return context;
}

prom_context *context_of_current(prom_error *error)
{
    preference wanted;
    if (read_preference(&wanted, error)) return NULL;
    prom_context c = {
        .display = EGL_NO_DISPLAY, .gl = EGL_NO_CONTEXT, .surface = EGL_NO_SURFACE};
    if (describe(&c, wanted)) return keep(&c);
    if (c.renderer)
        prom_fail(error, PROM_ERR_UNSUPPORTED,
                  "windows are drawn by `%s`, which PROM_GL_DEVICE rules out: unset it",
                  c.renderer);
    else
        prom_fail(error, PROM_ERR_UNSUPPORTED,
                  "the window has no OpenGL 4.5: install a driver");
    return NULL;
}

void prom_context_destroy(prom_context *context)
{
    if (!context) return;
    leave(context);
    prom_free((char *)context->renderer);
    prom_free((char *)context->version);
    prom_free(context);
}

const char *prom_context_renderer(const prom_context *context)
{
    return context->renderer;
}

const char *prom_context_version(const prom_context *context)
{
    return context->version;
}

bool prom_context_is_software(const prom_context *context)
{
    return context->software;
}
