// The shader programs: one per pipeline and look, with and without ids. Private to render/.
#ifndef PROM_RENDER_PROGRAMS_H
#define PROM_RENDER_PROGRAMS_H

#include "render/renderer.h"

#include <epoxy/gl.h>

// How the pixels of a draw are made.
typedef enum pipeline {
    PIPELINE_PLAIN,
    PIPELINE_TEXTURED,
    PIPELINE_MASKED,
    PIPELINE_BLENDED,
    PIPELINE_IMPOSTOR_UNLIT,
    PIPELINE_IMPOSTOR_LIT, // pictures of albedo and normals
    PIPELINE_COUNT
} pipeline;

// What is made of them: LIT and ALBEDO differ by a uniform alone.
typedef enum look { LOOK_COLOR, LOOK_NORMAL, LOOK_TINT, LOOK_COUNT } look;

enum { UNIFORM_PROJECTION = 0, UNIFORM_EYE = 1, UNIFORM_LIT = 2 };

typedef struct program {
    GLuint name;     // 0 until compiled
    uint64_t submit; // whose uniforms it holds
} program;

typedef struct programs {
    // Last: 1 writes ids. One that writes them to nowhere costs 5 % where triangles are small,
    // on llvmpipe (measured).
    program table[PIPELINE_COUNT][LOOK_COUNT][2];
} programs; // {0} holds none

// Compiles all. PROM_ERR_UNSUPPORTED with the driver's message if one fails.
prom_status programs_init(programs *programs, prom_error *error);
void programs_finish(programs *programs);
look look_of_output(prom_output output);
// The program of a pipeline under a look; several pipelines share one where pictures do not
// show.
// PIPELINE_BLENDED writes none, whatever is asked for.
program *programs_get(programs *programs, pipeline pipeline, look look, bool with_ids);

// A compute program by itself, without the version line; the caller deletes it. 0 with
// PROM_ERR_UNSUPPORTED as above.
GLuint programs_make_compute(const char *text, prom_error *error);

#endif
