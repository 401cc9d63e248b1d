#include "render/renderer_private.h"

#include <assert.h>
#include <stddef.h>

#define MAX_ANISOTROPY 4.0f

// ---- creation

static GLuint make_vertex_array(void)
{
    static const struct {
        GLuint binding;
        GLint size;
        GLenum type;
        bool integer;
        GLboolean normalized;
        GLuint offset;
    } attributes[] = {
        {0, 3, GL_FLOAT, false, GL_FALSE, offsetof(prom_vertex, position)},
        {0, 4, GL_BYTE, false, GL_FALSE, offsetof(prom_vertex, normal)},
        {0, 4, GL_UNSIGNED_BYTE, false, GL_TRUE, offsetof(prom_vertex, color)},
        {0, 2, GL_FLOAT, false, GL_FALSE, offsetof(prom_vertex, uv)},
        {1, 4, GL_FLOAT, false, GL_FALSE, offsetof(draw_record, rows[0])},
        {1, 4, GL_FLOAT, false, GL_FALSE, offsetof(draw_record, rows[1])},
        {1, 4, GL_FLOAT, false, GL_FALSE, offsetof(draw_record, rows[2])},
        {1, 4, GL_FLOAT, false, GL_FALSE, offsetof(draw_record, color)},
        {1, 4, GL_UNSIGNED_INT, true, GL_FALSE, offsetof(draw_record, layer)},
    };
    GLuint name;
    glCreateVertexArrays(1, &name);
    for (GLuint i = 0; i < sizeof attributes / sizeof *attributes; i++) {
        glEnableVertexArrayAttrib(name, i);
        glVertexArrayAttribBinding(name, i, attributes[i].binding);
        if (attributes[i].integer)
            glVertexArrayAttribIFormat(name, i, attributes[i].size, attributes[i].type,
                                       attributes[i].offset);
        else
            glVertexArrayAttribFormat(name, i, attributes[i].size, attributes[i].type,
                                      attributes[i].normalized, attributes[i].offset);
    }
    glVertexArrayBindingDivisor(name, 1, 1);
    return name;
}

// On software devices the nearest mip alone is read: blending two doubles the fetches.
static GLuint make_sampler(GLint wrap, bool software)
{
    GLuint name;
    glCreateSamplers(1, &name);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_S, wrap);
    glSamplerParameteri(name, GL_TEXTURE_WRAP_T, wrap);
    glSamplerParameteri(name, GL_TEXTURE_MIN_FILTER,
                        software ? GL_LINEAR_MIPMAP_NEAREST : GL_LINEAR_MIPMAP_LINEAR);
    glSamplerParameteri(name, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    if (!software && wrap == GL_REPEAT &&
        epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic"))
        glSamplerParameterf(name, GL_TEXTURE_MAX_ANISOTROPY_EXT, MAX_ANISOTROPY);
    return name;
}

prom_status renderer_out_of_memory(prom_error *error)
{
    return prom_fail(
        error, PROM_ERR_UNSUPPORTED,
        "the device has no memory left for meshes and textures: build the scene with "
        "a smaller --texture-mb");
}

prom_renderer *prom_renderer_create(prom_context *context, prom_error *error)
{
    prom_renderer *r = prom_calloc(1, sizeof *r);
    r->context = context;
    r->vertex_array = make_vertex_array();
    r->repeat = make_sampler(GL_REPEAT, prom_context_is_software(context));
    r->clamp = make_sampler(GL_CLAMP_TO_EDGE, prom_context_is_software(context));
    prom_status status = programs_init(&r->programs, error);
    if (!status && !texture_store_init(&r->textures)) status = renderer_out_of_memory(error);
    if (!status) status = renderer_warm(r, error);
    if (status) {
        prom_renderer_destroy(r);
        return NULL;
    }
    return r;
}

void prom_renderer_destroy(prom_renderer *renderer)
{
    if (!renderer) return;
    programs_finish(&renderer->programs);
    mesh_store_finish(&renderer->meshes);
    texture_store_finish(&renderer->textures);
    prom_array_finish(&renderer->materials);
    prom_array_finish(&renderer->colors);
    glDeleteVertexArrays(1, &renderer->vertex_array);
    glDeleteSamplers(2, (GLuint[]){renderer->repeat, renderer->clamp});
    prom_free(renderer);
}

// ---- the store

uint32_t prom_renderer_add_mesh(prom_renderer *renderer, const prom_mesh *mesh)
{
    return mesh_store_add(&renderer->meshes, mesh);
}

uint32_t prom_renderer_add_texture(prom_renderer *renderer, const prom_texture *texture)
{
    return texture_store_add(&renderer->textures, texture);
}

void prom_renderer_set_materials(prom_renderer *renderer, const prom_material *materials,
                                 uint32_t count)
{
    renderer->materials.count = renderer->colors.count = 0;
    for (uint32_t i = 0; i < count; i++) {
        draw_color color;
        for (int k = 0; k < 3; k++)
            color.rgba[k] = prom_linear_to_srgb(materials[i].base_color[k]);
        color.rgba[3] = materials[i].base_color[3];
        prom_array_push(&renderer->materials, materials[i]);
        prom_array_push(&renderer->colors, color);
    }
}

void prom_renderer_truncate(prom_renderer *renderer, uint32_t mesh_count,
                            uint32_t texture_count)
{
    mesh_store_truncate(&renderer->meshes, mesh_count);
    texture_store_truncate(&renderer->textures, texture_count);
}

uint32_t prom_renderer_mesh_count(const prom_renderer *renderer)
{
    return (uint32_t)renderer->meshes.meshes.count;
}

uint32_t prom_renderer_texture_count(const prom_renderer *renderer)
{
    return (uint32_t)renderer->textures.textures.count;
}

uint64_t prom_renderer_bytes(const prom_renderer *renderer)
{
    return mesh_store_bytes(&renderer->meshes) + texture_store_bytes(&renderer->textures);
}

// ---- the rest

void prom_renderer_finish(prom_renderer *renderer)
{
    (void)renderer;
    glFinish();
}

prom_draw_stats prom_renderer_take_stats(prom_renderer *renderer)
{
    prom_draw_stats stats = renderer->stats;
    renderer->stats = (prom_draw_stats){0};
    return stats;
}
