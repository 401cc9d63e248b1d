// The camera and camera paths.
#ifndef PROM_METAOBJ_CAMERA_H
#define PROM_METAOBJ_CAMERA_H

#include <stdint.h>

// Right-handed, y up; the camera looks down its -z.
typedef struct prom_camera {
    double eye[3];
    float orientation[4]; // unit quaternion x y z w: camera to world
    float fov_y;          // vertical field of view, radians
    float z_near;         // the far plane is at infinity
    uint32_t width, height;
} prom_camera;

// Turns the camera so that it looks at a point with world +y up.
void prom_camera_look_at(prom_camera *camera, const double target[3]);

#endif
