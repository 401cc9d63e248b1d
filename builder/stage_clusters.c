// Clusters, upwards: merged meshes on all cores, then coverage, shares, impostors and accuracy
// on the device. The truth that a cluster is measured against is its leaves, each at a level
// whose error stays under half a pixel of the largest view.
#include "builder/build.h"

#include "builder/cluster_mesh.h"
#include "metaobj/base/log.h"
#include "metaobj/base/threads.h"

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
} merge_job;

static void merge_cluster(void *user, size_t i, unsigned thread)
{
    (void)thread;
    const merge_job *job = user;
    prom_build_state *b = job->b;
    uint32_t index = job->clusters[i];
    const prom_tree_cluster *cluster = &b->tree.clusters.data[index];
    prom_cluster_build *out = &b->clusters[index];
    bool surface = cluster->layer == PROM_LAYER_SURFACE;
    if (cluster->mixed || cluster->layer == PROM_LAYER_BLENDED) return;

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
        if (s->mesh_ids[l] != PROM_NONE && size_px <= s->max_size_px[l] &&
            s->errors[l] * scale * px_per_unit <= TRUTH_ERROR_PX)
            level = l;
    prom_draw_item item = {.mesh = s->mesh_ids[level], .texture = PROM_NONE, .id = id};
    for (int a = 0; a < 3; a++)
        item.origin[a] = (float)(object->placement.origin[a] - center[a]);
    memcpy(item.basis, object->placement.basis, sizeof item.basis);
    prom_array_push(items, item);
}

static void measure_truth(prom_build_state *b, uint32_t p, uint32_t node, item_list *items)
{
    prom_prototype *proto = &b->prototypes[p];
    const prom_tree_node *n = &b->tree.nodes.data[node];
    float px_per_unit = PROM_VIEW_PX / (2.0f * proto->radius);
    items->count = 0;
    for (uint32_t c = 0; c < n->child_count; c++)
        collect_truth(b, n->first_child + c, c, b->model.center[node], px_per_unit, items);
    prom_baker_set_subject(b->baker, items->data, items->count);
    prom_baker_take_views(b->baker, proto->radius, &b->truth);
    prom_measure_set_truth(b->measure, &b->truth, b->coverage[p]);
    proto->first_share = (uint32_t)b->shares.count;
    proto->child_count = n->child_count;
    struct prom_share_row *rows = prom_array_extend(&b->shares, n->child_count);
    prom_measure_shares(&b->truth, n->child_count, (uint16_t(*)[PROM_DIRS])rows);
}

static prom_status add_meshes(prom_build_state *b, uint32_t index, uint32_t p,
                              prom_error *error)
{
    const prom_cluster_build *cluster = &b->clusters[index];
    for (uint32_t l = 0; l < cluster->level_count; l++) {
        prom_representation rep = {.kind = PROM_REP_MESH,
                                   .texture = PROM_NONE,
                                   .level = l,
                                   .error = cluster->errors[l]};
        prom_status status = prom_build_add_rep(b, p, &cluster->levels[l], &rep,
                                                PROM_ADMIT_MEASURED, NULL, error);
        if (status) return status;
    }
    return PROM_OK;
}

static prom_status add_cluster(prom_build_state *b, uint32_t index, item_list *items,
                               prom_error *error)
{
    const prom_tree_cluster *cluster = &b->tree.clusters.data[index];
    uint32_t p = (uint32_t)b->objects.shapes.count + index;
    prom_prototype *proto = &b->prototypes[p];
    proto->flags = PROM_PROTO_CLUSTER;
    if (!cluster->mixed && cluster->layer == PROM_LAYER_SURFACE)
        proto->flags |= PROM_PROTO_SURFACE;
    if (!cluster->mixed && cluster->layer == PROM_LAYER_BLENDED)
        proto->flags |= PROM_PROTO_BLENDED;
    measure_truth(b, p, cluster->node, items);
    if (cluster->mixed || cluster->layer == PROM_LAYER_BLENDED) return PROM_OK;
    prom_status status = add_meshes(b, index, p, error);
    if (status || cluster->layer != PROM_LAYER_OBJECT) return status;
    prom_baker_set_subject(b->baker, items->data, items->count); // the captures show the truth
    return prom_build_add_boxes(b, p, proto->center, proto->half, proto->radius, true,
                                b->boxed[p], error);
}

prom_status prom_stage_clusters(prom_build_state *b, prom_error *error)
{
    size_t count = b->tree.clusters.count;
    prom_build_place_nodes(b);
    b->clusters = prom_calloc(count, sizeof *b->clusters);
    prom_progress progress;
    prom_progress_begin(&progress, "clusters", count);
    item_list items = {0};
    PROM_ARRAY(uint32_t) row = {0}; // clusters of one height
    prom_status status = PROM_OK;
    size_t done = 0;
    for (uint32_t height = 1; done < count && !status; height++) {
        row.count = 0;
        for (uint32_t c = 0; c < count; c++)
            if (b->tree.clusters.data[c].height == height) prom_array_push(&row, c);
        merge_job job = {.b = b, .clusters = row.data};
        prom_parallel_for(row.count, merge_cluster, &job);
        for (size_t i = 0; i < row.count && !status; i++) {
            status = add_cluster(b, row.data[i], &items, error);
            prom_progress_step(&progress, 1);
        }
        done += row.count;
    }
    prom_array_finish(&row);
    prom_array_finish(&items);
    if (!status) prom_progress_end(&progress);
    return status;
}
