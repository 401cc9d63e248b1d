// Camera paths: text, `#` comments, then lines `t px py pz qx qy qz qw` (seconds, scene units,
// quaternion camera to world); times ascend.
#ifndef PROM_SCENES_PATH_H
#define PROM_SCENES_PATH_H

#include "metaobj/base/status.h"
#include "metaobj/camera.h"
#include "metaobj/model.h"

typedef struct prom_path_key {
    double t, position[3];
    float orientation[4];
} prom_path_key;

typedef struct prom_path {
    PROM_ARRAY(prom_path_key) keys;
} prom_path;

// Errors name file and line.
prom_status prom_path_load(const char *file, prom_path *path, prom_error *error);
prom_status prom_path_save(const char *file, const prom_path *path, const char *title,
                           prom_error *error);
void prom_path_finish(prom_path *path);
// The pose of frame `frame`: a key each; past the end the path is walked to and fro.
void prom_path_pose(const prom_path *path, uint64_t frame, prom_camera *camera);
// A sensible walk through a model: `frames` keys, 30 a second, at eye height through the dense
// part of the layout, looking ahead, smooth. Deterministic.
prom_status prom_path_auto(const prom_model *model, uint32_t frames, prom_path *path,
                           prom_error *error);

#endif
