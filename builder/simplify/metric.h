// What a collapse costs. The engine knows no metric: it asks one for the cost of a candidate
// and for the place and attributes of the vertex that it leaves behind.
//
// A metric keeps its own data for each point (say, a quadric) and each vertex, and combines
// them when points are merged. Costs are squared distances, object units, so that the square
// root of a cost is an error that a user understands; a metric that cannot promise that says
// so.
//
// Words: a *point* is a position, a *vertex* a point with attributes (a wedge of Hoppe 1996):
// points at texture seams and creases have several vertices.
#ifndef PROM_SIMPLIFY_METRIC_H
#define PROM_SIMPLIFY_METRIC_H

#include "builder/simplify/collapse_mesh.h"

#include <stdbool.h>

// The attributes a metric may know, as floats: normal, uv, colour (linear, straight alpha).
enum { PROM_ATTRIBUTES = 9 };

// Weights against geometric distance; {0} stands for the defaults in brackets. Texture
// coordinates are brought to object units first by the mean stretch of their submesh, so 1 says
// that a texture that slides by a centimetre is as bad as a surface that moves by one.
typedef struct prom_metric_weights {
    float normal; // [0.5, by measurement over textured and plain models] of the local edge
    float uv;     // [1]
    float color;  // [0.5] of the mesh's radius x 0.02
    float border; // [10] of quadrics on open borders and seams, against the faces'
} prom_metric_weights;

// One candidate: `from` moves into `to`. pairs[i] says which vertex of `from` goes over into
// which of `to`: along the edge the vertices of one side belong together; vertices of `from`
// without a partner keep their attributes.
typedef struct prom_collapse {
    uint32_t from, to; // points
    uint32_t pair_count;
    const uint32_t (*pairs)[2]; // vertices {of from, of to}
    bool free_place;            // full edge: the metric may choose the place; else it is to's
} prom_collapse;

// What it leaves behind.
typedef struct prom_collapse_result {
    float cost;                           // squared, object units; INFINITY: must not be done
    float place[3];                       // of the merged point
    float (*attributes)[PROM_ATTRIBUTES]; // per pair, caller's memory; unset for half edges
} prom_collapse_result;

typedef struct prom_metric prom_metric;

typedef struct prom_metric_class {
    const char *name; // as users type it
    prom_metric *(*create)(const prom_collapse_mesh *mesh, const prom_metric_weights *weights);
    void (*destroy)(prom_metric *metric); // NULL is allowed
    void (*evaluate)(prom_metric *metric, const prom_collapse *collapse,
                     prom_collapse_result *result);
    // The collapse was done: `point` is where both went, made[i] the vertex that pair i became.
    void (*merge)(prom_metric *metric, const prom_collapse *collapse, uint32_t point,
                  const uint32_t *made);
    size_t (*bytes)(const prom_metric *metric); // of its own data, for reports
} prom_metric_class;

// "qem": Garland and Heckbert 1997, area weighted. "qem-attributes": Hoppe 1999, "New quadric
// metric for simplifying meshes with appearance attributes", the default. "shortest": the
// length of the edge.
const prom_metric_class *prom_metric_find(const char *name); // NULL if there is none
const prom_metric_class *prom_metric_at(uint32_t index);     // NULL past the last

#endif
