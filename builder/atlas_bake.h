// Fills an atlas with what stands where its charts are, lit, seen on the device.
#ifndef PROM_BUILDER_ATLAS_BAKE_H
#define PROM_BUILDER_ATLAS_BAKE_H

#include "builder/atlas.h"
#include "builder/bake.h"
#include "metaobj/texture.h"

#define PROM_ATLAS_SIDE_MAX 256u // texels
#define PROM_ATLAS_CUTOFF 0.5f   // of the alpha, where it counts

typedef struct prom_sphere {
    float center[3], radius;
} prom_sphere;

// What the charted mesh stands for.
typedef struct prom_atlas_subject {
    const prom_draw_item *items; // relative to the centre
    const prom_sphere *spheres;  // around each, relative to the centre
    size_t count;
    float center[3]; // in the mesh's frame
    float error;     // greatest deviation of the mesh from the items
} prom_atlas_subject;

// A square picture with mips. Texels hold the mean colour, in linear light, of what is seen
// along their chart's axis from the error before the chart to the error behind it; where there
// is nothing they have a neighbour's. Alpha is the share of the faces that shows something:
// what the mesh has too much is cut out again. Returns whether anything is; else alpha is 255.
// unwrapped: the mesh of prom_atlas_unwrap. The side is PROM_ATLAS_SIDE_MAX at most.
bool prom_atlas_bake(prom_baker *baker, const prom_atlas *atlas, const prom_mesh *unwrapped,
                     const prom_atlas_subject *subject, prom_texture *out);

#endif
