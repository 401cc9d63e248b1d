// Clusters, upwards: merged meshes on all cores, then coverage, shares, impostors and accuracy
// on the device. The truth that a cluster is measured against is its leaves, each at a level
// whose error stays under half a pixel of the view.
#include "builder/subject.h"

#include "builder/cluster_mesh.h"

#define FINE_SHARE 4u   // the fine mesh has this part of its pieces' triangles
#define COARSE_SHARE 8u // and the coarse one this part of the fine
#define FINE_MIN 32u
#define COARSE_MIN 24u
#define TRUTH_ERROR_PX 0.5f

// What a cluster's meshes are made of, and the key of that.
typedef struct pieces {
    PROM_ARRAY(prom_cluster_piece) list;
    uint64_t key;
} pieces;

// A mesh, the result of unit `key`, that stands at `at` in the world, in the frame at `origin`.
static void add_piece(pieces *p, const prom_mesh *mesh, float error, uint64_t key,
                      const prom_placement *at, const double origin[3])
{
    prom_cluster_piece piece = {mesh, error, *at};
    for (int a = 0; a < 3; a++) piece.placement.origin[a] -= origin[a];
    prom_array_push(&p->list, piece);
    prom_key_add_placed(&p->key, key, piece.placement.origin, piece.placement.basis);
}

static void collect_pieces(const prom_build_state *b, uint32_t node, const double origin[3],
                           pieces *p)
{
    const prom_tree_node *n = &b->tree.nodes.data[node];
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) {
        const prom_tree_node *child = &b->tree.nodes.data[c];
        if (child->object != PROM_NONE) {
            const prom_object *object = &b->objects.objects.data[child->object];
            const prom_shape_build *s = &b->shapes[object->shape];
            if (s->merge.index_count)
                add_piece(p, &s->merge, s->merge_error, s->levels_key, &object->placement,
                          origin);
            continue;
        }
        const prom_cluster_build *cluster = &b->clusters[child->cluster];
        if (cluster->level_count) {
            prom_placement at = prom_placement_identity;
            memcpy(at.origin, child->origin, sizeof at.origin);
            add_piece(p, &cluster->levels[0], cluster->errors[0], cluster->merge_key, &at,
                      origin);
        } else {
            collect_pieces(b, c, origin, p);
        }
    }
}

static uint32_t clamped(uint32_t value, uint32_t least, uint32_t most)
{
    return value < least ? least : value > most ? most : value;
}

typedef struct merge_job {
    prom_build_state *b;
    const uint32_t *clusters;
} merge_job;

static void make_meshes(const pieces *p, bool surface, prom_cluster_build *out)
{
    uint32_t total = 0;
    for (size_t i = 0; i < p->list.count; i++) total += p->list.data[i].mesh->index_count / 3;
    uint32_t target = clamped(total / FINE_SHARE, FINE_MIN, PROM_CLUSTER_TRIANGLES);
    if (prom_cluster_mesh_make(p->list.data, p->list.count, surface, target, &out->levels[0],
                               &out->errors[0]))
        out->level_count = 1;
    if (!out->level_count) return;

    uint32_t fine = out->levels[0].index_count / 3;
    if (fine / COARSE_SHARE < COARSE_MIN) return;
    prom_cluster_piece whole = {&out->levels[0], out->errors[0], prom_placement_identity};
    if (prom_cluster_mesh_make(&whole, 1, surface, fine / COARSE_SHARE, &out->levels[1],
                               &out->errors[1])) {
        if (out->levels[1].index_count < out->levels[0].index_count)
            out->level_count = 2;
        else
            prom_mesh_finish(&out->levels[1]);
    }
}

static void pack_meshes(const prom_cluster_build *c, prom_pack *pack)
{
    prom_pack_bytes(pack, &c->level_count, sizeof c->level_count);
    for (uint32_t l = 0; l < c->level_count; l++) {
        prom_pack_bytes(pack, &c->errors[l], sizeof c->errors[l]);
        prom_pack_mesh(pack, &c->levels[l]);
    }
}

static bool unpack_meshes(prom_cluster_build *c, const prom_pack *pack)
{
    prom_unpack in = {.at = pack->data, .left = pack->count};
    c->level_count = prom_unpack_u32(&in, PROM_CLUSTER_LEVELS);
    for (uint32_t l = 0; l < c->level_count; l++) {
        prom_unpack_bytes(&in, &c->errors[l], sizeof c->errors[l]);
        prom_unpack_mesh(&in, 0, &c->levels[l]);
    }
    if (prom_unpack_end(&in)) return true;
    for (uint32_t l = 0; l < PROM_CLUSTER_LEVELS; l++) prom_mesh_finish(&c->levels[l]);
    c->level_count = 0;
    return false;
}

// Blended things are never inside a picture, and things of several layers have none.
static bool has_pictures(const prom_tree_cluster *cluster)
{
    return !cluster->mixed && cluster->layer != PROM_LAYER_BLENDED;
}

static void merge_cluster(void *user, size_t i, unsigned thread)
{
    (void)thread;
    merge_job *job = user;
    prom_build_state *b = job->b;
    const prom_tree_cluster *cluster = &b->tree.clusters.data[job->clusters[i]];
    prom_cluster_build *out = &b->clusters[job->clusters[i]];
    if (!has_pictures(cluster) || prom_build_goes_on(b, NULL)) return;
    pieces p = {.key = prom_key_of_merge(b, job->clusters[i])};
    collect_pieces(b, cluster->node, b->tree.nodes.data[cluster->node].origin, &p);
    out->merge_key = p.key;
    prom_pack pack = {0};
    if (!prom_store_get(b->store, PROM_UNIT_MERGE, p.key, &pack) ||
        !unpack_meshes(out, &pack)) {
        make_meshes(&p, cluster->layer == PROM_LAYER_SURFACE, out);
        pack.count = 0;
        pack_meshes(out, &pack);
        prom_build_keep(b, PROM_UNIT_MERGE, p.key, &pack);
    }
    prom_array_finish(&pack);
    prom_array_finish(&p.list);
    for (uint32_t l = 0; l < out->level_count; l++)
        out->hash = prom_mesh_hash(&out->levels[l], out->hash);
}

static prom_status merge_row(prom_build_state *b, const uint32_t *clusters, size_t count,
                             prom_error *error)
{
    merge_job job = {.b = b, .clusters = clusters};
    prom_parallel_for(count, merge_cluster, &job);
    return prom_build_goes_on(b, error);
}

// The coarsest level that is as good as the object in views of px_per_unit.
static uint32_t level_for(const prom_build_state *b, const prom_object *object,
                          float px_per_unit)
{
    const prom_shape_build *s = &b->shapes[object->shape];
    float scale = prom_basis_scale(object->placement.basis);
    uint32_t level = 0;
    float size_px = 2.0f * b->prototypes[object->shape].radius * scale * px_per_unit;
    for (uint32_t l = 1; l < s->level_count; l++)
        if (s->levels[l].kept && !s->levels[l].artist && size_px <= s->levels[l].max_size_px &&
            s->levels[l].error * scale * px_per_unit <= TRUTH_ERROR_PX)
            level = l;
    return level;
}

// The item of a leaf around `center` (world), in views of px_per_unit.
static prom_draw_item true_item(const prom_build_state *b, const prom_object *object,
                                uint32_t id, const double origin[3], float px_per_unit)
{
    uint32_t level = level_for(b, object, px_per_unit);
    prom_draw_item item = {.mesh = b->shapes[object->shape].levels[level].device_id,
                           .texture = PROM_NONE,
                           .id = id};
    for (int a = 0; a < 3; a++) item.origin[a] = (float)origin[a];
    memcpy(item.basis, object->placement.basis, sizeof item.basis);
    return item;
}

// All leaves below `node`, around `center` (world), with one id, to the subject's items and
// key.
static void collect_truth(prom_subject *s, uint32_t node, uint32_t id, const double center[3],
                          float px_per_unit)
{
    const float larger = (float)PROM_VIEW_LARGE_PX / PROM_VIEW_PX;
    const prom_build_state *b = s->build;
    const prom_tree_node *n = &b->tree.nodes.data[node];
    if (n->object == PROM_NONE) {
        for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++)
            collect_truth(s, c, id, center, px_per_unit);
        return;
    }
    const prom_object *object = &b->objects.objects.data[n->object];
    double origin[3];
    for (int a = 0; a < 3; a++) origin[a] = object->placement.origin[a] - center[a];
    const prom_prototype *proto = &b->prototypes[object->shape];
    prom_sphere sphere = {.radius = proto->radius * prom_basis_scale(object->placement.basis)};
    prom_basis_apply(object->placement.basis, proto->center, sphere.center);
    for (int a = 0; a < 3; a++) sphere.center[a] += (float)origin[a];
    prom_array_push(&s->item_spheres, sphere);
    prom_array_push(&s->items, true_item(b, object, id, origin, px_per_unit));
    prom_array_push(&s->large_items, true_item(b, object, id, origin, larger * px_per_unit));
    prom_key_add_placed(&s->views_key, b->shapes[object->shape].views_key + id, origin,
                        object->placement.basis);
}

static void collect_children(prom_subject *s, uint32_t node)
{
    const prom_build_state *b = s->build;
    const prom_tree_node *n = &b->tree.nodes.data[node];
    float px_per_unit = PROM_VIEW_PX / (2.0f * b->prototypes[s->prototype].radius);
    for (uint32_t c = 0; c < n->child_count; c++)
        collect_truth(s, n->first_child + c, c, b->model.center[node], px_per_unit);
}

static prom_status begin(prom_subject *s, uint32_t index, prom_error *error)
{
    (void)error;
    prom_build_state *b = s->build;
    const prom_tree_cluster *cluster = &b->tree.clusters.data[index];
    prom_cluster_build *meshes = &b->clusters[index];
    s->prototype = (uint32_t)b->objects.shapes.count + index;
    prom_prototype *proto = &b->prototypes[s->prototype];
    proto->flags = PROM_PROTO_CLUSTER;
    if (!cluster->mixed && cluster->layer == PROM_LAYER_SURFACE)
        proto->flags |= PROM_PROTO_SURFACE;
    if (!cluster->mixed && cluster->layer == PROM_LAYER_BLENDED)
        proto->flags |= PROM_PROTO_BLENDED;
    s->views_key = prom_key_of_cluster_views(b, index);
    collect_children(s, cluster->node);
    s->key = prom_key_of_measured(b, s->views_key);
    s->child_count = cluster->child_count;
    s->shares = prom_calloc(s->child_count, sizeof *s->shares);
    for (uint32_t l = 0; l < meshes->level_count; l++) {
        prom_representation rep = {.kind = PROM_REP_MESH,
                                   .texture = PROM_NONE,
                                   .level = l,
                                   .error = meshes->errors[l],
                                   .switch_distance = INFINITY};
        prom_subject_add(s, &meshes->levels[l], &rep, PROM_ADMIT_MEASURED);
    }
    return PROM_OK;
}

static prom_status draw(prom_subject *s, uint32_t index, prom_error *error)
{
    const prom_tree_cluster *cluster = &s->build->tree.clusters.data[index];
    prom_subject_take_truth(s);
    prom_status status = PROM_OK;
    for (uint32_t l = 0; l < s->count && !status; l++)
        status = prom_subject_take_views(s, l, PROM_NONE, error);
    if (!status) status = prom_subject_add_atlases(s, error);
    // The captures show the truth.
    if (!status && has_pictures(cluster) && cluster->layer == PROM_LAYER_OBJECT)
        status = prom_subject_add_boxes(s, true, error);
    return status;
}

// ---- meshes are freed once no higher cluster needs them

static uint32_t prototype_of(const prom_build_state *b, const prom_tree_node *node)
{
    return node->object != PROM_NONE ? b->objects.objects.data[node->object].shape
                                     : (uint32_t)b->objects.shapes.count + node->cluster;
}

// The children of a cluster are needed at `height`; instead of one that turned out to have no
// mesh (once they are made) its own children.
static void need_children(const prom_build_state *b, uint32_t cluster, uint32_t height,
                          bool made, uint32_t *last_need)
{
    const prom_tree_node *n = &b->tree.nodes.data[b->tree.clusters.data[cluster].node];
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) {
        const prom_tree_node *child = &b->tree.nodes.data[c];
        uint32_t p = prototype_of(b, child);
        if (last_need[p] >= height) continue;
        last_need[p] = height;
        if (made && child->object == PROM_NONE && !b->clusters[child->cluster].level_count)
            need_children(b, child->cluster, height, made, last_need);
    }
}

// Per prototype, the height of the highest cluster that is made of it.
static uint32_t *find_last_needs(const prom_build_state *b)
{
    size_t clusters = b->tree.clusters.count;
    uint32_t *last_need = prom_calloc(b->objects.shapes.count + clusters, sizeof *last_need);
    for (uint32_t c = 0; c < clusters; c++)
        need_children(b, c, b->tree.clusters.data[c].height, false, last_need);
    return last_need;
}

static void free_meshes(prom_build_state *b, uint32_t height, const uint32_t *last_need)
{
    const size_t shapes = b->objects.shapes.count;
    for (size_t i = 0; i < shapes; i++)
        if (last_need[i] <= height) prom_mesh_finish(&b->shapes[i].merge);
    for (size_t i = 0; i < b->tree.clusters.count; i++) {
        if (b->tree.clusters.data[i].height > height) continue;
        prom_mesh_finish(&b->clusters[i].levels[1]); // no cluster is made of coarse ones
        if (last_need[shapes + i] <= height) prom_mesh_finish(&b->clusters[i].levels[0]);
    }
}

// The clusters of one height: those below are done.
static prom_status run_row(prom_build_state *b, const uint32_t *clusters, uint32_t count,
                           uint32_t *last_need, prom_progress *progress, prom_error *error)
{
    static const prom_subject_class class = {
        PROM_UNIT_CLUSTER, PROM_UNIT_CLUSTER_VIEWS, begin, draw, NULL, NULL};
    prom_status status = merge_row(b, clusters, count, error);
    if (status) return status;
    for (uint32_t i = 0; i < count; i++) {
        uint32_t c = clusters[i], p = (uint32_t)b->objects.shapes.count + c;
        if (!b->clusters[c].level_count) need_children(b, c, last_need[p], true, last_need);
    }
    return prom_subjects_run(b, &class, clusters, count, progress, error);
}

prom_status prom_stage_clusters(prom_build_state *b, prom_error *error)
{
    size_t count = b->tree.clusters.count;
    prom_build_place_nodes(b);
    b->clusters = prom_calloc(count, sizeof *b->clusters);
    uint32_t *last_need = find_last_needs(b);
    prom_progress progress;
    prom_progress_begin(&progress, "clusters", count);
    PROM_ARRAY(uint32_t) row = {0}; // clusters of one height
    prom_status status = PROM_OK;
    size_t done = 0;
    for (uint32_t height = 1; done < count && !status; height++) {
        row.count = 0;
        for (uint32_t c = 0; c < count; c++)
            if (b->tree.clusters.data[c].height == height) prom_array_push(&row, c);
        status = run_row(b, row.data, (uint32_t)row.count, last_need, &progress, error);
        free_meshes(b, height, last_need);
        done += row.count;
    }
    prom_array_finish(&row);
    prom_free(last_need);
    if (!status) prom_build_end_progress(b, &progress);
    return status;
}
