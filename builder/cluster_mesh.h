// Cluster meshes: the merged and simplified geometry of a cluster's children, one
// vertex-coloured submesh, in the cluster's frame. (subject_atlas.c may put an atlas on it.)
#ifndef PROM_BUILDER_CLUSTER_MESH_H
#define PROM_BUILDER_CLUSTER_MESH_H

#include "metaobj/base/math.h"
#include "metaobj/mesh.h"
#include "metaobj/model.h"
#include "metaobj/texture.h"

#include <stdbool.h>

// A piece of the cluster: a child's mesh at a level, placed in the cluster's frame.
typedef struct prom_cluster_piece {
    const prom_mesh *mesh;
    float error;              // the piece's own deviation, its own units
    prom_placement placement; // to the cluster's frame
} prom_cluster_piece;

// Replaces materials by vertex colours: each vertex gets base colour x the texture's mean
// around it (a mip level that matches its triangles' extent in the texture), sRGB-encoded; the
// parts of alpha-masked submeshes are shrunk about their centres to the area that their alpha
// covers; all submeshes become one with PROM_NONE. textures[i] belongs to materials[].texture
// == i.
void prom_mesh_bake_colors(const prom_mesh *mesh, const prom_material *materials,
                           const prom_texture *textures, prom_mesh *out);

// Merges pieces (baked already) and simplifies to at most target_triangles where it can;
// surfaces are welded at common borders and keep their outer border. *error: deviation from
// full detail (the greatest piece error plus the simplification's). False if nothing could be
// made.
bool prom_cluster_mesh_make(const prom_cluster_piece *pieces, size_t count, bool surface,
                            uint32_t target_triangles, prom_mesh *out, float *error);

#endif
