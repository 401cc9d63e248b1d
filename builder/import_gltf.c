#include "builder/import_gltf.h"

#include "builder/import_parts.h"

#include <strings.h>

#define FILE_LIMIT ((uint64_t)8 << 30)
#define GLB_HEADER 12u
#define CHUNK_HEADER 8u
#define CHUNK_JSON 0x4e4f534au
#define CHUNK_BIN 0x004e4942u

json_t *prom_gltf_element(const json_t *root, const char *array, uint32_t index)
{
    return json_array_get(json_object_get(root, array), index);
}

bool prom_gltf_index(const json_t *value, uint64_t limit, uint64_t *index)
{
    double number = json_is_number(value) ? json_number_value(value) : -1;
    if (!(number >= 0) || number >= (double)limit || number != floor(number)) return false;
    *index = (uint64_t)number;
    return *index < limit;
}

static uint32_t little32(const uint8_t *at)
{
    return (uint32_t)at[0] | (uint32_t)at[1] << 8 | (uint32_t)at[2] << 16 |
           (uint32_t)at[3] << 24;
}

// ---- the binary container

typedef struct chunk {
    const uint8_t *data;
    size_t bytes;
} chunk;

static prom_status open_glb(const char *path, prom_gltf *gltf, chunk *json, prom_error *error)
{
    const uint8_t *d = gltf->file.data;
    size_t have = gltf->file.count;
    if (have < GLB_HEADER + CHUNK_HEADER)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: has %zu bytes, too few for a GLB file; it is cut short", path,
                         have);
    uint32_t total = little32(d + 8);
    if (total > have)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: its header promises %u bytes, it has %zu; it is cut short", path,
                         total, have);
    if (total >= GLB_HEADER + CHUNK_HEADER) have = total; // what follows is no part of it
    for (size_t at = GLB_HEADER; have - at >= CHUNK_HEADER;) {
        uint32_t bytes = little32(d + at), kind = little32(d + at + 4);
        at += CHUNK_HEADER;
        if (bytes > have - at)
            return prom_fail(error, PROM_ERR_INPUT,
                             "%s: its chunk at byte %zu is %u bytes long, %zu are left; the "
                             "file is damaged",
                             path, at - CHUNK_HEADER, bytes, have - at);
        if (kind == CHUNK_JSON && !json->data) *json = (chunk){d + at, bytes};
        if (kind == CHUNK_BIN && !gltf->has_bin) {
            gltf->has_bin = true;
            gltf->bin = d + at;
            gltf->bin_bytes = bytes;
        }
        at += bytes;
        size_t gap = (4 - at % 4) % 4;
        if (gap > have - at) break;
        at += gap;
    }
    if (!json->data)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: its GLB container has no JSON chunk; the file is damaged", path);
    return PROM_OK;
}

static void put32(uint8_t *at, uint32_t value)
{
    for (int k = 0; k < 4; k++) at[k] = (uint8_t)(value >> (8 * k));
}

// The changed JSON and the old binary chunk in a new container. False when it grows too large.
static bool write_glb(const prom_gltf *gltf, const char *json, size_t bytes, prom_bytes *out)
{
    size_t json_bytes = (bytes + 3) / 4 * 4, bin_bytes = (gltf->bin_bytes + 3) / 4 * 4;
    size_t total = GLB_HEADER + CHUNK_HEADER + json_bytes;
    if (gltf->has_bin) total += CHUNK_HEADER + bin_bytes;
    if (total > UINT32_MAX) return false;
    uint8_t *d = prom_calloc(total, 1);
    memcpy(d, "glTF", 4);
    put32(d + 4, 2);
    put32(d + 8, (uint32_t)total);
    put32(d + 12, (uint32_t)json_bytes);
    put32(d + 16, CHUNK_JSON);
    memset(d + 20, ' ', json_bytes);
    memcpy(d + 20, json, bytes);
    if (gltf->has_bin) {
        uint8_t *b = d + 20 + json_bytes;
        put32(b, (uint32_t)bin_bytes);
        put32(b + 4, CHUNK_BIN);
        if (gltf->bin_bytes) memcpy(b + 8, gltf->bin, gltf->bin_bytes);
    }
    *out = (prom_bytes){d, total};
    return true;
}

// ---- the text

static prom_status parse(const char *path, prom_gltf *gltf, chunk text, prom_error *error)
{
    static const char mark[] = "\xef\xbb\xbf"; // a byte order mark is no JSON
    if (text.bytes >= 3 && !memcmp(text.data, mark, 3)) {
        text.data += 3;
        text.bytes -= 3;
        gltf->changed = true;
    }
    json_error_t why;
    gltf->root = json_loadb((const char *)text.data, text.bytes,
                            JSON_ALLOW_NUL | JSON_DISABLE_EOF_CHECK, &why);
    if (json_is_object(gltf->root)) return PROM_OK;
    // Names in an old encoding: assimp does not mind.
    if (!gltf->root && json_error_code(&why) == json_error_invalid_utf8) return PROM_OK;
    if (gltf->root)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: its JSON is no object; the file is damaged", path);
    return prom_fail(error, PROM_ERR_INPUT,
                     "%s: its JSON is broken in line %d, column %d: %s; the file is damaged",
                     path, why.line, why.column, why.text);
}

static bool is_version_1(const json_t *root)
{
    const char *version =
        json_string_value(json_object_get(json_object_get(root, "asset"), "version"));
    return json_is_object(json_object_get(root, "meshes")) ||
           (version && !strncmp(version, "1.", 2));
}

static bool write_text(prom_gltf *gltf)
{
    char *json =
        json_dumps(gltf->root, JSON_COMPACT | JSON_REAL_PRECISION(17) | JSON_ENSURE_ASCII);
    if (!json) return false;
    size_t bytes = strlen(json);
    bool good = true;
    if (gltf->glb) {
        good = write_glb(gltf, json, bytes, &gltf->text);
    } else {
        gltf->text.data = prom_alloc(bytes, 1);
        memcpy(gltf->text.data, json, bytes);
        gltf->text.count = bytes;
    }
    free(json);
    return good;
}

static prom_status look(prom_import *import, prom_gltf *gltf, prom_error *error)
{
    prom_status status = prom_gltf_check(import, gltf, error);
    if (status) return status;
    prom_gltf_take_lods(import, gltf);
    if (gltf->changed && !write_text(gltf))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: is too large for its levels of detail to be read", import->path);
    return PROM_OK;
}

prom_status prom_gltf_read(prom_import *import, prom_gltf *gltf, prom_error *error)
{
    const char *path = import->path, *dot = strrchr(path, '.');
    if (!dot || (strcasecmp(dot, ".gltf") && strcasecmp(dot, ".glb"))) return PROM_OK;
    prom_import_doing(import, "reading its JSON");
    prom_status status = prom_file_read(path, FILE_LIMIT, &gltf->file, error);
    if (status) return status;
    chunk text = {gltf->file.data, gltf->file.count};
    // Either ending may stand for either form.
    gltf->glb = text.bytes >= 4 && !memcmp(text.data, "glTF", 4);
    if (gltf->glb && text.bytes >= 8 && little32(text.data + 4) == 1) return PROM_OK;
    if (!gltf->glb && !strcasecmp(dot, ".glb") && !memchr(text.data, '{', text.bytes))
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: is no GLB file: it does not start with \"glTF\"", path);
    if (gltf->glb) {
        text = (chunk){0};
        status = open_glb(path, gltf, &text, error);
    }
    if (!status) status = parse(path, gltf, text, error);
    if (!status && gltf->root && !is_version_1(gltf->root)) status = look(import, gltf, error);
    // What is left of it is small: assimp needs the memory.
    json_decref(gltf->root);
    gltf->root = NULL;
    prom_free(gltf->file.data);
    gltf->file = (prom_bytes){0};
    gltf->bin = NULL;
    return status;
}

void prom_gltf_finish(prom_gltf *gltf)
{
    json_decref(gltf->root);
    prom_free(gltf->file.data);
    prom_free(gltf->text.data);
    for (size_t i = 0; i < gltf->names.count; i++) prom_free(gltf->names.data[i]);
    prom_array_finish(&gltf->names);
    prom_array_finish(&gltf->lods);
    prom_array_finish(&gltf->levels);
    *gltf = (prom_gltf){0};
}
