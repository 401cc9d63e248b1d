// What the steps of objects.h share. The order of the steps:
//
//   groups     which nodes head repeated assemblies; what is left is the outer scope
//   parts      a node's opaque meshes are one part, its blended ones another
//   items      the connected pieces of every part that is no instance and has no levels by the
//              artist
//   layout     how large the scene is without its backdrop
//   fates      what becomes of every item: kept, cut, gathered, set apart
//   shapes     geometry is copied out
//
// A scope is a set of nodes looked at by itself: what is outside all groups, and the first
// member of each kind of group (the other members repeat its objects, moved).
#ifndef PROM_BUILDER_OBJECTS_PRIVATE_H
#define PROM_BUILDER_OBJECTS_PRIVATE_H

#include "builder/objects.h"
#include "builder/objects_box.h"

#include <stdint.h>

// An object that is connected, or is the whole scene, may have this many times the triangles of
// any other before it is cut: its levels of detail serve it better than a cut does. A scene of
// so few triangles in few parts is taken to be one thing, a chair rather than a street: its
// parts stay whole.
enum { PROM_ALONE_FACTOR = 16, PROM_FEW_PARTS = 64 };

typedef struct prom_part_level {
    uint32_t first_mesh, mesh_count; // range in part_meshes
    float until;
} prom_part_level;

typedef struct prom_part {
    uint32_t node, scope;
    uint32_t first_mesh, mesh_count;   // range in part_meshes
    uint32_t first_level, level_count; // range in part_levels: the artist's
    float until;                       // of the meshes, where there are levels
    uint32_t triangles;
    uint32_t kind; // parts of one kind have equal shapes
    bool blended;
    bool unique;              // the only one of its kind in its scope, and without levels
    int32_t stretch[3];       // logarithms of the stretch to be baked, in steps
    prom_placement placement; // without that stretch
    prom_wbox bounds;
    uint32_t first_item, item_count; // of unique parts
} prom_part;

// A source mesh where a unique part places it.
typedef struct prom_use {
    uint32_t node, mesh;
    double (*world)[3]; // positions
    prom_wbox bounds;
    float normal[9]; // takes normals to the world, column-major
    bool mirrored;
    uint32_t *copy,
        *stamp; // a vertex's index in the shape being made, and which shape that was
} prom_use;

typedef struct prom_face {
    uint32_t use, triangle;
} prom_face;

// A connected piece of a unique part; its faces stand together.
typedef struct prom_item {
    uint32_t part;
    uint32_t first_face, face_count;
    prom_wbox bounds;
    bool surface, backdrop;
} prom_item;

// Where the better part of some objects is, and how large it and they are.
typedef struct prom_layout {
    prom_wbox box;
    double diagonal; // of the box, or of the median part where that is longer
    double median;   // diagonal of the median object
    size_t objects;  // or pieces, that are not far larger than all of it
} prom_layout;

typedef struct prom_scope {
    uint32_t group_kind;        // PROM_NONE: outside all groups
    PROM_ARRAY(uint32_t) roots; // the members' root nodes; the first one is looked at
    uint32_t first_part, part_count;
    prom_layout layout; // of the first member; for scope 0 of the whole scene
    bool one_thing;     // see PROM_FEW_PARTS
} prom_scope;

typedef struct prom_finder {
    const prom_source *source;
    prom_object_options options; // defaults filled in
    prom_objects *out;
    uint32_t *node_scope; // PROM_NONE: in a member that repeats the first
    PROM_ARRAY(prom_scope) scopes;
    PROM_ARRAY(prom_part) parts;
    PROM_ARRAY(uint32_t) part_meshes;
    PROM_ARRAY(prom_part_level) part_levels;
    PROM_ARRAY(prom_use) uses;
    PROM_ARRAY(prom_face) faces;
    PROM_ARRAY(prom_item) items;
    const prom_scope *scope; // the one whose fates are decided
    uint32_t kind_count;
    uint32_t *kind_shape;  // 2 per kind: ordinary, backdrop; PROM_NONE until made
    uint32_t *node_name;   // offset into names, 0 until made
    uint32_t *node_weight; // scratch: faces per node, all 0 between uses
    uint32_t stamp;
    uint32_t split, gathered; // of the scope being made
} prom_finder;

// ---- groups
// Fills node_scope and scopes (scope 0 first).
void prom_find_groups(prom_finder *finder);

// ---- parts
prom_status prom_find_parts(prom_finder *finder, prom_error *error);
// Column i of the stretch that a part's shape has baked in.
float prom_part_stretch(const prom_part *part, int axis);
// Sets up unique parts' uses, faces and items.
void prom_find_items(prom_finder *finder);

// ---- layout
// Finds the layouts of the scopes, and marks backdrop and surface items.
void prom_find_layout(prom_finder *finder);
bool prom_is_backdrop(const prom_finder *finder, const prom_wbox *bounds, uint32_t triangles);

// ---- fates
// Adds the objects of a scope: of its only or first member.
void prom_make_scope(prom_finder *finder, const prom_scope *scope);

// A span of faces.
typedef struct prom_span {
    prom_face *faces;
    size_t count;
    prom_wbox bounds;
} prom_span;
typedef PROM_ARRAY(prom_span) prom_spans;

prom_wbox prom_faces_bounds(const prom_finder *finder, const prom_face *faces, size_t count);
void prom_face_centroid(const prom_finder *finder, prom_face face, double out[3]);
// Cuts surfaces into chunks on a grid aligned to the world. The faces are reordered; each chunk
// is a span of them.
void prom_cut_chunks(const prom_finder *finder, prom_face *faces, size_t count,
                     prom_spans *chunks);
// Halves faces along the longest axis until no span has more than max_triangles.
void prom_cut_halves(const prom_finder *finder, prom_face *faces, size_t count,
                     prom_spans *pieces);
// Gathers small items that are neighbours: writes their faces, neighbours together, to `faces`
// (room for all of them), one span for each object to be.
void prom_gather(const prom_finder *finder, const uint32_t *items, size_t count,
                 prom_face *faces, prom_spans *objects);

// ---- shapes
uint32_t prom_face_material(const prom_finder *finder, prom_face face);
uint32_t prom_node_name(prom_finder *finder, uint32_t node);
// Positions on a grid of this step are exact in every cut piece, so that borders still coincide
// when each piece is stored relative to its own centre.
double prom_snap_step(const prom_spans *pieces);
// Copies faces into a shape relative to their centre and adds the object. step: 0, or of
// prom_snap_step. The faces are reordered.
void prom_make_shape(prom_finder *finder, prom_span span, prom_layer layer, bool lock_border,
                     double step);
// Adds the object of a whole part, sharing the shape of its kind.
void prom_make_part(prom_finder *finder, const prom_part *part, bool backdrop);

#endif
