// Two meshes as they look from all around, side by side: pictures from the faces, edges and
// corners of the cube around the first, in the same views, and how they differ.
//
// Views are orthographic and show the bounding sphere of the first mesh, lit as all scenes are,
// over a middle grey. What the second one has outside of the sphere does not show.
#ifndef PROM_BUILDER_MESH_PICTURES_H
#define PROM_BUILDER_MESH_PICTURES_H

#include "benefit/pool.h"
#include "builder/mesh_file.h"

// First 6 faces (+x -x +y -y +z -z), then 12 edges, then 8 corners.
#define PROM_CUBE_VIEWS 26
// Towards the viewer, of unit length.
void prom_cube_view_direction(uint32_t view, float direction[3]);

// What they are compared by: rmse, sobel, flip.
enum { PROM_LOOK_RMSE, PROM_LOOK_SOBEL, PROM_LOOK_FLIP, PROM_LOOK_METRICS };
extern const char *const prom_look_metrics[PROM_LOOK_METRICS];

typedef struct prom_look_difference {
    prom_pooled all;    // over all pixels
    prom_pooled object; // over those that one of the two covers
} prom_look_difference;

typedef struct prom_mesh_pictures prom_mesh_pictures;

// Puts both on a headless device. size_px: along a side, 16 to 2048; ppd: pixels per degree,
// for flip. The files must live as long, and have one origin. NULL with PROM_ERR_UNSUPPORTED
// where there is no device or it has not the memory.
prom_mesh_pictures *prom_mesh_pictures_create(const prom_mesh_file *a, const prom_mesh_file *b,
                                              uint32_t size_px, double ppd, prom_error *error);
void prom_mesh_pictures_destroy(prom_mesh_pictures *pictures); // NULL is allowed

// Takes both pictures of a view below PROM_CUBE_VIEWS and compares them.
void prom_mesh_pictures_compare(prom_mesh_pictures *pictures, uint32_t view,
                                prom_look_difference differences[PROM_LOOK_METRICS]);
// Of the last view, until the next: a mesh's picture (0 or 1), RGBA, rows from the top, alpha
// 255 where the mesh is and 0 elsewhere; and the error of each pixel by flip.
const uint8_t (*prom_mesh_pictures_rgba(const prom_mesh_pictures *pictures, int mesh))[4];
const float *prom_mesh_pictures_flip(const prom_mesh_pictures *pictures);

#endif
