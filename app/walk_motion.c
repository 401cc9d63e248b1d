#include "app/walk_motion.h"

#include <cglm/cglm.h>
#include <math.h>
#include <string.h>

// By taste: a model is crossed in 40 s, or in 10 s fast; a turn of a screen's width is one of
// half a circle.
#define CROSSING_S 40.0
#define FAST 4.0
#define RADIANS_PER_PX 0.0025
#define TURN_PER_S 1.4
#define SPEED_PER_NOTCH 1.2
#define SPEED_RANGE 100.0

static double clamp(double value, double low, double high)
{
    return value > low ? (value < high ? value : high) : low; // NaN becomes low
}

static void set_direction(prom_walk_motion *m, double yaw, double pitch)
{
    m->yaw = remainder(yaw, 2 * M_PI);
    m->pitch = clamp(pitch, -PROM_WALK_PITCH_MAX, PROM_WALK_PITCH_MAX);
}

void prom_walk_take_pose(prom_walk_motion *motion, const prom_camera *camera)
{
    versor q;
    vec3 forward, up;
    memcpy(q, camera->orientation, sizeof q);
    memcpy(motion->eye, camera->eye, sizeof motion->eye);
    glm_quat_rotatev(q, (vec3){0, 0, -1}, forward);
    glm_quat_rotatev(q, (vec3){0, 1, 0}, up);
    double pitch = asin(clamp((double)forward[1], -1, 1));
    double x = forward[0], z = forward[2];
    if (hypot(x, z) < 1e-4) { // straight up or down: the camera's top says where ahead is
        x = forward[1] > 0 ? -up[0] : up[0];
        z = forward[1] > 0 ? -up[2] : up[2];
    }
    set_direction(motion, atan2(-x, -z), pitch);
}

void prom_walk_init(prom_walk_motion *motion, const prom_camera *start, double size)
{
    *motion = (prom_walk_motion){0};
    prom_walk_take_pose(motion, start);
    motion->speed = motion->start_speed = size / CROSSING_S;
    motion->least_speed = motion->speed / SPEED_RANGE;
    motion->most_speed = motion->speed * SPEED_RANGE;
    memcpy(motion->start_eye, motion->eye, sizeof motion->eye);
    motion->start_yaw = motion->yaw;
    motion->start_pitch = motion->pitch;
}

static void go_home(prom_walk_motion *m)
{
    memcpy(m->eye, m->start_eye, sizeof m->eye);
    m->yaw = m->start_yaw;
    m->pitch = m->start_pitch;
    m->speed = m->start_speed;
}

static void look(prom_walk_motion *m, const prom_walk_input *input, double dt_s)
{
    double keys = TURN_PER_S * dt_s;
    set_direction(m, m->yaw - input->look_px[0] * RADIANS_PER_PX - input->turn * keys,
                  m->pitch - input->look_px[1] * RADIANS_PER_PX + input->tilt * keys);
}

static void move(prom_walk_motion *m, const prom_walk_input *input, double dt_s)
{
    double asked = sqrt(input->forward * input->forward + input->right * input->right +
                        input->up * input->up);
    if (!(asked > 0)) return;
    double way = m->speed * (input->fast ? FAST : 1) * dt_s / asked;
    double s = sin(m->yaw), c = cos(m->yaw);
    m->eye[0] += way * (-s * input->forward + c * input->right);
    m->eye[1] += way * input->up;
    m->eye[2] += way * (-c * input->forward - s * input->right);
}

void prom_walk_step(prom_walk_motion *motion, const prom_walk_input *input, double dt_s)
{
    double dt = clamp(dt_s, 0, PROM_WALK_STEP_MAX_S);
    if (input->home) go_home(motion);
    motion->speed = clamp(motion->speed * pow(SPEED_PER_NOTCH, clamp(input->scroll, -99, 99)),
                          motion->least_speed, motion->most_speed);
    look(motion, input, dt);
    move(motion, input, dt);
}

bool prom_walk_input_moves(const prom_walk_input *input)
{
    return input->forward || input->right || input->up || input->turn || input->tilt ||
           input->look_px[0] != 0 || input->look_px[1] != 0 || input->home;
}

void prom_walk_camera(const prom_walk_motion *motion, prom_camera *camera)
{
    // Turned about +y, then tilted about its own +x, in doubles: small turns are not lost.
    double sy = sin(motion->yaw / 2), cy = cos(motion->yaw / 2);
    double sx = sin(motion->pitch / 2), cx = cos(motion->pitch / 2);
    const double q[4] = {cy * sx, sy * cx, -sy * sx, cy * cx};
    for (int i = 0; i < 4; i++) camera->orientation[i] = (float)q[i];
    memcpy(camera->eye, motion->eye, sizeof camera->eye);
}
