#include "builder/child.h"
#include "builder/import_parts.h"

#include <errno.h>
#include <sys/stat.h>
#include <unistd.h>

#define DEFAULT_TEXTURE_PX 1024u
#define DEFAULT_MEMORY_BYTES ((uint64_t)8 << 30)
#define DEFAULT_TIME_S 300u
// What the child may hand over, so that a runaway loader cannot fill the machine's memory.
#define RESULT_LIMIT_BYTES ((uint64_t)16 << 30)

void (*prom_import_child_hook)(void);

typedef struct job {
    const char *path;
    const prom_import_options *options;
} job;

static bool work(void *user, FILE *result, char *doing)
{
    const job *j = user;
    if (prom_import_child_hook) prom_import_child_hook();
    prom_source source = {0};
    prom_import import = {
        .path = j->path, .options = *j->options, .source = &source, .doing = doing};
    prom_error error = {0};
    error.status = prom_import_run(&import, &error);
    prom_import_doing(&import, "handing it over");
    return prom_import_pack(result, &source, import.warnings.data, import.warnings.count,
                            &error);
}

static prom_status run(const char *path, const prom_import_options *options,
                       prom_source *source, prom_error *error)
{
    job j = {path, options};
    prom_child_task task = {.path = path,
                            .who = "loader",
                            .memory_bytes = options->memory_bytes,
                            .result_bytes = RESULT_LIMIT_BYTES,
                            .time_s = options->time_s,
                            .work = work,
                            .user = &j};
    prom_child_result result;
    prom_status status = prom_child_run(&task, &result, error);
    if (status) return status;
    status = prom_import_unpack(result.data, result.bytes, path, source, error);
    prom_child_result_finish(&result);
    return status;
}

prom_status prom_source_import(const char *path, const prom_import_options *options,
                               prom_source *source, prom_error *error)
{
    static const prom_import_options none = {0};
    prom_import_options o = options ? *options : none;
    if (!o.max_texture_px) o.max_texture_px = DEFAULT_TEXTURE_PX;
    if (!o.memory_bytes) o.memory_bytes = DEFAULT_MEMORY_BYTES;
    if (!o.time_s) o.time_s = DEFAULT_TIME_S;
    if (o.max_texture_px > PROM_TEXTURE_MAX) o.max_texture_px = PROM_TEXTURE_MAX;
    *source = (prom_source){0};
    if (o.unit_m < 0 || !(o.unit_m < 1e9) || (o.unit_m > 0 && o.unit_m < 1e-9))
        return prom_fail(error, PROM_ERR_USAGE,
                         "import: a unit of %g m is no length; give metres, say 0.0254",
                         o.unit_m);
    if (o.up > PROM_UP_Z)
        return prom_fail(error, PROM_ERR_USAGE, "import: %u is no axis", (unsigned)o.up);
    struct stat info;
    if (stat(path, &info))
        return prom_fail(error, PROM_ERR_INPUT, "%s: %s", path, strerror(errno));
    if (S_ISDIR(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s: is a folder; name a scene file in it",
                         path);
    if (!S_ISREG(info.st_mode))
        return prom_fail(error, PROM_ERR_INPUT, "%s: is no regular file", path);
    if (!info.st_size) return prom_fail(error, PROM_ERR_INPUT, "%s: is empty", path);
    if (access(path, R_OK))
        return prom_fail(error, PROM_ERR_INPUT, "%s: %s", path, strerror(errno));
    prom_status status = run(path, &o, source, error);
    if (!status) source->file_bytes = (uint64_t)info.st_size;
    return status;
}
