#include "app/output.h"

#include "metaobj/base/alloc.h"

#include <errno.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Reals keep what a person may want to see, not all 17 digits.
#define JSON_FLAGS (JSON_INDENT(2) | JSON_REAL_PRECISION(9))

prom_status prom_output_check(const char *path, prom_error *error)
{
    if (!path) return PROM_OK;
    struct stat st;
    if (stat(path, &st) == 0 && S_ISDIR(st.st_mode))
        return prom_fail(error, PROM_ERR_OUTPUT, "%s: is a folder; name a file", path);
    // Only making a file tells for sure: permissions, read-only and full file systems.
    char *probe = prom_format("%s.XXXXXX", path);
    int file = mkstemp(probe);
    int reason = errno;
    if (file >= 0) {
        close(file);
        unlink(probe);
    }
    prom_free(probe);
    if (file >= 0) return PROM_OK;
    return prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot be written: %s", path,
                     strerror(reason));
}

prom_status prom_output_make_folder(const char *path, prom_error *error)
{
    char *copy = prom_strdup(path);
    bool good = true;
    for (char *at = copy + 1; good && at[-1]; at++) {
        if (*at != '/' && *at) continue;
        char kept = *at;
        *at = 0;
        good = mkdir(copy, 0777) == 0 || errno == EEXIST;
        *at = kept;
    }
    int reason = errno;
    prom_free(copy);
    struct stat st;
    if (good && stat(path, &st) == 0 && S_ISDIR(st.st_mode)) return PROM_OK;
    return prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot make this folder: %s", path,
                     good ? "a file is in the way" : strerror(reason));
}

static bool write_all(const char *path, const char *text, size_t bytes)
{
    FILE *file = fopen(path, "wb");
    if (!file) return false;
    bool good = fwrite(text, 1, bytes, file) == bytes;
    good = fflush(file) == 0 && good;
    good = fsync(fileno(file)) == 0 && good;
    return fclose(file) == 0 && good;
}

prom_status prom_output_write(const char *path, const char *text, size_t bytes,
                              prom_error *error)
{
    char *part = prom_format("%s.part", path);
    bool good = write_all(part, text, bytes) && rename(part, path) == 0;
    int reason = errno;
    if (!good) unlink(part);
    prom_free(part);
    if (good) return PROM_OK;
    return prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot be written: %s", path,
                     strerror(reason));
}

json_t *prom_json_number(double value)
{
    json_t *json = json_real(value);
    return json ? json : json_null();
}

json_t *prom_json_text(const char *text)
{
    json_t *json = json_string(text);
    if (json) return json;
    char *ascii = prom_strdup(text);
    for (char *c = ascii; *c; c++)
        if (*c & 0x80) *c = '?';
    json = json_string(ascii);
    prom_free(ascii);
    return json;
}

// jansson allocates with malloc: free, not prom_free.
static char *dump(json_t *json)
{
    char *text = json_dumps(json, JSON_FLAGS);
    json_decref(json);
    return text;
}

prom_status prom_output_write_json(const char *path, json_t *json, prom_error *error)
{
    char *text = dump(json);
    if (!text)
        return prom_fail(error, PROM_ERR_OUTPUT, "%s: the report is not valid UTF-8", path);
    char *line = prom_format("%s\n", text);
    prom_status status = prom_output_write(path, line, strlen(line), error);
    prom_free(line);
    free(text);
    return status;
}

prom_status prom_output_print_json(json_t *json, prom_error *error)
{
    char *text = dump(json);
    bool good = text && puts(text) >= 0 && fflush(stdout) == 0;
    free(text);
    if (good) return PROM_OK;
    return prom_fail(error, PROM_ERR_OUTPUT, "stdout: the report cannot be printed");
}
