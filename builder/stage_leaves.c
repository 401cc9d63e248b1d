// Leaves: mesh levels on all cores, then impostors and accuracy tables on the device.
#include "builder/build.h"

#include "builder/cluster_mesh.h"
#include "builder/simplify.h"
#include "builder/textures.h"
#include "metaobj/base/log.h"
#include "metaobj/base/threads.h"

#define MIN_TRIANGLES 12u     // of a level; a box has as many
#define MERGE_TRIANGLES 2048u // of the level that goes into cluster meshes
#define SHEET_FLATNESS 0.05f  // thinner than this part of its length and width
#define BOXED_TRIANGLES 64u   // fewer, and a textured box saves nothing

prom_status prom_stage_textures(prom_build_state *b, prom_error *error)
{
    size_t count = b->source.images.count;
    b->textures = prom_calloc(count, sizeof *b->textures);
    prom_textures_make(&b->source, b->textures);
    for (size_t i = 0; i < count; i++) {
        uint32_t id;
        prom_status status = prom_build_add_texture(b, &b->textures[i], &id, error);
        if (status) return status;
    }
    prom_renderer_set_materials(b->renderer, b->source.materials.data,
                                (uint32_t)b->source.materials.count);
    return PROM_OK;
}

typedef struct levels_job {
    prom_build_state *b;
    prom_progress progress;
} levels_job;

// A pavement, a stretch of road, a wall: flat, and likely to meet others at its border, which
// no level may move then.
static bool is_sheet(const prom_box *bounds)
{
    float half[3];
    prom_box_half(bounds, half);
    for (int a = 0; a < 3; a++)
        if (half[a] < SHEET_FLATNESS * fminf(half[(a + 1) % 3], half[(a + 2) % 3])) return true;
    return false;
}

// Welds, but leaves a mesh without any area as it is: it shows nothing, and does no harm.
static void weld(prom_mesh *mesh)
{
    prom_mesh welded;
    prom_mesh_copy(&welded, mesh);
    prom_mesh_weld(&welded, 0);
    if (!welded.index_count) {
        prom_mesh_finish(&welded);
        return;
    }
    prom_mesh_finish(mesh);
    *mesh = welded;
}

static void make_levels(void *user, size_t i, unsigned thread)
{
    (void)thread;
    levels_job *job = user;
    prom_shape *shape = &job->b->objects.shapes.data[i];
    prom_shape_build *s = &job->b->shapes[i];
    weld(&shape->mesh);
    bool fixed = shape->layer == PROM_LAYER_BACKDROP || shape->layer == PROM_LAYER_BLENDED;
    bool lock = shape->lock_border || is_sheet(&shape->bounds);
    s->level_count = prom_simplify_levels(&shape->mesh, lock, MIN_TRIANGLES,
                                          fixed ? 1 : PROM_LEVELS_MAX, s->levels, s->errors);
    if (!s->level_count) { // nothing in it has an area
        s->levels[0] = shape->mesh;
        s->level_count = 1;
        shape->mesh = (prom_mesh){0};
    }
    prom_mesh_finish(&shape->mesh); // level 0 holds it now
    uint32_t merge = 0;
    while (merge + 1 < s->level_count && s->levels[merge].index_count / 3 > MERGE_TRIANGLES)
        merge++;
    if (!fixed)
        prom_mesh_bake_colors(&s->levels[merge], job->b->source.materials.data,
                              job->b->textures, &s->merge);
    s->merge_error = s->errors[merge];
    prom_progress_step(&job->progress, 1);
}

// Area-weighted mean luminance of what clusters will merge: the scene's own background.
static float mean_luminance(const prom_build_state *b)
{
    double sum = 0, area = 0;
    for (size_t i = 0; i < b->objects.shapes.count; i++) {
        const prom_mesh *m = &b->shapes[i].merge;
        double weight = b->objects.shapes.data[i].instances;
        for (uint32_t t = 0; t + 2 < m->index_count; t += 3) {
            const prom_vertex *v[3];
            for (int k = 0; k < 3; k++) v[k] = &m->vertices[m->indices[t + k]];
            vec3 e1, e2, n;
            glm_vec3_sub((float *)v[1]->position, (float *)v[0]->position, e1);
            glm_vec3_sub((float *)v[2]->position, (float *)v[0]->position, e2);
            glm_vec3_cross(e1, e2, n);
            double a = weight * glm_vec3_norm(n);
            const uint8_t *c = v[0]->color;
            sum += a * (0.2126f * prom_srgb8_to_linear(c[0]) +
                        0.7152f * prom_srgb8_to_linear(c[1]) +
                        0.0722f * prom_srgb8_to_linear(c[2]));
            area += a;
        }
    }
    return area > 0 ? (float)(sum / area) : 0.2f;
}

prom_status prom_stage_levels(prom_build_state *b, prom_error *error)
{
    (void)error;
    size_t count = b->objects.shapes.count;
    b->shapes = prom_calloc(count, sizeof *b->shapes);
    levels_job job = {.b = b};
    prom_progress_begin(&job.progress, "levels", count);
    prom_parallel_for(count, make_levels, &job);
    prom_progress_end(&job.progress);
    b->mean_luminance = mean_luminance(b);
    return PROM_OK;
}

static uint32_t flags_of_layer(prom_layer layer)
{
    static const uint32_t flags[PROM_LAYER_COUNT] = {
        [PROM_LAYER_SURFACE] = PROM_PROTO_SURFACE,
        [PROM_LAYER_BLENDED] = PROM_PROTO_BLENDED,
        [PROM_LAYER_BACKDROP] = PROM_PROTO_BACKDROP,
    };
    return flags[layer];
}

static prom_status add_leaf(prom_build_state *b, uint32_t p, prom_error *error)
{
    const prom_shape *shape = &b->objects.shapes.data[p];
    prom_shape_build *s = &b->shapes[p];
    prom_prototype *proto = &b->prototypes[p];
    proto->flags = flags_of_layer(shape->layer);
    proto->first_share = PROM_NONE;
    proto->triangles = s->levels[0].index_count / 3;
    prom_box bounds = prom_mesh_bounds(&s->levels[0]);
    prom_box_center(&bounds, proto->center);
    prom_box_half(&bounds, proto->half);
    // The sphere around the box, not around the vertices: impostors fill the box.
    proto->radius = fmaxf(glm_vec3_norm(proto->half), 1e-6f);

    uint32_t cheapest = 0; // kept level
    for (uint32_t l = 0; l < s->level_count; l++) {
        prom_representation rep = {
            .kind = PROM_REP_MESH, .texture = PROM_NONE, .level = l, .error = s->errors[l]};
        prom_admission admission = shape->layer == PROM_LAYER_BACKDROP ? PROM_ADMIT_UNMEASURED
                                   : l == 0                            ? PROM_ADMIT_TRUTH
                                                                       : PROM_ADMIT_MEASURED;
        prom_status status =
            prom_build_add_rep(b, p, &s->levels[l], &rep, admission, &s->mesh_ids[l], error);
        if (status) return status;
        if (s->mesh_ids[l] == PROM_NONE) continue;
        s->max_size_px[l] = b->reps.data[b->reps.count - 1].max_size_px;
        cheapest = l;
    }
    if (shape->layer != PROM_LAYER_OBJECT) return PROM_OK;
    // Where a level costs as little, a box would only show less.
    const prom_mesh *last = &s->levels[cheapest];
    if (last->index_count / 3 <= MIN_TRIANGLES && last->submesh_count == 1) return PROM_OK;
    prom_draw_item item = prom_build_item_around(s->mesh_ids[0], proto->center);
    prom_baker_set_subject(b->baker, &item, 1);
    return prom_build_add_boxes(b, p, proto->center, proto->half, proto->radius, false,
                                b->boxed[p], error);
}

typedef struct candidate {
    double value;   // triangles replaced per byte
    uint32_t index; // shapes, then clusters
} candidate;

static int by_value(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    if (x->value != y->value) return x->value > y->value ? -1 : 1;
    return (x->index > y->index) - (x->index < y->index);
}

// Which prototypes get textured boxes: those that replace most triangles per byte, within the
// byte budget of the device.
static void plan_boxes(prom_build_state *b)
{
    const double face_bytes = PROM_FACE_PX * PROM_FACE_PX * 4.0 * 4.0 / 3.0; // with mips
    const double shape_bytes = 12 * face_bytes, cluster_bytes = 6 * face_bytes;
    PROM_ARRAY(candidate) list = {0};
    size_t shape_count = b->objects.shapes.count, cluster_count = b->tree.clusters.count;
    b->boxed = prom_calloc(shape_count + cluster_count, sizeof *b->boxed);
    for (size_t i = 0; i < shape_count; i++) {
        const prom_shape *s = &b->objects.shapes.data[i];
        uint32_t triangles = b->shapes[i].levels[0].index_count / 3;
        if (s->layer == PROM_LAYER_OBJECT && triangles >= BOXED_TRIANGLES)
            prom_array_push(&list, (candidate){(double)triangles * s->instances / shape_bytes,
                                               (uint32_t)i});
    }
    for (size_t i = 0; i < cluster_count; i++) {
        const prom_tree_cluster *c = &b->tree.clusters.data[i];
        if (c->layer == PROM_LAYER_OBJECT && !c->mixed) // its own mesh is what a box replaces
            prom_array_push(&list, (candidate){(double)PROM_CLUSTER_TRIANGLES * c->instances /
                                                   cluster_bytes,
                                               (uint32_t)(shape_count + i)});
    }
    if (list.count) qsort(list.data, list.count, sizeof *list.data, by_value);
    double left = (b->options->texture_mb) * 1048576.0;
    size_t refused = 0;
    for (size_t i = 0; i < list.count; i++) {
        double bytes = list.data[i].index < shape_count ? shape_bytes : cluster_bytes;
        bool fits = bytes <= left;
        if (fits) left -= bytes;
        refused += !fits;
        b->boxed[list.data[i].index] = fits;
    }
    if (refused)
        prom_log(PROM_LOG_INFO,
                 "textured boxes: %zu of %zu do not fit --texture-mb; raise it to keep them",
                 refused, list.count);
    prom_array_finish(&list);
}

prom_status prom_stage_leaves(prom_build_state *b, prom_error *error)
{
    plan_boxes(b);
    b->measure = prom_measure_create(b->mean_luminance);
    prom_progress progress;
    prom_progress_begin(&progress, "leaves", b->objects.shapes.count);
    for (uint32_t p = 0; p < b->objects.shapes.count; p++) {
        prom_status status = add_leaf(b, p, error);
        if (status) return status;
        prom_progress_step(&progress, 1);
    }
    prom_progress_end(&progress);
    return PROM_OK;
}
