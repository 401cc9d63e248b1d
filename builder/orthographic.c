#include "builder/orthographic.h"

void prom_frame_of_direction(const float out[3], float right[3], float up[3])
{
    vec3 world_up = {0.0f, 1.0f, 0.0f};
    if (fabsf(out[1]) > 0.99f) glm_vec3_copy((vec3){0.0f, 0.0f, -1.0f}, world_up);
    glm_vec3_crossn(world_up, (float *)out, right);
    glm_vec3_cross((float *)out, right, up);
}

void prom_orthographic(const float right[3], const float up[3], const float out[3],
                       float half_width, float half_height, float half_depth, mat4 m)
{
    glm_mat4_zero(m);
    for (int c = 0; c < 3; c++) {
        m[c][0] = right[c] / half_width;
        m[c][1] = up[c] / half_height;
        m[c][2] = 0.5f * out[c] / half_depth;
    }
    m[3][2] = 0.5f;
    m[3][3] = 1.0f;
}
