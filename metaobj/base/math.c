#include "metaobj/base/math.h"

const prom_placement prom_placement_identity = {{0, 0, 0}, {1, 0, 0, 0, 1, 0, 0, 0, 1}};

void prom_box_add_point(prom_box *box, const float point[3])
{
    for (int a = 0; a < 3; a++) {
        if (point[a] < box->min[a]) box->min[a] = point[a];
        if (point[a] > box->max[a]) box->max[a] = point[a];
    }
}

void prom_box_add_box(prom_box *box, const prom_box *other)
{
    for (int a = 0; a < 3; a++) {
        if (other->min[a] < box->min[a]) box->min[a] = other->min[a];
        if (other->max[a] > box->max[a]) box->max[a] = other->max[a];
    }
}

bool prom_box_is_empty(const prom_box *box)
{
    return !(box->min[0] <= box->max[0] && box->min[1] <= box->max[1] &&
             box->min[2] <= box->max[2]);
}

float prom_box_diagonal(const prom_box *box)
{
    if (prom_box_is_empty(box)) return 0;
    double sum = 0;
    for (int a = 0; a < 3; a++) {
        double d = (double)box->max[a] - box->min[a];
        sum += d * d;
    }
    return (float)sqrt(sum);
}

void prom_box_center(const prom_box *box, float center[3])
{
    bool empty = prom_box_is_empty(box);
    for (int a = 0; a < 3; a++)
        center[a] = empty ? 0 : (float)(((double)box->min[a] + box->max[a]) / 2);
}

void prom_box_half(const prom_box *box, float half[3])
{
    bool empty = prom_box_is_empty(box);
    for (int a = 0; a < 3; a++)
        half[a] = empty ? 0 : (float)(((double)box->max[a] - box->min[a]) / 2);
}

prom_placement prom_placement_from_matrix(const double matrix[16])
{
    prom_placement p;
    for (int column = 0; column < 3; column++)
        for (int row = 0; row < 3; row++)
            p.basis[3 * column + row] = (float)matrix[4 * column + row];
    for (int row = 0; row < 3; row++) p.origin[row] = matrix[12 + row];
    return p;
}

void prom_placement_apply(const prom_placement *placement, const float local[3],
                          double world[3])
{
    const float *b = placement->basis;
    double x = local[0], y = local[1], z = local[2];
    for (int row = 0; row < 3; row++)
        world[row] = placement->origin[row] + b[row] * x + b[3 + row] * y + b[6 + row] * z;
}

void prom_basis_apply(const float basis[9], const float local[3], float out[3])
{
    float x = local[0], y = local[1], z = local[2];
    for (int row = 0; row < 3; row++)
        out[row] = basis[row] * x + basis[3 + row] * y + basis[6 + row] * z;
}

void prom_basis_apply_transposed(const float basis[9], const float v[3], float out[3])
{
    float x = v[0], y = v[1], z = v[2];
    for (int column = 0; column < 3; column++) {
        const float *c = basis + 3 * column;
        out[column] = c[0] * x + c[1] * y + c[2] * z;
    }
}

void prom_basis_apply_half(const float basis[9], const float half[3], float out[3])
{
    float x = half[0], y = half[1], z = half[2];
    for (int row = 0; row < 3; row++)
        out[row] =
            fabsf(basis[row]) * x + fabsf(basis[3 + row]) * y + fabsf(basis[6 + row]) * z;
}

// Cofactors in double: bases of thin objects lose too much in float.
static void cofactors(const float m[9], double c[9])
{
    c[0] = (double)m[4] * m[8] - (double)m[7] * m[5];
    c[1] = (double)m[7] * m[2] - (double)m[1] * m[8];
    c[2] = (double)m[1] * m[5] - (double)m[4] * m[2];
    c[3] = (double)m[6] * m[5] - (double)m[3] * m[8];
    c[4] = (double)m[0] * m[8] - (double)m[6] * m[2];
    c[5] = (double)m[3] * m[2] - (double)m[0] * m[5];
    c[6] = (double)m[3] * m[7] - (double)m[6] * m[4];
    c[7] = (double)m[6] * m[1] - (double)m[0] * m[7];
    c[8] = (double)m[0] * m[4] - (double)m[3] * m[1];
}

static double determinant(const float m[9], const double c[9])
{
    return m[0] * c[0] + m[3] * c[1] + m[6] * c[2];
}

float prom_basis_determinant(const float basis[9])
{
    double c[9];
    cofactors(basis, c);
    return (float)determinant(basis, c);
}

float prom_basis_scale(const float basis[9])
{
    float largest = 0;
    for (int column = 0; column < 3; column++) {
        const float *c = basis + 3 * column;
        float square = c[0] * c[0] + c[1] * c[1] + c[2] * c[2];
        if (square > largest) largest = square;
    }
    return sqrtf(largest);
}

bool prom_normal_matrix(const double w[16], float normal[9])
{
    // The matrix of cofactors serves flattened matrices too, which have no inverse.
    double c[9], largest = 0;
    for (int i = 0; i < 3; i++)
        for (int r = 0; r < 3; r++) {
            const double *a = w + 4 * ((i + 1) % 3), *b = w + 4 * ((i + 2) % 3);
            int s = (r + 1) % 3, t = (r + 2) % 3;
            c[i * 3 + r] = a[s] * b[t] - a[t] * b[s];
            largest = fmax(largest, fabs(c[i * 3 + r]));
        }
    double det = w[0] * c[0] + w[1] * c[1] + w[2] * c[2];
    double scale = largest > 0 ? (det < 0 ? -1 : 1) / largest : 0;
    for (int k = 0; k < 9; k++) normal[k] = (float)(c[k] * scale);
    return det < 0;
}

bool prom_basis_invert(const float basis[9], float out[9])
{
    double c[9];
    cofactors(basis, c);
    double det = determinant(basis, c);
    // Relative to the scale, so that small objects are not taken for flat ones.
    double scale = prom_basis_scale(basis);
    if (!(fabs(det) > 1e-12 * scale * scale * scale)) return false;
    for (int i = 0; i < 9; i++) out[i] = (float)(c[i] / det);
    return true;
}

void prom_basis_multiply(const float a[9], const float b[9], float out[9])
{
    float result[9]; // out may be a or b
    for (int column = 0; column < 3; column++)
        prom_basis_apply(a, b + 3 * column, result + 3 * column);
    for (int i = 0; i < 9; i++) out[i] = result[i];
}

void prom_octahedral_encode(const float direction[3], float uv[2])
{
    float x = direction[0], y = direction[1], z = direction[2];
    float sum = fabsf(x) + fabsf(y) + fabsf(z);
    if (!(sum > 0)) {
        uv[0] = uv[1] = 0.5f;
        return;
    }
    float u = x / sum, v = z / sum;
    if (y < 0) { // fold the lower half over the diamond's sides
        float folded = copysignf(1 - fabsf(v), u);
        v = copysignf(1 - fabsf(u), v);
        u = folded;
    }
    uv[0] = u * 0.5f + 0.5f;
    uv[1] = v * 0.5f + 0.5f;
}

void prom_octahedral_decode(const float uv[2], float direction[3])
{
    float x = uv[0] * 2 - 1, z = uv[1] * 2 - 1;
    float y = 1 - fabsf(x) - fabsf(z);
    if (y < 0) {
        float unfolded = copysignf(1 - fabsf(z), x);
        z = copysignf(1 - fabsf(x), z);
        x = unfolded;
    }
    float length = sqrtf(x * x + y * y + z * z);
    direction[0] = x / length;
    direction[1] = y / length;
    direction[2] = z / length;
}
