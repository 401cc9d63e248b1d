// What a collapse costs. The engine knows no metric: it asks one for the cost of a candidate
// and for the place and attributes of the vertices that it leaves behind.
//
// A metric keeps its own data for each point (say, a quadric) and each vertex, and combines
// them when points are merged. It says two numbers: a cost, which orders the candidates and may
// be in any unit, and an error, a squared distance in object units, so that its square root is
// an error that a user understands.
//
// The points' positions and the vertices' attributes are read from the mesh.
#ifndef PROM_SIMPLIFY_METRIC_H
#define PROM_SIMPLIFY_METRIC_H

#include "builder/simplify/collapse_mesh.h"

#include <stdbool.h>

// The attributes a metric may know, as floats: normal, uv, colour (linear, straight alpha).
enum { PROM_ATTRIBUTES = 9 };

// Weights against geometric distance; 0 stands for the default in brackets, a negative weight
// for none. Texture coordinates are brought to object units first by the mean stretch of their
// group, so 1 says that a texture that slides by a centimetre is as bad as a surface that moves
// by one.
typedef struct prom_metric_weights {
    float normal; // [0.1] of the mean edge's length: of normals that differ by one radian
    float uv;     // [0.3]
    float color;  // [0.5] of the mesh's radius x 0.02: of black against white
    float border; // [1.5] of quadrics on open borders against the faces'; of seams a tenth
} prom_metric_weights;

// One candidate: `from` moves into `to`. Their vertices become those of the merged point: all
// with the same slot become one. A slot either keeps a vertex of `to` as it is or gets a new
// one. PROM_NONE: a vertex of another group or without triangles, forgotten.
typedef struct prom_collapse {
    uint32_t from, to;        // points
    uint32_t count;           // vertices of both
    const uint32_t *vertices; // of `to` first
    const uint32_t *slots;    // per vertex
    uint32_t slot_count;
    const uint32_t *kept; // per slot: the vertex that it keeps, PROM_NONE: none
    bool fixed;           // the merged point is where `to` is, else the metric may choose
} prom_collapse;

typedef struct prom_collapse_result {
    float cost;     // orders candidates; not finite: must not be done
    float error;    // squared, object units
    float place[3]; // of the merged point
} prom_collapse_result;

typedef struct prom_collapse_metric prom_collapse_metric;

typedef struct prom_collapse_metric_class {
    const char *name;   // as users type it
    bool uses_vertices; // else evaluate gets count and slot_count 0
    prom_collapse_metric *(*create)(const prom_collapse_mesh *mesh,
                                    const prom_metric_weights *weights);
    void (*destroy)(prom_collapse_metric *metric); // NULL is allowed
    void (*evaluate)(prom_collapse_metric *metric, const prom_collapse *collapse,
                     prom_collapse_result *result);
    // The vertices of slots that keep none: made[slot] holds the place and attributes
    // interpolated along the edge, and the metric sets those that it knows better. May be NULL.
    void (*attributes)(prom_collapse_metric *metric, const prom_collapse *collapse,
                       const float place[3], prom_vertex *made);
    // The collapse is being done: vertices[slot] stands for all of the slot from now on. The
    // mesh's position of `to` is still the old one. May be NULL.
    void (*merge)(prom_collapse_metric *metric, const prom_collapse *collapse,
                  const float place[3], const uint32_t *vertices);
    size_t (*bytes)(const prom_collapse_metric *metric); // of its own data, for reports
} prom_collapse_metric_class;

// "qem": Garland and Heckbert 1997, area weighted. "qem-attributes": Hoppe 1999, "New quadric
// metric for simplifying meshes with appearance attributes", the default. "shortest": the
// length of the edge.
const prom_collapse_metric_class *
prom_collapse_metric_find(const char *name); // NULL if there is none
const prom_collapse_metric_class *prom_collapse_metric_at(uint32_t index); // NULL past the last

extern const prom_collapse_metric_class prom_collapse_shortest, prom_collapse_qem,
    prom_collapse_attributes;

#endif
