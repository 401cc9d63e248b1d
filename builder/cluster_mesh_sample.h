// Private to cluster meshes: colours and coverage read from a material's texture.
#ifndef PROM_BUILDER_CLUSTER_MESH_SAMPLE_H
#define PROM_BUILDER_CLUSTER_MESH_SAMPLE_H

#include "metaobj/model.h"
#include "metaobj/texture.h"

// A material made ready to sample; texture NULL: base colour alone.
typedef struct prom_sampler {
    const prom_texture *texture;
    float base[4];
    bool masked;
    float cutoff;
} prom_sampler;

prom_sampler prom_sampler_init(const prom_material *material, const prom_texture *textures);
// The level at which a texel is about half as large as the triangle's extent in the texture.
uint32_t prom_sampler_level(const prom_sampler *sampler, const float *uv[3]);
// Base colour times the texture at a level, bilinear, repeating; linear. In masked materials
// covered texels count by their alpha.
void prom_sampler_color(const prom_sampler *sampler, uint32_t level, const float uv[2],
                        float rgb[3]);
// Share of a triangle's area that passes the alpha test; alpha: of the vertex colours, [0,1].
float prom_sampler_coverage(const prom_sampler *sampler, const float *uv[3], float alpha);

#endif
