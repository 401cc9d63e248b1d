// Mending a mesh before anything is made of it, and saying what shape it is in.
//
// Files come with hairline cracks, faces without area, faces twice, and faces that look the
// wrong way. All of it spoils simplification (a crack is a border that must stay), and some of
// it shows: what is drawn from one side only has a hole where a face is turned over.
//
// What cannot be mended without guessing is counted and left: edges of more than two faces
// (and the sides of patches that have many of them), open edges, surfaces with one side
// (Moebius), faces that clash with their neighbours.
//
// A second repair with the same options changes nothing.
#ifndef PROM_SIMPLIFY_REPAIR_H
#define PROM_SIMPLIFY_REPAIR_H

#include "metaobj/mesh.h"

#include <stdbool.h>

#define PROM_REPAIR_TOLERANCE 1e-5f // of the bounding radius

// What tells the right side of a face. Patches are what hangs together over edges of exactly
// two faces, materials aside. Sheets with two sides (the same triangle in both windings) are
// in no patch and never turned. A face in a second material over another turns with it.
typedef enum prom_repair_orient {
    // Where the faces of a patch disagree, or a closed patch is inside out, those faces are
    // turned whose normals at all three corners are against them; but only if the patch's
    // normals are of one mind about its side. For meshes whose normals are the author's word.
    PROM_ORIENT_BY_NORMALS,
    // Where the faces of a patch disagree, they are turned to one side: of a closed patch that
    // of a positive volume, of an open one that of the greater area. Normals that are against
    // a turned face turn with it. For meshes whose normals were made from their windings. A
    // patch that agrees with itself stays: a room is a box seen from within.
    PROM_ORIENT_BY_SHAPE,
    PROM_ORIENT_NOT,
} prom_repair_orient;

// {0} stands for the defaults.
typedef struct prom_repair_options {
    float tolerance; // of the bounding radius, in every coordinate; 0: PROM_REPAIR_TOLERANCE;
                     // below 0: no position moves
    prom_repair_orient orient;
} prom_repair_options;

// Numbers of what was mended, then of what is left. By 64 bits, since those of a whole scene
// are summed up.
typedef struct prom_repair_report {
    uint64_t snapped;    // vertices that moved to another's place
    uint64_t welded;     // vertices that were equal to another in all attributes
    uint64_t degenerate; // faces without area, or not finite
    uint64_t duplicate;  // faces of the same material over the same points in the same winding
    uint64_t turned;     // faces

    uint64_t faces;
    uint64_t two_sided;          // faces of them that have the same face as their back
    uint64_t open_edges;         // of one face; of this and the following, two-sided ones aside
    uint64_t non_manifold_edges; // of three faces or more
    uint64_t clashing_edges;     // of two faces that disagree about their side
    uint64_t patches;
    uint64_t closed_patches; // all of whose edges have two faces
} prom_repair_report;

// Mends in place. Vertices within the tolerance come to be at one place (that of the earliest),
// also across seams of the texture; they become one where all other attributes are equal.
// Faces, vertices and submeshes keep their order; unused vertices and empty submeshes go, so
// that nothing may be left. Indices must be in range and the submeshes cover them.
// options: NULL for the defaults.
void prom_mesh_repair(prom_mesh *mesh, const prom_repair_options *options,
                      prom_repair_report *report);

void prom_repair_report_add(prom_repair_report *sum, const prom_repair_report *part);
bool prom_repair_mended(const prom_repair_report *report); // whether anything was
// No open edge, none of too many faces, and something there.
bool prom_repair_closed(const prom_repair_report *report);

// ---- in words; free the texts with prom_free

// "12 vertices welded, 3 faces turned, 40 non-manifold edges": what is not 0.
char *prom_repair_text(const prom_repair_report *report);
// {"welded": 12, ...}: all numbers.
char *prom_repair_json(const prom_repair_report *report);
// Sets the number of that name, if there is one: for reading them back.
void prom_repair_set(prom_repair_report *report, const char *key, uint64_t value);

#endif
