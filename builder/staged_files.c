#include "builder/staged_files.h"

#include <errno.h>
#include <stdbool.h>
#include <unistd.h>

static prom_status fail(const char *path, int reason, prom_error *error)
{
    return prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot be written: %s", path,
                     strerror(reason));
}

// Whether all of it is on the disk.
static bool close_file(prom_staged_file *file)
{
    if (!file->out) return true;
    bool good = !fflush(file->out) && !ferror(file->out) && !fsync(fileno(file->out));
    int reason = errno;
    if (fclose(file->out) && good) good = false, reason = errno;
    file->out = NULL;
    errno = reason;
    return good;
}

FILE *prom_staged_open(prom_staged_files *staged, const char *path, prom_error *error)
{
    prom_staged_file file = {.path = prom_strdup(path), .part = prom_format("%s.part", path)};
    file.out = fopen(file.part, "wb");
    if (!file.out) {
        fail(path, errno, error);
        prom_free(file.path);
        prom_free(file.part);
        return NULL;
    }
    prom_array_push(&staged->files, file);
    return file.out;
}

prom_status prom_staged_finish(prom_staged_files *staged, prom_status status, prom_error *error)
{
    const size_t count = staged->files.count;
    prom_staged_file *files = staged->files.data;
    for (size_t i = 0; i < count; i++)
        if (!close_file(&files[i]) && !status) status = fail(files[i].path, errno, error);
    for (size_t i = 0; i < count; i++) {
        if (!status && rename(files[i].part, files[i].path))
            status = fail(files[i].path, errno, error);
        if (status) unlink(files[i].part);
        prom_free(files[i].path);
        prom_free(files[i].part);
    }
    prom_array_finish(&staged->files);
    return status;
}
