// Triangle meshes in the layout that the GPU draws.
#ifndef PROM_METAOBJ_MESH_H
#define PROM_METAOBJ_MESH_H

#include "metaobj/base/math.h"

#include <stdint.h>

// 28 bytes. Position in the frame of the prototype; normal as signed bytes / 127 (w unused);
// colour sRGB-encoded with straight alpha, multiplied with the material; uv with v = 0 at the
// first row of the picture. In the mesh of a textured box color[3] is unused and the face index
// (0..5: +x -x +y -y +z -z) stands in normal[3].
typedef struct prom_vertex {
    float position[3];
    int8_t normal[4];
    uint8_t color[4];
    float uv[2];
} prom_vertex;

typedef struct prom_submesh {
    uint32_t first_index, index_count;
    uint32_t material; // index into the model's materials, or PROM_NONE: vertex colour alone
} prom_submesh;

// A triangle list: index_count is a multiple of 3; submeshes cover it without overlap, in
// order. Counter-clockwise triangles face the viewer.
typedef struct prom_mesh {
    prom_vertex *vertices;
    uint32_t *indices;
    prom_submesh *submeshes;
    uint32_t vertex_count, index_count, submesh_count;
} prom_mesh;

#define PROM_NONE UINT32_MAX

// Allocates zeroed arrays of the given sizes.
void prom_mesh_init(prom_mesh *mesh, uint32_t vertices, uint32_t indices, uint32_t submeshes);
void prom_mesh_finish(prom_mesh *mesh); // frees the arrays; {0} is allowed
void prom_mesh_copy(prom_mesh *out, const prom_mesh *mesh);
prom_box prom_mesh_bounds(const prom_mesh *mesh);
// NULL if indices are in range, submeshes consistent, positions finite and materials below
// `material_count` or PROM_NONE; else a literal that says what is wrong.
const char *prom_mesh_check(const prom_mesh *mesh, uint32_t material_count);
// Hash of all that the mesh holds. Which corner of a triangle stands first does not count: the
// container's codec may turn triangles (keeping their winding).
uint64_t prom_mesh_hash(const prom_mesh *mesh, uint64_t seed);

// A box of 12 triangles and 24 vertices around [center - half, center + half], faces in the
// order +x -x +y -y +z -z, uv over each face as its camera sees it (u to the right, v down; the
// camera's up is +y for the sides, -z for the top, +z for the bottom), one submesh with
// PROM_NONE. colors: per face, sRGB-encoded RGBA, or NULL for white.
void prom_mesh_init_box(prom_mesh *mesh, const float center[3], const float half[3],
                        const uint8_t colors[6][4]);
// The axes of a face's camera: right, up, and out (from the face to its camera), each of unit
// length along a coordinate axis.
void prom_box_face_axes(int face, float right[3], float up[3], float out[3]);

// Encodes a normal; the zero vector becomes +y.
void prom_pack_normal(const float normal[3], int8_t packed[4]);
// Turns an encoded normal by a matrix of prom_normal_matrix.
void prom_turn_normal(const float matrix[9], const int8_t packed[4], int8_t turned[4]);

#endif
