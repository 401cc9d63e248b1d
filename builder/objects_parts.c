// Parts: what every source node contributes, and which of them have equal shapes.
#include "builder/objects_private.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/log.h"

#include <stdlib.h>

// A scale that differs more than this between the axes is baked into the shape.
#define UNIFORM_SCALE 1.05
// Stretches within this factor of each other share a shape; what is left stays in the
// placement.
#define STRETCH_STEP 1.01
enum { FLAT = INT32_MAX };

static prom_placement placement_from_columns(const double world[16], double columns[3][3])
{
    prom_placement p = {.origin = {world[12], world[13], world[14]}};
    for (int c = 0; c < 3; c++)
        for (int r = 0; r < 3; r++) p.basis[c * 3 + r] = (float)columns[c][r];
    return p;
}

static double length3(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

// A direction at right angles to the two other columns, for one that is squeezed to nothing.
static void restore_column(double columns[3][3], int c, double length)
{
    const double *a = columns[(c + 1) % 3], *b = columns[(c + 2) % 3];
    double n[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                   a[0] * b[1] - a[1] * b[0]};
    double l = length3(n);
    for (int k = 0; k < 3; k++) columns[c][k] = l > 0 ? n[k] / l * length : 0;
}

// Takes a non-uniform scale out of the world matrix. False when nothing is left to be seen.
static bool set_placement(prom_part *part, const double world[16])
{
    double columns[3][3], length[3], longest = 0, shortest = INFINITY;
    for (int c = 0; c < 3; c++) {
        for (int r = 0; r < 3; r++) columns[c][r] = world[c * 4 + r];
        length[c] = length3(columns[c]);
        longest = fmax(longest, length[c]);
        shortest = fmin(shortest, length[c]);
    }
    if (!(longest > 0)) return false;
    if (longest > UNIFORM_SCALE * shortest) {
        for (int c = 0; c < 3; c++) {
            if (length[c] < 1e-6 * longest) {
                part->stretch[c] = FLAT;
                continue;
            }
            part->stretch[c] = (int32_t)lrint(log(longest / length[c]) / log(STRETCH_STEP));
            double baked = pow(STRETCH_STEP, -part->stretch[c]);
            for (int k = 0; k < 3; k++) columns[c][k] /= baked;
        }
        for (int c = 0; c < 3; c++)
            if (part->stretch[c] == FLAT) restore_column(columns, c, longest);
    }
    part->placement = placement_from_columns(world, columns);
    return true;
}

float prom_part_stretch(const prom_part *part, int axis)
{
    int32_t steps = part->stretch[axis];
    return steps == FLAT ? 0 : (float)pow(STRETCH_STEP, -steps);
}

static bool is_blended(const prom_source *source, uint32_t mesh)
{
    uint32_t material = source->meshes.data[mesh].submeshes[0].material;
    return material != PROM_NONE &&
           source->materials.data[material].alpha_mode == PROM_ALPHA_BLEND;
}

static bool matrix_finite(const double m[16])
{
    for (int k = 0; k < 16; k++)
        if (!isfinite(m[k]) || fabs(m[k]) > 1e30) return false;
    return true;
}

// Appends the opaque or the blended ones of some meshes; how many.
static uint32_t take_meshes(prom_finder *finder, uint32_t first, uint32_t count, bool blended)
{
    const prom_source *source = finder->source;
    size_t before = finder->part_meshes.count;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t mesh = source->mesh_refs.data[first + i];
        if (source->meshes.data[mesh].index_count && is_blended(source, mesh) == blended)
            prom_array_push(&finder->part_meshes, mesh);
    }
    return (uint32_t)(finder->part_meshes.count - before);
}

// The artist's levels, as far as they have meshes of this kind: a pane that is gone from the
// second level on keeps its own geometry.
static void take_levels(prom_finder *finder, const prom_source_node *node, prom_part *part)
{
    part->first_level = (uint32_t)finder->part_levels.count;
    part->until = node->until;
    for (uint32_t i = 0; i < node->level_count; i++) {
        const prom_source_level *from = &finder->source->levels.data[node->first_level + i];
        prom_part_level level = {.first_mesh = (uint32_t)finder->part_meshes.count,
                                 .until = from->until};
        level.mesh_count =
            take_meshes(finder, from->first_mesh, from->mesh_count, part->blended);
        if (!level.mesh_count) break;
        prom_array_push(&finder->part_levels, level);
        part->level_count++;
    }
}

// The node's opaque or blended meshes; false if it has none with an extent. *lost is set when
// meshes were there and had none.
static bool make_part(prom_finder *finder, uint32_t node, bool blended,
                      const prom_box *mesh_bounds, prom_part *part, bool *lost)
{
    const prom_source *source = finder->source;
    const prom_source_node *n = &source->nodes.data[node];
    *part = (prom_part){.node = node,
                        .scope = finder->node_scope[node],
                        .first_mesh = (uint32_t)finder->part_meshes.count,
                        .blended = blended,
                        .bounds = PROM_WBOX_EMPTY};
    prom_placement whole = prom_placement_from_matrix(n->world);
    uint64_t triangles = 0;
    part->mesh_count = take_meshes(finder, n->first_mesh, n->mesh_count, blended);
    if (!part->mesh_count) return false;
    for (uint32_t i = 0; i < part->mesh_count; i++) {
        uint32_t mesh = finder->part_meshes.data[part->first_mesh + i];
        triangles += source->meshes.data[mesh].index_count / 3;
        prom_wbox b = prom_wbox_of_placed(&mesh_bounds[mesh], &whole);
        prom_wbox_add(&part->bounds, &b);
    }
    double diagonal = prom_wbox_diagonal(&part->bounds);
    if (diagonal > 0 && isfinite(diagonal) && triangles <= UINT32_MAX / 3 &&
        set_placement(part, n->world)) {
        part->triangles = (uint32_t)triangles;
        take_levels(finder, n, part);
        return true;
    }
    *lost = true;
    finder->part_meshes.count = part->first_mesh;
    return false;
}

static void collect_parts(prom_finder *finder)
{
    const prom_source *source = finder->source;
    prom_box *mesh_bounds = prom_alloc(source->meshes.count, sizeof *mesh_bounds);
    for (size_t i = 0; i < source->meshes.count; i++)
        mesh_bounds[i] = prom_mesh_bounds(&source->meshes.data[i]);
    uint32_t broken = 0, empty = 0;
    for (uint32_t i = 0; i < source->nodes.count; i++) {
        const prom_source_node *n = &source->nodes.data[i];
        if (finder->node_scope[i] == PROM_NONE || !n->mesh_count) continue;
        if (!matrix_finite(n->world)) {
            if (!broken++)
                prom_log(PROM_LOG_WARNING,
                         "node %u '%s' has a matrix that is not finite; it is left out", i,
                         n->name ? n->name : "");
            continue;
        }
        bool lost = false;
        for (int blended = 0; blended < 2; blended++) {
            prom_part part;
            if (make_part(finder, i, blended, mesh_bounds, &part, &lost))
                prom_array_push(&finder->parts, part);
        }
        if (lost && !empty++)
            prom_log(PROM_LOG_WARNING,
                     "node %u '%s' has geometry without any extent; it is left out", i,
                     n->name ? n->name : "");
    }
    if (broken > 1)
        prom_log(PROM_LOG_WARNING, "%u nodes were left out for such matrices", broken);
    if (empty > 1) prom_log(PROM_LOG_WARNING, "%u nodes were without any extent", empty);
    prom_free(mesh_bounds);
}

static int by_scope(const void *pa, const void *pb)
{
    const prom_part *a = pa, *b = pb;
    if (a->scope != b->scope) return a->scope < b->scope ? -1 : 1;
    if (a->node != b->node) return a->node < b->node ? -1 : 1;
    return (int)a->blended - (int)b->blended;
}

typedef struct kind_key {
    const prom_finder *finder;
    const prom_part *part;
    uint32_t index;
} kind_key;

static int compare_meshes(const prom_finder *f, uint32_t a, uint32_t a_count, uint32_t b,
                          uint32_t b_count)
{
    const uint32_t *meshes = f->part_meshes.data;
    if (a_count != b_count) return a_count < b_count ? -1 : 1;
    for (uint32_t i = 0; i < a_count; i++)
        if (meshes[a + i] != meshes[b + i]) return meshes[a + i] < meshes[b + i] ? -1 : 1;
    return 0;
}

static int compare_levels(const prom_finder *f, const prom_part *a, const prom_part *b)
{
    if (a->level_count != b->level_count) return a->level_count < b->level_count ? -1 : 1;
    if (a->level_count && a->until != b->until) return a->until < b->until ? -1 : 1;
    for (uint32_t i = 0; i < a->level_count; i++) {
        const prom_part_level *p = &f->part_levels.data[a->first_level + i];
        const prom_part_level *q = &f->part_levels.data[b->first_level + i];
        if (p->until != q->until) return p->until < q->until ? -1 : 1;
        int c = compare_meshes(f, p->first_mesh, p->mesh_count, q->first_mesh, q->mesh_count);
        if (c) return c;
    }
    return 0;
}

static int compare_shapes(const kind_key *a, const kind_key *b)
{
    const prom_finder *f = a->finder;
    int c = compare_meshes(f, a->part->first_mesh, a->part->mesh_count, b->part->first_mesh,
                           b->part->mesh_count);
    if (!c) c = compare_levels(f, a->part, b->part);
    if (c) return c;
    for (int k = 0; k < 3; k++)
        if (a->part->stretch[k] != b->part->stretch[k])
            return a->part->stretch[k] < b->part->stretch[k] ? -1 : 1;
    return 0;
}

static int by_shape(const void *pa, const void *pb)
{
    const kind_key *a = pa, *b = pb;
    int c = compare_shapes(a, b);
    return c ? c : a->index < b->index ? -1 : 1;
}

// Numbers the kinds of parts and tells which parts are the only ones of their kind in a scope.
static void number_kinds(prom_finder *finder)
{
    size_t n = finder->parts.count;
    kind_key *keys = prom_alloc(n, sizeof *keys);
    for (uint32_t i = 0; i < n; i++) keys[i] = (kind_key){finder, &finder->parts.data[i], i};
    qsort(keys, n, sizeof *keys, by_shape);
    uint32_t kind = 0;
    for (size_t i = 0; i < n; i++) {
        if (i && compare_shapes(&keys[i - 1], &keys[i])) kind++;
        finder->parts.data[keys[i].index].kind = kind;
    }
    // Parts stand by scope, so those of one kind and scope are neighbours among the keys.
    for (size_t i = 0; i < n; i++) {
        prom_part *p = &finder->parts.data[keys[i].index];
        const prom_part *before = i ? keys[i - 1].part : NULL;
        const prom_part *after = i + 1 < n ? keys[i + 1].part : NULL;
        p->unique = !p->level_count &&
                    !(before && before->kind == p->kind && before->scope == p->scope) &&
                    !(after && after->kind == p->kind && after->scope == p->scope);
    }
    prom_free(keys);
    finder->kind_count = kind + 1;
    finder->kind_shape = prom_alloc(finder->kind_count, 2 * sizeof *finder->kind_shape);
    memset(finder->kind_shape, 0xff, finder->kind_count * 2 * sizeof *finder->kind_shape);
}

prom_status prom_find_parts(prom_finder *finder, prom_error *error)
{
    collect_parts(finder);
    size_t n = finder->parts.count;
    if (!n)
        return prom_fail(
            error, PROM_ERR_INPUT,
            "the scene has no geometry with an extent; nothing can be built from it");
    qsort(finder->parts.data, n, sizeof *finder->parts.data, by_scope);
    for (size_t i = n; i-- > 0;) {
        prom_scope *s = &finder->scopes.data[finder->parts.data[i].scope];
        s->first_part = (uint32_t)i;
        s->part_count++;
    }
    number_kinds(finder);
    uint64_t triangles = 0;
    for (size_t i = 0; i < n; i++)
        if (finder->parts.data[i].unique) triangles += finder->parts.data[i].triangles;
    if (triangles > UINT32_MAX)
        return prom_fail(
            error, PROM_ERR_UNSUPPORTED,
            "the scene has %llu triangles that are no instances; at most %u can be "
            "built, split the scene",
            (unsigned long long)triangles, UINT32_MAX);
    return PROM_OK;
}
