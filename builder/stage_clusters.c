// Clusters, upwards: merged meshes on all cores, then coverage, shares, impostors and accuracy
// on the device. The truth that a cluster is measured against is its leaves, each at a level
// whose error stays under half a pixel of the largest view.
#include "builder/subject.h"

#include "builder/cluster_mesh.h"

#include <pthread.h>

#define FINE_SHARE 4u   // the fine mesh has this part of its pieces' triangles
#define COARSE_SHARE 8u // and the coarse one this part of the fine
#define FINE_MIN 32u
#define COARSE_MIN 24u
#define TRUTH_ERROR_PX 0.5f

typedef PROM_ARRAY(prom_cluster_piece) piece_list;
typedef PROM_ARRAY(prom_draw_item) item_list;

// The placement of an object, or of a cluster, in the frame at `origin`.
static prom_placement relative_to(const prom_placement *placement, const double origin[3])
{
    prom_placement p = *placement;
    for (int a = 0; a < 3; a++) p.origin[a] -= origin[a];
    return p;
}

static void collect_pieces(const prom_build_state *b, uint32_t node, const double origin[3],
                           piece_list *pieces)
{
    const prom_tree_node *n = &b->tree.nodes.data[node];
    for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++) {
        const prom_tree_node *child = &b->tree.nodes.data[c];
        if (child->object != PROM_NONE) {
            const prom_object *object = &b->objects.objects.data[child->object];
            const prom_shape_build *s = &b->shapes[object->shape];
            if (s->merge.index_count)
                prom_array_push(pieces,
                                (prom_cluster_piece){&s->merge, s->merge_error,
                                                     relative_to(&object->placement, origin)});
            continue;
        }
        const prom_cluster_build *cluster = &b->clusters[child->cluster];
        if (cluster->level_count) {
            prom_placement at = prom_placement_identity;
            memcpy(at.origin, child->origin, sizeof at.origin);
            prom_array_push(pieces,
                            (prom_cluster_piece){&cluster->levels[0], cluster->errors[0],
                                                 relative_to(&at, origin)});
        } else {
            collect_pieces(b, c, origin, pieces);
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
    pthread_mutex_t lock;
    prom_error error; // the first
} merge_job;

static void make_meshes(prom_build_state *b, const prom_tree_cluster *cluster,
                        prom_cluster_build *out)
{
    bool surface = cluster->layer == PROM_LAYER_SURFACE;
    const prom_tree_node *node = &b->tree.nodes.data[cluster->node];
    piece_list pieces = {0};
    collect_pieces(b, cluster->node, node->origin, &pieces);
    uint32_t total = 0;
    for (size_t p = 0; p < pieces.count; p++) total += pieces.data[p].mesh->index_count / 3;
    uint32_t target = clamped(total / FINE_SHARE, FINE_MIN, PROM_CLUSTER_TRIANGLES);
    if (prom_cluster_mesh_make(pieces.data, pieces.count, surface, target, &out->levels[0],
                               &out->errors[0]))
        out->level_count = 1;
    prom_array_finish(&pieces);
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
        prom_unpack_mesh(&in, &c->levels[l]);
    }
    if (prom_unpack_end(&in)) return true;
    for (uint32_t l = 0; l < PROM_CLUSTER_LEVELS; l++) {
        prom_mesh_finish(&c->levels[l]);
        c->levels[l] = (prom_mesh){0};
    }
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
    out->merge_key = prom_key_of_merge(b, job->clusters[i]);
    if (!has_pictures(cluster)) return;
    prom_pack pack = {0};
    if (!prom_store_get(b->store, PROM_UNIT_MERGE, out->merge_key, &pack) ||
        !unpack_meshes(out, &pack)) {
        prom_error error = {0};
        make_meshes(b, cluster, out);
        pack.count = 0;
        pack_meshes(out, &pack);
        if (prom_store_put(b->store, PROM_UNIT_MERGE, out->merge_key, &pack, &error)) {
            pthread_mutex_lock(&job->lock);
            if (!job->error.status) job->error = error;
            pthread_mutex_unlock(&job->lock);
        }
    }
    prom_array_finish(&pack);
    for (uint32_t l = 0; l < out->level_count; l++)
        out->hash = prom_mesh_hash(&out->levels[l], out->hash);
}

static prom_status merge_row(prom_build_state *b, const uint32_t *clusters, size_t count,
                             prom_error *error)
{
    merge_job job = {.b = b, .clusters = clusters, .lock = PTHREAD_MUTEX_INITIALIZER};
    prom_parallel_for(count, merge_cluster, &job);
    if (job.error.status) *error = job.error;
    return job.error.status;
}

// Items of all leaves below `node`, around `center` (world), with one id, each at the coarsest
// level that is as good as the object in views of px_per_unit.
static void collect_truth(const prom_build_state *b, uint32_t node, uint32_t id,
                          const double center[3], float px_per_unit, item_list *items)
{
    const prom_tree_node *n = &b->tree.nodes.data[node];
    if (n->object == PROM_NONE) {
        for (uint32_t c = n->first_child; c < n->first_child + n->child_count; c++)
            collect_truth(b, c, id, center, px_per_unit, items);
        return;
    }
    const prom_object *object = &b->objects.objects.data[n->object];
    const prom_shape_build *s = &b->shapes[object->shape];
    float scale = prom_basis_scale(object->placement.basis);
    uint32_t level = 0;
    float size_px = 2.0f * b->prototypes[object->shape].radius * scale * px_per_unit;
    for (uint32_t l = 1; l < s->level_count; l++)
        if (s->levels[l].kept && !s->levels[l].artist && size_px <= s->levels[l].max_size_px &&
            s->levels[l].error * scale * px_per_unit <= TRUTH_ERROR_PX)
            level = l;
    prom_draw_item item = {.mesh = s->levels[level].device_id, .texture = PROM_NONE, .id = id};
    for (int a = 0; a < 3; a++)
        item.origin[a] = (float)(object->placement.origin[a] - center[a]);
    memcpy(item.basis, object->placement.basis, sizeof item.basis);
    prom_array_push(items, item);
}

static void collect_items(const prom_build_state *b, const prom_subject *s,
                          const prom_tree_cluster *cluster, item_list *items)
{
    const prom_tree_node *n = &b->tree.nodes.data[cluster->node];
    float px_per_unit = PROM_VIEW_PX / (2.0f * b->prototypes[s->prototype].radius);
    for (uint32_t c = 0; c < n->child_count; c++)
        collect_truth(b, n->first_child + c, c, b->model.center[cluster->node], px_per_unit,
                      items);
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
    s->key = meshes->cluster_key = prom_key_of_cluster(b, index);
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
    prom_build_state *b = s->build;
    const prom_tree_cluster *cluster = &b->tree.clusters.data[index];
    item_list items = {0};
    collect_items(b, s, cluster, &items);
    prom_baker_set_subject(b->baker, items.data, items.count);
    prom_subject_take_truth(s, true);
    prom_status status = PROM_OK;
    for (uint32_t l = 0; l < s->count && !status; l++)
        status = prom_subject_take_views(s, l, PROM_NONE, error);
    // The captures show the truth.
    if (!status && has_pictures(cluster) && cluster->layer == PROM_LAYER_OBJECT)
        status = prom_subject_add_boxes(s, items.data, items.count, true, error);
    prom_array_finish(&items);
    return status;
}

prom_status prom_stage_clusters(prom_build_state *b, prom_error *error)
{
    static const prom_subject_class class = {PROM_UNIT_CLUSTER, begin, draw, NULL, NULL};
    size_t count = b->tree.clusters.count;
    prom_build_place_nodes(b);
    b->clusters = prom_calloc(count, sizeof *b->clusters);
    prom_progress progress;
    prom_progress_begin(&progress, "clusters", count);
    PROM_ARRAY(uint32_t) row = {0}; // clusters of one height
    prom_status status = PROM_OK;
    size_t done = 0;
    for (uint32_t height = 1; done < count && !status; height++) {
        row.count = 0;
        for (uint32_t c = 0; c < count; c++)
            if (b->tree.clusters.data[c].height == height) prom_array_push(&row, c);
        status = merge_row(b, row.data, row.count, error);
        if (!status)
            status =
                prom_subjects_run(b, &class, row.data, (uint32_t)row.count, &progress, error);
        done += row.count;
    }
    prom_array_finish(&row);
    if (!status) prom_build_end_progress(b, &progress);
    return status;
}
