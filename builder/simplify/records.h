// Records of collapses: all that is needed to undo and redo each, and what it depends on.
//
// Vertices are never changed (collapse_mesh.h): a record lists the corners that it gives other
// vertices and the triangles that it removes, so undoing puts the old numbers back and is
// exact. Its *star* is all triangles around its two points before the collapse; and where a
// removed triangle leaves its third point with others, of which none is in the star, one of
// these. It depends on every earlier record that was the last to have one of its star's
// triangles in its own. So the records are a directed acyclic graph, and a *cut* of it (a set
// of records that holds with each also those it depends on) is a mesh: a progressive mesh
// (Hoppe 1996) in the order in which they were made, a multi-triangulation (De Floriani,
// Magillo and Puppo 1997) in any.
//
// Why the star is enough: of two records that neither depends on the other, no triangle is in
// both stars, and each changes corners in its own star only. So each finds the triangles around
// its points the same whether or not the other was applied, and what was asked of the collapse
// (the link condition, no edge shared by too many, nothing flipped) was asked of these alone.
// Any order that respects the dependencies comes from the recorded one by exchanging such
// neighbours. Why not less: with the triangles around the vanishing point alone, a later
// collapse could be done without one that cleared the link condition around the point that
// stays. And a removed triangle is around its third point no longer: where sheets meet in a
// point only, that point could be moved later without the removal, and the triangle would be
// there still, at the old place. Both points must have triangles: one that lost its last could
// get new ones without depending on that.
#ifndef PROM_SIMPLIFY_RECORDS_H
#define PROM_SIMPLIFY_RECORDS_H

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"

#include <stdbool.h>
#include <stdint.h>

// Of each list the end alone is stored; it begins where the one before ends.
typedef struct prom_record {
    uint32_t from, to;                       // points; `to` stays the number of both
    float error;                             // object units, the metric's estimate
    uint32_t changes_end;                    // in changes
    uint32_t removed_end;                    // in removed
    uint32_t dependencies_end, vertices_end; // in dependencies; among the mesh's vertices
} prom_record;

// One vertex becomes another in some corners: most collapses have two such changes.
typedef struct prom_vertex_change {
    uint32_t from, to;
    uint32_t corners_end; // in corners
} prom_vertex_change;

typedef struct prom_removed_triangle {
    uint32_t triangle;
    uint32_t corners[3]; // vertices before
} prom_removed_triangle;

typedef struct prom_records {
    PROM_ARRAY(prom_record) records;
    PROM_ARRAY(prom_vertex_change) changes;
    PROM_ARRAY(uint32_t) corners; // 3 * triangle + k
    PROM_ARRAY(prom_removed_triangle) removed;
    PROM_ARRAY(uint32_t) dependencies; // of a record: earlier ones, ascending, none twice
    uint32_t *last; // per triangle: the last record that had it in its star, PROM_NONE: none
    uint32_t triangle_slots;
    uint32_t first_vertex; // the first that a record made
    bool open;             // between begin and end
} prom_records;

void prom_records_init(prom_records *records, uint32_t triangle_slots);
void prom_records_finish(prom_records *records);
size_t prom_records_bytes(const prom_records *records); // allocated

// The part [first, end) of an array.
typedef struct prom_record_part {
    uint32_t first, end;
} prom_record_part;

static inline prom_record_part prom_record_changes(const prom_records *r, uint32_t record)
{
    const prom_record *own = r->records.data + record;
    return (prom_record_part){record ? own[-1].changes_end : 0, own->changes_end};
}

// Of a change, not of a record.
static inline prom_record_part prom_change_corners(const prom_records *r, uint32_t change)
{
    const prom_vertex_change *own = r->changes.data + change;
    return (prom_record_part){change ? own[-1].corners_end : 0, own->corners_end};
}

static inline prom_record_part prom_record_removed(const prom_records *r, uint32_t record)
{
    const prom_record *own = r->records.data + record;
    return (prom_record_part){record ? own[-1].removed_end : 0, own->removed_end};
}

static inline prom_record_part prom_record_dependencies(const prom_records *r, uint32_t record)
{
    const prom_record *own = r->records.data + record;
    return (prom_record_part){record ? own[-1].dependencies_end : 0, own->dependencies_end};
}

// The vertices that it made.
static inline prom_record_part prom_record_vertices(const prom_records *r, uint32_t record)
{
    const prom_record *own = r->records.data + record;
    return (prom_record_part){record ? own[-1].vertices_end : r->first_vertex,
                              own->vertices_end};
}

// ---- recording, by the engine, one collapse at a time

// next_vertex: the number that the next new vertex would get. Vertices are made by recorded
// collapses only.
void prom_records_begin(prom_records *records, uint32_t from, uint32_t to,
                        uint32_t next_vertex);
// Every triangle of the star (see above; those around the two points before anything changes);
// a triangle may be named twice.
void prom_records_touch(prom_records *records, uint32_t triangle);
// Whether it is in the star of the open record.
static inline bool prom_records_touched(const prom_records *records, uint32_t triangle)
{
    return records->last[triangle] == (uint32_t)records->records.count - 1;
}
// A corner of the star gets another vertex. Corners with the same `from` and `to` in a row take
// the least memory.
void prom_records_change(prom_records *records, uint32_t corner, uint32_t from, uint32_t to);
// A triangle of the star goes. corners: its vertices as they are, that is with the changes
// named so far.
void prom_records_remove(prom_records *records, uint32_t triangle, const uint32_t corners[3]);
void prom_records_end(prom_records *records, float error, uint32_t next_vertex);

// ---- replaying, on a plain array of 3 * triangle_slots corners (PROM_NONE in all: gone)

typedef struct prom_replay {
    const prom_records *records;
    uint32_t *corners;
    uint8_t *applied;   // per record
    uint32_t *users;    // per record: applied records that depend on it
    uint32_t triangles; // present
    uint32_t low, high; // all records before `low` are applied, none from `high` on
} prom_replay;

// corners: the original's; copied. The records must not grow while they are replayed.
void prom_replay_init(prom_replay *replay, const prom_records *records,
                      const uint32_t *corners);
void prom_replay_finish(prom_replay *replay);
// A record can be applied if it is not and all it depends on are; undone if it is and nothing
// applied depends on it.
bool prom_replay_can_apply(const prom_replay *replay, uint32_t record);
bool prom_replay_can_undo(const prom_replay *replay, uint32_t record);
void prom_replay_apply(prom_replay *replay, uint32_t record); // must be possible
void prom_replay_undo(prom_replay *replay, uint32_t record);
// The mesh after the first `count` records in their order (from any state). From one such
// mesh to another it takes as long as the records between.
void prom_replay_seek(prom_replay *replay, uint32_t count);

#endif
