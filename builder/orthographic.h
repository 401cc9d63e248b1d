// Views along a direction, without perspective.
#ifndef PROM_BUILDER_ORTHOGRAPHIC_H
#define PROM_BUILDER_ORTHOGRAPHIC_H

#include "metaobj/base/math.h"

// The frame of a view: `out` goes to the viewer, +y is up, or -z where one looks along y.
void prom_frame_of_direction(const float out[3], float right[3], float up[3]);

// Clip coordinates from a frame: x and y over the half extents, z from 0 (far) to 1 (near).
void prom_orthographic(const float right[3], const float up[3], const float out[3],
                       float half_width, float half_height, float half_depth, mat4 clip);

#endif
