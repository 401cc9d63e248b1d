// A texture atlas for a mesh: its faces in charts, groups of connected faces that look about
// the same way, each seen straight on in a rectangle of its own.
//
//   prom_atlas_init: charts and their places
//   prom_atlas_unwrap: the mesh with texture coordinates
//   whoever fills the texture looks at each chart along its axis (prom_chart)
//
// Positions are in the mesh's frame, texels count from the top left.
#ifndef PROM_BUILDER_ATLAS_H
#define PROM_BUILDER_ATLAS_H

#include "metaobj/mesh.h"

#include <stdbool.h>
#include <stdint.h>

#define PROM_ATLAS_GUTTER 1u // texels around a chart that are its own and show no face

typedef struct prom_chart {
    float right[3], up[3], out[3]; // orthonormal: texels to the right, texels up, to the viewer
    float min[3], max[3];          // of its faces along right, up, out
    uint32_t first, count;         // its part of prom_atlas.faces
    uint32_t x, y, width, height;  // its place in texels, gutter included
} prom_chart;

typedef struct prom_atlas {
    prom_chart *charts;
    uint32_t *faces; // triangles of the mesh, chart by chart, each once
    uint32_t chart_count, face_count;
    uint32_t side;         // texels, a power of two
    float texels_per_unit; // the same in all charts
} prom_atlas;

// Charts the mesh and packs the charts: into the smallest square of min_side to max_side texels
// (powers of two) that holds them at texels_per_unit, or at the greatest density that
// max_side holds. Deterministic. False, with *atlas empty, if the mesh is empty or has too many
// charts for max_side.
bool prom_atlas_init(prom_atlas *atlas, const prom_mesh *mesh, float texels_per_unit,
                     uint32_t min_side, uint32_t max_side);
void prom_atlas_finish(prom_atlas *atlas); // {0} is allowed
// The mesh with texture coordinates, its vertices parted at the borders of charts; one submesh,
// white, with PROM_NONE.
void prom_atlas_unwrap(const prom_atlas *atlas, const prom_mesh *mesh, prom_mesh *out);

// ---- the steps of prom_atlas_init

// Sets the charts but for their places, and the faces.
void prom_atlas_chart(prom_atlas *atlas, const prom_mesh *mesh);
// Gives the charts their places at a density in a square; false, with the places undefined, if
// they do not fit.
bool prom_atlas_pack(prom_atlas *atlas, float texels_per_unit, uint32_t side);

#endif
