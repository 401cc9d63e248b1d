// Levels of detail by the scene's artist: MSFT_lod names nodes that stand in for a node,
// extras.lods (a custom of exporters of game scenes) meshes. Both hide from assimp what only
// they refer to, so their nodes are hung into the scene under names that carry their numbers,
// and import_levels.c takes them out again. Levels of materials are ignored.
#include "builder/import_gltf.h"

#include "builder/import_parts.h"

// Where a file gives no share of the picture: a quarter of it, and a quarter of that from level
// to level, which is twice the distance (by taste).
#define COVERAGE_STEP 0.25

typedef struct taker {
    prom_import *import;
    prom_gltf *gltf;
    json_t *nodes;
    uint32_t mesh_count;
    uint32_t *mesh_node; // per mesh: the node made for it, or PROM_NONE
    bool *is_level;      // per node of the file
    uint32_t refused;
} taker;

static bool is_number(const json_t *value)
{
    return json_is_number(value) && isfinite(json_number_value(value));
}

// ---- extras.lods: [{"mesh": its own, "distance": d}, {"mesh": coarser, "distance": e}, ...]

static bool lods_sound(const taker *t, const json_t *node, const json_t *lods)
{
    uint64_t own = 0, mesh;
    double last = 0;
    if (!prom_gltf_index(json_object_get(node, "mesh"), t->mesh_count, &own)) return false;
    for (size_t k = 0; k < json_array_size(lods); k++) {
        const json_t *lod = json_array_get(lods, k), *far = json_object_get(lod, "distance");
        if (!prom_gltf_index(json_object_get(lod, "mesh"), t->mesh_count, &mesh)) return false;
        if (!is_number(far) || !(json_number_value(far) > last)) return false;
        if (k == 0 && mesh != own) return false;
        last = json_number_value(far);
    }
    return true;
}

// A node of no transform that places a mesh for the levels alone.
static uint32_t node_of_mesh(taker *t, uint32_t mesh)
{
    if (t->mesh_node[mesh] == PROM_NONE) {
        t->mesh_node[mesh] = (uint32_t)json_array_size(t->nodes);
        json_array_append_new(t->nodes, json_pack("{s:i}", "mesh", (int)mesh));
    }
    return t->mesh_node[mesh];
}

static void take_extras(taker *t, uint32_t node, const json_t *lods)
{
    prom_gltf *gltf = t->gltf;
    prom_gltf_lod lod = {.node = node,
                         .first_level = (uint32_t)gltf->levels.count,
                         .level_count = (uint32_t)json_array_size(lods) - 1,
                         .in_frame = true};
    for (uint32_t k = 0; k <= lod.level_count; k++) {
        const json_t *entry = json_array_get(lods, k);
        double until = json_number_value(json_object_get(entry, "distance"));
        uint64_t mesh = 0;
        prom_gltf_index(json_object_get(entry, "mesh"), t->mesh_count, &mesh);
        if (!k)
            lod.until = until;
        else
            prom_array_push(&gltf->levels,
                            (prom_gltf_level){node_of_mesh(t, (uint32_t)mesh), until});
    }
    prom_array_push(&gltf->lods, lod);
}

// ---- MSFT_lod: ids of nodes from fine to coarse; extras.MSFT_screencoverage: least shares of
// the picture of the node itself and of each of those

static bool ids_sound(const taker *t, uint32_t node, const json_t *ids, const json_t *shares)
{
    uint64_t id;
    double last = INFINITY;
    for (size_t k = 0; k < json_array_size(ids); k++)
        if (!prom_gltf_index(json_array_get(ids, k), t->gltf->node_count, &id) || id == node)
            return false;
    for (size_t k = 0; k < json_array_size(shares); k++) {
        const json_t *share = json_array_get(shares, k);
        if (!is_number(share) || json_number_value(share) < 0) return false;
        if (json_number_value(share) > last) return false;
        last = json_number_value(share);
    }
    return true;
}

static double share_of(const json_t *shares, size_t level, size_t last)
{
    const json_t *given = json_array_get(shares, level);
    if (given) return json_number_value(given);
    return level == last ? 0 : pow(COVERAGE_STEP, (double)level + 1);
}

static void take_ids(taker *t, uint32_t node, const json_t *ids, const json_t *shares)
{
    prom_gltf *gltf = t->gltf;
    size_t count = json_array_size(ids);
    prom_array_push(&gltf->lods, (prom_gltf_lod){.node = node,
                                                 .first_level = (uint32_t)gltf->levels.count,
                                                 .level_count = (uint32_t)count,
                                                 .until = share_of(shares, 0, count),
                                                 .coverage = true});
    for (size_t k = 0; k < count; k++) {
        uint64_t id = 0;
        prom_gltf_index(json_array_get(ids, k), gltf->node_count, &id);
        t->is_level[id] = true;
        prom_array_push(&gltf->levels,
                        (prom_gltf_level){(uint32_t)id, share_of(shares, k + 1, count)});
    }
}

static void take_node(taker *t, uint32_t i)
{
    const json_t *node = json_array_get(t->nodes, i), *extras = json_object_get(node, "extras");
    const json_t *lods = json_object_get(extras, "lods");
    const json_t *ids = json_object_get(
        json_object_get(json_object_get(node, "extensions"), "MSFT_lod"), "ids");
    const json_t *shares = json_object_get(extras, "MSFT_screencoverage");
    if (json_array_size(ids) && ids_sound(t, i, ids, shares))
        take_ids(t, i, ids, shares);
    else if (json_array_size(lods) > 1 && lods_sound(t, node, lods))
        take_extras(t, i, lods);
    else if (json_array_size(ids) || json_array_size(lods) > 1)
        t->refused++;
}

// ---- the changed JSON

// Takes level nodes out of a list of nodes.
static void unhang(const taker *t, json_t *list)
{
    json_t *kept = json_array(), *value;
    size_t k;
    json_array_foreach(list, k, value)
    {
        uint64_t index;
        bool level = prom_gltf_index(value, t->gltf->node_count, &index) && t->is_level[index];
        if (!level) json_array_append(kept, value);
    }
    json_array_clear(list);
    json_array_extend(list, kept);
    json_decref(kept);
}

static void hang_levels(taker *t)
{
    json_t *root = t->gltf->root;
    uint64_t scene = 0;
    prom_gltf_index(json_object_get(root, "scene"), PROM_NONE, &scene);
    json_t *shown = prom_gltf_element(root, "scenes", (uint32_t)scene);
    json_t *list = json_object_get(shown, "nodes");
    unhang(t, list);
    for (uint32_t i = 0; i < t->gltf->node_count; i++)
        unhang(t, json_object_get(json_array_get(t->nodes, i), "children"));
    for (uint32_t i = 0; i < json_array_size(t->nodes); i++)
        if (i >= t->gltf->node_count || t->is_level[i])
            json_array_append_new(list, json_integer((json_int_t)i));
}

// Names carry numbers, and what assimp would keep of the levels goes.
static void number_nodes(taker *t)
{
    json_t *node;
    size_t i;
    json_array_foreach(t->nodes, i, node)
    {
        const char *name = json_string_value(json_object_get(node, "name"));
        prom_array_push(&t->gltf->names, prom_strdup(name ? name : ""));
        char text[64];
        snprintf(text, sizeof text, PROM_GLTF_NODE "%zu", i);
        json_object_set_new(node, "name", json_string(text));
        json_object_del(node, "extras");
        json_object_del(json_object_get(node, "extensions"), "MSFT_lod");
    }
    t->gltf->numbered = t->gltf->changed = true;
}

void prom_gltf_take_lods(prom_import *import, prom_gltf *gltf)
{
    json_t *root = gltf->root;
    taker t = {.import = import, .gltf = gltf, .nodes = json_object_get(root, "nodes")};
    if (gltf->tangled) return;
    t.mesh_count = (uint32_t)json_array_size(json_object_get(root, "meshes"));
    t.mesh_node = prom_alloc(t.mesh_count, sizeof *t.mesh_node);
    memset(t.mesh_node, 0xff, t.mesh_count * sizeof *t.mesh_node);
    t.is_level = prom_calloc(gltf->node_count, sizeof *t.is_level);
    for (uint32_t i = 0; i < gltf->node_count; i++) take_node(&t, i);
    if (t.refused)
        prom_import_warn(import,
                         "the levels of detail of %u nodes contradict themselves and "
                         "are ignored",
                         t.refused);
    if (gltf->lods.count) {
        hang_levels(&t);
        number_nodes(&t);
    }
    prom_free(t.mesh_node);
    prom_free(t.is_level);
}
