#include "render/programs.h"

#include "metaobj/base/log.h"
#include "render/shaders.h"

#include <stdio.h>

static const char *const pipeline_names[PIPELINE_COUNT] = {
    "PLAIN", "TEXTURED", "MASKED", "BLENDED", "IMPOSTOR_UNLIT", "IMPOSTOR_LIT"};
static const char *const look_names[LOOK_COUNT] = {"COLOR", "NORMAL", "TINT"};

// The pipeline whose program serves: without the picture's colour a textured surface is a plain
// one; normals and ids of see-through surfaces are written as masked ones; false colours of
// impostors need no normals.
static pipeline canonical(pipeline p, look l)
{
    if (p == PIPELINE_TEXTURED && l != LOOK_COLOR) return PIPELINE_PLAIN;
    if (p == PIPELINE_BLENDED && l == LOOK_NORMAL) return PIPELINE_MASKED;
    if (p == PIPELINE_IMPOSTOR_LIT && l == LOOK_TINT) return PIPELINE_IMPOSTOR_UNLIT;
    return p;
}

static GLuint compile(GLenum stage, const char *prefix, const char *library, const char *text,
                      prom_error *error)
{
    const char *parts[] = {prefix, library, text};
    GLuint shader = glCreateShader(stage);
    glShaderSource(shader, 3, parts, NULL);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    char log[300] = "";
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    prom_fail(error, PROM_ERR_UNSUPPORTED, "the GL driver rejects a shader: %s", log);
    glDeleteShader(shader);
    return 0;
}

// Of one shader or two.
static GLuint link(const GLuint shaders[2], prom_error *error)
{
    GLuint name = glCreateProgram();
    for (int i = 0; i < 2; i++)
        if (shaders[i]) glAttachShader(name, shaders[i]);
    glLinkProgram(name);
    GLint ok = 0;
    glGetProgramiv(name, GL_LINK_STATUS, &ok);
    if (ok) return name;
    char log[300] = "";
    glGetProgramInfoLog(name, sizeof log, NULL, log);
    prom_fail(error, PROM_ERR_UNSUPPORTED, "the GL driver cannot link a shader: %s", log);
    glDeleteProgram(name);
    return 0;
}

static prom_status build(program *out, pipeline p, look l, bool with_ids, prom_error *error)
{
    char prefix[160];
    snprintf(prefix, sizeof prefix,
             "#version 450 core\n#define PIPELINE_%s\n#define LOOK_%s\n%s", pipeline_names[p],
             look_names[l], with_ids ? "" : "#define WITHOUT_ID\n");
    const char *light = prom_glsl_lighting_glsl;
    GLuint shaders[2] = {compile(GL_VERTEX_SHADER, prefix, light, prom_glsl_mesh_vert, error)};
    if (!shaders[0]) return PROM_ERR_UNSUPPORTED;
    shaders[1] = compile(GL_FRAGMENT_SHADER, prefix, light, prom_glsl_mesh_frag, error);
    if (shaders[1]) out->name = link(shaders, error);
    glDeleteShader(shaders[0]);
    glDeleteShader(shaders[1]);
    return out->name ? PROM_OK : PROM_ERR_UNSUPPORTED;
}

GLuint programs_make_compute(const char *text, prom_error *error)
{
    const GLuint shaders[2] = {
        compile(GL_COMPUTE_SHADER, "#version 450 core\n", "", text, error)};
    GLuint name = shaders[0] ? link(shaders, error) : 0;
    glDeleteShader(shaders[0]);
    return name;
}

prom_status programs_init(programs *all, prom_error *error)
{
    for (pipeline p = 0; p < PIPELINE_COUNT; p++)
        for (look l = 0; l < LOOK_COUNT; l++)
            for (int ids = 0; ids < 2; ids++) {
                if (canonical(p, l) != p || (ids && p == PIPELINE_BLENDED)) continue;
                prom_status status = build(&all->table[p][l][ids], p, l, ids, error);
                if (status) return status;
            }
    return PROM_OK;
}

void programs_finish(programs *all)
{
    program *first = &all->table[0][0][0];
    for (size_t i = 0; i < sizeof all->table / sizeof *first; i++)
        glDeleteProgram(first[i].name);
    *all = (programs){0};
}

look look_of_output(prom_output output)
{
    return output == PROM_OUTPUT_NORMAL ? LOOK_NORMAL
           : output == PROM_OUTPUT_TINT ? LOOK_TINT
                                        : LOOK_COLOR;
}

program *programs_get(programs *all, pipeline p, look l, bool with_ids)
{
    pipeline c = canonical(p, l);
    return &all->table[c][l][with_ids && c != PIPELINE_BLENDED];
}
