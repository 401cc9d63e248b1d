// Small scene files for tests, in a folder of their own that is removed at the end.
#ifndef PROM_TESTS_SCENE_FILES_H
#define PROM_TESTS_SCENE_FILES_H

#include <dirent.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

static char scene_folder[256];

static inline const char *scene_path(const char *name)
{
    static char path[16][512];
    static int next;
    char *p = path[next++ % 16];
    snprintf(p, sizeof path[0], "%s/%s", scene_folder, name);
    return p;
}

static inline int scene_folder_make(void **state)
{
    (void)state;
    const char *base = getenv("TMPDIR");
    snprintf(scene_folder, sizeof scene_folder, "%s/prom-test-XXXXXX", base ? base : "/tmp");
    return mkdtemp(scene_folder) ? 0 : -1;
}

static inline unsigned scene_folder_count(void)
{
    unsigned count = 0;
    DIR *dir = opendir(scene_folder);
    for (struct dirent *e; dir && (e = readdir(dir));) count += e->d_name[0] != '.';
    if (dir) closedir(dir);
    return count;
}

static inline int scene_folder_remove(void **state)
{
    (void)state;
    DIR *dir = opendir(scene_folder);
    for (struct dirent *e; dir && (e = readdir(dir));)
        if (e->d_name[0] != '.') unlink(scene_path(e->d_name));
    if (dir) closedir(dir);
    return rmdir(scene_folder);
}

static inline const char *scene_write_bytes(const char *name, const void *data, size_t bytes)
{
    const char *path = scene_path(name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(data, 1, bytes, f), bytes);
    assert_int_equal(fclose(f), 0);
    return path;
}

static inline const char *scene_write(const char *name, const char *text)
{
    return scene_write_bytes(name, text, strlen(text));
}

// Base64 of the bytes, to be freed.
static inline char *scene_base64(const void *data, size_t bytes)
{
    static const char digits[] =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const uint8_t *in = data;
    char *out = malloc(bytes / 3 * 4 + 5), *o = out;
    assert_non_null(out);
    for (size_t i = 0; i < bytes; i += 3) {
        uint32_t n = (uint32_t)in[i] << 16 | (i + 1 < bytes ? (uint32_t)in[i + 1] << 8 : 0) |
                     (i + 2 < bytes ? in[i + 2] : 0u);
        for (int k = 0; k < 4; k++) *o++ = digits[n >> (18 - 6 * k) & 63];
        if (i + 1 >= bytes) o[-2] = '=';
        if (i + 2 >= bytes) o[-1] = '=';
    }
    *o = 0;
    return out;
}

// One triangle: three positions, three texture coordinates, three linear RGBA colours.
typedef struct scene_triangle {
    float position[3][3], uv[3][2], color[3][4];
} scene_triangle;

static const scene_triangle scene_triangle_unit = {
    {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}},
    {{0, 0}, {1, 0}, {0, 1}},
    {{0.5f, 0.5f, 0.5f, 1}, {1, 1, 1, 1}, {0, 0, 0, 1}}};

// glTF text around that triangle's buffer: accessors 0 to 2 are its attributes. `uri` is the
// buffer's; `rest` holds the other members ("scenes", "nodes", "meshes", ...).
static inline char *scene_gltf(const char *uri, const char *rest)
{
    static const char form[] =
        "{\"asset\":{\"version\":\"2.0\"},\n"
        "\"buffers\":[{\"uri\":\"%s\",\"byteLength\":108}],\n"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":36},"
        "{\"buffer\":0,\"byteOffset\":36,\"byteLength\":24},"
        "{\"buffer\":0,\"byteOffset\":60,\"byteLength\":48}],\n"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5126,\"count\":3,\"type\":\"VEC3\","
        "\"min\":[0,0,0],\"max\":[1,1,0]},"
        "{\"bufferView\":1,\"componentType\":5126,\"count\":3,\"type\":\"VEC2\"},"
        "{\"bufferView\":2,\"componentType\":5126,\"count\":3,\"type\":\"VEC4\"}],\n%s}\n";
    size_t size = sizeof form + strlen(uri) + strlen(rest);
    char *text = malloc(size);
    assert_non_null(text);
    snprintf(text, size, form, uri, rest);
    return text;
}

static inline const char *scene_write_gltf(const char *name, const char *rest)
{
    char *data = scene_base64(&scene_triangle_unit, sizeof scene_triangle_unit);
    char *uri = NULL;
    assert_true(asprintf(&uri, "data:application/octet-stream;base64,%s", data) > 0);
    char *text = scene_gltf(uri, rest);
    const char *path = scene_write(name, text);
    free(data);
    free(uri);
    free(text);
    return path;
}

#endif
