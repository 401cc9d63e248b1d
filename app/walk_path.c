#include "app/walk_path.h"

#include <cglm/cglm.h>
#include <math.h>
#include <string.h>

void prom_walk_path_pose(const prom_path *path, double at_keys, prom_camera *camera)
{
    double whole = floor(at_keys), part = at_keys - whole;
    prom_camera next = *camera;
    prom_path_pose(path, (uint64_t)whole, camera);
    if (!(part > 0)) return;
    prom_path_pose(path, (uint64_t)whole + 1, &next);
    versor from, to, q;
    memcpy(from, camera->orientation, sizeof from);
    memcpy(to, next.orientation, sizeof to);
    // Keys are close together; cglm 0.8's slerp fails for close ones of opposite signs.
    glm_quat_nlerp(from, to, (float)part, q);
    memcpy(camera->orientation, q, sizeof q);
    for (int i = 0; i < 3; i++) camera->eye[i] += part * (next.eye[i] - camera->eye[i]);
}

double prom_walk_path_keys(const prom_path *path, double seconds)
{
    size_t count = path->keys.count;
    double rate = PROM_PATH_RATE;
    if (count > 1) {
        double span = path->keys.data[count - 1].t - path->keys.data[0].t;
        if (span > 0) rate = (double)(count - 1) / span;
    }
    return seconds * rate;
}
