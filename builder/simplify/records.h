// Records of collapses: all that is needed to undo and redo each, and what it depends on.
//
// A record lists the corners that it rewires (from, to) and the triangles that it removes;
// vertices are never changed (collapse_mesh.h), so undoing puts the old numbers back and is
// exact. Its *star* is all triangles around its two points before the collapse. It depends on
// every earlier record that was the last to have one of these triangles in its star. So the
// records are a directed acyclic graph, and a *cut* of it (a set of records that holds with
// each also those it depends on) is a mesh: a progressive mesh (Hoppe 1996) in the order in
// which they were made, a multi-triangulation (De Floriani, Magillo and Puppo 1997) in any.
#ifndef PROM_SIMPLIFY_RECORDS_H
#define PROM_SIMPLIFY_RECORDS_H

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct prom_corner_change {
    uint32_t corner;   // 3 * triangle + k
    uint32_t from, to; // vertices
} prom_corner_change;

typedef struct prom_record {
    uint32_t from, to;                       // points; `to` stays the number of both
    float error;                             // object units, the metric's estimate
    uint32_t first_change, changes;          // into corner_changes
    uint32_t first_removed, removed;         // into removed_triangles
    uint32_t first_dependency, dependencies; // into dependencies: earlier records, ascending
    uint32_t first_vertex, vertices;         // those that it made, among the mesh's vertices
} prom_record;

typedef struct prom_removed_triangle {
    uint32_t triangle;
    uint32_t corners[3]; // vertices before
} prom_removed_triangle;

typedef struct prom_records {
    PROM_ARRAY(prom_record) records;
    PROM_ARRAY(prom_corner_change) corner_changes;
    PROM_ARRAY(prom_removed_triangle) removed_triangles;
    PROM_ARRAY(uint32_t) dependencies;
    uint32_t *last; // per triangle: the last record that had it in its star, PROM_NONE: none
    uint32_t triangle_slots;
    bool open; // between begin and end
} prom_records;

void prom_records_init(prom_records *records, uint32_t triangle_slots);
void prom_records_finish(prom_records *records);
size_t prom_records_bytes(const prom_records *records);

// ---- recording, by the engine, one collapse at a time

void prom_records_begin(prom_records *records, uint32_t from, uint32_t to,
                        uint32_t next_vertex);
// Every triangle of the star, before anything changes; a triangle may be named twice.
void prom_records_touch(prom_records *records, uint32_t triangle);
void prom_records_change(prom_records *records, uint32_t corner, uint32_t from, uint32_t to);
void prom_records_remove(prom_records *records, uint32_t triangle, const uint32_t corners[3]);
void prom_records_end(prom_records *records, float error, uint32_t next_vertex);

// ---- replaying, on a plain array of 3 * triangle_slots corners (PROM_NONE in all: gone)

typedef struct prom_replay {
    const prom_records *records;
    uint32_t *corners;
    uint8_t *applied;   // per record
    uint32_t *users;    // per record: applied records that depend on it
    uint32_t triangles; // present
} prom_replay;

// corners: the original's; copied.
void prom_replay_init(prom_replay *replay, const prom_records *records,
                      const uint32_t *corners);
void prom_replay_finish(prom_replay *replay);
// A record can be applied if it is not and all it depends on are; undone if it is and nothing
// applied depends on it.
bool prom_replay_can_apply(const prom_replay *replay, uint32_t record);
bool prom_replay_can_undo(const prom_replay *replay, uint32_t record);
void prom_replay_apply(prom_replay *replay, uint32_t record); // must be possible
void prom_replay_undo(prom_replay *replay, uint32_t record);
// The mesh after the first `count` records in their order (from any state).
void prom_replay_seek(prom_replay *replay, uint32_t count);

#endif
