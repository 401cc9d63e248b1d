#include "builder/cluster_mesh.h"

#include "builder/cluster_mesh_color.h"
#include "builder/simplify/cards.h"
#include "builder/simplify/distance.h"
#include "builder/simplify/reduce.h"
#include "builder/simplify/weld.h"

#include <math.h>

// Pieces of a surface meet within this share of its radius.
#define WELD_TOLERANCE 1e-5f
// By taste: how far above the target a result may be before a rougher means is used, how small
// against the whole a component must be to be left out, how near parts must be to become one,
// and from which reduction on colours are averaged.
#define NEAR_TARGET 1.3f
#define SURFACE_TARGET 4.0f
#define SPECK_EXTENT (1.0f / 24)
#define PAIR_DISTANCE (1.0f / 48)
enum { RECOLOR_BELOW = 4 };

// The matrix for normals: the inverse transpose; a flat placement has none, its basis serves.
static void normal_basis(const float basis[9], float out[9])
{
    float inverse[9];
    if (!prom_basis_invert(basis, inverse)) {
        memcpy(out, basis, 9 * sizeof *out);
        return;
    }
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) out[c * 3 + r] = inverse[r * 3 + c];
}

static void place_vertex(const prom_cluster_piece *piece, const float normals[9],
                         prom_vertex *v)
{
    double world[3];
    float n[3], turned[3];
    prom_placement_apply(&piece->placement, v->position, world);
    for (int a = 0; a < 3; a++) {
        v->position[a] = (float)world[a];
        n[a] = (float)v->normal[a] / 127;
        v->uv[a % 2] = 0;
    }
    prom_basis_apply(normals, n, turned);
    glm_vec3_normalize(turned);
    prom_pack_normal(turned, v->normal);
}

static void append_piece(const prom_cluster_piece *piece, prom_mesh *out)
{
    const prom_mesh *mesh = piece->mesh;
    float normals[9];
    normal_basis(piece->placement.basis, normals);
    bool mirrored = prom_basis_determinant(piece->placement.basis) < 0;
    uint32_t base = out->vertex_count;
    for (uint32_t i = 0; i < mesh->vertex_count; i++) {
        prom_vertex *v = &out->vertices[out->vertex_count++];
        *v = mesh->vertices[i];
        place_vertex(piece, normals, v);
    }
    for (uint32_t i = 0; i < mesh->index_count; i++) {
        uint32_t corner = mirrored ? i - i % 3 + (3 - i % 3) % 3 : i;
        out->indices[out->index_count++] = base + mesh->indices[corner];
    }
}

// All pieces in the cluster's frame; false if they are too many for 32-bit indices.
static bool merge(const prom_cluster_piece *pieces, size_t count, prom_mesh *out, float *error)
{
    uint64_t vertices = 0, indices = 0;
    *error = 0;
    for (size_t i = 0; i < count; i++) {
        vertices += pieces[i].mesh->vertex_count;
        indices += pieces[i].mesh->index_count / 3 * 3;
        float scale = prom_basis_scale(pieces[i].placement.basis);
        *error = fmaxf(*error, pieces[i].error * scale);
    }
    if (!indices || vertices > INT32_MAX || indices > INT32_MAX) return false;
    prom_mesh_init(out, (uint32_t)vertices, (uint32_t)indices, 1);
    out->vertex_count = out->index_count = 0;
    for (size_t i = 0; i < count; i++) append_piece(&pieces[i], out);
    out->submeshes[0] = (prom_submesh){0, out->index_count, PROM_NONE};
    return true;
}

static bool above(const prom_work *work, const prom_index_array *faces, uint32_t target,
                  float factor)
{
    return (float)prom_work_count(work, faces) > factor * (float)target;
}

// Reduces from scratch; `out` holds the result's own vertices in the work until its reset.
static void reduce(prom_work *work, const prom_reduce_options *options, uint32_t target,
                   prom_index_array *out)
{
    prom_work_reset(work);
    prom_reduction *reduction = prom_reduction_create(work, options);
    prom_reduction_run(reduction, target, INFINITY, out);
    prom_reduction_destroy(reduction);
}

// Parts may become one; where that is not enough, specks are left out.
static void reduce_objects(prom_work *work, uint32_t target, prom_index_array *faces)
{
    const prom_reduce_options options = {
        .merged = true, .loose = true, .pair_distance = PAIR_DISTANCE * work->diagonal};
    reduce(work, &options, target, faces);
    if (!above(work, faces, target, NEAR_TARGET)) return;
    double fronts = (double)work->indices.count / 3 / work->triangles;
    prom_work_drop_specks(work, (uint32_t)(target * fronts), SPECK_EXTENT * work->diagonal,
                          faces);
}

// The outer border stays, since the neighbour keeps it too. Where that leaves far too much, the
// border gives way: its deviation is part of the error, and it may show as a crack of that
// size.
static void reduce_surface(prom_work *work, uint32_t target, prom_index_array *faces)
{
    prom_reduce_options options = {.merged = true, .lock_border = true};
    reduce(work, &options, target, faces);
    if (!above(work, faces, target, SURFACE_TARGET)) return;
    options.lock_border = false;
    options.keep_cards = true;
    reduce(work, &options, target, faces);
}

bool prom_cluster_mesh_make(const prom_cluster_piece *pieces, size_t count, bool surface,
                            uint32_t target_triangles, prom_mesh *out, float *error)
{
    prom_mesh merged;
    *out = (prom_mesh){0};
    *error = 0;
    if (!merge(pieces, count, &merged, error)) {
        *error = 0;
        return false;
    }
    if (surface) {
        prom_box box = prom_mesh_bounds(&merged);
        prom_mesh_weld_surface(&merged, WELD_TOLERANCE * prom_box_diagonal(&box) / 2);
    }
    prom_work work;
    prom_work_init(&work, &merged);
    prom_mesh_finish(&merged);
    prom_index_array faces = {0};
    const prom_index_array *result = &faces;
    if (target_triangles < 1) target_triangles = 1;
    if (work.triangles <= target_triangles) {
        result = &work.indices;
    } else {
        (surface ? reduce_surface : reduce_objects)(&work, target_triangles, &faces);
        *error += prom_work_deviation(&work, &faces);
    }
    bool made = result->count > 0;
    if (made && result->count * RECOLOR_BELOW < work.indices.count)
        prom_work_recolor(&work, result, surface);
    if (made) prom_work_emit(&work, result, out);
    if (!made) *error = 0;
    prom_array_finish(&faces);
    prom_work_finish(&work);
    return made;
}
