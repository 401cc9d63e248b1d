#include "scenes/tile.h"

#include "metaobj/base/log.h"
#include "scenes/tile_gltf_layout.h"

#include <math.h>

#define MAX_NODES (1u << 24)
#define MAX_SIDE 1024u

// The scene on its way from one tile to many.
typedef struct tiling {
    const char *path;
    prom_tile_gltf gltf;
    prom_tile_gltf_layout layout;
    json_t *nodes;    // of the file
    json_t *roots;    // of a tile: the original nodes, without the backdrop
    json_t *backdrop; // root nodes that stand once
} tiling;

static json_t *index_of_last(const json_t *array)
{
    return json_integer((json_int_t)json_array_size(array) - 1);
}

// ---- one scene, nothing that moves

static prom_status choose_scene(tiling *t, prom_error *error)
{
    json_t *root = t->gltf.root, *scenes = json_object_get(root, "scenes");
    size_t index = 0;
    if (json_object_get(root, "scene") &&
        !prom_tile_gltf_index(root, "scene", json_array_size(scenes), &index))
        return prom_fail(error, PROM_ERR_INPUT, "%s: its scene does not exist", t->path);
    json_t *scene = json_array_get(scenes, index);
    if (!scene) return prom_fail(error, PROM_ERR_INPUT, "%s: has no scene", t->path);
    json_t *only = json_array();
    json_array_append(only, scene);
    json_object_set_new(root, "scenes", only);
    json_object_set_new(root, "scene", json_integer(0));
    t->nodes = prom_tile_gltf_array(root, "nodes");
    return PROM_OK;
}

// Animations and skins name nodes; their copies would need copies of their own.
static void drop_motion(tiling *t)
{
    json_t *root = t->gltf.root, *node;
    size_t i;
    bool moving = json_object_get(root, "animations") || json_object_get(root, "skins");
    if (moving) prom_log(PROM_LOG_DEBUG, "%s: animations and skins are dropped", t->path);
    json_object_del(root, "animations");
    json_object_del(root, "skins");
    json_array_foreach(t->nodes, i, node)
    {
        json_object_del(node, "skin");
    }
}

// ---- the backdrop out of the hierarchy

static json_t *matrix_json(const double m[16])
{
    json_t *array = json_array();
    for (int i = 0; i < 16; i++) json_array_append_new(array, json_real(m[i]));
    return array;
}

// A new mesh of those primitives of `mesh` that are backdrop, or are not.
static json_t *pick_primitives(tiling *t, const prom_tile_gltf_part *parts, size_t count,
                               bool backdrop)
{
    json_t *meshes = json_object_get(t->gltf.root, "meshes");
    const json_t *mesh = json_array_get(meshes, parts->mesh);
    const json_t *primitives = json_object_get(mesh, "primitives");
    json_t *copy = json_copy((json_t *)mesh), *picked = json_array();
    for (size_t i = 0; i < count; i++)
        if (parts[i].backdrop == backdrop)
            json_array_append(picked, json_array_get(primitives, parts[i].primitive));
    json_object_set_new(copy, "primitives", picked);
    json_array_append_new(meshes, copy);
    return index_of_last(meshes);
}

// A node of the backdrop with a world matrix of its own.
static void hoist(tiling *t, uint32_t node, json_t *mesh)
{
    json_t *source = json_array_get(t->nodes, node), *copy = json_copy(source);
    static const char *const local[] = {"children", "translation", "rotation", "scale",
                                        "camera"};
    for (size_t i = 0; i < sizeof local / sizeof *local; i++) json_object_del(copy, local[i]);
    json_object_set_new(copy, "mesh", mesh);
    json_object_set_new(copy, "matrix", matrix_json(t->layout.world[node]));
    json_array_append_new(t->nodes, copy);
    json_array_append_new(t->backdrop, index_of_last(t->nodes));
}

static void part_backdrop(tiling *t, const prom_tile_gltf_part *parts, size_t count)
{
    size_t behind = 0;
    for (size_t i = 0; i < count; i++) behind += parts[i].backdrop;
    if (!behind) return;
    json_t *node = json_array_get(t->nodes, parts->node);
    const json_t *name = json_object_get(node, "name");
    prom_log(PROM_LOG_DEBUG, "%s: backdrop: %zu of %zu parts of node %u '%s'", t->path, behind,
             count, parts->node, name ? json_string_value(name) : "");
    if (behind == count) {
        hoist(t, parts->node, json_incref(json_object_get(node, "mesh")));
        json_object_del(node, "mesh");
    } else {
        hoist(t, parts->node, pick_primitives(t, parts, count, true));
        json_object_set_new(node, "mesh", pick_primitives(t, parts, count, false));
    }
}

static void split_backdrop(tiling *t, const json_t *roots)
{
    const prom_tile_gltf_part *parts = t->layout.parts.data;
    for (size_t i = 0, end; i < t->layout.parts.count; i = end) {
        for (end = i; end < t->layout.parts.count && parts[end].node == parts[i].node;) end++;
        part_backdrop(t, parts + i, end - i);
    }
    for (size_t i = 0; i < json_array_size(roots); i++) {
        json_t *index = json_array_get(roots, i);
        const json_t *node = json_array_get(t->nodes, (size_t)json_integer_value(index));
        bool empty = !json_object_get(node, "mesh") && !json_object_get(node, "camera") &&
                     !json_object_get(node, "extensions") &&
                     !json_array_size(json_object_get(node, "children"));
        if (!empty) json_array_append(t->roots, index);
    }
}

// ---- the copies

// The depth of the tree was checked by the layout.
static json_t *copy_subtree(json_t *nodes, const json_t *index)
{
    json_t *node = json_array_get(nodes, (size_t)json_integer_value(index));
    json_t *copy = json_copy(node); // values are shared: nothing changes them
    json_t *children = json_object_get(node, "children"), *child;
    if (children) {
        json_t *copies = json_array();
        size_t i;
        json_array_foreach(children, i, child)
        {
            json_array_append_new(copies, copy_subtree(nodes, child));
        }
        json_object_set_new(copy, "children", copies);
    }
    json_array_append_new(nodes, copy);
    return index_of_last(nodes);
}

static void add_tile(tiling *t, const prom_tile_options *o, const double spacing[2], uint32_t x,
                     uint32_t z, json_t *scene_nodes)
{
    bool center = x == o->columns / 2 && z == o->rows / 2;
    json_t *children = json_array(), *root;
    size_t i;
    json_array_foreach(t->roots, i, root)
    {
        json_array_append_new(children,
                              center ? json_incref(root) : copy_subtree(t->nodes, root));
    }
    char name[64];
    snprintf(name, sizeof name, "tile_%u_%u", x, z);
    double dx = ((double)x - o->columns / 2) * spacing[0];
    double dz = ((double)z - o->rows / 2) * spacing[1];
    json_array_append_new(t->nodes,
                          json_pack("{s:s, s:[f,f,f], s:o}", "name", name, "translation", dx,
                                    0.0, dz, "children", children));
    json_array_append_new(scene_nodes, index_of_last(t->nodes));
}

static void add_tiles(tiling *t, const prom_tile_options *o, const double spacing[2])
{
    json_t *scene_nodes = json_array();
    for (uint32_t z = 0; z < o->rows; z++)
        for (uint32_t x = 0; x < o->columns; x++) add_tile(t, o, spacing, x, z, scene_nodes);
    json_array_extend(scene_nodes, t->backdrop);
    json_t *scene = json_array_get(json_object_get(t->gltf.root, "scenes"), 0);
    json_object_set_new(scene, "nodes", scene_nodes);
}

static prom_status tile(tiling *t, const prom_tile_options *o, prom_error *error)
{
    prom_status status = choose_scene(t, error);
    if (status) return status;
    json_t *scene = json_array_get(json_object_get(t->gltf.root, "scenes"), 0);
    const json_t *roots = json_object_get(scene, "nodes");
    status = prom_tile_gltf_layout_find(&t->gltf, t->path, roots, &t->layout, error);
    if (status) return status;
    uint64_t tiles = (uint64_t)o->columns * o->rows;
    if (json_array_size(t->nodes) * tiles > MAX_NODES)
        return prom_fail(error, PROM_ERR_USAGE,
                         "%s: %llu tiles of %zu nodes are too many; at "
                         "most %u nodes are written",
                         t->path, (unsigned long long)tiles, json_array_size(t->nodes),
                         MAX_NODES);
    double spacing[2];
    for (int k = 0; k < 2; k++) {
        double size = t->layout.max[2 * k] - t->layout.min[2 * k];
        spacing[k] = o->spacing[k] > 0 ? o->spacing[k] : size > 0 ? size : 1;
    }
    drop_motion(t);
    split_backdrop(t, roots);
    add_tiles(t, o, spacing);
    prom_tile_gltf_embed_images(&t->gltf, t->path);
    prom_log(PROM_LOG_INFO, "%s: %u x %u tiles, spacing %.6g x %.6g, %u parts of backdrop",
             t->path, o->columns, o->rows, spacing[0], spacing[1], t->layout.backdrops);
    return PROM_OK;
}

prom_status prom_tile_write(const char *scene_path, const char *glb_path,
                            const prom_tile_options *options, prom_error *error)
{
    const prom_tile_options *o = options;
    if (!o->columns || !o->rows || o->columns > MAX_SIDE || o->rows > MAX_SIDE)
        return prom_fail(error, PROM_ERR_USAGE, "a grid of %ux%u tiles: give 1 to %u a side",
                         o->columns, o->rows, MAX_SIDE);
    for (int k = 0; k < 2; k++)
        if (!(o->spacing[k] >= 0) || !isfinite(o->spacing[k]))
            return prom_fail(error, PROM_ERR_USAGE,
                             "a spacing of %g: give lengths above 0, or 0 for the scene's size",
                             o->spacing[k]);
    tiling t = {.path = scene_path};
    prom_status status = prom_tile_gltf_load(scene_path, &t.gltf, error);
    if (status) return status;
    t.roots = json_array();
    t.backdrop = json_array();
    status = tile(&t, o, error);
    if (!status) status = prom_tile_gltf_save(&t.gltf, glb_path, error);
    json_decref(t.roots);
    json_decref(t.backdrop);
    prom_tile_gltf_layout_finish(&t.layout);
    prom_tile_gltf_finish(&t.gltf);
    return status;
}
