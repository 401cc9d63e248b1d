#include "render/window.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "render/context_private.h"
#include "render/target.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <string.h>

struct prom_window {
    GLFWwindow *handle;
    bool full_screen;
    bool has_alpha;   // the window's own buffer: a compositor would see through it
    double cursor[2]; // where the captured mouse was last
    bool down[PROM_KEY_COUNT];
    prom_window_input input; // gathered for the next poll
};

static const int key_codes[PROM_KEY_COUNT] = {
    [PROM_KEY_W] = GLFW_KEY_W,
    [PROM_KEY_A] = GLFW_KEY_A,
    [PROM_KEY_S] = GLFW_KEY_S,
    [PROM_KEY_D] = GLFW_KEY_D,
    [PROM_KEY_Q] = GLFW_KEY_Q,
    [PROM_KEY_E] = GLFW_KEY_E,
    [PROM_KEY_C] = GLFW_KEY_C,
    [PROM_KEY_P] = GLFW_KEY_P,
    [PROM_KEY_SPACE] = GLFW_KEY_SPACE,
    [PROM_KEY_SHIFT] = GLFW_KEY_LEFT_SHIFT,
    [PROM_KEY_UP] = GLFW_KEY_UP,
    [PROM_KEY_DOWN] = GLFW_KEY_DOWN,
    [PROM_KEY_LEFT] = GLFW_KEY_LEFT,
    [PROM_KEY_RIGHT] = GLFW_KEY_RIGHT,
    [PROM_KEY_PAGE_UP] = GLFW_KEY_PAGE_UP,
    [PROM_KEY_PAGE_DOWN] = GLFW_KEY_PAGE_DOWN,
    [PROM_KEY_HOME] = GLFW_KEY_HOME,
    [PROM_KEY_ESCAPE] = GLFW_KEY_ESCAPE,
    [PROM_KEY_F12] = GLFW_KEY_F12,
};

// ---- what the user does

static void capture(prom_window *w, bool captured)
{
    if (w->input.captured == captured) return;
    w->input.captured = captured;
    glfwSetInputMode(w->handle, GLFW_CURSOR,
                     captured ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    if (glfwRawMouseMotionSupported())
        glfwSetInputMode(w->handle, GLFW_RAW_MOUSE_MOTION, captured);
    // Capturing moves the cursor: what it says from here on counts.
    glfwGetCursorPos(w->handle, &w->cursor[0], &w->cursor[1]);
}

static void on_key(GLFWwindow *handle, int code, int scancode, int action, int modifiers)
{
    (void)scancode, (void)modifiers;
    prom_window *w = glfwGetWindowUserPointer(handle);
    if (action == GLFW_REPEAT) return;
    if (code == GLFW_KEY_TAB && action == GLFW_PRESS) capture(w, !w->input.captured);
    if (code == GLFW_KEY_RIGHT_SHIFT) code = GLFW_KEY_LEFT_SHIFT;
    for (int i = 0; i < PROM_KEY_COUNT; i++) {
        if (key_codes[i] != code) continue;
        w->down[i] = action == GLFW_PRESS;
        // A key let go at once would be missed between two polls.
        if (action == GLFW_PRESS) w->input.pressed[i] = w->input.held[i] = true;
    }
}

static void on_button(GLFWwindow *handle, int button, int action, int modifiers)
{
    (void)modifiers;
    if (button == GLFW_MOUSE_BUTTON_LEFT && action == GLFW_PRESS)
        capture(glfwGetWindowUserPointer(handle), true);
}

static void on_cursor(GLFWwindow *handle, double x, double y)
{
    prom_window *w = glfwGetWindowUserPointer(handle);
    if (!w->input.captured) return;
    w->input.look_px[0] += x - w->cursor[0];
    w->input.look_px[1] += y - w->cursor[1];
    w->cursor[0] = x;
    w->cursor[1] = y;
}

static void on_scroll(GLFWwindow *handle, double x, double y)
{
    (void)x;
    prom_window *w = glfwGetWindowUserPointer(handle);
    w->input.scroll += y;
}

// GLFW itself lets go of all keys when the focus is lost, and says so.
static void on_focus(GLFWwindow *handle, int focused)
{
    prom_window *w = glfwGetWindowUserPointer(handle);
    if (!focused || w->full_screen) capture(w, focused);
}

static void on_refresh(GLFWwindow *handle)
{
    prom_window *w = glfwGetWindowUserPointer(handle);
    w->input.exposed = true;
}

static void listen(prom_window *w)
{
    glfwSetWindowUserPointer(w->handle, w);
    glfwSetKeyCallback(w->handle, on_key);
    glfwSetMouseButtonCallback(w->handle, on_button);
    glfwSetCursorPosCallback(w->handle, on_cursor);
    glfwSetScrollCallback(w->handle, on_scroll);
    glfwSetWindowFocusCallback(w->handle, on_focus);
    glfwSetWindowRefreshCallback(w->handle, on_refresh);
}

void prom_window_poll(prom_window *window, double wait_s, prom_window_input *input)
{
    if (wait_s > 0)
        glfwWaitEventsTimeout(wait_s);
    else
        glfwPollEvents();
    prom_window_input *now = &window->input;
    now->closing = glfwWindowShouldClose(window->handle);
    prom_window_size(window, now->size_px);
    *input = *now;
    *now = (prom_window_input){.captured = now->captured};
    memcpy(now->held, window->down, sizeof now->held);
}

// ---- making one

static void hint_context(void)
{
    // EGL, as without a window, so that both get the same driver.
    glfwWindowHint(GLFW_CONTEXT_CREATION_API, GLFW_EGL_CONTEXT_API);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_DEBUG_CONTEXT, context_wants_debug());
    // Pictures are drawn in targets; the window only takes a copy.
    glfwWindowHint(GLFW_ALPHA_BITS, 0);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

static const char *last_problem(void)
{
    const char *text = NULL;
    glfwGetError(&text);
    return text ? text : "no reason given";
}

static GLFWwindow *make_handle(const char *title, const uint32_t size_px[2], bool full_screen)
{
    GLFWmonitor *monitor = full_screen ? glfwGetPrimaryMonitor() : NULL;
    const GLFWvidmode *mode = monitor ? glfwGetVideoMode(monitor) : NULL;
    hint_context();
    glfwWindowHint(GLFW_VISIBLE, GLFW_FALSE);
    return glfwCreateWindow(mode ? mode->width : (int)size_px[0],
                            mode ? mode->height : (int)size_px[1], title, monitor, NULL);
}

prom_window *prom_window_create(const char *title, const uint32_t size_px[2], bool full_screen,
                                prom_error *error)
{
    if (!glfwInit()) {
        prom_fail(error, PROM_ERR_UNSUPPORTED,
                  "no window can be opened (%s): set DISPLAY, or use `promenade bench` or "
                  "`promenade shot`, which need none",
                  last_problem());
        return NULL;
    }
    GLFWwindow *handle = make_handle(title, size_px, full_screen);
    if (!handle) {
        prom_fail(error, PROM_ERR_UNSUPPORTED,
                  "no window with OpenGL 4.5 can be opened (%s): install a driver (Debian: "
                  "libegl1 libgl1-mesa-dri), or use `promenade bench` or `promenade shot`",
                  last_problem());
        return NULL;
    }
    prom_window *w = prom_calloc(1, sizeof *w);
    w->handle = handle;
    w->full_screen = full_screen;
    listen(w);
    return w;
}

// GLFW stays initialised until the program ends: it would unload X11 libraries, whose memory is
// lost with them.
void prom_window_destroy(prom_window *window)
{
    if (!window) return;
    glfwDestroyWindow(window->handle);
    prom_free(window);
}

prom_context *prom_context_create_window(prom_window *window, prom_error *error)
{
    glfwMakeContextCurrent(window->handle);
    prom_context *context = context_of_current(error);
    if (!context) return NULL;
    glfwSwapInterval(1);
    GLint alpha_bits = 0;
    glGetNamedFramebufferAttachmentParameteriv(
        0, GL_BACK_LEFT, GL_FRAMEBUFFER_ATTACHMENT_ALPHA_SIZE, &alpha_bits);
    window->has_alpha = alpha_bits > 0;
    return context;
}

void prom_window_size(const prom_window *window, uint32_t size_px[2])
{
    int width = 0, height = 0;
    glfwGetFramebufferSize(window->handle, &width, &height);
    size_px[0] = width > 0 ? (uint32_t)width : 0;
    size_px[1] = height > 0 ? (uint32_t)height : 0;
}

void prom_window_show(prom_window *window)
{
    glfwShowWindow(window->handle);
}

void prom_window_set_title(prom_window *window, const char *title)
{
    glfwSetWindowTitle(window->handle, title);
}

// ---- showing pictures

// Binds the window's buffer rather than naming it: Mesa asks for a window's size only when its
// buffer is bound.
static void copy_to_back(prom_window *w, const prom_target *t, const uint32_t size[2])
{
    GLenum filter = t->width == size[0] && t->height == size[1] ? GL_NEAREST : GL_LINEAR;
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, t->plain);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBlitFramebuffer(0, 0, (GLint)t->width, (GLint)t->height, 0, 0, (GLint)size[0],
                      (GLint)size[1], GL_COLOR_BUFFER_BIT, filter);
    if (!w->has_alpha) return;
    const GLfloat opaque[4] = {0, 0, 0, 1};
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_TRUE);
    glClearBufferfv(GL_COLOR, 0, opaque);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
}

double prom_window_present(prom_window *window, prom_target *target)
{
    uint32_t size[2];
    prom_window_size(window, size);
    if (!size[0] || !size[1]) return 0;
    double start = prom_clock_ms();
    copy_to_back(window, target, size);
    glFinish();
    double copied = prom_clock_ms();
    glfwSwapBuffers(window->handle);
    glFinish();
    return copied - start;
}
