#include "builder/simplify/repair_orient.h"

#include "builder/simplify/face_match.h"
#include "builder/simplify/repair_edges.h"
#include "builder/simplify/work.h"

#include <math.h>

// Normals are believed where those of this part of a patch's area, by taste, say the same: the
// rest may be creases and slivers. Where they contradict each other it is they that are wrong,
// and turning faces by them would tear holes.
#define VOUCHED 0.9
// A patch with more than one edge of three faces or more to so many of its faces is no surface
// that has sides (by taste: ruins cut out of walls come apart into patches of a few faces).
#define TANGLED 20

// Faces of a patch are of two parities: neighbours of one parity agree about their side.
typedef struct patch {
    uint32_t faces[2]; // by parity
    double area[2];
    double vouched;  // area whose normals are for parity 0 being as it is and 1 turned over,
                     // less the opposite
    double volume;   // with parity 1 turned over, six times
    float origin[3]; // of the volume: near, which keeps it exact
    bool closed;
    bool one_sided;   // no choice of sides makes all agree
    uint32_t tangled; // its edges of three faces or more
} patch;

typedef struct orienter {
    prom_mesh *mesh;
    const uint32_t *points;
    uint32_t *same, *opposite; // per triangle: see face_match.h
    prom_edges edges;
    uint32_t *patch_of; // per triangle; PROM_NONE: not there yet, or in none
    uint8_t *parity;    // per triangle
    bool *turned;       // per triangle
    PROM_ARRAY(patch) patches;
    PROM_ARRAY(uint32_t) front; // of the flood
} orienter;

static const prom_vertex *corner_of(const orienter *o, uint32_t triangle, uint32_t k)
{
    return &o->mesh->vertices[o->mesh->indices[(size_t)triangle * 3 + k]];
}

static float along(const prom_vertex *v, const float cross[3])
{
    return (float)v->normal[0] * cross[0] + (float)v->normal[1] * cross[1] +
           (float)v->normal[2] * cross[2];
}

// 1 where the normals at all corners are along the winding, -1 where all are against it.
static int normals_say(const orienter *o, uint32_t triangle, const float cross[3])
{
    int with = 0, against = 0;
    for (uint32_t k = 0; k < 3; k++) {
        float a = along(corner_of(o, triangle, k), cross);
        with += a > 0;
        against += a < 0;
    }
    return with == 3 ? 1 : against == 3 ? -1 : 0;
}

static void face_cross(const orienter *o, uint32_t t, float cross[3])
{
    prom_triangle_cross(corner_of(o, t, 0)->position, corner_of(o, t, 1)->position,
                        corner_of(o, t, 2)->position, cross);
}

static void add_face(const orienter *o, patch *p, uint32_t t)
{
    float cross[3], from[3];
    face_cross(o, t, cross);
    glm_vec3_sub((float *)corner_of(o, t, 0)->position, p->origin, from);
    int parity = o->parity[t], say = normals_say(o, t, cross);
    double area = glm_vec3_norm(cross), sign = parity ? -1 : 1;
    p->faces[parity]++;
    p->area[parity] += area;
    p->vouched += sign * say * area;
    p->volume += sign * glm_vec3_dot(from, cross);
}

// Whether two uses of an edge disagree about the side: both run along it in one direction.
static bool disagree(const orienter *o, const prom_edge *e)
{
    return o->points[e->half[0]] == o->points[e->half[1]];
}

static void cross_edge(orienter *o, patch *p, uint32_t corner)
{
    const prom_edge *e = &o->edges.edges.data[o->edges.of[corner]];
    if (e->uses != 2) {
        p->closed = false;
        p->tangled += e->uses > 2;
        return;
    }
    uint32_t here = corner / 3, there = e->half[e->half[0] == corner] / 3;
    uint8_t parity = (uint8_t)(o->parity[here] ^ disagree(o, e));
    if (o->patch_of[there] != PROM_NONE) {
        p->one_sided |= o->parity[there] != parity;
        return;
    }
    o->patch_of[there] = o->patch_of[here];
    o->parity[there] = parity;
    prom_array_push(&o->front, there);
}

static void flood(orienter *o, uint32_t start)
{
    patch p = {.closed = true};
    memcpy(p.origin, corner_of(o, start, 0)->position, sizeof p.origin);
    o->patch_of[start] = (uint32_t)o->patches.count;
    o->parity[start] = 0;
    prom_array_push(&o->front, start);
    while (o->front.count) {
        uint32_t t = o->front.data[--o->front.count];
        for (uint32_t k = 0; k < 3; k++) cross_edge(o, &p, t * 3 + k);
    }
    prom_array_push(&o->patches, p);
}

// The parity that is the wrong one; -1: none is.
static int wrong_parity(const patch *p, prom_repair_orient how)
{
    uint32_t faces = p->faces[0] + p->faces[1];
    if (how == PROM_ORIENT_NOT || p->one_sided || p->tangled * TANGLED > faces) return -1;
    bool agrees = !p->faces[1];
    if (how == PROM_ORIENT_BY_SHAPE) {
        if (agrees) return -1;
        return p->closed ? p->volume >= 0 : p->area[0] >= p->area[1];
    }
    if (agrees && !(p->closed && p->volume < 0)) return -1;
    if (fabs(p->vouched) < VOUCHED * (p->area[0] + p->area[1])) return -1;
    return p->vouched >= 0;
}

static bool is_to_turn(const orienter *o, uint32_t t, prom_repair_orient how)
{
    if (o->patch_of[t] == PROM_NONE) return false;
    if (o->parity[t] != wrong_parity(&o->patches.data[o->patch_of[t]], how)) return false;
    float cross[3];
    face_cross(o, t, cross);
    return how == PROM_ORIENT_BY_SHAPE || normals_say(o, t, cross) < 0;
}

// The vertex with the opposite normal, made once; the mesh has room for it.
static uint32_t opposite_vertex(prom_mesh *mesh, uint32_t *opposite, uint32_t vertex)
{
    if (opposite[vertex] != PROM_NONE) return opposite[vertex];
    prom_vertex *v = &mesh->vertices[mesh->vertex_count];
    *v = mesh->vertices[vertex];
    for (int k = 0; k < 3; k++)
        v->normal[k] = (int8_t)(v->normal[k] == -128 ? 127 : -v->normal[k]);
    return opposite[vertex] = mesh->vertex_count++;
}

static void turn(orienter *o, uint32_t t, uint32_t *opposite)
{
    uint32_t *corners = o->mesh->indices + (size_t)t * 3, second = corners[1];
    corners[1] = corners[2];
    corners[2] = second;
    float cross[3];
    face_cross(o, t, cross);
    for (uint32_t k = 0; k < 3; k++)
        if (along(corner_of(o, t, k), cross) < 0)
            corners[k] = opposite_vertex(o->mesh, opposite, corners[k]);
}

static void turn_faces(orienter *o, uint32_t faces)
{
    prom_mesh *mesh = o->mesh;
    uint32_t count = mesh->vertex_count;
    uint32_t *opposite = prom_alloc(count, sizeof *opposite);
    memset(opposite, 0xff, (size_t)count * sizeof *opposite);
    mesh->vertices = prom_realloc(mesh->vertices, (size_t)count * 2, sizeof *mesh->vertices);
    for (uint32_t t = 0; t < faces; t++)
        if (o->turned[t]) turn(o, t, opposite);
    prom_free(opposite);
}

static void count_up(const orienter *o, prom_repair_report *report)
{
    for (size_t i = 0; i < o->edges.edges.count; i++) {
        const prom_edge *e = &o->edges.edges.data[i];
        report->open_edges += e->uses == 1;
        report->non_manifold_edges += e->uses > 2;
        if (e->uses != 2) continue;
        bool other = o->turned[e->half[0] / 3] != o->turned[e->half[1] / 3];
        report->clashing_edges += disagree(o, e) != other;
    }
    report->patches += o->patches.count;
    for (size_t i = 0; i < o->patches.count; i++)
        report->closed_patches += o->patches.data[i].closed;
}

// Edges and patches are those of the faces that stand alone: neither sheets with two sides nor
// further materials over a face, which turn with it.
static void find_patches(orienter *o, uint32_t faces)
{
    bool *skip = prom_alloc(faces, sizeof *skip);
    for (uint32_t t = 0; t < faces; t++)
        skip[t] = o->same[t] != PROM_NONE || o->opposite[t] != PROM_NONE;
    prom_edges_init(&o->edges, o->points, skip, faces);
    for (uint32_t t = 0; t < faces; t++)
        if (!skip[t] && o->patch_of[t] == PROM_NONE) flood(o, t);
    prom_free(skip);
    // In the order of the faces, so that sums do not depend on which way they are wound.
    for (uint32_t t = 0; t < faces; t++)
        if (o->patch_of[t] != PROM_NONE) add_face(o, &o->patches.data[o->patch_of[t]], t);
}

static void choose(orienter *o, uint32_t faces, prom_repair_orient how,
                   prom_repair_report *report)
{
    for (uint32_t t = 0; t < faces; t++) {
        uint32_t same = o->same[t]; // an earlier one
        o->turned[t] = same == PROM_NONE ? is_to_turn(o, t, how) : o->turned[same];
        report->turned += o->turned[t];
        report->two_sided += o->opposite[t] != PROM_NONE;
    }
}

void prom_mesh_orient(prom_mesh *mesh, const uint32_t *points, prom_repair_orient how,
                      prom_repair_report *report)
{
    uint32_t faces = mesh->index_count / 3;
    orienter o = {.mesh = mesh,
                  .points = points,
                  .same = prom_alloc(faces, sizeof *o.same),
                  .opposite = prom_alloc(faces, sizeof *o.opposite),
                  .patch_of = prom_alloc(faces, sizeof *o.patch_of),
                  .parity = prom_calloc(faces, sizeof *o.parity),
                  .turned = prom_calloc(faces, sizeof *o.turned)};
    memset(o.patch_of, 0xff, (size_t)faces * sizeof *o.patch_of);
    prom_match_faces(points, NULL, faces, o.same, o.opposite);
    find_patches(&o, faces);
    choose(&o, faces, how, report);
    report->faces = faces;
    count_up(&o, report);
    if (report->turned) turn_faces(&o, faces);
    prom_free(o.same);
    prom_free(o.opposite);
    prom_free(o.patch_of);
    prom_free(o.parity);
    prom_free(o.turned);
    prom_array_finish(&o.patches);
    prom_array_finish(&o.front);
    prom_edges_finish(&o.edges);
}
