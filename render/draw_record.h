// What the shaders get for each draw: vertex attributes that change per instance. (From a
// storage buffer, the same costs llvmpipe 15 % more where vertices abound; measured.) Private
// to render/.
#ifndef PROM_RENDER_DRAW_RECORD_H
#define PROM_RENDER_DRAW_RECORD_H

#include <epoxy/gl.h>
#include <stdint.h>

// As in mesh.vert.
enum {
    DRAW_UNLIT = 1,
    DRAW_DOUBLE_SIDED = 2,
    DRAW_MIRRORED = 4,
    DRAW_BACKGROUND = 8,
};

// Straight alpha.
typedef struct draw_color {
    float rgba[4];
} draw_color;

typedef struct draw_record {
    float rows[3][4]; // placement relative to the eye
    draw_color color; // of the material, sRGB-encoded
    uint32_t layer;   // of the texture, in its pool
    uint32_t flags;   // low half: DRAW_*; high half: alpha cutoff x 65535
    uint32_t id;
    uint8_t tint[4];
} draw_record;

// glMultiDrawElementsIndirect's command.
typedef struct draw_command {
    GLuint count, instance_count, first_index;
    GLint base_vertex;
    GLuint base_instance;
} draw_command;

#endif
