#include "metaobj/camera.h"

#include "metaobj/base/math.h"

void prom_camera_look_at(prom_camera *camera, const double target[3])
{
    double d[3], length = 0;
    for (int a = 0; a < 3; a++) {
        d[a] = target[a] - camera->eye[a];
        length += d[a] * d[a];
    }
    length = sqrt(length);
    if (!(length > 0)) return; // no direction: the orientation stays
    double fx = d[0] / length, fy = d[1] / length, fz = d[2] / length;
    // right = forward x (0,1,0); straight up or down leaves the turn free: +x is taken.
    double rx = -fz, rz = fx, r = hypot(rx, rz);
    if (r < 1e-9) {
        rx = r = 1;
        rz = 0;
    }
    rx /= r;
    rz /= r;
    mat3 axes = {{(float)rx, 0, (float)rz},
                 {(float)(-rz * fy), (float)(rz * fx - rx * fz), (float)(rx * fy)},
                 {(float)-fx, (float)-fy, (float)-fz}};
    versor q;
    glm_mat3_quat(axes, q);
    glm_quat_normalize(q);
    for (int i = 0; i < 4; i++) camera->orientation[i] = q[i];
}
