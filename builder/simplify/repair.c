#include "builder/simplify/repair.h"

#include "builder/simplify/face_match.h"
#include "builder/simplify/repair_orient.h"
#include "builder/simplify/weld.h"
#include "builder/simplify/work.h"

#include <math.h>

// ---- faces and vertices that go

static uint32_t drop_faces(prom_mesh *mesh, const bool *gone)
{
    uint32_t n = 0, submeshes = 0, faces = mesh->index_count / 3;
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        prom_submesh sub = mesh->submeshes[s];
        uint32_t first = n, end = (sub.first_index + sub.index_count) / 3;
        for (uint32_t t = sub.first_index / 3; t < end; t++) {
            if (gone[t]) continue;
            memmove(mesh->indices + (size_t)n++ * 3, mesh->indices + (size_t)t * 3,
                    3 * sizeof *mesh->indices);
        }
        if (n > first)
            mesh->submeshes[submeshes++] =
                (prom_submesh){first * 3, (n - first) * 3, sub.material};
    }
    mesh->index_count = n * 3;
    mesh->submesh_count = submeshes;
    return faces - n;
}

// Not that of an infinite coordinate: its area is infinite or undefined.
static bool has_area(const prom_mesh *mesh, uint32_t triangle)
{
    const float *p[3];
    for (uint32_t k = 0; k < 3; k++)
        p[k] = mesh->vertices[mesh->indices[(size_t)triangle * 3 + k]].position;
    float cross[3];
    prom_triangle_cross(p[0], p[1], p[2], cross);
    float area = glm_vec3_norm(cross);
    return isfinite(area) && area > 0;
}

static uint32_t drop_degenerate(prom_mesh *mesh)
{
    uint32_t faces = mesh->index_count / 3;
    bool *gone = prom_alloc(faces, sizeof *gone);
    for (uint32_t t = 0; t < faces; t++) gone[t] = !has_area(mesh, t);
    uint32_t dropped = drop_faces(mesh, gone);
    prom_free(gone);
    return dropped;
}

static void drop_unused(prom_mesh *mesh)
{
    uint32_t *id = prom_calloc(mesh->vertex_count, sizeof *id), n = 0;
    for (uint32_t i = 0; i < mesh->index_count; i++) id[mesh->indices[i]] = 1;
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        if (!id[v]) continue;
        id[v] = n;
        mesh->vertices[n++] = mesh->vertices[v];
    }
    for (uint32_t i = 0; i < mesh->index_count; i++) mesh->indices[i] = id[mesh->indices[i]];
    mesh->vertex_count = n;
    prom_free(id);
}

// ---- vertices that are one

// Equal numbers must be equal bytes.
static void without_negative_zeros(prom_mesh *mesh)
{
    for (uint32_t v = 0; v < mesh->vertex_count; v++) {
        for (int k = 0; k < 3; k++) mesh->vertices[v].position[k] += 0.0f;
        for (int k = 0; k < 2; k++) mesh->vertices[v].uv[k] += 0.0f;
    }
}

static uint32_t snap(prom_mesh *mesh, float tolerance)
{
    uint32_t moved = 0;
    if (tolerance < 0 || !mesh->vertex_count) return 0;
    prom_box box = prom_mesh_bounds(mesh);
    float radius = prom_box_diagonal(&box) / 2;
    prom_mesh_snap(mesh, radius * (tolerance > 0 ? tolerance : PROM_REPAIR_TOLERANCE), &moved);
    return moved;
}

static uint32_t merge_equal(prom_mesh *mesh)
{
    uint32_t *first = prom_alloc(mesh->vertex_count, sizeof *first), merged = 0;
    prom_first_equal(mesh->vertices, mesh->vertex_count, sizeof *mesh->vertices, first);
    for (uint32_t v = 0; v < mesh->vertex_count; v++) merged += first[v] != v;
    for (uint32_t i = 0; i < mesh->index_count; i++) mesh->indices[i] = first[mesh->indices[i]];
    prom_free(first);
    return merged;
}

// The points of all corners; to be freed.
static uint32_t *points_of(const prom_mesh *mesh)
{
    float(*places)[3] = prom_alloc(mesh->vertex_count, sizeof *places);
    uint32_t *first = prom_alloc(mesh->vertex_count, sizeof *first);
    uint32_t *points = prom_alloc(mesh->index_count, sizeof *points);
    for (uint32_t v = 0; v < mesh->vertex_count; v++)
        memcpy(places[v], mesh->vertices[v].position, sizeof places[v]);
    prom_first_equal(places, mesh->vertex_count, sizeof *places, first);
    for (uint32_t i = 0; i < mesh->index_count; i++) points[i] = first[mesh->indices[i]];
    prom_free(places);
    prom_free(first);
    return points;
}

// ---- all of it

// Within a material: another over the same faces may be meant (a decal).
static uint32_t drop_repeated(prom_mesh *mesh)
{
    uint32_t faces = mesh->index_count / 3;
    uint32_t *points = points_of(mesh);
    uint32_t *group = prom_alloc(faces, sizeof *group);
    uint32_t *same = prom_alloc(faces, sizeof *same);
    uint32_t *opposite = prom_alloc(faces, sizeof *opposite);
    bool *gone = prom_alloc(faces, sizeof *gone);
    for (uint32_t s = 0; s < mesh->submesh_count; s++) {
        const prom_submesh *sub = &mesh->submeshes[s];
        for (uint32_t i = 0; i < sub->index_count / 3; i++) group[sub->first_index / 3 + i] = s;
    }
    prom_match_faces(points, group, faces, same, opposite);
    for (uint32_t t = 0; t < faces; t++) gone[t] = same[t] != PROM_NONE;
    uint32_t dropped = drop_faces(mesh, gone);
    prom_free(points);
    prom_free(group);
    prom_free(same);
    prom_free(opposite);
    prom_free(gone);
    return dropped;
}

static void orient(prom_mesh *mesh, prom_repair_orient how, prom_repair_report *report)
{
    uint32_t *points = points_of(mesh);
    prom_mesh_orient(mesh, points, how, report);
    prom_free(points);
}

void prom_mesh_repair(prom_mesh *mesh, const prom_repair_options *options,
                      prom_repair_report *report)
{
    prom_repair_options o = options ? *options : (prom_repair_options){0};
    *report = (prom_repair_report){.degenerate = drop_degenerate(mesh)};
    drop_unused(mesh);
    without_negative_zeros(mesh);
    report->snapped = snap(mesh, o.tolerance);
    report->degenerate += drop_degenerate(mesh);
    report->welded = merge_equal(mesh);
    report->duplicate = drop_repeated(mesh);
    orient(mesh, o.orient, report);
    merge_equal(mesh); // of those that turned faces were given
    drop_unused(mesh);
}
