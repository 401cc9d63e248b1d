// Geometry helpers over cglm: bounds, rigid and affine transforms, the octahedral map.
// Matrices are column-major as in cglm and OpenGL. World positions are doubles; everything
// relative to a node or to the eye is float.
#ifndef PROM_METAOBJ_BASE_MATH_H
#define PROM_METAOBJ_BASE_MATH_H

#include <cglm/cglm.h>
#include <stdbool.h>
#include <stdint.h>

// An axis-aligned box. Empty when min > max.
typedef struct prom_box {
    float min[3], max[3];
} prom_box;

#define PROM_BOX_EMPTY                                                                         \
    ((prom_box){{INFINITY, INFINITY, INFINITY}, {-INFINITY, -INFINITY, -INFINITY}})

void prom_box_add_point(prom_box *box, const float point[3]);
void prom_box_add_box(prom_box *box, const prom_box *other);
bool prom_box_is_empty(const prom_box *box);
// Length of the diagonal; 0 for an empty box.
float prom_box_diagonal(const prom_box *box);
void prom_box_center(const prom_box *box, float center[3]);
void prom_box_half(const prom_box *box, float half[3]);

// A placement: world = origin + basis * local. `basis` is column-major 3x3 and may scale,
// mirror and shear.
typedef struct prom_placement {
    double origin[3];
    float basis[9];
} prom_placement;

extern const prom_placement prom_placement_identity;

// Splits a 4x4 world matrix of doubles (column-major) into a placement.
prom_placement prom_placement_from_matrix(const double matrix[16]);
void prom_placement_apply(const prom_placement *placement, const float local[3],
                          double world[3]);
// Direction or offset: basis * local.
void prom_basis_apply(const float basis[9], const float local[3], float out[3]);
// Transposed product, for directions into the local frame of a rotation.
void prom_basis_apply_transposed(const float basis[9], const float v[3], float out[3]);
// Half extents of the axis-aligned box of a turned box: |basis| * half.
void prom_basis_apply_half(const float basis[9], const float half[3], float out[3]);
// Determinant (negative: mirrored) and the largest column length (the scale of errors and
// radii).
float prom_basis_determinant(const float basis[9]);
float prom_basis_scale(const float basis[9]);
// out = inverse of basis; false when it is singular.
bool prom_basis_invert(const float basis[9], float out[9]);
// What turns normals where a 4x4 matrix (column-major) turns positions, up to a positive
// factor; flattening matrices, which have no inverse, have one too. Returns whether the matrix
// mirrors.
bool prom_normal_matrix(const double matrix[16], float normal[9]);
// out = a * b.
void prom_basis_multiply(const float a[9], const float b[9], float out[9]);

// The octahedral map between unit vectors and the square [0,1]^2 (Cigolle et al. 2014); +y is
// the centre of the square, so that the upper hemisphere fills the inner diamond.
void prom_octahedral_encode(const float direction[3], float uv[2]);
void prom_octahedral_decode(const float uv[2], float direction[3]);

// sRGB transfer curve on [0,1] (IEC 61966-2-1).
float prom_srgb_to_linear(float encoded);
float prom_linear_to_srgb(float linear);
// The same through a table, from an 8-bit value.
float prom_srgb8_to_linear(uint8_t encoded);
uint8_t prom_linear_to_srgb8(float linear);

#endif
