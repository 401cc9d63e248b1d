// A path played in a window: in real time, between its keys too.
#ifndef PROM_APP_WALK_PATH_H
#define PROM_APP_WALK_PATH_H

#include "scenes/path.h"

// The pose at a place of the path, in keys from its start, any value from 0: past the end the
// path is walked to and fro. Sets the camera's eye and orientation. The path must have a key.
void prom_walk_path_pose(const prom_path *path, double at_keys, prom_camera *camera);
// How far the path leads in a time, in keys: its own rate.
double prom_walk_path_keys(const prom_path *path, double seconds);

#endif
