// Camera paths: text, `#` comments, then lines `t px py pz qx qy qz qw` (seconds, scene units,
// quaternion camera to world); times ascend.
#ifndef PROM_SCENES_PATH_H
#define PROM_SCENES_PATH_H

#include "metaobj/base/status.h"
#include "metaobj/camera.h"
#include "metaobj/container.h"
#include "metaobj/model.h"

// Keys a second in the paths that are made here; a key is a frame.
#define PROM_PATH_RATE 30.0

typedef struct prom_path_key {
    double t, position[3];
    float orientation[4]; // unit quaternion x y z w: camera to world
} prom_path_key;

typedef struct prom_path {
    PROM_ARRAY(prom_path_key) keys;
} prom_path;

// Reads a path of at least one key. Errors name file and line; then *path is empty.
prom_status prom_path_load(const char *file, prom_path *path, prom_error *error);
// Writes a path atomically; `title` goes into the header line (one line; NULL: none).
prom_status prom_path_save(const char *file, const prom_path *path, const char *title,
                           prom_error *error);
void prom_path_finish(prom_path *path); // {0} is allowed
// Adds a key at the path's end, looking along `forward` (any length, not straight up or down)
// with +y up. Its time is its number / PROM_PATH_RATE.
void prom_path_add(prom_path *path, const double position[3], const double forward[3]);
// The pose of frame `frame`: a key each; past the end the path is walked to and fro. Sets the
// camera's eye and orientation only. The path must have a key.
void prom_path_pose(const prom_path *path, uint64_t frame, prom_camera *camera);
// A sensible walk through a model: `frames` keys (at least 1), 30 a second, at eye height
// through the dense part of the layout, looking ahead, smooth; a round trip that looks at a
// model of few objects. It keeps to floors with headroom, such as streets, and past walls, from
// the model's geometry in `container`, which takes a second or so; with NULL it knows the
// objects' boxes only. Deterministic. PROM_ERR_INPUT when the model has no object.
prom_status prom_path_auto(prom_container *container, const prom_model *model, uint32_t frames,
                           prom_path *path, prom_error *error);

#endif
