// Whole files in and out: reading with a limit, writing so that a file is complete or absent.
#ifndef PROM_BUILDER_FILE_IO_H
#define PROM_BUILDER_FILE_IO_H

#include "metaobj/base/status.h"

#include <stddef.h>
#include <stdint.h>

typedef struct prom_bytes {
    uint8_t *data;
    size_t count;
} prom_bytes;

// Reads a regular file of at most `limit` bytes; one zero byte follows the data. Free
// bytes->data with prom_free. Errors name the path.
prom_status prom_file_read(const char *path, uint64_t limit, prom_bytes *bytes,
                           prom_error *error);

// Writes the parts one after the other into a temporary file beside `path` and renames it:
// either the whole file stands there or what stood there before.
prom_status prom_file_write(const char *path, const prom_bytes *parts, size_t count,
                            prom_error *error);

// Finds a file that a scene names: beside the scene as written (backslashes count as slashes),
// then in any case of letters, then by its last component there and in the usual folders of
// pictures, then all that with %20 and the like decoded. NULL if there is none; free the path
// with prom_free.
char *prom_file_find(const char *scene_path, const char *name);

#endif
