// Solids under construction: vertices and triangles by material, put together from
// quads, boxes, mouldings, turned profiles and tubes. Metres, y up.
#ifndef PROM_SCENES_SOLID_H
#define PROM_SCENES_SOLID_H

#include "builder/glb_writer.h"
#include "metaobj/base/alloc.h"

#include <stdbool.h>
#include <stdint.h>

// What a surface is made of: a material of the file and the metres that its picture covers.
typedef struct prom_paint {
    uint32_t material;
    float repeat;
} prom_paint;

typedef struct prom_solid_part {
    uint32_t material;
    PROM_ARRAY(prom_glb_vertex) vertices;
    PROM_ARRAY(uint32_t) indices;
} prom_solid_part;

// Where the following pieces go: turned by a yaw about +y (given as cosine and sine), shifted.
typedef struct prom_solid_frame {
    float origin[3], c, s;
} prom_solid_frame;

typedef struct prom_solid {
    PROM_ARRAY(prom_solid_part) parts;
    size_t part; // the one that is added to
    float repeat;
    prom_solid_frame frame;
} prom_solid;

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

void prom_solid_init(prom_solid *shape);
void prom_solid_finish(prom_solid *shape);
uint32_t prom_solid_triangles(const prom_solid *shape);
// Writes it to the file as one mesh; its number there. The shape must not be empty.
uint32_t prom_solid_write(const prom_solid *shape, prom_glb *glb, const char *name);

// The following pieces are of this paint.
void prom_solid_use(prom_solid *shape, prom_paint paint);
// Moves into a frame within the present one, and back to the frame that it returned.
prom_solid_frame prom_solid_enter(prom_solid *shape, float x, float y, float z, float yaw);
void prom_solid_leave(prom_solid *shape, prom_solid_frame frame);

// Single vertices and triangles, for what has no function here. uv as stored.
uint32_t prom_solid_vertex(prom_solid *shape, const float position[3], const float normal[3],
                           float u, float v);
void prom_solid_triangle(prom_solid *shape, uint32_t a, uint32_t b, uint32_t c);

// Flat faces, counter-clockwise, from the lower left: the picture's u runs along the first
// edge.
void prom_solid_quad(prom_solid *shape, const float a[3], const float b[3], const float c[3],
                     const float d[3]);
void prom_solid_flat_triangle(prom_solid *shape, const float a[3], const float b[3],
                              const float c[3]);
// A quad that shows the whole picture once.
void prom_solid_picture(prom_solid *shape, const float a[3], const float b[3], const float c[3],
                        const float d[3]);
// The same with a part of the picture: uv is left, top, right, bottom.
void prom_solid_picture_part(prom_solid *shape, const float a[3], const float b[3],
                             const float c[3], const float d[3], const float uv[4]);
// A convex outline of (x, y) points, counter-clockwise as seen from +z, drawn out from z0 to
// z1 > z0. Of `faces` FRONT, BACK and any of SIDES count: all the edges or none.
void prom_solid_extrude(prom_solid *shape, const float (*outline)[2], int points, float z0,
                        float z1, int faces);
void prom_solid_box(prom_solid *shape, float x0, float y0, float z0, float x1, float y1,
                    float z1, int faces);
// A moulding along x from x0 to x1: `profile` is a line of (y, z) points from bottom to top
// that bulges towards +z. Ends are closed (convex profile).
void prom_solid_moulding(prom_solid *shape, const float (*profile)[2], int points, float x0,
                         float x1);
// Turns a profile of (radius, y) points, bottom to top, about the frame's y axis. Smooth
// around; smooth or flat along the profile.
void prom_solid_lathe(prom_solid *shape, const float (*profile)[2], int points, int sides,
                      bool smooth);
// A round tube through points, ends open; radii per point.
void prom_solid_tube(prom_solid *shape, const float (*points)[3], const float *radii, int count,
                     int sides);
// A flat horizontal grid at height y, facing up, of cells of about `cell` metres.
void prom_solid_floor(prom_solid *shape, float x0, float z0, float x1, float z1, float y,
                      float cell);

#endif
