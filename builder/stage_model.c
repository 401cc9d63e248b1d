// The tree as the model's nodes, and everything gathered so far as the model's tables.
#include "builder/build.h"

static void place_object(const prom_build_state *b, prom_model *m, uint32_t node,
                         uint32_t object)
{
    const prom_object *o = &b->objects.objects.data[object];
    m->prototype[node] = o->shape;
    m->name[node] = o->name;
    m->placement[node] = o->placement;
}

void prom_build_place_nodes(prom_build_state *b)
{
    prom_model *m = &b->model;
    uint32_t tree_count = (uint32_t)b->tree.nodes.count;
    uint32_t count = tree_count + (uint32_t)b->tree.backdrop_objects.count;
    uint32_t shape_count = (uint32_t)b->objects.shapes.count;
    m->tree_count = tree_count;
    m->node_count = count;
    m->parent = prom_arena_alloc(&m->arena, count, sizeof *m->parent);
    m->first_child = prom_arena_alloc(&m->arena, count, sizeof *m->first_child);
    m->child_count = prom_arena_alloc(&m->arena, count, sizeof *m->child_count);
    m->prototype = prom_arena_alloc(&m->arena, count, sizeof *m->prototype);
    m->name = prom_arena_alloc(&m->arena, count, sizeof *m->name);
    m->placement = prom_arena_alloc(&m->arena, count, sizeof *m->placement);
    m->center = prom_arena_alloc(&m->arena, count, sizeof *m->center);
    m->half = prom_arena_alloc(&m->arena, count, sizeof *m->half);
    m->radius = prom_arena_alloc(&m->arena, count, sizeof *m->radius);
    m->weight = prom_arena_alloc(&m->arena, count, sizeof *m->weight);
    for (uint32_t i = 0; i < count; i++) m->weight[i] = 1.0f;
    for (uint32_t i = 0; i < tree_count; i++) {
        const prom_tree_node *n = &b->tree.nodes.data[i];
        bool leaf = n->object != PROM_NONE;
        m->parent[i] = n->parent;
        m->first_child[i] = leaf ? PROM_NONE : n->first_child;
        m->child_count[i] = leaf ? 0 : n->child_count;
        if (leaf) {
            place_object(b, m, i, n->object);
        } else {
            m->prototype[i] = shape_count + n->cluster;
            m->placement[i] = prom_placement_identity;
            memcpy(m->placement[i].origin, n->origin, sizeof n->origin);
        }
    }
    for (uint32_t i = tree_count; i < count; i++) {
        m->parent[i] = m->first_child[i] = PROM_NONE;
        place_object(b, m, i, b->tree.backdrop_objects.data[i - tree_count]);
    }
    m->prototypes = b->prototypes;
    m->prototype_count = shape_count + (uint32_t)b->tree.clusters.count;
    prom_model_update_bounds(m);
    for (size_t c = 0; c < b->tree.clusters.count; c++) {
        prom_prototype *proto = &b->prototypes[shape_count + c];
        uint32_t node = b->tree.clusters.data[c].node;
        for (int a = 0; a < 3; a++) {
            proto->center[a] = (float)(m->center[node][a] - m->placement[node].origin[a]);
            proto->half[a] = m->half[node][a];
        }
        proto->radius = m->radius[node];
    }
}

// Leaves and the background by the scene's nodes; clusters have no weight of their own.
static void weigh(prom_build_state *b)
{
    prom_weight_rules rules = b->options->weights; // takes note of what matches
    prom_model *m = &b->model;
    float *weights = prom_alloc(b->source.nodes.count, sizeof *weights);
    for (size_t i = 0; i < b->source.nodes.count; i++) {
        const prom_source_node *n = &b->source.nodes.data[i];
        float above = n->parent == PROM_NONE ? 1.0f : weights[n->parent];
        weights[i] = prom_weight_of_name(&rules, n->name ? n->name : "", above);
    }
    for (uint32_t i = 0; i < m->node_count; i++) {
        uint32_t object = i < m->tree_count ? b->tree.nodes.data[i].object
                                            : b->tree.backdrop_objects.data[i - m->tree_count];
        if (object != PROM_NONE) m->weight[i] = weights[b->objects.objects.data[object].node];
    }
    prom_weight_rules_warn(&rules);
    prom_free(weights);
}

// Full-detail triangles below each cluster.
static void count_triangles(prom_build_state *b)
{
    const prom_model *m = &b->model;
    uint64_t *below = prom_calloc(m->tree_count, sizeof *below);
    for (uint32_t i = m->tree_count; i-- > 0;) {
        if (m->child_count[i] == 0) below[i] = b->prototypes[m->prototype[i]].triangles;
        b->prototypes[m->prototype[i]].triangles = below[i];
        if (m->parent[i] != PROM_NONE) below[m->parent[i]] += below[i];
    }
    prom_free(below);
}

prom_status prom_stage_model(prom_build_state *b, prom_error *error)
{
    prom_model *m = &b->model;
    count_triangles(b);
    weigh(b);
    m->reps = b->reps.data;
    m->rep_count = (uint32_t)b->reps.count;
    m->accuracy = b->accuracy.data;
    prom_measure_tell(b->measure, &m->measured);
    m->coverage = b->coverage;
    m->shares = (uint16_t(*)[PROM_DIRS])b->shares.data;
    m->share_count = (uint32_t)b->shares.count;
    for (size_t i = 0; i < b->atlas_materials.count; i++)
        prom_array_push(&b->source.materials, b->atlas_materials.data[i]);
    m->materials = b->source.materials.data;
    m->material_count = (uint32_t)b->source.materials.count;
    m->meshes = b->mesh_infos.data;
    m->mesh_count = (uint32_t)b->mesh_infos.count;
    m->textures = b->texture_infos.data;
    m->texture_count = (uint32_t)b->texture_infos.count;
    m->names = b->objects.names.data;
    m->names_bytes = (uint32_t)b->objects.names.count;
    return prom_writer_put_model(b->writer, m, error);
}
