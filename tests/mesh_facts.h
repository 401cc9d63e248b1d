// What holds of a mesh as triangles over points: how edges are shared, what is open, repeated
// or degenerate. For tests of edge collapse.
#ifndef PROM_TESTS_MESH_FACTS_H
#define PROM_TESTS_MESH_FACTS_H

#include "metaobj/base/alloc.h"
#include "metaobj/mesh.h"

#include <stdbool.h>
#include <stdlib.h>

typedef struct mesh_facts {
    bool in_range; // each triangle has three vertices that exist, or none at all
    uint32_t triangles, edges, points;
    uint32_t degenerate;   // triangles with two corners at one point
    uint32_t repeated;     // triangles over the points of another, whatever their winding
    uint32_t most_sharing; // most triangles at an edge
    uint32_t most_along;   // of these, that run through it the same way
    uint32_t open_edges;   // with an odd number of triangles
    int32_t euler;         // points - edges + triangles
    uint32_t pinched;      // fans of triangles (joined by edges) around points, past the first
    uint32_t pieces;       // joined by points
} mesh_facts;

typedef struct mesh_facts_triangle {
    uint32_t points[3]; // ascending
} mesh_facts_triangle;

static inline int mesh_facts_by_points(const void *a, const void *b)
{
    const uint32_t *x = a, *y = b;
    for (int k = 0; k < 3; k++)
        if (x[k] != y[k]) return x[k] < y[k] ? -1 : 1;
    return 0;
}

// An edge of a triangle: its points, the smaller first, and whether it runs against that order.
typedef struct mesh_facts_edge {
    uint32_t low, high;
    uint32_t corners[2]; // at these points
    bool against;
} mesh_facts_edge;

static inline int mesh_facts_by_ends(const void *a, const void *b)
{
    const mesh_facts_edge *x = a, *y = b;
    if (x->low != y->low) return x->low < y->low ? -1 : 1;
    return (x->high > y->high) - (x->high < y->high);
}

static inline mesh_facts_edge mesh_facts_edge_of(uint32_t a, uint32_t b, uint32_t at_a,
                                                 uint32_t at_b)
{
    if (a < b) return (mesh_facts_edge){a, b, {at_a, at_b}, false};
    return (mesh_facts_edge){b, a, {at_b, at_a}, true};
}

static inline uint32_t mesh_facts_root(uint32_t *sets, uint32_t i)
{
    while (sets[i] != i) i = sets[i] = sets[sets[i]];
    return i;
}

// Whether two sets became one.
static inline bool mesh_facts_join(uint32_t *sets, uint32_t a, uint32_t b)
{
    const uint32_t x = mesh_facts_root(sets, a), y = mesh_facts_root(sets, b);
    sets[x] = y;
    return x != y;
}

static inline mesh_facts_triangle mesh_facts_sorted(uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t low = a < b ? a : b, high = a < b ? b : a;
    if (c <= low) return (mesh_facts_triangle){{c, low, high}};
    if (c >= high) return (mesh_facts_triangle){{low, high, c}};
    return (mesh_facts_triangle){{low, c, high}};
}

// edges: in the order of their ends. Leaves the fans around the points in `pinched`.
static inline void mesh_facts_edges(mesh_facts *facts, const mesh_facts_edge *edges,
                                    size_t count)
{
    uint32_t *fans = prom_alloc(count, sizeof *fans);
    for (uint32_t i = 0; i < count; i++) fans[i] = i;
    facts->pinched = (uint32_t)count;
    for (size_t i = 0, end; i < count; i = end) {
        uint32_t along[2] = {0};
        for (end = i; end < count && !mesh_facts_by_ends(edges + end, edges + i); end++) {
            along[edges[end].against]++;
            for (int k = 0; k < 2; k++)
                facts->pinched -=
                    mesh_facts_join(fans, edges[i].corners[k], edges[end].corners[k]);
        }
        const uint32_t most = along[0] > along[1] ? along[0] : along[1];
        if (most > facts->most_along) facts->most_along = most;
        if (end - i > facts->most_sharing) facts->most_sharing = (uint32_t)(end - i);
        facts->open_edges += (end - i) & 1;
        facts->edges++;
    }
    prom_free(fans);
}

// corners: 3 * slots vertices, PROM_NONE in all three: no triangle. point: per vertex, below
// their number; NULL: a vertex is its point.
static inline mesh_facts mesh_facts_of(const uint32_t *corners, uint32_t slots,
                                       const uint32_t *point, uint32_t vertices)
{
    mesh_facts facts = {.in_range = true};
    PROM_ARRAY(mesh_facts_edge) edges = {0};
    PROM_ARRAY(mesh_facts_triangle) triangles = {0};
    uint32_t *piece = prom_alloc(vertices, sizeof *piece); // per point
    memset(piece, 0xff, vertices * sizeof *piece);
    for (const uint32_t *c = corners; c < corners + 3 * (size_t)slots; c += 3) {
        const int none = (c[0] == PROM_NONE) + (c[1] == PROM_NONE) + (c[2] == PROM_NONE);
        if (none == 3) continue;
        facts.in_range &= c[0] < vertices && c[1] < vertices && c[2] < vertices;
        if (!facts.in_range) break;
        uint32_t p[3];
        for (int k = 0; k < 3; k++) p[k] = point ? point[c[k]] : c[k];
        facts.degenerate += p[0] == p[1] || p[1] == p[2] || p[2] == p[0];
        for (int k = 0; k < 3; k++) {
            const uint32_t next = (uint32_t)(k + 1) % 3, first = 3 * (uint32_t)triangles.count;
            prom_array_push(
                &edges, mesh_facts_edge_of(p[k], p[next], first + (uint32_t)k, first + next));
            if (piece[p[k]] == PROM_NONE) {
                piece[p[k]] = p[k];
                facts.points++, facts.pieces++;
            }
        }
        for (int k = 1; k < 3; k++) facts.pieces -= mesh_facts_join(piece, p[0], p[k]);
        prom_array_push(&triangles, mesh_facts_sorted(p[0], p[1], p[2]));
    }
    facts.triangles = (uint32_t)triangles.count;
    if (facts.triangles) {
        qsort(edges.data, edges.count, sizeof *edges.data, mesh_facts_by_ends);
        qsort(triangles.data, triangles.count, sizeof *triangles.data, mesh_facts_by_points);
    }
    mesh_facts_edges(&facts, edges.data, edges.count);
    facts.pinched -= facts.points;
    for (size_t i = 1; i < triangles.count; i++)
        facts.repeated += !mesh_facts_by_points(triangles.data + i - 1, triangles.data + i);
    facts.euler = (int32_t)facts.points - (int32_t)facts.edges + (int32_t)facts.triangles;
    prom_array_finish(&edges);
    prom_array_finish(&triangles);
    prom_free(piece);
    return facts;
}

// NULL if the mesh is as good as the one that it was made of, else what is wrong. That a
// surface keeps its pieces and holes is asked of surfaces.
static inline const char *mesh_facts_spoiled(const mesh_facts *now, const mesh_facts *original)
{
    const bool surface = original->most_sharing <= 2 && original->most_along <= 1 &&
                         !original->pinched && !original->repeated;
    if (!now->in_range) return "a corner has no vertex";
    if (now->degenerate) return "a triangle has two corners at one point";
    if (now->repeated > original->repeated) return "two triangles over the same points";
    if (original->most_sharing <= 2 && now->most_sharing > 2)
        return "an edge has more than two triangles";
    if (!original->open_edges && now->open_edges) return "a closed mesh is open";
    if (!surface) return NULL;
    if (now->most_along > 1) return "neighbours are of opposite orientation";
    if (now->pinched) return "sheets meet in a point only";
    if (now->pieces > original->pieces) return "a piece came apart";
    // Only a disc can go altogether: with it one from the pieces and the Euler number.
    const int32_t gone = (int32_t)(original->pieces - now->pieces);
    if (now->euler + gone != original->euler) return "the Euler number changed";
    return NULL;
}

#endif
