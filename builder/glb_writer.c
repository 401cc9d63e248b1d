// glTF 2.0 specification (Khronos Group, 2021), section 4 for the binary container: a header of
// 12 bytes, then a JSON and a BIN chunk, all sizes 32-bit, chunks padded to 4 bytes.
#include "builder/glb_writer.h"

#include "metaobj/base/alloc.h"

#include <assert.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#define HEADER_BYTES 12u
#define CHUNK_HEADER_BYTES 8u
#define MAGIC 0x46546c67u      // "glTF"
#define CHUNK_JSON 0x4e4f534au // "JSON"
#define CHUNK_BIN 0x004e4942u  // "BIN"
// The whole file's length is a 32-bit number.
#define MAX_BYTES UINT32_MAX
// Nine digits bring a float back exactly.
#define DUMP_FLAGS (JSON_COMPACT | JSON_REAL_PRECISION(9))

enum {
    TYPE_UINT16 = 5123, // indices, colours
    TYPE_UINT32 = 5125,
    TYPE_FLOAT = 5126,
    TARGET_VERTICES = 34962,
    TARGET_INDICES = 34963,
    FILTER_LINEAR = 9729,
    FILTER_MIPMAPS = 9987,
};

typedef struct node_record {
    const char *name;
    uint32_t parent, mesh;
    uint32_t first_child, child_count; // in the order of child_lists; filled by finish
    double translation[3], yaw, scale;
} node_record;

struct prom_glb {
    char *path, *part_path, *bin_path;
    FILE *bin;
    uint64_t bin_bytes, triangles;
    bool failed;
    prom_error error;
    json_t *images, *textures, *materials, *meshes, *accessors, *views;
    PROM_ARRAY(uint64_t) mesh_triangles;
    PROM_ARRAY(node_record) nodes;
    prom_arena names;
};

static void fail(prom_glb *glb, const char *what)
{
    if (glb->failed) return;
    glb->failed = true;
    prom_fail(&glb->error, PROM_ERR_OUTPUT, "%s: cannot write the scene: %s", glb->path, what);
}

prom_glb *prom_glb_create(const char *path)
{
    prom_glb *glb = prom_calloc(1, sizeof *glb);
    glb->path = prom_strdup(path);
    glb->part_path = prom_format("%s.part", path);
    glb->bin_path = prom_format("%s.bin.part", path);
    glb->images = json_array();
    glb->textures = json_array();
    glb->materials = json_array();
    glb->meshes = json_array();
    glb->accessors = json_array();
    glb->views = json_array();
    glb->bin = fopen(glb->bin_path, "w+b");
    if (!glb->bin) fail(glb, strerror(errno));
    return glb;
}

void prom_glb_destroy(prom_glb *glb)
{
    if (!glb) return;
    if (glb->bin) {
        fclose(glb->bin);
        unlink(glb->bin_path);
    }
    json_decref(glb->images);
    json_decref(glb->textures);
    json_decref(glb->materials);
    json_decref(glb->meshes);
    json_decref(glb->accessors);
    json_decref(glb->views);
    prom_array_finish(&glb->mesh_triangles);
    prom_array_finish(&glb->nodes);
    prom_arena_finish(&glb->names);
    prom_free(glb->path);
    prom_free(glb->part_path);
    prom_free(glb->bin_path);
    prom_free(glb);
}

bool prom_glb_failed(const prom_glb *glb)
{
    return glb->failed;
}

uint64_t prom_glb_triangles(const prom_glb *glb)
{
    return glb->triangles;
}

// ---- the binary part

static void write_bin(prom_glb *glb, const void *data, size_t bytes)
{
    if (glb->failed) return;
    if (bytes > MAX_BYTES - glb->bin_bytes) {
        fail(glb, "over 4 GiB, the limit of .glb; ask for a smaller scene");
        return;
    }
    if (fwrite(data, 1, bytes, glb->bin) != bytes) fail(glb, strerror(errno));
    glb->bin_bytes += bytes;
}

static void pad_bin(prom_glb *glb)
{
    static const uint8_t zeros[4];
    write_bin(glb, zeros, (4 - glb->bin_bytes % 4) % 4);
}

// A buffer view from `start` to the end of what has been written.
static json_int_t add_view(prom_glb *glb, uint64_t start, int stride, int target)
{
    json_t *view = json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset", (json_int_t)start,
                             "byteLength", (json_int_t)(glb->bin_bytes - start));
    if (stride) json_object_set_new(view, "byteStride", json_integer(stride));
    if (target) json_object_set_new(view, "target", json_integer(target));
    json_array_append_new(glb->views, view);
    return (json_int_t)json_array_size(glb->views) - 1;
}

static json_int_t add_accessor(prom_glb *glb, json_int_t view, uint64_t offset, int type,
                               uint32_t count, const char *shape)
{
    json_t *a = json_pack("{s:I, s:I, s:i, s:I, s:s}", "bufferView", view, "byteOffset",
                          (json_int_t)offset, "componentType", type, "count", (json_int_t)count,
                          "type", shape);
    json_array_append_new(glb->accessors, a);
    return (json_int_t)json_array_size(glb->accessors) - 1;
}

// ---- content

uint32_t prom_glb_add_png(prom_glb *glb, const char *name, const void *png, size_t bytes)
{
    uint32_t id = (uint32_t)json_array_size(glb->images);
    uint64_t start = glb->bin_bytes;
    write_bin(glb, png, bytes);
    json_array_append_new(glb->images,
                          json_pack("{s:s, s:s, s:I}", "name", name, "mimeType", "image/png",
                                    "bufferView", add_view(glb, start, 0, 0)));
    json_array_append_new(glb->textures,
                          json_pack("{s:i, s:i}", "sampler", 0, "source", (int)id));
    pad_bin(glb);
    return id;
}

uint32_t prom_glb_add_material(prom_glb *glb, const prom_glb_material *m)
{
    json_t *shading =
        json_pack("{s:[ffff], s:f, s:f}", "baseColorFactor", (double)m->base_color[0],
                  (double)m->base_color[1], (double)m->base_color[2], (double)m->base_color[3],
                  "metallicFactor", 0.0, "roughnessFactor", 1.0);
    if (m->image != PROM_GLB_NONE) {
        assert(m->image < json_array_size(glb->images));
        json_object_set_new(shading, "baseColorTexture",
                            json_pack("{s:i}", "index", (int)m->image));
    }
    json_t *material =
        json_pack("{s:s, s:o}", "name", m->name, "pbrMetallicRoughness", shading);
    if (m->alpha == PROM_GLB_MASK) {
        json_object_set_new(material, "alphaMode", json_string("MASK"));
        json_object_set_new(material, "alphaCutoff", json_real((double)m->alpha_cutoff));
    } else if (m->alpha == PROM_GLB_BLEND) {
        json_object_set_new(material, "alphaMode", json_string("BLEND"));
    }
    if (m->double_sided) json_object_set_new(material, "doubleSided", json_true());
    json_array_append_new(glb->materials, material);
    return (uint32_t)json_array_size(glb->materials) - 1;
}

static void set_bounds(json_t *accessor, const prom_glb_part *part)
{
    json_t *min = json_array(), *max = json_array();
    for (int axis = 0; axis < 3; axis++) {
        float lo = INFINITY, hi = -INFINITY;
        for (uint32_t i = 0; i < part->vertex_count; i++) {
            lo = fminf(lo, part->vertices[i].position[axis]);
            hi = fmaxf(hi, part->vertices[i].position[axis]);
        }
        json_array_append_new(min, json_real((double)lo));
        json_array_append_new(max, json_real((double)hi));
    }
    json_object_set_new(accessor, "min", min);
    json_object_set_new(accessor, "max", max);
}

static void write_indices(prom_glb *glb, const prom_glb_part *part, bool wide)
{
    if (wide) {
        write_bin(glb, part->indices, (size_t)part->index_count * 4);
        return;
    }
    uint16_t chunk[1024];
    for (uint32_t i = 0; i < part->index_count;) {
        uint32_t n = 0;
        for (; n < 1024 && i < part->index_count; n++, i++)
            chunk[n] = (uint16_t)part->indices[i];
        write_bin(glb, chunk, (size_t)n * 2);
    }
    pad_bin(glb);
}

static json_int_t add_colors(prom_glb *glb, const prom_glb_part *part)
{
    const uint64_t start = glb->bin_bytes;
    write_bin(glb, part->colors, (size_t)part->vertex_count * sizeof *part->colors);
    const json_int_t view = add_view(glb, start, sizeof *part->colors, TARGET_VERTICES);
    const json_int_t color =
        add_accessor(glb, view, 0, TYPE_UINT16, part->vertex_count, "VEC4");
    json_object_set_new(json_array_get(glb->accessors, (size_t)color), "normalized",
                        json_true());
    return color;
}

static json_t *add_attributes(prom_glb *glb, const prom_glb_part *part)
{
    uint64_t start = glb->bin_bytes;
    write_bin(glb, part->vertices, (size_t)part->vertex_count * sizeof *part->vertices);
    json_int_t view = add_view(glb, start, sizeof *part->vertices, TARGET_VERTICES);
    json_int_t position = add_accessor(glb, view, offsetof(prom_glb_vertex, position),
                                       TYPE_FLOAT, part->vertex_count, "VEC3");
    set_bounds(json_array_get(glb->accessors, (size_t)position), part);
    json_int_t normal = add_accessor(glb, view, offsetof(prom_glb_vertex, normal), TYPE_FLOAT,
                                     part->vertex_count, "VEC3");
    json_int_t uv = add_accessor(glb, view, offsetof(prom_glb_vertex, uv), TYPE_FLOAT,
                                 part->vertex_count, "VEC2");
    json_t *attributes =
        json_pack("{s:I, s:I, s:I}", "POSITION", position, "NORMAL", normal, "TEXCOORD_0", uv);
    if (part->colors)
        json_object_set_new(attributes, "COLOR_0", json_integer(add_colors(glb, part)));
    return attributes;
}

static json_t *add_primitive(prom_glb *glb, const prom_glb_part *part)
{
    assert(part->vertex_count && part->index_count && part->index_count % 3 == 0);
    assert(part->material < json_array_size(glb->materials));
    json_t *attributes = add_attributes(glb, part);
    bool wide = part->vertex_count > UINT16_MAX; // 65535 itself restarts a primitive
    const uint64_t start = glb->bin_bytes;
    write_indices(glb, part, wide);
    json_int_t indices =
        add_accessor(glb, add_view(glb, start, 0, TARGET_INDICES), 0,
                     wide ? TYPE_UINT32 : TYPE_UINT16, part->index_count, "SCALAR");
    return json_pack("{s:o, s:I, s:I}", "attributes", attributes, "indices", indices,
                     "material", (json_int_t)part->material);
}

uint32_t prom_glb_add_mesh(prom_glb *glb, const char *name, const prom_glb_part *parts,
                           size_t part_count)
{
    assert(part_count);
    uint64_t triangles = 0;
    json_t *primitives = json_array();
    for (size_t i = 0; i < part_count; i++) {
        json_array_append_new(primitives, add_primitive(glb, &parts[i]));
        triangles += parts[i].index_count / 3;
    }
    json_array_append_new(glb->meshes,
                          json_pack("{s:s, s:o}", "name", name, "primitives", primitives));
    prom_array_push(&glb->mesh_triangles, triangles);
    return (uint32_t)glb->mesh_triangles.count - 1;
}

uint32_t prom_glb_add_node(prom_glb *glb, const prom_glb_node *node)
{
    assert(node->parent == PROM_GLB_NONE || node->parent < glb->nodes.count);
    assert(node->mesh == PROM_GLB_NONE || node->mesh < glb->mesh_triangles.count);
    node_record record = {
        .name = prom_arena_strdup(&glb->names, node->name),
        .parent = node->parent,
        .mesh = node->mesh,
        .yaw = node->yaw,
        .scale = node->scale,
    };
    memcpy(record.translation, node->translation, sizeof record.translation);
    prom_array_push(&glb->nodes, record);
    if (node->mesh != PROM_GLB_NONE) glb->triangles += glb->mesh_triangles.data[node->mesh];
    return (uint32_t)glb->nodes.count - 1;
}

// ---- the JSON part

// Children of each node one after the other, parents in order; roots come last. Returns the
// list, roots from *first_root on.
static uint32_t *list_children(prom_glb *glb, size_t *first_root)
{
    size_t n = glb->nodes.count, next = 0;
    node_record *nodes = glb->nodes.data;
    for (size_t i = 0; i < n; i++)
        if (nodes[i].parent != PROM_GLB_NONE) nodes[nodes[i].parent].child_count++;
    for (size_t i = 0; i < n; i++) {
        nodes[i].first_child = (uint32_t)next;
        next += nodes[i].child_count;
        nodes[i].child_count = 0;
    }
    *first_root = next;
    uint32_t *list = prom_alloc(n, sizeof *list);
    for (size_t i = 0; i < n; i++) {
        if (nodes[i].parent == PROM_GLB_NONE) {
            list[next++] = (uint32_t)i;
        } else {
            node_record *parent = &nodes[nodes[i].parent];
            list[parent->first_child + parent->child_count++] = (uint32_t)i;
        }
    }
    return list;
}

static json_t *number_list(const uint32_t *list, size_t count)
{
    json_t *array = json_array();
    for (size_t i = 0; i < count; i++)
        json_array_append_new(array, json_integer((json_int_t)list[i]));
    return array;
}

static json_t *node_json(const node_record *n, const uint32_t *children)
{
    json_t *node = json_pack("{s:s}", "name", n->name);
    if (n->mesh != PROM_GLB_NONE) json_object_set_new(node, "mesh", json_integer(n->mesh));
    if (n->translation[0] != 0 || n->translation[1] != 0 || n->translation[2] != 0)
        json_object_set_new(
            node, "translation",
            json_pack("[fff]", n->translation[0], n->translation[1], n->translation[2]));
    if (n->yaw != 0)
        json_object_set_new(node, "rotation",
                            json_pack("[ffff]", 0.0, sin(n->yaw / 2), 0.0, cos(n->yaw / 2)));
    if (n->scale != 1)
        json_object_set_new(node, "scale", json_pack("[fff]", n->scale, n->scale, n->scale));
    if (n->child_count)
        json_object_set_new(node, "children",
                            number_list(children + n->first_child, n->child_count));
    return node;
}

static void dump(prom_glb *glb, FILE *out, json_t *value)
{
    if (json_dumpf(value, out, DUMP_FLAGS | JSON_ENCODE_ANY)) fail(glb, strerror(errno));
}

static void dump_member(prom_glb *glb, FILE *out, const char *key, json_t *value)
{
    fprintf(out, ",\"%s\":", key);
    dump(glb, out, value);
}

static void dump_nodes(prom_glb *glb, FILE *out)
{
    size_t first_root;
    uint32_t *children = list_children(glb, &first_root);
    json_t *scene = json_pack(
        "[{s:o}]", "nodes", number_list(children + first_root, glb->nodes.count - first_root));
    fputs(",\"scene\":0", out);
    dump_member(glb, out, "scenes", scene);
    json_decref(scene);
    fputs(",\"nodes\":[", out);
    for (size_t i = 0; i < glb->nodes.count; i++) {
        json_t *node = node_json(&glb->nodes.data[i], children);
        if (i) fputc(',', out);
        dump(glb, out, node);
        json_decref(node);
    }
    fputc(']', out);
    prom_free(children);
}

static void dump_json(prom_glb *glb, FILE *out, const char *generator)
{
    json_t *asset = json_pack("{s:s, s:s}", "version", "2.0", "generator", generator);
    json_t *buffers = json_pack("[{s:I}]", "byteLength", (json_int_t)glb->bin_bytes);
    json_t *samplers =
        json_pack("[{s:i, s:i}]", "magFilter", FILTER_LINEAR, "minFilter", FILTER_MIPMAPS);
    fputs("{\"asset\":", out);
    dump(glb, out, asset);
    dump_nodes(glb, out);
    // The format forbids empty arrays.
    if (json_array_size(glb->meshes)) dump_member(glb, out, "meshes", glb->meshes);
    if (json_array_size(glb->materials)) dump_member(glb, out, "materials", glb->materials);
    if (json_array_size(glb->images)) {
        dump_member(glb, out, "textures", glb->textures);
        dump_member(glb, out, "samplers", samplers);
        dump_member(glb, out, "images", glb->images);
    }
    if (json_array_size(glb->accessors)) dump_member(glb, out, "accessors", glb->accessors);
    if (json_array_size(glb->views)) {
        dump_member(glb, out, "bufferViews", glb->views);
        dump_member(glb, out, "buffers", buffers);
    }
    fputc('}', out);
    json_decref(asset);
    json_decref(buffers);
    json_decref(samplers);
}

// ---- the file

static void put_words(prom_glb *glb, FILE *out, const uint32_t *words, size_t count)
{
    // glTF is little-endian, and so is every machine that this program runs on.
    if (fwrite(words, 4, count, out) != count) fail(glb, strerror(errno));
}

static void copy_bin(prom_glb *glb, FILE *out)
{
    size_t chunk = (size_t)1 << 20, got;
    uint8_t *buffer = prom_alloc(chunk, 1);
    if (fflush(glb->bin) || fseeko(glb->bin, 0, SEEK_SET)) fail(glb, strerror(errno));
    while (!glb->failed && (got = fread(buffer, 1, chunk, glb->bin)) > 0)
        if (fwrite(buffer, 1, got, out) != got) fail(glb, strerror(errno));
    if (ferror(glb->bin)) fail(glb, strerror(errno));
    prom_free(buffer);
}

static void write_file(prom_glb *glb, FILE *out, const char *generator)
{
    put_words(glb, out, (uint32_t[5]){0}, 5); // header and first chunk's header: filled last
    dump_json(glb, out, generator);
    off_t end = ftello(out);
    while (end >= 0 && end % 4 && fputc(' ', out) != EOF) end++;
    uint64_t total = (uint64_t)end + CHUNK_HEADER_BYTES + glb->bin_bytes;
    if (end < 0) fail(glb, strerror(errno));
    if (total > MAX_BYTES) fail(glb, "over 4 GiB, the limit of .glb; ask for a smaller scene");
    if (glb->failed) return;
    uint32_t json_bytes = (uint32_t)end - HEADER_BYTES - CHUNK_HEADER_BYTES;
    put_words(glb, out, (uint32_t[]){(uint32_t)glb->bin_bytes, CHUNK_BIN}, 2);
    copy_bin(glb, out);
    if (fseeko(out, 0, SEEK_SET)) fail(glb, strerror(errno));
    put_words(glb, out, (uint32_t[]){MAGIC, 2, (uint32_t)total, json_bytes, CHUNK_JSON}, 5);
}

prom_status prom_glb_finish(prom_glb *glb, const char *generator, prom_error *error)
{
    FILE *out = glb->failed ? NULL : fopen(glb->part_path, "wb");
    if (out) {
        write_file(glb, out, generator);
        if (fflush(out) || ferror(out) || fsync(fileno(out))) fail(glb, strerror(errno));
        if (fclose(out)) fail(glb, strerror(errno));
        if (!glb->failed && rename(glb->part_path, glb->path)) fail(glb, strerror(errno));
        if (glb->failed) unlink(glb->part_path);
    } else {
        fail(glb, strerror(errno));
    }
    if (!glb->failed) return PROM_OK;
    return prom_fail(error, glb->error.status, "%s", glb->error.text);
}
