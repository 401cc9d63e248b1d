#include "builder/file_io.h"

#include "metaobj/base/alloc.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

static prom_status read_all(int fd, const char *path, uint64_t limit, prom_bytes *bytes,
                            prom_error *error)
{
    struct stat info;
    if (fstat(fd, &info))
        return prom_fail(error, PROM_ERR_INPUT, "%s: %s", path, strerror(errno));
    if (S_ISDIR(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s: is a folder; name a file", path);
    if (!S_ISREG(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s: is no regular file", path);
    if ((uint64_t)info.st_size > limit)
        return prom_fail(error, PROM_ERR_INPUT, "%s: has %lld bytes; at most %llu are read",
                         path, (long long)info.st_size, (unsigned long long)limit);
    size_t size = (size_t)info.st_size, got = 0;
    uint8_t *data = prom_alloc(size + 1, 1);
    while (got < size) {
        ssize_t n = read(fd, data + got, size - got);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            prom_free(data);
            return prom_fail(error, PROM_ERR_INPUT, "%s: %s", path, strerror(errno));
        }
        if (n == 0) break; // it shrank meanwhile: what is there counts
        got += (size_t)n;
    }
    data[got] = 0;
    *bytes = (prom_bytes){data, got};
    return PROM_OK;
}

prom_status prom_file_read(const char *path, uint64_t limit, prom_bytes *bytes,
                           prom_error *error)
{
    *bytes = (prom_bytes){0};
    int fd = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK); // a pipe must not block
    if (fd < 0) return prom_fail(error, PROM_ERR_INPUT, "%s: %s", path, strerror(errno));
    prom_status status = read_all(fd, path, limit, bytes, error);
    close(fd);
    return status;
}

static bool write_all(int fd, prom_bytes part)
{
    while (part.count) {
        ssize_t n = write(fd, part.data, part.count);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) return false;
        part.data += n;
        part.count -= (size_t)n;
    }
    return true;
}

// A name beside `path` that nobody has yet; the file gets the rights of any new file.
static int open_beside(const char *path, char **name)
{
    for (int attempt = 0; attempt < 100; attempt++) {
        *name = prom_format("%s.%ld-%d.part", path, (long)getpid(), attempt);
        int fd = open(*name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (fd >= 0 || errno != EEXIST) return fd;
        prom_free(*name);
    }
    *name = NULL;
    return -1;
}

prom_status prom_file_write(const char *path, const prom_bytes *parts, size_t count,
                            prom_error *error)
{
    char *temporary;
    int fd = open_beside(path, &temporary), reason = errno;
    bool good = fd >= 0;
    for (size_t i = 0; good && i < count; i++) good = write_all(fd, parts[i]);
    if (good && fsync(fd)) good = false;
    if (fd >= 0 && !good) reason = errno;
    if (fd >= 0 && close(fd) && good) good = false, reason = errno;
    if (good && rename(temporary, path)) good = false, reason = errno;
    prom_status status = PROM_OK;
    if (!good) {
        if (fd >= 0) unlink(temporary);
        status = prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot be written: %s", path,
                           strerror(reason));
    }
    prom_free(temporary);
    return status;
}
