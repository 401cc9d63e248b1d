// The text of the shaders in render/shaders, embedded by the build.
#ifndef PROM_RENDER_SHADERS_H
#define PROM_RENDER_SHADERS_H

extern const char prom_glsl_lighting_glsl[];
extern const char prom_glsl_mesh_vert[];
extern const char prom_glsl_mesh_frag[];
extern const char prom_glsl_gather_ids_comp[];

#endif
