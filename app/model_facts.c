#include "app/model_facts.h"

const char *prom_texture_kind_name(uint32_t kind)
{
    static const char *const names[PROM_TEXTURE_KIND_COUNT] = {"color", "impostor-lit",
                                                               "impostor-albedo"};
    return kind < PROM_TEXTURE_KIND_COUNT ? names[kind] : "?";
}

static void count_leaf(const prom_model *model, uint32_t node, prom_model_facts *facts)
{
    uint32_t flags = model->prototypes[model->prototype[node]].flags;
    facts->leaves++;
    if (flags & PROM_PROTO_BLENDED)
        facts->blended_leaves++;
    else if (flags & PROM_PROTO_SURFACE)
        facts->surface_leaves++;
    else
        facts->object_leaves++;
}

static void count_nodes(const prom_model *model, prom_model_facts *facts)
{
    uint32_t *level = prom_calloc(model->node_count, sizeof *level);
    for (uint32_t i = 0; i < model->tree_count; i++) {
        if (i) level[i] = level[model->parent[i]] + 1; // parents come first
        uint32_t l = level[i] < PROM_FACT_LEVELS ? level[i] : PROM_FACT_LEVELS - 1;
        facts->nodes_by_level[l]++;
        if (l + 1 > facts->levels) facts->levels = l + 1;
        if (model->child_count[i])
            facts->clusters++;
        else
            count_leaf(model, i, facts);
        if (model->child_count[i] > facts->most_children)
            facts->most_children = model->child_count[i];
    }
    prom_free(level);
    facts->backdrops = model->node_count - model->tree_count;
    if (model->tree_count) facts->triangles = model->prototypes[model->prototype[0]].triangles;
    for (uint32_t i = model->tree_count; i < model->node_count; i++)
        facts->triangles += model->prototypes[model->prototype[i]].triangles;
    for (int i = 0; i < 3 && model->tree_count; i++)
        facts->size[i] = 2.0 * (double)model->half[0][i];
}

static void count_prototypes(const prom_model *model, prom_model_facts *facts)
{
    uint32_t *uses = prom_calloc(model->prototype_count, sizeof *uses);
    for (uint32_t i = 0; i < model->node_count; i++) uses[model->prototype[i]]++;
    for (uint32_t p = 0; p < model->prototype_count; p++) {
        const prom_prototype *proto = &model->prototypes[p];
        bool cluster = proto->flags & PROM_PROTO_CLUSTER;
        if (cluster)
            facts->cluster_prototypes++;
        else
            facts->leaf_prototypes++;
        facts->shared_prototypes += uses[p] > 1;
        for (uint32_t r = 0; r < proto->rep_count; r++) {
            const prom_representation *rep = &model->reps[proto->first_rep + r];
            if (rep->kind >= PROM_REP_KIND_COUNT) continue;
            prom_rep_facts *kind = &facts->reps[rep->kind];
            if (cluster)
                kind->cluster++;
            else
                kind->leaf++;
            kind->triangles += rep->triangles;
        }
    }
    prom_free(uses);
}

static uint64_t count_textures(const prom_model *model, prom_model_facts *facts)
{
    uint64_t all = 0;
    for (uint32_t i = 0; i < model->texture_count; i++) {
        const prom_texture_info *info = &model->textures[i];
        prom_texture shape = {info->kind,   info->width,  info->height,
                              info->layers, info->levels, NULL};
        uint64_t bytes = prom_texture_bytes(&shape);
        all += bytes;
        if (info->kind >= PROM_TEXTURE_KIND_COUNT) continue;
        facts->textures[info->kind].count++;
        facts->textures[info->kind].bytes += bytes;
    }
    return all;
}

static uint64_t mesh_bytes(const prom_model *model)
{
    uint64_t bytes = 0;
    for (uint32_t i = 0; i < model->mesh_count; i++)
        bytes += (uint64_t)model->meshes[i].vertex_count * sizeof(prom_vertex) +
                 (uint64_t)model->meshes[i].index_count * sizeof(uint32_t) +
                 (uint64_t)model->meshes[i].submesh_count * sizeof(prom_submesh);
    return bytes;
}

static void count_cells(const prom_view_cells *cells, prom_model_facts *facts)
{
    if (!cells->cell_count) return;
    facts->cell_size = cells->size;
    facts->cell_shows = (double)cells->entry_count / cells->cell_count / (double)facts->leaves;
}

void prom_model_facts_of(const prom_model *model, const prom_view_cells *cells,
                         prom_model_facts *facts)
{
    *facts = (prom_model_facts){.materials = model->material_count};
    count_nodes(model, facts);
    count_prototypes(model, facts);
    count_cells(cells, facts);
    const prom_model *m = model;
    uint64_t node =
        5 * sizeof(uint32_t) + sizeof(prom_placement) + 3 * sizeof(double) + 4 * sizeof(float);
    uint64_t rep = sizeof *m->reps, proto = sizeof *m->prototypes + sizeof *m->coverage;
    uint64_t entry = sizeof *cells->leaves + sizeof *cells->shares;
    prom_table_facts tables[PROM_FACT_TABLES] = {
        {"node", m->node_count, m->node_count * node},
        {"prototype", m->prototype_count, m->prototype_count * proto},
        {"representation", m->rep_count, m->rep_count * rep},
        {"accuracy", m->rep_count, m->rep_count * sizeof *m->accuracy},
        {"share", m->share_count, m->share_count * sizeof *m->shares},
        {"mesh", m->mesh_count, mesh_bytes(m)},
        {"texture", m->texture_count, count_textures(m, facts)},
        {"view_cell", cells->cell_count,
         cells->cell_count * sizeof *cells->cells + cells->entry_count * entry},
    };
    memcpy(facts->tables, tables, sizeof tables);
}
