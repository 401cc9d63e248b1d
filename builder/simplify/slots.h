// Private to simplification: which vertices of two points become one when the points are
// merged.
//
// Vertices that share a triangle of the edge lie on the same side of it and belong together,
// one of `from` with one of `to`; where a seam forks or ends there, those that fit best. A
// vertex that finds none becomes a vertex of its own at the merged point, with attributes that
// the metric continues to there; where no vertex may be made, it becomes the vertex of `to` in
// its group that fits best. Vertices whose triangles all go are added, where the texture goes
// on beside them, to what fits them best, so that what they cost is not forgotten. So no seam
// forbids a collapse: it costs what it spoils.
#ifndef PROM_SIMPLIFY_SLOTS_H
#define PROM_SIMPLIFY_SLOTS_H

#include "builder/simplify/metric.h"

typedef struct prom_slot_entry {
    uint32_t vertex;
    uint32_t partner; // entry of the other point, PROM_NONE: none
    bool stays;       // has a triangle that is not at the edge
} prom_slot_entry;

typedef struct prom_slot_pair {
    uint32_t from, to; // entries
    float misfit;
} prom_slot_pair;

typedef struct prom_slots {
    PROM_ARRAY(prom_slot_entry) entries; // those of `to` first
    PROM_ARRAY(prom_slot_pair) pairs;
    PROM_ARRAY(uint32_t) vertices, slots, kept, owners; // see prom_collapse; owners: entries
} prom_slots;                                           // {0} is ready for use

void prom_slots_finish(prom_slots *slots);

// Sets vertices, slots and kept of a collapse of which from, to and fixed are set, until the
// next call. keep: vertices of `to` stay as they are; half_edge: no others may be made. single:
// each point has one vertex, they have a triangle in common. False where it cannot be done: no
// vertex of a group may be had, or there are too many.
bool prom_slots_find(prom_slots *slots, const prom_collapse_mesh *mesh, prom_collapse *collapse,
                     bool keep, bool half_edge, bool single);

#endif
