// How a walker moves: from keys, mouse and time to a camera. Knows no window.
//
// Walking keeps the height, whatever the pitch; turning keeps the horizon level. Mouse look
// adds up the mouse's way only, so that a mouse that returns brings the view back.
#ifndef PROM_APP_WALK_MOTION_H
#define PROM_APP_WALK_MOTION_H

#include "metaobj/camera.h"

#include <stdbool.h>

// The longest step: after a stall the walker does not leap through a wall.
#define PROM_WALK_STEP_MAX_S 0.1
// Nearly straight up or down, where the heading still means something.
#define PROM_WALK_PITCH_MAX 1.55

// What is asked for at the moment.
typedef struct prom_walk_input {
    int forward, right, up; // -1, 0 or 1
    int turn, tilt;         // by keys: 1 is right, up
    double look_px[2];      // the mouse's way since the last step: right, down
    double scroll;          // notches: positive is faster
    bool fast, home;
} prom_walk_input;

typedef struct prom_walk_motion {
    double eye[3];
    double yaw, pitch; // radians; 0, 0 looks along -z, positive is left, up
    double speed;      // scene units a second
    double least_speed, most_speed;
    double start_eye[3], start_yaw, start_pitch, start_speed;
} prom_walk_motion;

// Starts at the camera's pose. size: of the model, scene units, above 0; sets the speed.
void prom_walk_init(prom_walk_motion *motion, const prom_camera *start, double size);
// Goes on from a camera's place and direction; its roll is dropped.
void prom_walk_take_pose(prom_walk_motion *motion, const prom_camera *camera);
// Moves by what is asked for in dt_s seconds (any value: it is bounded).
void prom_walk_step(prom_walk_motion *motion, const prom_walk_input *input, double dt_s);
// Whether the input moves or turns the walker.
bool prom_walk_input_moves(const prom_walk_input *input);
// Sets the camera's eye and orientation.
void prom_walk_camera(const prom_walk_motion *motion, prom_camera *camera);

#endif
