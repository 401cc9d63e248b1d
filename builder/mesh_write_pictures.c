#include "builder/file_io.h"
#include "builder/mesh_write_parts.h"

#include <stdlib.h>

// Alpha below this is a hole to a reader that guesses, as import does.
#define HOLE 128

static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? prom_format("%.*s", (int)(slash - path + 1), path) : prom_strdup(".");
}

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

// From one real folder to a real file, without the root they share.
static char *way(const char *folder, const char *file)
{
    size_t shared = 0, i = 0;
    for (; folder[i] && folder[i] == file[i]; i++)
        if (folder[i] == '/') shared = i + 1;
    if (!folder[i] && file[i] == '/') return prom_strdup(file + i + 1);
    char *up = prom_strdup("");
    for (const char *at = folder + shared; at && *at;) {
        char *more = prom_format("%s../", up);
        prom_free(up);
        up = more;
        at = strchr(at, '/');
        at = at ? at + 1 : NULL;
    }
    char *whole = prom_format("%s%s", up, file + shared);
    prom_free(up);
    return whole;
}

// The file that the scene calls `name`, as seen from the mesh's folder; NULL: there is none.
static char *find(const prom_picture_writer *writer, const char *name)
{
    char *found = *name ? prom_file_find(writer->scene, name) : NULL;
    if (!found) return NULL;
    char *folder = folder_of(writer->path);
    char *real_folder = realpath(folder, NULL), *real_file = realpath(found, NULL);
    char *result = real_folder && real_file ? way(real_folder, real_file) : NULL;
    free(real_folder); // from the C library
    free(real_file);
    prom_free(folder);
    prom_free(found);
    return result;
}

static bool has_holes(const prom_source_image *image)
{
    for (size_t i = 0; i < (size_t)image->width * image->height; i++)
        if (image->rgba[4 * i + 3] < HOLE) return true;
    return false;
}

// Whether the scene's files say all that the picture shows.
static bool find_all(const prom_picture_writer *writer, const prom_source_image *image,
                     bool opaque, prom_picture_names *names)
{
    if (image->missing) {
        names->color = prom_strdup(image->name);
        return true;
    }
    const bool masked = *image->mask;
    if (!writer->scene || (masked && (!writer->masks || !strcmp(image->name, image->mask))))
        return false;
    if (opaque && has_holes(image)) return false;
    names->color = find(writer, image->name);
    names->mask = masked ? find(writer, image->mask) : NULL;
    if (names->color && (names->mask || !masked)) return true;
    prom_picture_names_finish(names);
    return false;
}

static prom_status write_picture(prom_picture_writer *writer, const char *path,
                                 const prom_source_image *image, bool opaque, prom_error *error)
{
    uint8_t *png;
    size_t bytes;
    prom_status status = prom_write_png(image, opaque, &png, &bytes, error);
    if (status) return status;
    FILE *out = prom_staged_open(writer->staged, path, error);
    if (out) fwrite(png, 1, bytes, out);
    prom_free(png);
    return out ? PROM_OK : error->status;
}

prom_status prom_picture_name(prom_picture_writer *writer, const prom_material *material,
                              prom_picture_names *names, prom_error *error)
{
    const prom_source_image *image = &writer->source->images.data[material->texture];
    const bool opaque = material->alpha_mode == PROM_ALPHA_OPAQUE;
    *names = (prom_picture_names){0};
    if (find_all(writer, image, opaque, names)) return PROM_OK;
    const uint32_t key = 2 * material->texture + opaque;
    size_t i = 0;
    while (i < writer->keys.count && writer->keys.data[i] != key) i++;
    char *path = prom_format("%s-%zu.png", writer->path, i);
    prom_status status = PROM_OK;
    if (i == writer->keys.count) {
        status = write_picture(writer, path, image, opaque, error);
        prom_array_push(&writer->keys, key);
    }
    if (!status) names->color = prom_strdup(name_of(path));
    prom_free(path);
    return status;
}

void prom_picture_names_finish(prom_picture_names *names)
{
    prom_free(names->color);
    prom_free(names->mask);
    *names = (prom_picture_names){0};
}

void prom_picture_writer_finish(prom_picture_writer *writer)
{
    prom_array_finish(&writer->keys);
}
