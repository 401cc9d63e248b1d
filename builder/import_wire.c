#include "builder/import_parts.h"
#include "metaobj/base/hash.h"
#include "metaobj/base/log.h"

#include <assert.h>

// The stream: magic, status, error text, warnings; after an error nothing more. Then counts and
// rows of images, materials, meshes, mesh references and nodes with their levels, and the magic
// again. Texts are a length and bytes. Written and read by one program in one run: native byte
// order.

#define MAGIC 0x31504d4950524f4dull
#define TEXT_LIMIT 4096u
#define SIDE_LIMIT 16384u

static_assert(sizeof(prom_material) == 32, "written without padding");

// ---- packing

static void put(FILE *file, const void *data, size_t bytes)
{
    if (bytes) fwrite(data, bytes, 1, file); // errors stay in the stream until pack ends
}

static void put64(FILE *file, uint64_t value)
{
    put(file, &value, sizeof value);
}

static void put_text(FILE *file, const char *text)
{
    size_t n = strlen(text);
    if (n > TEXT_LIMIT) n = TEXT_LIMIT;
    put64(file, n);
    put(file, text, n);
}

static void put_mesh(FILE *file, const prom_mesh *mesh)
{
    assert(mesh->submesh_count == 1);
    put64(file, mesh->vertex_count);
    put64(file, mesh->index_count);
    put64(file, mesh->submeshes[0].material);
    put(file, mesh->vertices, mesh->vertex_count * sizeof *mesh->vertices);
    put(file, mesh->indices, mesh->index_count * sizeof *mesh->indices);
}

static void put_source(FILE *file, const prom_source *s)
{
    put64(file, s->images.count);
    for (size_t i = 0; i < s->images.count; i++) {
        const prom_source_image *image = &s->images.data[i];
        put_text(file, image->name);
        put_text(file, image->mask);
        put64(file, image->width);
        put64(file, image->height);
        put64(file, image->missing);
        put(file, image->rgba, (size_t)image->width * image->height * 4);
    }
    put64(file, s->materials.count);
    put(file, s->materials.data, s->materials.count * sizeof *s->materials.data);
    put64(file, s->meshes.count);
    for (size_t i = 0; i < s->meshes.count; i++) put_mesh(file, &s->meshes.data[i]);
    put64(file, s->mesh_refs.count);
    put(file, s->mesh_refs.data, s->mesh_refs.count * sizeof *s->mesh_refs.data);
    put64(file, s->nodes.count);
    for (size_t i = 0; i < s->nodes.count; i++) {
        const prom_source_node *node = &s->nodes.data[i];
        put_text(file, node->name);
        put64(file, node->parent);
        put64(file, node->mesh_count);
        put64(file, node->level_count);
        put(file, &node->until, sizeof node->until);
        put(file, node->local, sizeof node->local);
        put(file, node->world, sizeof node->world);
        for (uint32_t k = 0; k < node->level_count; k++) {
            const prom_source_level *level = &s->levels.data[node->first_level + k];
            put64(file, level->mesh_count);
            put(file, &level->until, sizeof level->until);
        }
    }
}

bool prom_import_pack(FILE *file, const prom_source *source, char *const *warnings,
                      size_t warning_count, const prom_error *error)
{
    put64(file, MAGIC);
    put64(file, error->status);
    put_text(file, error->status ? error->text : "");
    put64(file, warning_count);
    for (size_t i = 0; i < warning_count; i++) put_text(file, warnings[i]);
    if (!error->status) put_source(file, source);
    put64(file, MAGIC);
    return !ferror(file) && !fflush(file);
}

// ---- unpacking

typedef struct reader {
    const uint8_t *at;
    size_t left;
    const char *wrong; // the first thing that was wrong; NULL while all is well
} reader;

static bool expect(reader *r, bool good, const char *wrong)
{
    if (!good && !r->wrong) r->wrong = wrong;
    return !r->wrong;
}

static const void *take(reader *r, uint64_t count, size_t size)
{
    uint64_t bytes;
    bool fits = !__builtin_mul_overflow(count, (uint64_t)size, &bytes) && bytes <= r->left;
    if (!expect(r, fits, "it ends early")) return NULL;
    const void *data = r->at;
    r->at += bytes;
    r->left -= bytes;
    return data;
}

static void get(reader *r, void *out, size_t bytes)
{
    const void *data = take(r, bytes, 1);
    if (data)
        memcpy(out, data, bytes);
    else
        memset(out, 0, bytes);
}

static uint64_t get64(reader *r)
{
    uint64_t value;
    get(r, &value, sizeof value);
    return value;
}

// A count of rows that take at least row_bytes each.
static uint32_t get_count(reader *r, size_t row_bytes, const char *wrong)
{
    uint64_t n = get64(r);
    return expect(r, n < PROM_NONE && n <= r->left / row_bytes, wrong) ? (uint32_t)n : 0;
}

// The length of the valid UTF-8 sequence at s (no more than n bytes), or 0.
static size_t utf8_length(const uint8_t *s, size_t n)
{
    static const uint32_t least[5] = {0, 0, 0x80, 0x800, 0x10000};
    size_t length = s[0] < 0x80       ? 1
                    : s[0] >> 5 == 6  ? 2
                    : s[0] >> 4 == 14 ? 3
                    : s[0] >> 3 == 30 ? 4
                                      : 0;
    if (!length || length > n) return 0;
    uint32_t code = length == 1 ? s[0] : s[0] & (0x7fu >> length);
    for (size_t k = 1; k < length; k++) {
        if (s[k] >> 6 != 2) return 0;
        code = code << 6 | (s[k] & 63u);
    }
    bool surrogate = code >= 0xd800 && code < 0xe000;
    return code < least[length] || surrogate || code > 0x10ffff ? 0 : length;
}

// Texts end up in messages and JSON: no control characters, valid UTF-8; the rest becomes '?'.
static char *get_text(reader *r, prom_arena *arena)
{
    uint64_t n = get64(r);
    if (!expect(r, n <= TEXT_LIMIT, "a text is too long")) n = 0;
    const uint8_t *text = take(r, n, 1);
    char *out = prom_arena_alloc(arena, n + 1, 1);
    for (size_t i = 0; text && i < n;) {
        size_t length = utf8_length(text + i, n - i);
        bool printable = length > 1 || (length == 1 && text[i] >= 32 && text[i] != 127);
        if (printable)
            memcpy(out + i, text + i, length);
        else
            out[i] = '?';
        i += printable ? length : 1;
    }
    return out;
}

static void get_images(reader *r, prom_source *s)
{
    uint32_t count = get_count(r, 44, "the count of pictures is wrong");
    for (uint32_t i = 0; i < count && !r->wrong; i++) {
        prom_source_image image = {.name = get_text(r, &s->strings)};
        image.mask = get_text(r, &s->strings);
        uint64_t width = get64(r), height = get64(r);
        image.missing = get64(r) != 0;
        bool good = width && height && width <= SIDE_LIMIT && height <= SIDE_LIMIT;
        if (!expect(r, good, "a picture has an impossible size")) return;
        const uint8_t *pixels = take(r, width * height, 4);
        if (!pixels) return;
        image.width = (uint32_t)width;
        image.height = (uint32_t)height;
        image.rgba = prom_alloc(width * height, 4);
        memcpy(image.rgba, pixels, width * height * 4);
        prom_array_push(&s->images, image);
    }
}

static bool unit_range(float v)
{
    return v >= 0 && v <= 1;
}

static void get_materials(reader *r, prom_source *s)
{
    uint32_t count = get_count(r, sizeof(prom_material), "the count of materials is wrong");
    for (uint32_t i = 0; i < count && !r->wrong; i++) {
        prom_material m;
        get(r, &m, sizeof m);
        bool good = (m.texture == PROM_NONE || m.texture < s->images.count) &&
                    m.alpha_mode <= PROM_ALPHA_BLEND && m.double_sided <= 1 &&
                    unit_range(m.alpha_cutoff);
        for (int k = 0; k < 4; k++) good = good && unit_range(m.base_color[k]);
        if (expect(r, good, "a material is out of range")) prom_array_push(&s->materials, m);
    }
}

static void get_meshes(reader *r, prom_source *s)
{
    uint32_t count = get_count(r, 24, "the count of meshes is wrong");
    for (uint32_t i = 0; i < count && !r->wrong; i++) {
        uint64_t vertices = get64(r), indices = get64(r), material = get64(r);
        bool good = vertices && indices && vertices < PROM_NONE && indices < PROM_NONE &&
                    material <= PROM_NONE;
        if (!expect(r, good, "a mesh has an impossible size")) return;
        const void *vertex_data = take(r, vertices, sizeof(prom_vertex));
        const void *index_data = take(r, indices, sizeof(uint32_t));
        if (r->wrong) return;
        prom_mesh mesh;
        prom_mesh_init(&mesh, (uint32_t)vertices, (uint32_t)indices, 1);
        memcpy(mesh.vertices, vertex_data, vertices * sizeof(prom_vertex));
        memcpy(mesh.indices, index_data, indices * sizeof(uint32_t));
        mesh.submeshes[0] = (prom_submesh){0, (uint32_t)indices, (uint32_t)material};
        prom_array_push(&s->meshes, mesh); // source_finish frees it, right or wrong
        const char *wrong = prom_mesh_check(&mesh, (uint32_t)s->materials.count);
        expect(r, !wrong, wrong);
    }
}

static void get_refs(reader *r, prom_source *s)
{
    uint32_t count = get_count(r, sizeof(uint32_t), "the count of mesh references is wrong");
    if (!count) return;
    uint32_t *refs = prom_array_extend(&s->mesh_refs, count);
    get(r, refs, count * sizeof *refs);
    for (uint32_t i = 0; i < count; i++)
        if (!expect(r, refs[i] < s->meshes.count, "a mesh reference is out of range")) return;
}

// The levels of a node; their references follow its own, from *ref on.
static void get_levels(reader *r, prom_source *s, prom_source_node *node, uint64_t count,
                       uint32_t *ref)
{
    float before = node->until;
    node->first_level = (uint32_t)s->levels.count;
    for (uint64_t k = 0; k < count && !r->wrong; k++) {
        prom_source_level level = {.first_mesh = *ref};
        uint64_t meshes = get64(r);
        get(r, &level.until, sizeof level.until);
        bool good =
            meshes && meshes <= s->mesh_refs.count - *ref && level.until >= before; // no NaN
        if (!expect(r, good, "a level of detail is out of range")) return;
        level.mesh_count = (uint32_t)meshes;
        *ref += level.mesh_count;
        before = level.until;
        prom_array_push(&s->levels, level);
        node->level_count++;
    }
}

static void get_nodes(reader *r, prom_source *s)
{
    uint32_t count = get_count(r, 36 + 2 * sizeof(double[16]), "the count of nodes is wrong");
    uint32_t ref = 0;
    for (uint32_t i = 0; i < count && !r->wrong; i++) {
        prom_source_node node = {.name = get_text(r, &s->strings), .first_mesh = ref};
        uint64_t parent = get64(r), meshes = get64(r), levels = get64(r);
        get(r, &node.until, sizeof node.until);
        get(r, node.local, sizeof node.local);
        get(r, node.world, sizeof node.world);
        bool good = i ? parent < i : parent == PROM_NONE;
        good = good && meshes <= s->mesh_refs.count - ref && node.until > 0;
        for (int k = 0; k < 16; k++)
            good = good && isfinite(node.local[k]) && isfinite(node.world[k]);
        if (!expect(r, good, "a node is out of range")) return;
        node.parent = (uint32_t)parent;
        node.mesh_count = (uint32_t)meshes;
        ref += node.mesh_count;
        get_levels(r, s, &node, levels, &ref);
        prom_array_push(&s->nodes, node);
    }
    expect(r, ref == s->mesh_refs.count, "the nodes do not use all mesh references");
}

static void get_warnings(reader *r, const char *path, prom_arena *arena)
{
    enum { SHOWN = 32 };
    uint32_t count = get_count(r, 8, "the count of warnings is wrong");
    for (uint32_t i = 0; i < count && !r->wrong; i++) {
        const char *text = get_text(r, arena);
        if (i < SHOWN && !r->wrong) prom_log(PROM_LOG_WARNING, "%s: %s", path, text);
    }
    if (count > SHOWN) prom_log(PROM_LOG_WARNING, "%s: and %u more", path, count - SHOWN);
}

// The order of everything counts; pointers, names of files and the clock do not.
static uint64_t hash_content(const prom_source *s)
{
    uint64_t h =
        prom_hash(s->materials.data, s->materials.count * sizeof *s->materials.data, 0);
    for (size_t i = 0; i < s->images.count; i++) {
        const prom_source_image *image = &s->images.data[i];
        uint32_t size[2] = {image->width, image->height};
        h = prom_hash(size, sizeof size, h);
        h = prom_hash(image->rgba, (size_t)image->width * image->height * 4, h);
    }
    for (size_t i = 0; i < s->meshes.count; i++) h = prom_mesh_hash(&s->meshes.data[i], h);
    h = prom_hash(s->mesh_refs.data, s->mesh_refs.count * sizeof *s->mesh_refs.data, h);
    for (size_t i = 0; i < s->nodes.count; i++) {
        const prom_source_node *node = &s->nodes.data[i];
        uint32_t row[4] = {node->parent, node->first_mesh, node->mesh_count, node->level_count};
        h = prom_hash(node->name, strlen(node->name), h);
        h = prom_hash(row, sizeof row, h);
        h = prom_hash(node->local, sizeof node->local, h);
        if (node->level_count) h = prom_hash(&node->until, sizeof node->until, h);
    }
    for (size_t i = 0; i < s->levels.count; i++) {
        const prom_source_level *level = &s->levels.data[i];
        h = prom_hash(&level->mesh_count, sizeof level->mesh_count, h);
        h = prom_hash(&level->until, sizeof level->until, h);
    }
    return h;
}

prom_status prom_import_unpack(const uint8_t *data, size_t bytes, const char *path,
                               prom_source *source, prom_error *error)
{
    reader r = {.at = data, .left = bytes};
    *source = (prom_source){0};
    bool whole = get64(&r) == MAGIC;
    expect(&r, whole, "its start is wrong");
    uint64_t status = get64(&r);
    const char *text = get_text(&r, &source->strings);
    get_warnings(&r, path, &source->strings);
    if (!r.wrong && status) {
        prom_status kept =
            status == PROM_ERR_UNSUPPORTED ? PROM_ERR_UNSUPPORTED : PROM_ERR_INPUT;
        prom_fail(error, kept, "%s", text);
        prom_source_finish(source);
        return kept;
    }
    if (!r.wrong) get_images(&r, source);
    if (!r.wrong) get_materials(&r, source);
    if (!r.wrong) get_meshes(&r, source);
    if (!r.wrong) get_refs(&r, source);
    if (!r.wrong) get_nodes(&r, source);
    expect(&r, get64(&r) == MAGIC && !r.left, "its end is wrong");
    if (!r.wrong) expect(&r, source->mesh_refs.count > 0, "it places no mesh");
    if (r.wrong) {
        prom_source_finish(source);
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: the loader handed over damaged data (%s); the file is probably "
                         "damaged",
                         path, r.wrong);
    }
    source->content_hash = hash_content(source);
    return PROM_OK;
}
