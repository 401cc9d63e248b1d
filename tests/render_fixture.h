// What the tests of render/ share: a device, simple meshes, parallel projections.
#ifndef PROM_TESTS_RENDER_FIXTURE_H
#define PROM_TESTS_RENDER_FIXTURE_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>
#include <epoxy/gl.h>

#include "render/renderer.h"

typedef struct fixture {
    prom_context *context; // NULL where there is no GL: the tests skip
    prom_renderer *renderer;
    prom_draw_list *list;
} fixture;

static fixture fix;

static const uint8_t clear_none[4] = {0, 0, 0, 0};

static inline int fixture_setup(void **state)
{
    (void)state;
    prom_error error = {0};
    fix.context = prom_context_create_headless(&error);
    if (!fix.context) {
        print_message("%s\n", error.text);
        return error.status != PROM_ERR_UNSUPPORTED;
    }
    fix.renderer = prom_renderer_create(fix.context, &error);
    if (!fix.renderer) fail_msg("%s", error.text);
    fix.list = prom_draw_list_create(fix.renderer);
    return 0;
}

static inline int fixture_teardown(void **state)
{
    (void)state;
    if (!fix.context) return 0;
    GLenum gl_error = glGetError();
    prom_draw_list_destroy(fix.list);
    prom_renderer_destroy(fix.renderer);
    prom_context_destroy(fix.context);
    if (gl_error != GL_NO_ERROR) print_error("GL error 0x%x\n", gl_error);
    return gl_error != GL_NO_ERROR;
}

// Each test starts with an empty store, and skips without GL.
#define NEEDS_GL(state)                                                                        \
    do {                                                                                       \
        (void)(state);                                                                         \
        if (!fix.context) skip();                                                              \
        prom_renderer_truncate(fix.renderer, 0, 0);                                            \
        prom_renderer_set_materials(fix.renderer, NULL, 0);                                    \
        prom_draw_list_reset(fix.list);                                                        \
        prom_renderer_take_stats(fix.renderer);                                                \
    } while (0)

static inline prom_target *make_target(uint32_t width, uint32_t height, bool with_ids)
{
    prom_error error = {0};
    prom_target *target = prom_target_create(width, height, with_ids, &error);
    if (!target) fail_msg("%s", error.text);
    return target;
}

// The square [-1,1]^2 at z = 0 that faces +z, v down, in one colour and material.
static inline uint32_t add_square(const uint8_t color[4], uint32_t material)
{
    static const float corners[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    static const uint32_t order[6] = {0, 1, 2, 0, 2, 3};
    prom_mesh mesh;
    prom_mesh_init(&mesh, 4, 6, 1);
    for (int i = 0; i < 4; i++) {
        prom_vertex *v = &mesh.vertices[i];
        v->position[0] = corners[i][0];
        v->position[1] = corners[i][1];
        v->normal[2] = 127;
        memcpy(v->color, color, 4);
        v->uv[0] = 0.5f + 0.5f * corners[i][0];
        v->uv[1] = 0.5f - 0.5f * corners[i][1];
    }
    memcpy(mesh.indices, order, sizeof order);
    mesh.submeshes[0] = (prom_submesh){0, 6, material};
    uint32_t id = prom_renderer_add_mesh(fix.renderer, &mesh);
    prom_mesh_finish(&mesh);
    assert_int_not_equal(id, PROM_NONE);
    return id;
}

// A mesh placed at (x, y, z) with the given scale; id and depth as in the camera of
// pass_parallel.
static inline prom_draw_item item_at(uint32_t mesh, float x, float y, float z, float scale)
{
    return (prom_draw_item){.mesh = mesh,
                            .texture = PROM_NONE,
                            .origin = {x, y, z},
                            .basis = {scale, 0, 0, 0, scale, 0, 0, 0, scale},
                            .depth = 10 - z};
}

// A parallel view from direction `out`: the square [-1,1]^2 of right and up fills the picture,
// depths from -10 to 10 along out.
static inline prom_pass pass_from(const float right[3], const float up[3], const float out[3],
                                  uint32_t size)
{
    prom_pass pass = {.width = size, .height = size};
    memset(pass.projection, 0, sizeof pass.projection);
    for (int i = 0; i < 3; i++) {
        pass.projection[i][0] = right[i];
        pass.projection[i][1] = up[i];
        pass.projection[i][2] = out[i] / 20;
    }
    pass.projection[3][2] = 0.5f;
    pass.projection[3][3] = 1;
    return pass;
}

// The same from +z.
static inline prom_pass pass_parallel(uint32_t size)
{
    static const float x[3] = {1, 0, 0}, y[3] = {0, 1, 0}, z[3] = {0, 0, 1};
    return pass_from(x, y, z, size);
}

static inline void draw_over(prom_target *target, const prom_pass *pass)
{
    prom_draw_list_prepare(fix.list);
    prom_draw_list_submit(fix.list, target, pass);
    prom_draw_list_reset(fix.list);
}

static inline void draw(prom_target *target, const prom_pass *pass)
{
    prom_target_clear(target, clear_none);
    draw_over(target, pass);
}

// The pixel at x, y from the top left of a picture of `size` pixels.
static inline const uint8_t *pixel(const uint8_t *rgba, uint32_t size, uint32_t x, uint32_t y)
{
    return rgba + 4 * ((size_t)y * size + x);
}

static inline void assert_near(const uint8_t *got, const uint8_t *want, int tolerance)
{
    for (int i = 0; i < 4; i++)
        if (abs(got[i] - want[i]) > tolerance)
            fail_msg("got %d %d %d %d, want %d %d %d %d", got[0], got[1], got[2], got[3],
                     want[0], want[1], want[2], want[3]);
}

#endif
