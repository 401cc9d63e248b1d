// Distance between two triangle surfaces by sampling, as Metro measures it (Cignoni, Rocchini
// and Scopigno 1998, "Metro: measuring error on simplified surfaces"), and how far their
// normals turn.
//
// Samples are uniform by area and stratified: sample k of n lies where (k + 1/2) / n of the
// area has gone by, triangle after triangle in a spatial order, and within its triangle on the
// sequence R2 (Roberts 2018, "The unreasonable effectiveness of quasirandom sequences"). They
// give means, as integrals over the surface; maxima see the vertices too. The result depends on
// the meshes and the number of samples alone.
#ifndef PROM_SIMPLIFY_MESH_DISTANCE_H
#define PROM_SIMPLIFY_MESH_DISTANCE_H

#include "metaobj/mesh.h"

// Samples of each surface when none are asked for: so many, or more for meshes of more faces.
enum {
    PROM_DISTANCE_SAMPLES = 500000,
    PROM_DISTANCE_SAMPLES_PER_FACE = 10,
    PROM_DISTANCE_SAMPLES_MOST = 5000000,
};

// From the points of one surface to the nearest ones of the other; object units.
typedef struct prom_one_way {
    double mean, rms, max;
    double from[3], to[3];     // where the maximum is, and the nearest point to it
    double normal_rms_degrees; // between shading normals there, sides not told apart: [0, 90]
    uint64_t samples;          // of the surface, vertices aside
} prom_one_way;

typedef struct prom_mesh_distances {
    prom_one_way ab, ba;
    double rms;       // the greater of both ways, as of
    double hausdorff; // the maxima
} prom_mesh_distances;

// samples: of each surface; 0: by the numbers above. Works on all cores. Positions are finite
// and, for their floats' sake, near the origin; distances that such floats cannot tell from 0
// are 0, others right to the precision of floats. A mesh without area has its means over
// vertices; one without triangles is INFINITY away from everything.
void prom_mesh_distances_measure(const prom_mesh *a, const prom_mesh *b, uint64_t samples,
                                 prom_mesh_distances *distances);

#endif
