// Shapes under construction: vertices and triangles by material, put together from
// quads, boxes, mouldings, turned profiles and tubes. Metres, y up.
#ifndef PROM_SCENES_SHAPE_H
#define PROM_SCENES_SHAPE_H

#include "metaobj/base/alloc.h"
#include "scenes/glb_writer.h"

#include <stdbool.h>
#include <stdint.h>

// What a surface is made of: a material of the file and the metres that its picture covers.
typedef struct prom_paint {
    uint32_t material;
    float repeat;
} prom_paint;

typedef struct prom_shape_part {
    uint32_t material;
    PROM_ARRAY(prom_glb_vertex) vertices;
    PROM_ARRAY(uint32_t) indices;
} prom_shape_part;

// Where the following pieces go: turned by a yaw about +y (given as cosine and sine), shifted.
typedef struct prom_shape_frame {
    float origin[3], c, s;
} prom_shape_frame;

typedef struct prom_shape {
    PROM_ARRAY(prom_shape_part) parts;
    size_t part; // the one that is added to
    float repeat;
    prom_shape_frame frame;
} prom_shape;

// Faces of a box, to leave out those that nobody sees.
enum {
    PROM_FACE_RIGHT = 1,
    PROM_FACE_LEFT = 2,
    PROM_FACE_TOP = 4,
    PROM_FACE_BOTTOM = 8,
    PROM_FACE_FRONT = 16,
    PROM_FACE_BACK = 32,
    PROM_FACE_SIDES = 1 | 2 | 16 | 32,
    PROM_FACE_NO_BACK = 31,
    PROM_FACE_ALL = 63,
};

void prom_shape_init(prom_shape *shape);
void prom_shape_finish(prom_shape *shape);
uint32_t prom_shape_triangles(const prom_shape *shape);
// Writes it to the file as one mesh; its number there. The shape must not be empty.
uint32_t prom_shape_write(const prom_shape *shape, prom_glb *glb, const char *name);

// The following pieces are of this paint.
void prom_shape_use(prom_shape *shape, prom_paint paint);
// Moves into a frame within the present one, and back to the frame that it returned.
prom_shape_frame prom_shape_enter(prom_shape *shape, float x, float y, float z, float yaw);
void prom_shape_leave(prom_shape *shape, prom_shape_frame frame);

// Single vertices and triangles, for what has no function here. uv as stored.
uint32_t prom_shape_vertex(prom_shape *shape, const float position[3], const float normal[3],
                           float u, float v);
void prom_shape_triangle(prom_shape *shape, uint32_t a, uint32_t b, uint32_t c);

// Flat faces, counter-clockwise, from the lower left: the picture's u runs along the first
// edge.
void prom_shape_quad(prom_shape *shape, const float a[3], const float b[3], const float c[3],
                     const float d[3]);
void prom_shape_flat_triangle(prom_shape *shape, const float a[3], const float b[3],
                              const float c[3]);
// A quad that shows the whole picture once.
void prom_shape_picture(prom_shape *shape, const float a[3], const float b[3], const float c[3],
                        const float d[3]);
void prom_shape_box(prom_shape *shape, float x0, float y0, float z0, float x1, float y1,
                    float z1, int faces);
// A moulding along x from x0 to x1: `profile` is a line of (y, z) points from bottom to top
// that bulges towards +z. Ends are closed (convex profile).
void prom_shape_moulding(prom_shape *shape, const float (*profile)[2], int points, float x0,
                         float x1);
// Turns a profile of (radius, y) points, bottom to top, about the frame's y axis. Smooth
// around; smooth or flat along the profile.
void prom_shape_lathe(prom_shape *shape, const float (*profile)[2], int points, int sides,
                      bool smooth);
// A round tube through points, ends open; radii per point.
void prom_shape_tube(prom_shape *shape, const float (*points)[3], const float *radii, int count,
                     int sides);
// A flat horizontal grid at height y, facing up, of cells of about `cell` metres.
void prom_shape_floor(prom_shape *shape, float x0, float z0, float x1, float z1, float y,
                      float cell);

#endif
