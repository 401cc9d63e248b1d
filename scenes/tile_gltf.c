#include "scenes/tile_gltf.h"

#include "builder/file_io.h"
#include "metaobj/base/log.h"

#include <strings.h>

#define FILE_LIMIT ((uint64_t)4 << 30) // a .glb counts its bytes in 32 bits
enum { GLB_MAGIC = 0x46546c67, CHUNK_JSON = 0x4e4f534a, CHUNK_BIN = 0x004e4942 };

json_t *prom_tile_gltf_array(json_t *object, const char *key)
{
    json_t *array = json_object_get(object, key);
    if (json_is_array(array)) return array;
    array = json_array();
    json_object_set_new(object, key, array);
    return array;
}

bool prom_tile_gltf_index(const json_t *object, const char *key, size_t limit, size_t *out)
{
    const json_t *value = json_object_get(object, key);
    if (!json_is_integer(value)) return false;
    json_int_t i = json_integer_value(value);
    if (i < 0 || (uint64_t)i >= limit) return false;
    *out = (size_t)i;
    return true;
}

uint64_t prom_tile_gltf_bytes(const json_t *object, const char *key, uint64_t missing)
{
    const json_t *value = json_object_get(object, key);
    if (!value) return missing;
    json_int_t i = json_is_integer(value) ? json_integer_value(value) : -1;
    return i < 0 ? UINT64_MAX : (uint64_t)i;
}

// Appends to bin at a multiple of 4 and gives the offset.
static size_t append(prom_tile_gltf *gltf, const uint8_t *data, size_t bytes)
{
    size_t padding = (4 - gltf->bin.count % 4) % 4;
    if (padding) (void)prom_array_extend(&gltf->bin, padding);
    size_t offset = gltf->bin.count;
    if (bytes) memcpy(prom_array_extend(&gltf->bin, bytes), data, bytes);
    return offset;
}

// ---- data URIs

static int base64_value(char c)
{
    if (c >= 'A' && c <= 'Z') return c - 'A';
    if (c >= 'a' && c <= 'z') return c - 'a' + 26;
    if (c >= '0' && c <= '9') return c - '0' + 52;
    return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : -1;
}

static bool is_data_uri(const char *uri)
{
    return !strncasecmp(uri, "data:", 5);
}

// The bytes of a base64 data URI; false if it is none.
static bool decode_data_uri(const char *uri, prom_bytes *out)
{
    const char *text = strstr(uri, ";base64,");
    if (!text) return false;
    text += strlen(";base64,");
    *out = (prom_bytes){prom_alloc(strlen(text) / 4 * 3 + 3, 1), 0};
    uint32_t word = 0;
    int bits = 0;
    for (; *text && *text != '='; text++) {
        int value = base64_value(*text);
        if (value < 0) {
            prom_free(out->data);
            return false;
        }
        word = word << 6 | (uint32_t)value;
        if ((bits += 6) >= 8) out->data[out->count++] = (uint8_t)(word >> (bits -= 8));
    }
    return true;
}

// ---- reading

static uint32_t u32(const uint8_t *p)
{
    return p[0] | (uint32_t)p[1] << 8 | (uint32_t)p[2] << 16 | (uint32_t)p[3] << 24;
}

static bool is_glb(const prom_bytes *file)
{
    return file->count >= 12 && u32(file->data) == GLB_MAGIC;
}

static prom_status split_glb(const char *path, const prom_bytes *file, prom_bytes *json,
                             prom_bytes *bin, prom_error *error)
{
    if (u32(file->data + 4) != 2)
        return prom_fail(error, PROM_ERR_INPUT, "%s: is no glTF 2 (container version %u)", path,
                         u32(file->data + 4));
    for (size_t at = 12; file->count - at >= 8;) {
        uint64_t bytes = u32(file->data + at);
        uint32_t type = u32(file->data + at + 4);
        if (bytes > file->count - at - 8)
            return prom_fail(error, PROM_ERR_INPUT,
                             "%s: ends within the chunk at byte %zu; the file is damaged", path,
                             at);
        prom_bytes chunk = {file->data + at + 8, (size_t)bytes};
        if (type == CHUNK_JSON && !json->data) *json = chunk;
        if (type == CHUNK_BIN && !bin->data) *bin = chunk;
        at += 8 + (size_t)bytes;
        if (at > file->count) break;
    }
    if (json->data) return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT, "%s: has no JSON chunk; the file is damaged", path);
}

static prom_status parse(const char *path, const prom_bytes *text, json_t **root,
                         prom_error *error)
{
    json_error_t why;
    *root = json_loadb((const char *)text->data, text->count, 0, &why);
    if (!*root)
        return prom_fail(error, PROM_ERR_INPUT, "%s: line %d, column %d: %s", path, why.line,
                         why.column, why.text);
    const json_t *asset = json_object_get(*root, "asset");
    const char *version = json_string_value(json_object_get(asset, "version"));
    if (version && version[0] == '2') return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: is no glTF 2 (asset version %s); tiling needs glTF 2", path,
                     version ? version : "missing");
}

static prom_status load_buffer(const char *path, size_t i, const json_t *buffer,
                               const prom_bytes *bin, prom_bytes *out, prom_error *error)
{
    const char *uri = json_string_value(json_object_get(buffer, "uri"));
    uint64_t bytes = prom_tile_gltf_bytes(buffer, "byteLength", UINT64_MAX);
    if (!uri && i == 0 && bin->data) {
        *out = (prom_bytes){prom_alloc(bin->count, 1), bin->count};
        memcpy(out->data, bin->data, bin->count);
    } else if (!uri) {
        return prom_fail(error, PROM_ERR_INPUT, "%s: buffer %zu has no data", path, i);
    } else if (is_data_uri(uri)) {
        if (!decode_data_uri(uri, out))
            return prom_fail(error, PROM_ERR_INPUT, "%s: buffer %zu has a broken data URI",
                             path, i);
    } else {
        char *found = prom_file_find(path, uri);
        prom_status status =
            found ? prom_file_read(found, FILE_LIMIT, out, error)
                  : prom_fail(error, PROM_ERR_INPUT, "%s: its buffer %s is missing", path, uri);
        prom_free(found);
        if (status) return status;
    }
    if (bytes <= out->count) return PROM_OK;
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: buffer %zu holds %zu bytes, not the %lld named", path, i, out->count,
                     (long long)bytes);
}

// Points a bufferView (or the extension object that stands for one) into bin.
static bool move_view(json_t *view, const size_t *base, const size_t *size, size_t count)
{
    size_t b;
    if (!prom_tile_gltf_index(view, "buffer", count, &b)) return false;
    uint64_t offset = prom_tile_gltf_bytes(view, "byteOffset", 0);
    uint64_t length = prom_tile_gltf_bytes(view, "byteLength", UINT64_MAX);
    if (offset > size[b] || length > size[b] - offset) return false;
    json_object_set_new(view, "buffer", json_integer(0));
    json_object_set_new(view, "byteOffset", json_integer((json_int_t)(base[b] + offset)));
    return true;
}

static prom_status move_views(prom_tile_gltf *gltf, const char *path, const size_t *base,
                              const size_t *size, size_t count, prom_error *error)
{
    json_t *view;
    size_t i;
    json_array_foreach(json_object_get(gltf->root, "bufferViews"), i, view)
    {
        json_t *compressed =
            json_object_get(json_object_get(view, "extensions"), "EXT_meshopt_compression");
        bool good = move_view(view, base, size, count) &&
                    (!compressed || move_view(compressed, base, size, count));
        if (!good)
            return prom_fail(error, PROM_ERR_INPUT,
                             "%s: bufferView %zu lies outside its buffer; the file is damaged",
                             path, i);
    }
    return PROM_OK;
}

static prom_status merge_buffers(prom_tile_gltf *gltf, const char *path, const prom_bytes *bin,
                                 prom_error *error)
{
    json_t *buffers = prom_tile_gltf_array(gltf->root, "buffers");
    size_t count = json_array_size(buffers);
    size_t *base = prom_calloc(count, sizeof *base), *size = prom_calloc(count, sizeof *size);
    prom_status status = PROM_OK;
    for (size_t i = 0; i < count && !status; i++) {
        prom_bytes data = {0};
        status = load_buffer(path, i, json_array_get(buffers, i), bin, &data, error);
        if (!status) {
            size[i] = data.count;
            base[i] = append(gltf, data.data, data.count);
        }
        prom_free(data.data);
    }
    if (!status) status = move_views(gltf, path, base, size, count, error);
    prom_free(base);
    prom_free(size);
    return status;
}

static prom_status load(prom_tile_gltf *gltf, const char *path, const prom_bytes *file,
                        prom_error *error)
{
    prom_bytes json = *file, bin = {0};
    size_t start = 0;
    if (is_glb(file)) {
        json = (prom_bytes){0};
        prom_status status = split_glb(path, file, &json, &bin, error);
        if (status) return status;
    } else {
        while (start < file->count && strchr(" \t\r\n", file->data[start])) start++;
        if (start == file->count || file->data[start] != '{')
            return prom_fail(error, PROM_ERR_INPUT,
                             "%s: is no glTF; tiling needs a .gltf or .glb file", path);
    }
    prom_status status = parse(path, &json, &gltf->root, error);
    return status ? status : merge_buffers(gltf, path, &bin, error);
}

prom_status prom_tile_gltf_load(const char *path, prom_tile_gltf *gltf, prom_error *error)
{
    *gltf = (prom_tile_gltf){0};
    prom_bytes file;
    prom_status status = prom_file_read(path, FILE_LIMIT, &file, error);
    if (status) return status;
    status = load(gltf, path, &file, error);
    prom_free(file.data);
    if (status) prom_tile_gltf_finish(gltf);
    return status;
}

// ---- pictures

static const char *mime_of(const prom_bytes *file)
{
    static const struct {
        size_t at, length;
        const char *magic, *mime;
    } table[] = {
        {0, 8, "\x89PNG\r\n\x1a\n", "image/png"},
        {0, 3, "\xff\xd8\xff", "image/jpeg"},
        {8, 4, "WEBP", "image/webp"},
        {0, 4, "DDS ", "image/vnd-ms.dds"},
        {1, 4, "KTX ", "image/ktx2"},
        {0, 2, "BM", "image/bmp"},
        {0, 4, "GIF8", "image/gif"},
    };
    for (size_t i = 0; i < sizeof table / sizeof *table; i++)
        if (file->count >= table[i].at + table[i].length &&
            !memcmp(file->data + table[i].at, table[i].magic, table[i].length))
            return table[i].mime;
    return NULL;
}

static bool read_picture(const char *path, const char *uri, prom_bytes *out)
{
    if (is_data_uri(uri)) return decode_data_uri(uri, out);
    char *found = prom_file_find(path, uri);
    bool good = found && !prom_file_read(found, FILE_LIMIT, out, NULL);
    prom_free(found);
    return good;
}

static void embed(prom_tile_gltf *gltf, const char *path, json_t *image)
{
    const char *uri = json_string_value(json_object_get(image, "uri"));
    prom_bytes data = {0};
    if (!uri) return;
    bool good = read_picture(path, uri, &data);
    const char *mime = good ? mime_of(&data) : NULL;
    if (!mime) {
        prom_log(PROM_LOG_WARNING, "%s: its picture %.80s %s; it is left out of the .glb", path,
                 uri, good ? "is of no known format" : "is missing or broken");
    } else {
        json_t *views = prom_tile_gltf_array(gltf->root, "bufferViews");
        size_t offset = append(gltf, data.data, data.count);
        json_array_append_new(views, json_pack("{s:i, s:I, s:I}", "buffer", 0, "byteOffset",
                                               (json_int_t)offset, "byteLength",
                                               (json_int_t)data.count));
        // The name keeps where it came from: messages about pictures use it.
        if (!json_object_get(image, "name") && !is_data_uri(uri))
            json_object_set_new(image, "name", json_string(uri));
        json_object_del(image, "uri");
        json_object_set_new(image, "bufferView",
                            json_integer((json_int_t)json_array_size(views) - 1));
        json_object_set_new(image, "mimeType", json_string(mime));
    }
    prom_free(data.data);
}

void prom_tile_gltf_embed_images(prom_tile_gltf *gltf, const char *path)
{
    json_t *image;
    size_t i;
    json_array_foreach(json_object_get(gltf->root, "images"), i, image)
    {
        embed(gltf, path, image);
    }
}

// ---- writing

static void put_u32(uint8_t *p, uint32_t v)
{
    for (int k = 0; k < 4; k++) p[k] = (uint8_t)(v >> 8 * k);
}

prom_status prom_tile_gltf_save(const prom_tile_gltf *gltf, const char *path, prom_error *error)
{
    static uint8_t spaces[4] = "   ", zeros[4];
    size_t bin_pad = (4 - gltf->bin.count % 4) % 4, bin_bytes = gltf->bin.count + bin_pad;
    json_t *buffer = json_pack("{s:I}", "byteLength", (json_int_t)gltf->bin.count);
    json_t *buffers = json_array();
    if (bin_bytes) json_array_append(buffers, buffer);
    json_decref(buffer);
    if (bin_bytes)
        json_object_set(gltf->root, "buffers", buffers);
    else
        json_object_del(gltf->root, "buffers");
    json_decref(buffers);
    char *text = json_dumps(gltf->root, JSON_COMPACT);
    if (!text)
        return prom_fail(error, PROM_ERR_OUTPUT, "%s: the scene cannot be put into JSON", path);
    size_t length = strlen(text), json_pad = (4 - length % 4) % 4;
    uint64_t total = 12 + 8 + length + json_pad + (bin_bytes ? 8 + bin_bytes : 0);
    uint8_t head[20], bin_head[8];
    put_u32(head, GLB_MAGIC);
    put_u32(head + 4, 2);
    put_u32(head + 8, (uint32_t)total);
    put_u32(head + 12, (uint32_t)(length + json_pad));
    put_u32(head + 16, CHUNK_JSON);
    put_u32(bin_head, (uint32_t)bin_bytes);
    put_u32(bin_head + 4, CHUNK_BIN);
    prom_bytes parts[] = {
        {head, sizeof head},           {(uint8_t *)text, length},         {spaces, json_pad},
        {bin_head, bin_bytes ? 8 : 0}, {gltf->bin.data, gltf->bin.count}, {zeros, bin_pad}};
    prom_status status =
        total <= UINT32_MAX
            ? prom_file_write(path, parts, sizeof parts / sizeof *parts, error)
            : prom_fail(
                  error, PROM_ERR_OUTPUT,
                  "%s: would need %llu bytes; a .glb holds at most 4 GiB; take fewer tiles",
                  path, (unsigned long long)total);
    free(text);
    return status;
}

void prom_tile_gltf_finish(prom_tile_gltf *gltf)
{
    json_decref(gltf->root);
    prom_array_finish(&gltf->bin);
    *gltf = (prom_tile_gltf){0};
}
