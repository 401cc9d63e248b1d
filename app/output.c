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

// What outputs that are links lead to, for the rest of the program, like argv.
static char *link_targets[PROM_FILES_MAX];

// Whether two names mean one file. A file that is not there yet is known by its folder and
// name.
static bool same_file(const char *a, const char *b)
{
    struct stat sa, sb;
    bool there[2] = {stat(a, &sa) == 0, stat(b, &sb) == 0};
    if (there[0] != there[1]) return false;
    if (there[0]) return sa.st_dev == sb.st_dev && sa.st_ino == sb.st_ino;
    const char *slash[2] = {strrchr(a, '/'), strrchr(b, '/')};
    if (strcmp(slash[0] ? slash[0] + 1 : a, slash[1] ? slash[1] + 1 : b) != 0) return false;
    char *folders[2] = {
        slash[0] ? prom_format("%.*s/", (int)(slash[0] - a), a) : prom_strdup("."),
        slash[1] ? prom_format("%.*s/", (int)(slash[1] - b), b) : prom_strdup("."),
    };
    bool same = stat(folders[0], &sa) == 0 && stat(folders[1], &sb) == 0 &&
                sa.st_dev == sb.st_dev && sa.st_ino == sb.st_ino;
    prom_free(folders[0]);
    prom_free(folders[1]);
    return same;
}

static prom_status check_distinct(const prom_command_files *files, prom_error *error)
{
    for (int i = 0; i < PROM_FILES_MAX; i++) {
        if (!files->outputs[i] || !*files->outputs[i]) continue;
        const char *output = *files->outputs[i];
        for (int k = 0; k < PROM_FILES_MAX; k++) {
            if (files->inputs[k] && same_file(output, files->inputs[k]))
                return prom_fail(error, PROM_ERR_USAGE,
                                 "%s: is also an input; give the output another name", output);
            if (k < i && files->outputs[k] && *files->outputs[k] &&
                same_file(output, *files->outputs[k]))
                return prom_fail(error, PROM_ERR_USAGE,
                                 "%s: is named for two outputs; give one another name", output);
        }
    }
    return PROM_OK;
}

static prom_status follow_link(const char **path, char **kept, prom_error *error)
{
    struct stat st;
    if (lstat(*path, &st) != 0 || !S_ISLNK(st.st_mode)) return PROM_OK;
    char *target = realpath(*path, NULL); // of malloc: free
    if (!target)
        return prom_fail(error, PROM_ERR_OUTPUT, "%s: is a link that leads nowhere: %s", *path,
                         strerror(errno));
    free(*kept);
    *path = *kept = target;
    return PROM_OK;
}

static prom_status check_writable(const char *path, prom_error *error)
{
    struct stat st;
    bool there = stat(path, &st) == 0;
    if (there && S_ISDIR(st.st_mode))
        return prom_fail(error, PROM_ERR_OUTPUT, "%s: is a folder; name a file", path);
    if (there && !S_ISREG(st.st_mode))
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "%s: is no regular file; outputs replace a file as a whole", path);
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

prom_status prom_outputs_check(const prom_command_files *files, prom_error *error)
{
    prom_status status = check_distinct(files, error);
    for (int i = 0; i < PROM_FILES_MAX && !status; i++) {
        if (!files->outputs[i] || !*files->outputs[i]) continue;
        status = follow_link(files->outputs[i], &link_targets[i], error);
        if (!status) status = check_writable(*files->outputs[i], error);
    }
    return status;
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

prom_status prom_output_begin_text(prom_output_text *file, const char *path, prom_error *error)
{
    *file = (prom_output_text){.path = path};
    file->out = open_memstream(&file->text, &file->bytes);
    if (file->out) return PROM_OK;
    return prom_fail(error, PROM_ERR_OUTPUT, "%s: %s", path, strerror(errno));
}

prom_status prom_output_end_text(prom_output_text *file, prom_error *error)
{
    prom_status status;
    if (fclose(file->out) != 0)
        status = prom_fail(error, PROM_ERR_OUTPUT, "%s: %s", file->path, strerror(errno));
    else
        status = prom_output_write(file->path, file->text, file->bytes, error);
    free(file->text); // from the C library
    return status;
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
