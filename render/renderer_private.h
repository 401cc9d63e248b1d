// The inside of the renderer and of draw lists. Private to render/.
#ifndef PROM_RENDER_RENDERER_PRIVATE_H
#define PROM_RENDER_RENDERER_PRIVATE_H

#include "render/draw_record.h"
#include "render/mesh_store.h"
#include "render/programs.h"
#include "render/renderer.h"
#include "render/texture_store.h"

struct prom_renderer {
    prom_context *context;
    mesh_store meshes;
    texture_store textures;
    PROM_ARRAY(prom_material) materials;
    PROM_ARRAY(draw_color) colors; // base colours of the materials, sRGB-encoded
    programs programs;
    GLuint vertex_array;
    GLuint repeat, clamp; // samplers
    uint64_t submits;     // so far
    prom_draw_stats stats;
};

// Draws every combination of shader and state once. Leaves the store empty.
prom_status renderer_warm(prom_renderer *renderer, prom_error *error);

prom_status renderer_out_of_memory(prom_error *error);

// In the order of drawing.
typedef enum phase {
    PHASE_OPAQUE,
    PHASE_BACKGROUND,
    PHASE_BACKGROUND_BLENDED,
    PHASE_BLENDED,
} phase;

// What must be set on the device for a draw; draws of equal state go out in one call.
typedef struct draw_state {
    uint8_t phase, pipeline;
    bool double_sided, mirrored;
    uint16_t pool;
} draw_state;

typedef struct draw_run {
    draw_state state;
    uint32_t first, count; // of the commands
} draw_run;

typedef struct sort_entry {
    uint64_t key; // phase, depth slice, state, depth: see draw_list.c
    uint32_t item, submesh;
    draw_state state;
} sort_entry;

struct prom_draw_list {
    prom_renderer *renderer;
    PROM_ARRAY(prom_draw_item) items;
    // Filled by prepare.
    PROM_ARRAY(sort_entry) entries;
    PROM_ARRAY(sort_entry) scratch;
    PROM_ARRAY(draw_record) records;
    PROM_ARRAY(draw_command) commands;
    PROM_ARRAY(draw_run) runs;
    gpu_buffer record_buffer, command_buffer;
    uint64_t vertices;
};

#endif
