#include "builder/simplify/guard.h"

#include <float.h>
#include <math.h>

// About 78 degrees: faces that turn a little each time would end up turned round.
#define LEAST_COSINE 0.2f
// Twice the area against the longest edge's square: of an equilateral triangle 0.87. Slimmer
// ones than this are refused where they are much slimmer than before.
#define SLIVER 0.02f
#define MUCH_SLIMMER 0.25f
// Stars of more corners are left alone until they have fewer, for the time it takes.
enum { LONGEST_STAR = 2000 };

void prom_marks_init(prom_marks *marks, uint32_t points)
{
    marks->mark = prom_calloc(points, sizeof *marks->mark);
    marks->epoch = 0;
    marks->points = points;
}

void prom_marks_finish(prom_marks *marks)
{
    prom_free(marks->mark);
    memset(marks, 0, sizeof *marks);
}

uint32_t prom_marks_begin(prom_marks *marks)
{
    if (marks->epoch >= UINT32_MAX - 4) {
        memset(marks->mark, 0, marks->points * sizeof *marks->mark);
        marks->epoch = 0;
    }
    return marks->epoch += 2;
}

// The other two points of a corner's triangle.
static void others(const prom_collapse_mesh *mesh, uint32_t corner, uint32_t out[2])
{
    out[0] = prom_corner_point(mesh, prom_corner_after(corner));
    out[1] = prom_corner_point(mesh, prom_corner_before(corner));
}

static bool has_triangle(const prom_collapse_mesh *mesh, uint32_t point, const uint32_t with[2])
{
    for (uint32_t c = mesh->first_corner[point]; c != PROM_NONE; c = mesh->next_corner[c]) {
        uint32_t o[2];
        others(mesh, c, o);
        if ((o[0] == with[0] && o[1] == with[1]) || (o[0] == with[1] && o[1] == with[0]))
            return true;
    }
    return false;
}

// Marks the points around `to` with epoch, those of the edge's triangles with epoch + 1.
static bool mark_around(const prom_collapse_mesh *mesh, prom_marks *marks, uint32_t epoch,
                        uint32_t from, uint32_t to, uint32_t *edge_triangles)
{
    uint32_t n = 0;
    for (uint32_t c = mesh->first_corner[to]; c != PROM_NONE; c = mesh->next_corner[c]) {
        uint32_t o[2];
        others(mesh, c, o);
        const bool edge = o[0] == from || o[1] == from;
        *edge_triangles += edge;
        for (int k = 0; k < 2; k++) {
            uint32_t *mark = &marks->mark[o[k]];
            if (edge || *mark < epoch) *mark = epoch + edge;
        }
        if (++n > LONGEST_STAR) return false;
    }
    return true;
}

prom_verdict prom_guard_link(const prom_collapse_mesh *mesh, prom_marks *marks, uint32_t from,
                             uint32_t to, bool borders)
{
    const uint32_t epoch = prom_marks_begin(marks);
    uint32_t edge_triangles = 0, n = 0;
    if (!mark_around(mesh, marks, epoch, from, to, &edge_triangles)) return PROM_VERDICT_LINK;
    if (borders && edge_triangles > 1) return PROM_VERDICT_LINK;
    for (uint32_t c = mesh->first_corner[from]; c != PROM_NONE; c = mesh->next_corner[c]) {
        uint32_t o[2];
        others(mesh, c, o);
        if (++n > LONGEST_STAR) return PROM_VERDICT_LINK;
        if (o[0] == to || o[1] == to) continue;
        const uint32_t m[2] = {marks->mark[o[0]], marks->mark[o[1]]};
        if (edge_triangles && (m[0] == epoch || m[1] == epoch)) return PROM_VERDICT_LINK;
        if (m[0] >= epoch && m[1] >= epoch && has_triangle(mesh, to, o))
            return PROM_VERDICT_LINK;
    }
    return PROM_VERDICT_GOOD;
}

static bool star_is_too_long(const prom_collapse_mesh *mesh, uint32_t point)
{
    uint32_t n = 0;
    for (uint32_t c = mesh->first_corner[point]; c != PROM_NONE; c = mesh->next_corner[c])
        if (++n > LONGEST_STAR) return true;
    return false;
}

static bool star_is_of_edge(const prom_collapse_mesh *mesh, uint32_t point, uint32_t other)
{
    for (uint32_t c = mesh->first_corner[point]; c != PROM_NONE; c = mesh->next_corner[c]) {
        uint32_t o[2];
        others(mesh, c, o);
        if (o[0] != other && o[1] != other) return false;
    }
    return true;
}

bool prom_guard_last(const prom_collapse_mesh *mesh, uint32_t from, uint32_t to)
{
    return star_is_of_edge(mesh, from, to) && star_is_of_edge(mesh, to, from);
}

bool prom_guard_small(const prom_collapse_mesh *mesh, uint32_t from, uint32_t to, float squared)
{
    const float *a = mesh->position[from], *b = mesh->position[to];
    if (glm_vec3_distance2((float *)a, (float *)b) > squared) return false;
    for (uint32_t c = mesh->first_corner[from]; c != PROM_NONE; c = mesh->next_corner[c]) {
        uint32_t o[2];
        others(mesh, c, o);
        if (o[0] != to && o[1] != to) continue;
        float *third = mesh->position[o[0] == to ? o[1] : o[0]];
        if (glm_vec3_distance2((float *)a, third) > squared ||
            glm_vec3_distance2((float *)b, third) > squared)
            return false;
    }
    return !star_is_too_long(mesh, from) && !star_is_too_long(mesh, to);
}

// Twice the area's vector; returns the longest edge's square.
static float face_normal(const float a[3], const float b[3], const float c[3], float normal[3])
{
    float e[3], f[3], g[3];
    for (int k = 0; k < 3; k++) e[k] = b[k] - a[k], f[k] = c[k] - a[k], g[k] = c[k] - b[k];
    glm_vec3_cross(e, f, normal);
    return fmaxf(glm_vec3_norm2(e), fmaxf(glm_vec3_norm2(f), glm_vec3_norm2(g)));
}

// Whether a face looks the way that its corners' normals do, one of them being `first`.
static bool looks_outward(const prom_vertex *const corners[3], const prom_vertex *first,
                          const float normal[3])
{
    float sum = 0;
    for (int k = 0; k < 3; k++)
        sum += normal[k] *
               (float)(first->normal[k] + corners[1]->normal[k] + corners[2]->normal[k]);
    return sum > 0;
}

// partner: a vertex of the other point; what the merged one will look like is between.
static prom_verdict judge(const prom_vertex *const corners[3], const prom_vertex *partner,
                          const float place[3])
{
    float was[3], is[3];
    const float *b = corners[1]->position, *c = corners[2]->position;
    const float was_longest = face_normal(corners[0]->position, b, c, was);
    const float is_longest = face_normal(place, b, c, is);
    const float was_area = glm_vec3_norm(was), is_area = glm_vec3_norm(is);
    if (!(is_area > FLT_MIN) || !isfinite(is_area)) return PROM_VERDICT_DEGENERATE;
    // Slivers that are there may stay, but they must not be made.
    const float is_slim = is_area / is_longest, was_slim = was_area / was_longest;
    if (is_slim < SLIVER && is_slim < MUCH_SLIMMER * was_slim) return PROM_VERDICT_DEGENERATE;
    if (!(was_area > FLT_MIN)) return PROM_VERDICT_GOOD;
    if (glm_vec3_dot(was, is) < LEAST_COSINE * was_area * is_area) return PROM_VERDICT_FLIP;
    // Small turns add up; normals remember where a face looked at first.
    if (!looks_outward(corners, corners[0], was)) return PROM_VERDICT_GOOD;
    return looks_outward(corners, corners[0], is) && looks_outward(corners, partner, is)
               ? PROM_VERDICT_GOOD
               : PROM_VERDICT_FLIP;
}

static prom_verdict judge_star(const prom_collapse_mesh *mesh, uint32_t point, uint32_t other,
                               const float place[3])
{
    const prom_vertex *v = mesh->vertices.data;
    const prom_vertex *partner = &v[mesh->corners[mesh->first_corner[other]]];
    for (uint32_t c = mesh->first_corner[point]; c != PROM_NONE; c = mesh->next_corner[c]) {
        const uint32_t after = mesh->corners[prom_corner_after(c)];
        const uint32_t before = mesh->corners[prom_corner_before(c)];
        if (mesh->point.data[after] == other || mesh->point.data[before] == other) continue;
        const prom_vertex *const corners[3] = {&v[mesh->corners[c]], &v[after], &v[before]};
        const prom_verdict verdict = judge(corners, partner, place);
        if (verdict) return verdict;
    }
    return PROM_VERDICT_GOOD;
}

prom_verdict prom_guard_faces(const prom_collapse_mesh *mesh, uint32_t from, uint32_t to,
                              const float place[3])
{
    const prom_verdict verdict = judge_star(mesh, from, to, place);
    if (verdict || !memcmp(place, mesh->position[to], 3 * sizeof *place)) return verdict;
    return judge_star(mesh, to, from, place);
}
