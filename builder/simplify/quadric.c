#include "builder/simplify/quadric.h"

// So weak that a place on a gently curved surface is off by less than a hundredth of an edge,
// and well above what floats lose.
#define PRIOR 1e-5

bool prom_quadric_minimum(const prom_quadric *q, const float prior[3], float place[3])
{
    const double weak = PRIOR * ((double)q->a[0] + (double)q->a[1] + (double)q->a[2]);
    if (!(weak > 0)) return false;
    const double xx = (double)q->a[0] + weak, yy = (double)q->a[1] + weak,
                 zz = (double)q->a[2] + weak, xy = (double)q->a[3], xz = (double)q->a[4],
                 yz = (double)q->a[5];
    double r[3];
    for (int k = 0; k < 3; k++) r[k] = weak * (double)prior[k] - (double)q->b[k];
    // Cramer's rule on a symmetric matrix.
    const double cxx = yy * zz - yz * yz, cxy = xz * yz - xy * zz, cxz = xy * yz - xz * yy;
    const double cyy = xx * zz - xz * xz, cyz = xy * xz - xx * yz, czz = xx * yy - xy * xy;
    const double determinant = xx * cxx + xy * cxy + xz * cxz;
    if (!(determinant > 0)) return false;
    place[0] = (float)((cxx * r[0] + cxy * r[1] + cxz * r[2]) / determinant);
    place[1] = (float)((cxy * r[0] + cyy * r[1] + cyz * r[2]) / determinant);
    place[2] = (float)((cxz * r[0] + cyz * r[1] + czz * r[2]) / determinant);
    return true;
}
