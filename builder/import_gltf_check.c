// What a glTF file must have for there to be anything to import. Everything that later steps
// rely on is checked here: arrays of objects, indices in range, nodes that form a forest.
#include "builder/import_gltf.h"

#include "builder/import_parts.h"

#include <sys/stat.h>

enum { MODE_TRIANGLES = 4, MODE_FAN = 6, NAME_BYTES = 100 };

typedef struct checker {
    const char *path;
    prom_gltf *gltf;
    prom_error *error;
    uint64_t *external; // per buffer: bytes of its file + 1; 0: not looked at yet
} checker;

static prom_status damaged(const checker *c, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

static prom_status damaged(const checker *c, const char *format, ...)
{
    char text[256];
    va_list args;
    va_start(args, format);
    vsnprintf(text, sizeof text, format, args);
    va_end(args);
    return prom_fail(c->error, PROM_ERR_INPUT, "%s: %s; the file is damaged", c->path, text);
}

// ---- the shape of the JSON

static prom_status check_arrays(const checker *c)
{
    static const char *const names[] = {"scenes",    "nodes",   "meshes",
                                        "accessors", "buffers", "bufferViews",
                                        "materials", "images",  "textures"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        json_t *array = json_object_get(c->gltf->root, names[i]), *element;
        size_t at;
        if (!array) continue;
        if (!json_is_array(array)) return damaged(c, "its \"%s\" is no array", names[i]);
        if (json_array_size(array) >= PROM_NONE)
            return damaged(c, "its \"%s\" has too many elements", names[i]);
        json_array_foreach(array, at, element) if (!json_is_object(element)) return damaged(
            c, "element %zu of its \"%s\" is no object", at, names[i]);
    }
    return PROM_OK;
}

// An index that a member holds, if it is there. PROM_NONE where it is not.
static prom_status get_index(const checker *c, const json_t *object, const char *what,
                             size_t number, const char *member, const char *array,
                             uint32_t *index)
{
    uint64_t value = PROM_NONE;
    const json_t *given = json_object_get(object, member);
    *index = PROM_NONE;
    if (!given) return PROM_OK;
    size_t count = json_array_size(json_object_get(c->gltf->root, array));
    if (!prom_gltf_index(given, count, &value))
        return damaged(c, "\"%s\" of %s %zu is no index into its %zu %s", member, what, number,
                       count, array);
    *index = (uint32_t)value;
    return PROM_OK;
}

// Children and meshes of the nodes; parent[i] is filled.
static prom_status check_nodes(const checker *c, uint32_t *parent)
{
    json_t *nodes = json_object_get(c->gltf->root, "nodes"), *node, *child;
    size_t count = json_array_size(nodes), i, k;
    for (i = 0; i < count; i++) parent[i] = PROM_NONE;
    json_array_foreach(nodes, i, node)
    {
        uint32_t mesh;
        prom_status status = get_index(c, node, "node", i, "mesh", "meshes", &mesh);
        if (status) return status;
        json_array_foreach(json_object_get(node, "children"), k, child)
        {
            uint64_t index;
            if (!prom_gltf_index(child, count, &index))
                return damaged(c, "child %zu of node %zu is no index into its %zu nodes", k, i,
                               count);
            if (parent[index] == PROM_NONE)
                parent[index] = (uint32_t)i;
            else
                c->gltf->tangled = true;
        }
    }
    return PROM_OK;
}

// With one parent each, what no root reaches goes round in circles.
static prom_status check_forest(const checker *c, const uint32_t *parent, size_t count)
{
    uint8_t *known = prom_calloc(count, 1); // 1: on the way up, 2: ends at a root
    prom_status status = PROM_OK;
    for (size_t i = 0; i < count && !status; i++) {
        size_t at = i;
        while (at != PROM_NONE && !known[at]) {
            known[at] = 1;
            at = parent[at];
        }
        if (at != PROM_NONE && known[at] == 1)
            status = damaged(c, "node %zu is its own ancestor", at);
        for (at = i; at != PROM_NONE && known[at] == 1; at = parent[at]) known[at] = 2;
    }
    prom_free(known);
    return status;
}

// A file need not name a scene, nor have one: then all of it is shown.
static prom_status check_scene(const checker *c, const uint32_t *parent, size_t count)
{
    json_t *root = c->gltf->root, *scenes = json_object_get(root, "scenes"), *value;
    uint32_t scene;
    size_t i;
    prom_status status = get_index(c, root, "asset", 0, "scene", "scenes", &scene);
    if (status) return status;
    if (!json_array_size(scenes)) {
        json_t *roots = json_array();
        for (i = 0; i < count; i++)
            if (parent[i] == PROM_NONE)
                json_array_append_new(roots, json_integer((json_int_t)i));
        json_object_set_new(root, "scenes", json_pack("[{s:o}]", "nodes", roots));
        c->gltf->changed = true;
    }
    if (scene == PROM_NONE) {
        json_object_set_new(root, "scene", json_integer(0));
        c->gltf->changed = true;
        scene = 0;
    }
    const json_t *shown = prom_gltf_element(root, "scenes", scene);
    json_array_foreach(json_object_get(shown, "nodes"), i, value)
    {
        uint64_t index;
        if (!prom_gltf_index(value, count, &index))
            return damaged(c, "entry %zu of scene %u is no index into its %zu nodes", i, scene,
                           count);
    }
    return PROM_OK;
}

// ---- data

// The bytes that the payload of a data URI stands for.
static uint64_t data_uri_bytes(const char *uri)
{
    const char *comma = strchr(uri, ',');
    if (!comma) return 0;
    size_t n = strlen(comma + 1);
    while (n && comma[n] == '=') n--;
    return memmem(uri, (size_t)(comma - uri), ";base64", 7) ? n / 4 * 3 + n % 4 * 3 / 4 : n;
}

static uint64_t external_bytes(const checker *c, const char *uri)
{
    struct stat info;
    char *path = prom_file_find(c->path, uri);
    uint64_t bytes = path && !stat(path, &info) ? (uint64_t)info.st_size + 1 : 1;
    prom_free(path);
    return bytes;
}

// That a buffer has `needed` bytes. Names it where it has not.
static prom_status check_buffer(const checker *c, uint32_t index, uint64_t needed)
{
    const json_t *buffer = prom_gltf_element(c->gltf->root, "buffers", index);
    const char *uri = json_string_value(json_object_get(buffer, "uri"));
    uint64_t have;
    if (!uri && !(index == 0 && c->gltf->has_bin))
        return prom_fail(c->error, PROM_ERR_INPUT,
                         "%s: its mesh data is missing: buffer %u has no \"uri\"%s; export the "
                         "scene again",
                         c->path, index,
                         c->gltf->glb ? " and the container has no binary chunk" : "");
    if (!uri) {
        have = c->gltf->bin_bytes;
    } else if (!strncmp(uri, "data:", 5)) {
        have = data_uri_bytes(uri);
    } else {
        if (!c->external[index]) c->external[index] = external_bytes(c, uri);
        have = c->external[index] - 1;
        if (!have)
            return prom_fail(
                c->error, PROM_ERR_INPUT,
                "%s: its mesh data is missing: there is no file '%.*s' (buffer %u) "
                "beside it, or it is empty",
                c->path, NAME_BYTES, uri, index);
    }
    if (have < needed)
        return prom_fail(
            c->error, PROM_ERR_INPUT,
            "%s: its mesh data is missing: buffer %u%s%.*s has %llu bytes, %llu are "
            "used",
            c->path, index, uri && strncmp(uri, "data:", 5) ? " " : "", NAME_BYTES,
            uri && strncmp(uri, "data:", 5) ? uri : "", (unsigned long long)have,
            (unsigned long long)needed);
    return PROM_OK;
}

static uint64_t get_bytes(const json_t *object, const char *member)
{
    uint64_t value;
    return prom_gltf_index(json_object_get(object, member), (uint64_t)1 << 52, &value) ? value
                                                                                       : 0;
}

// Whether an accessor has elements that differ; those without a view are all zero. Its data
// must be there.
static prom_status check_accessor(const checker *c, uint32_t index, uint64_t *count)
{
    const json_t *root = c->gltf->root;
    const json_t *accessor = prom_gltf_element(root, "accessors", index);
    uint32_t view, buffer;
    *count = 0;
    prom_status status =
        get_index(c, accessor, "accessor", index, "bufferView", "bufferViews", &view);
    if (status) return status;
    if (view == PROM_NONE) {
        if (json_object_get(accessor, "sparse")) *count = get_bytes(accessor, "count");
        return PROM_OK;
    }
    const json_t *of = prom_gltf_element(root, "bufferViews", view);
    status = get_index(c, of, "bufferView", view, "buffer", "buffers", &buffer);
    if (status) return status;
    if (buffer == PROM_NONE) return damaged(c, "bufferView %u names no buffer", view);
    *count = get_bytes(accessor, "count");
    return check_buffer(c, buffer, get_bytes(of, "byteOffset") + get_bytes(of, "byteLength"));
}

static prom_status check_primitive(const checker *c, uint32_t mesh, const json_t *primitive,
                                   bool *triangles)
{
    uint64_t mode = MODE_TRIANGLES, count;
    const json_t *given = json_object_get(primitive, "mode");
    if (given && !prom_gltf_index(given, MODE_FAN + 1, &mode)) return PROM_OK;
    if (mode < MODE_TRIANGLES) return PROM_OK;
    const json_t *extensions = json_object_get(primitive, "extensions");
    if (json_object_get(extensions, "KHR_draco_mesh_compression")) {
        *triangles = true; // its data lie elsewhere: the loader's matter
        return PROM_OK;
    }
    uint32_t position, indices;
    prom_status status =
        get_index(c, json_object_get(primitive, "attributes"), "a primitive of mesh", mesh,
                  "POSITION", "accessors", &position);
    if (!status)
        status = get_index(c, primitive, "a primitive of mesh", mesh, "indices", "accessors",
                           &indices);
    if (status || position == PROM_NONE) return status;
    status = check_accessor(c, position, &count);
    if (status || !count) return status;
    if (indices != PROM_NONE) status = check_accessor(c, indices, &count);
    if (!status && count >= 3) *triangles = true;
    return status;
}

static prom_status check_mesh(const checker *c, uint32_t mesh, bool *triangles)
{
    const json_t *object = prom_gltf_element(c->gltf->root, "meshes", mesh), *primitive;
    size_t i;
    prom_status status = PROM_OK;
    json_array_foreach(json_object_get(object, "primitives"), i, primitive) if (!status)
        status = check_primitive(c, mesh, primitive, triangles);
    return status;
}

// Compressed vertices leave nothing for assimp to read.
static prom_status check_required(const checker *c)
{
    const json_t *required = json_object_get(c->gltf->root, "extensionsRequired"), *name;
    size_t i;
    json_array_foreach(required, i, name)
    {
        const char *text = json_string_value(name);
        if (text && strstr(text, "meshopt_compression"))
            return prom_fail(c->error, PROM_ERR_INPUT,
                             "%s: its meshes are compressed with %.*s, which cannot be read; "
                             "export it without compression",
                             c->path, NAME_BYTES, text);
    }
    return PROM_OK;
}

// The nodes that hang below those of the scene.
static void mark_shown(const checker *c, const uint32_t *parent, size_t count, bool *shown)
{
    const json_t *root = c->gltf->root, *value;
    bool *known = prom_calloc(count, sizeof *known);
    uint64_t scene = 0, index;
    size_t i;
    prom_gltf_index(json_object_get(root, "scene"), PROM_NONE, &scene);
    json_array_foreach(
        json_object_get(prom_gltf_element(root, "scenes", (uint32_t)scene), "nodes"), i,
        value) if (prom_gltf_index(value, count, &index)) shown[index] = known[index] = true;
    for (i = 0; i < count; i++) {
        size_t top = i;
        while (!known[top] && parent[top] != PROM_NONE) top = parent[top];
        bool below = shown[top];
        for (size_t at = i; at != PROM_NONE && !known[at]; at = parent[at]) {
            known[at] = true;
            shown[at] = below;
        }
    }
    prom_free(known);
}

static prom_status check_triangles(const checker *c, const uint32_t *parent, size_t count)
{
    json_t *root = c->gltf->root;
    size_t meshes = json_array_size(json_object_get(root, "meshes")), i, placed = 0;
    bool *shown = prom_calloc(count, sizeof *shown), *seen = prom_calloc(meshes, sizeof *seen);
    bool triangles = false;
    uint64_t index;
    mark_shown(c, parent, count, shown);
    prom_status status = PROM_OK;
    for (i = 0; i < count && !status; i++) {
        const json_t *node = prom_gltf_element(root, "nodes", (uint32_t)i);
        bool has = prom_gltf_index(json_object_get(node, "mesh"), meshes, &index);
        if (!shown[i] || !has || seen[index]) continue;
        seen[index] = true;
        placed++;
        status = check_mesh(c, (uint32_t)index, &triangles);
    }
    prom_free(shown);
    prom_free(seen);
    if (status || triangles) return status;
    return prom_fail(c->error, PROM_ERR_INPUT, "%s: has no triangles (%s)", c->path,
                     !meshes   ? "it holds no mesh"
                     : !placed ? "no node of its scene places a mesh"
                               : "its meshes hold points, lines or no data");
}

prom_status prom_gltf_check(prom_import *import, prom_gltf *gltf, prom_error *error)
{
    checker c = {.path = import->path, .gltf = gltf, .error = error};
    prom_status status = check_arrays(&c);
    if (!status) status = check_required(&c);
    if (status) return status;
    size_t nodes = json_array_size(json_object_get(gltf->root, "nodes"));
    uint32_t *parent = prom_alloc(nodes, sizeof *parent);
    c.external = prom_calloc(json_array_size(json_object_get(gltf->root, "buffers")),
                             sizeof *c.external);
    gltf->node_count = (uint32_t)nodes;
    status = check_nodes(&c, parent);
    if (!status) status = check_forest(&c, parent, nodes);
    if (!status) status = check_scene(&c, parent, nodes);
    if (!status) status = check_triangles(&c, parent, nodes);
    prom_free(parent);
    prom_free(c.external);
    return status;
}
