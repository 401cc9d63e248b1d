// How assimp gets at files: regular ones only, none written, other names tried when a file that
// the scene refers to is not where it says, and one file replaced by bytes in memory.
#include "builder/import_parts.h"

#include <assimp/cfileio.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

typedef struct opened {
    struct aiFile file;
    FILE *stream;     // NULL: bytes in memory
    prom_bytes bytes; // owned by the import
    size_t at, size;
} opened;

static opened *opened_of(struct aiFile *file)
{
    return (opened *)file->UserData;
}

static size_t read_items(struct aiFile *file, char *out, size_t size, size_t count)
{
    opened *o = opened_of(file);
    if (o->stream) return fread(out, size, count, o->stream);
    size_t left = o->size - o->at;
    if (!size || count > left / size) count = size ? left / size : 0;
    if (count) memcpy(out, o->bytes.data + o->at, count * size);
    o->at += count * size;
    return count;
}

static size_t write_nothing(struct aiFile *file, const char *data, size_t size, size_t count)
{
    (void)file;
    (void)data;
    (void)size;
    (void)count;
    return 0;
}

static size_t tell(struct aiFile *file)
{
    opened *o = opened_of(file);
    if (!o->stream) return o->at;
    long at = ftell(o->stream);
    return at < 0 ? 0 : (size_t)at;
}

static size_t file_size(struct aiFile *file)
{
    return opened_of(file)->size;
}

static enum aiReturn seek(struct aiFile *file, size_t offset, enum aiOrigin origin)
{
    opened *o = opened_of(file);
    static const int whence[] = {SEEK_SET, SEEK_CUR, SEEK_END};
    if (origin > aiOrigin_END) return aiReturn_FAILURE;
    if (o->stream)
        return fseek(o->stream, (long)offset, whence[origin]) ? aiReturn_FAILURE
                                                              : aiReturn_SUCCESS;
    size_t from = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? o->at : o->size;
    size_t to = from + offset; // an offset may be negative: it wraps around
    if (to > o->size) return aiReturn_FAILURE;
    o->at = to;
    return aiReturn_SUCCESS;
}

static void flush_nothing(struct aiFile *file)
{
    (void)file;
}

static FILE *open_regular(const char *path, size_t *size)
{
    struct stat info;
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (fd < 0) return NULL;
    FILE *stream = !fstat(fd, &info) && S_ISREG(info.st_mode) ? fdopen(fd, "rb") : NULL;
    if (stream)
        *size = (size_t)info.st_size;
    else
        close(fd);
    return stream;
}

static struct aiFile *open_file(struct aiFileIO *io, const char *name, const char *mode)
{
    prom_import *import = (prom_import *)io->UserData;
    if (*mode != 'r') return NULL;
    opened o = {
        .file = {read_items, write_nothing, tell, file_size, seek, flush_nothing, NULL}};
    bool scene = !strcmp(name, import->path);
    if (scene && import->gltf_file.text.data) {
        o.bytes = import->gltf_file.text;
        o.size = o.bytes.count;
    } else {
        o.stream = open_regular(name, &o.size);
        if (!o.stream && !scene) {
            char *found = prom_file_find(import->path, name);
            if (found) o.stream = open_regular(found, &o.size);
            prom_free(found);
        }
        if (!o.stream) return NULL;
    }
    opened *kept = prom_alloc(1, sizeof *kept);
    *kept = o;
    kept->file.UserData = (char *)kept;
    return &kept->file;
}

static void close_file(struct aiFileIO *io, struct aiFile *file)
{
    (void)io;
    opened *o = opened_of(file);
    if (o->stream) fclose(o->stream);
    prom_free(o);
}

struct aiFileIO prom_import_files(prom_import *import)
{
    return (struct aiFileIO){open_file, close_file, (char *)import};
}
