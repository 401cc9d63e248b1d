// Leaves: representations of the shapes' prototypes, from their levels and boxes.
#include "builder/subject.h"

#include "metaobj/base/log.h"

#define BOXED_TRIANGLES 64u // fewer, and a textured box saves nothing

static uint32_t flags_of_layer(prom_layer layer)
{
    static const uint32_t flags[PROM_LAYER_COUNT] = {
        [PROM_LAYER_SURFACE] = PROM_PROTO_SURFACE,
        [PROM_LAYER_BLENDED] = PROM_PROTO_BLENDED,
        [PROM_LAYER_BACKDROP] = PROM_PROTO_BACKDROP,
    };
    return flags[layer];
}

static void fill_prototype(prom_build_state *b, uint32_t p)
{
    const prom_shape *shape = &b->objects.shapes.data[p];
    const prom_mesh *mesh = &b->shapes[p].levels[0].mesh;
    prom_prototype *proto = &b->prototypes[p];
    proto->flags = flags_of_layer(shape->layer);
    proto->triangles = mesh->index_count / 3;
    prom_box bounds = prom_mesh_bounds(mesh);
    prom_box_center(&bounds, proto->center);
    prom_box_half(&bounds, proto->half);
    // The sphere around the box, not around the vertices: impostors fill the box.
    proto->radius = fmaxf(glm_vec3_norm(proto->half), 1e-6f);
}

static prom_status begin(prom_subject *s, uint32_t p, prom_error *error)
{
    prom_build_state *b = s->build;
    prom_shape_build *shape = &b->shapes[p];
    bool backdrop = b->objects.shapes.data[p].layer == PROM_LAYER_BACKDROP;
    fill_prototype(b, p);
    s->prototype = p;
    s->views_key = shape->views_key = prom_key_of_leaf_views(b, p);
    s->key = prom_key_of_measured(b, s->views_key);
    for (uint32_t l = 0; l < shape->level_count; l++) {
        prom_level *level = &shape->levels[l];
        prom_representation rep = {.kind = PROM_REP_MESH,
                                   .texture = PROM_NONE,
                                   .flags = level->artist ? PROM_REP_ARTIST : 0,
                                   .level = l,
                                   .error = level->error,
                                   .switch_distance = level->switch_distance};
        prom_subject_add(s, &level->mesh, &rep,
                         backdrop ? PROM_ADMIT_UNMEASURED
                         : l == 0 ? PROM_ADMIT_TRUTH
                                  : PROM_ADMIT_MEASURED);
        // Clusters are measured against these.
        level->device_id = prom_renderer_add_mesh(b->renderer, &level->mesh);
        if (level->device_id == PROM_NONE) return prom_build_device_full("meshes", error);
    }
    prom_array_push(&s->items,
                    prom_item_around(shape->levels[0].device_id, b->prototypes[p].center));
    return PROM_OK;
}

// Where a level costs as little, a box would only show less.
static bool as_cheap_as_a_box(const prom_mesh *mesh)
{
    return mesh->index_count / 3 <= PROM_LEVEL_MIN_TRIANGLES && mesh->submesh_count == 1;
}

static prom_status draw(prom_subject *s, uint32_t p, prom_error *error)
{
    prom_build_state *b = s->build;
    const prom_shape_build *shape = &b->shapes[p];
    prom_layer layer = b->objects.shapes.data[p].layer;
    if (layer == PROM_LAYER_BACKDROP) return PROM_OK;
    prom_subject_take_truth(s);
    for (uint32_t l = 1; l < shape->level_count; l++) {
        prom_status status = prom_subject_take_views(s, l, shape->levels[l].device_id, error);
        if (status) return status;
    }
    if (layer != PROM_LAYER_OBJECT ||
        as_cheap_as_a_box(&shape->levels[shape->level_count - 1].mesh))
        return PROM_OK;
    return prom_subject_add_boxes(s, false, error);
}

// The level that was to be as cheap as a box may have turned out to be of no use.
static prom_status amend(prom_subject *s, uint32_t p, prom_error *error)
{
    if (s->build->objects.shapes.data[p].layer != PROM_LAYER_OBJECT) return PROM_OK;
    if (s->first_made < s->count) return PROM_OK;
    uint32_t cheapest = s->count - 1;
    while (!s->candidates[cheapest].kept) cheapest--; // the object itself is
    if (as_cheap_as_a_box(s->candidates[cheapest].mesh)) return PROM_OK;
    return prom_subject_add_boxes(s, false, error);
}

static void settled(prom_subject *s, uint32_t p)
{
    prom_shape_build *shape = &s->build->shapes[p];
    for (uint32_t l = 0; l < shape->level_count; l++) {
        prom_level *level = &shape->levels[l];
        level->kept = s->candidates[l].kept;
        level->max_size_px = s->candidates[l].rep.max_size_px;
        prom_mesh_finish(&level->mesh); // it is in the container and on the device
    }
}

// Pictures of a prototype: the box's, or the atlases of a cluster's meshes.
typedef struct candidate {
    double value; // triangles replaced per byte
    double bytes;
    uint32_t index; // shapes, then clusters
    bool atlas;
} candidate;

static int by_value(const void *a, const void *b)
{
    const candidate *x = a, *y = b;
    if (x->value != y->value) return x->value > y->value ? -1 : 1;
    if (x->atlas != y->atlas) return x->atlas ? 1 : -1;
    return (x->index > y->index) - (x->index < y->index);
}

// Which prototypes get textured boxes, which clusters atlases: those that replace most
// triangles per byte, within the byte budget of the device.
static void plan_pictures(prom_build_state *b)
{
    const double texel_bytes = 4.0 * 4.0 / 3.0; // with mips
    const double face_bytes = PROM_FACE_PX * PROM_FACE_PX * texel_bytes;
    const double shape_bytes = 12 * face_bytes, cluster_bytes = 6 * face_bytes;
    double atlas_bytes = 0;
    for (uint32_t l = 0; l < PROM_CLUSTER_LEVELS; l++)
        atlas_bytes += texel_bytes * PROM_ATLAS_PX(l) * PROM_ATLAS_PX(l);
    PROM_ARRAY(candidate) list = {0};
    size_t shape_count = b->objects.shapes.count, cluster_count = b->tree.clusters.count;
    b->boxed = prom_calloc(shape_count + cluster_count, sizeof *b->boxed);
    b->atlased = prom_calloc(shape_count + cluster_count, sizeof *b->atlased);
    for (size_t i = 0; i < shape_count; i++) {
        const prom_shape *s = &b->objects.shapes.data[i];
        uint32_t triangles = b->shapes[i].levels[0].mesh.index_count / 3;
        if (s->layer == PROM_LAYER_OBJECT && triangles >= BOXED_TRIANGLES)
            prom_array_push(&list, (candidate){(double)triangles * s->instances / shape_bytes,
                                               shape_bytes, (uint32_t)i, false});
    }
    for (size_t i = 0; i < cluster_count; i++) {
        const prom_tree_cluster *c = &b->tree.clusters.data[i];
        if (c->mixed || c->layer == PROM_LAYER_BLENDED) continue;
        double triangles = (double)PROM_CLUSTER_TRIANGLES * c->instances;
        uint32_t index = (uint32_t)(shape_count + i);
        if (c->layer == PROM_LAYER_OBJECT) // its own mesh is what a box replaces
            prom_array_push(
                &list, (candidate){triangles / cluster_bytes, cluster_bytes, index, false});
        prom_array_push(&list, (candidate){triangles / atlas_bytes, atlas_bytes, index, true});
    }
    if (list.count) qsort(list.data, list.count, sizeof *list.data, by_value);
    double left = (b->options->texture_mb) * 1048576.0;
    size_t refused = 0;
    for (size_t i = 0; i < list.count; i++) {
        const candidate *c = &list.data[i];
        bool fits = c->bytes <= left;
        if (fits) left -= c->bytes;
        refused += !fits;
        (c->atlas ? b->atlased : b->boxed)[c->index] = fits;
    }
    if (refused)
        prom_log(PROM_LOG_INFO,
                 "textured boxes and atlases: %zu of %zu do not fit --texture-mb; raise it to "
                 "keep them",
                 refused, list.count);
    prom_array_finish(&list);
}

prom_status prom_stage_leaves(prom_build_state *b, prom_error *error)
{
    static const prom_subject_class leaf = {
        PROM_UNIT_LEAF, PROM_UNIT_LEAF_VIEWS, begin, draw, amend, settled};
    uint32_t count = (uint32_t)b->objects.shapes.count;
    plan_pictures(b);
    b->measure = prom_measure_create(&b->options->measure, b->mean_luminance);
    b->pool = prom_pool_create();
    prom_progress progress;
    prom_progress_begin(&progress, "leaves", count);
    prom_status status = prom_subjects_run(b, &leaf, NULL, count, &progress, error);
    if (!status) prom_build_end_progress(b, &progress);
    return status;
}
