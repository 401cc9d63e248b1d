// Edge collapse on arrays: a queue of candidates with lazy updates, a metric behind an
// interface, guards, and on request a record of every step.
//
// Vertices are never changed. A collapse that makes a new one appends it, and rewires corners;
// so a step is undone by putting old vertex numbers back (records.h).
//
// 1. prom_collapse_mesh_init  from a prom_mesh (or arrays)
// 2. prom_collapser_create    finds candidates; prom_records_init before it, if wanted
// 3. prom_collapser_run       to a target, as often as wanted: it goes on where it stopped
// 4. prom_collapse_mesh_emit  the mesh as it stands
// 5. prom_collapser_destroy, prom_collapse_mesh_finish
#ifndef PROM_SIMPLIFY_ENGINE_H
#define PROM_SIMPLIFY_ENGINE_H

#include "builder/simplify/collapse_mesh.h"
#include "builder/simplify/metric.h"
#include "builder/simplify/records.h"

typedef struct prom_collapse_options {
    const prom_collapse_metric_class *metric; // NULL: qem-attributes
    prom_metric_weights weights;
    bool half_edge;        // survivors are vertices of the original: nothing is appended
    bool lock_border;      // open borders stay exactly
    const uint8_t *locked; // per original vertex, nonzero: it stays, exactly; NULL: none
    float pair_distance;   // points of different pieces closer than this are candidates too
                           // (virtual edges; Garland and Heckbert 1997, section 3.2); 0: none
    bool loose; // connections may change where what goes is no longer than max_error: holes
                // close, parts become one or vanish; not with records
    prom_records *records; // NULL: nothing is recorded; of the mesh's triangle_slots
} prom_collapse_options;

typedef struct prom_collapse_stats {
    uint32_t collapses, triangles;
    // Candidates that were turned away; some came again and are counted again.
    uint32_t rejected_flip, rejected_link, rejected_degenerate, rejected_lock;
    double init_ms, run_ms;
    size_t peak_bytes; // of the mesh, the metric and the engine; records aside
} prom_collapse_stats;

typedef struct prom_collapser prom_collapser;

// Finds candidates and their costs. The mesh must outlive the collapser and is changed by it;
// `locked` is read here only.
prom_collapser *prom_collapser_create(prom_collapse_mesh *mesh,
                                      const prom_collapse_options *options);
void prom_collapser_destroy(prom_collapser *collapser); // NULL is allowed
// Collapses the cheapest first until at most target_triangles are left, or all that is left has
// an error greater than max_error (object units, INFINITY: no limit) or may not be done.
// Returns the greatest error of any collapse so far, object units by the metric's own estimate.
float prom_collapser_run(prom_collapser *collapser, uint32_t target_triangles, float max_error);
void prom_collapser_stats(const prom_collapser *collapser, prom_collapse_stats *stats);

#endif
