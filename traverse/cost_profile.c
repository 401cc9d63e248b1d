// The cost model as a JSON file.
#include "traverse/cost.h"

#include "metaobj/base/alloc.h"

#include <ctype.h>
#include <errno.h>
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FORMAT "promenade-cost-profile"
#define VERSION 3
#define OLDEST_VERSION 2 // without form, bind_ms, uploading_ms and upload_ms
#define FILE_BYTES_MAX 65536
#define SIDE_MAX 65536

static const char *const shading_keys[PROM_COST_KINDS] = {
    "plain", "textured", "masked", "blended", "impostor", "impostor_lit"};

static const char *const form_names[PROM_COST_FORMS] = {"sum", "max"};

typedef struct field {
    const char *key;
    size_t offset;
    double least, most;
} field;

#define FIELD(name, least, most)                                                               \
    {                                                                                          \
#name, offsetof(prom_cost_model, name), least, most                                    \
    }
static const field fields[] = {
    FIELD(fixed_ms, 0.0, 1e6),        FIELD(draw_ms, 0.0, 1e6),
    FIELD(vertex_ms, 0.0, 1e6),       FIELD(triangle_ms, 0.0, 1e6),
    FIELD(edge_ms, 0.0, 1e6),         FIELD(hidden_edge_ms, 0.0, 1e6),
    FIELD(hidden_pixel_ms, 0.0, 1e6), FIELD(mean_error, 0.0, 1e6),
    FIELD(worst_under, 0.0, 1e6),     FIELD(margin, 0.0, 0.9),
    FIELD(bind_ms, 0.0, 1e6),         FIELD(upload_ms, 0.0, 1e6),
    FIELD(uploading_ms, 0.0, 1e6),
};
enum { FIELD_COUNT = sizeof fields / sizeof *fields, OLDEST_FIELD_COUNT = FIELD_COUNT - 3 };

// ---- saving

// Renderer names are ASCII in practice; JSON takes valid UTF-8 only.
static void printable(const char *text, char *out, size_t size)
{
    size_t i = 0;
    for (; i + 1 < size && text[i]; i++)
        out[i] = text[i] >= 32 && text[i] < 127 ? text[i] : '?';
    out[i] = 0;
}

bool prom_cost_is_of(const prom_cost_model *model, const char *renderer)
{
    char measured[sizeof model->renderer], here[sizeof model->renderer];
    printable(model->renderer, measured, sizeof measured);
    printable(renderer, here, sizeof here);
    return !strcmp(measured, here);
}

static json_t *to_json(const prom_cost_model *model)
{
    char renderer[sizeof model->renderer];
    printable(model->renderer, renderer, sizeof renderer);
    json_t *root = json_object(), *pixel = json_object();
    json_object_set_new(root, "format", json_string(FORMAT));
    json_object_set_new(root, "version", json_integer(VERSION));
    json_object_set_new(root, "renderer", json_string(renderer));
    json_object_set_new(root, "form", json_string(form_names[model->form]));
    json_object_set_new(root, "sample_count", json_integer(model->sample_count));
    if (model->width && model->height) {
        json_object_set_new(root, "width", json_integer(model->width));
        json_object_set_new(root, "height", json_integer(model->height));
    }
    for (int i = 0; i < FIELD_COUNT; i++) {
        double value;
        memcpy(&value, (const char *)model + fields[i].offset, sizeof value);
        json_object_set_new(root, fields[i].key, json_real(value));
    }
    for (int k = 0; k < PROM_COST_KINDS; k++)
        json_object_set_new(pixel, shading_keys[k], json_real(model->pixel_ms[k]));
    json_object_set_new(root, "pixel_ms", pixel);
    return root;
}

// Writes, syncs and closes; what could not be written shows in errno.
static bool write_file(const char *path, const char *text)
{
    FILE *file = fopen(path, "wbx");
    if (!file) return false;
    bool good = fputs(text, file) >= 0 && fputc('\n', file) != EOF && !fflush(file) &&
                !fsync(fileno(file));
    int reason = errno;
    if (fclose(file) && good) return false;
    errno = reason;
    return good;
}

static const char *model_fault(const prom_cost_model *model);

prom_status prom_cost_save(const prom_cost_model *model, const char *path, prom_error *error)
{
    const char *fault = model_fault(model);
    if (fault)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: cost profile not written: %s is out of range; calibrate again",
                         path, fault);
    prom_status status = PROM_OK;
    json_t *root = to_json(model);
    char *text = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(17));
    char *part = prom_format("%s.%ld.part", path, (long)getpid());
    remove(part);
    if (!text || !write_file(part, text) || rename(part, path)) {
        status = prom_fail(error, PROM_ERR_OUTPUT, "%s: cannot write the cost profile: %s",
                           path, text ? strerror(errno) : "out of memory");
        remove(part);
    }
    prom_free(part);
    free(text);
    json_decref(root);
    return status;
}

// ---- loading

static bool in_range(double value, double least, double most)
{
    return isfinite(value) && value >= least && value <= most;
}

// The key of the first number that is out of range, or NULL.
static const char *model_fault(const prom_cost_model *model)
{
    for (int i = 0; i < FIELD_COUNT; i++) {
        double value;
        memcpy(&value, (const char *)model + fields[i].offset, sizeof value);
        if (!in_range(value, fields[i].least, fields[i].most)) return fields[i].key;
    }
    for (int k = 0; k < PROM_COST_KINDS; k++)
        if (!in_range(model->pixel_ms[k], 0.0, 1e6)) return "pixel_ms";
    if ((int)model->form < 0 || model->form >= PROM_COST_FORMS) return "form";
    return NULL;
}

static bool get_number(const json_t *object, const char *key, double *value)
{
    const json_t *v = json_object_get(object, key);
    if (!json_is_number(v)) return false;
    *value = json_number_value(v);
    return true;
}

// Both sides or none; counts their keys.
static bool get_size(const json_t *root, prom_cost_model *model, size_t *keys)
{
    const json_t *width = json_object_get(root, "width");
    const json_t *height = json_object_get(root, "height");
    if (!width && !height) return true;
    *keys += 2;
    if (!json_is_integer(width) || !json_is_integer(height)) return false;
    json_int_t w = json_integer_value(width), h = json_integer_value(height);
    if (w < 1 || h < 1 || w > SIDE_MAX || h > SIDE_MAX) return false;
    model->width = (uint32_t)w;
    model->height = (uint32_t)h;
    return true;
}

static bool get_form(const json_t *root, prom_cost_model *model)
{
    const char *name = json_string_value(json_object_get(root, "form"));
    for (int form = 0; name && form < PROM_COST_FORMS; form++)
        if (!strcmp(name, form_names[form])) {
            model->form = (prom_cost_form)form;
            return true;
        }
    return false;
}

static bool get_fields(const json_t *root, int count, prom_cost_model *model,
                       const char **fault)
{
    for (int i = 0; i < count; i++) {
        double value;
        *fault = fields[i].key;
        if (!get_number(root, fields[i].key, &value)) return false;
        memcpy((char *)model + fields[i].offset, &value, sizeof value);
    }
    return true;
}

// The first key that is missing, of a wrong type or out of range, or NULL.
static const char *from_json(const json_t *root, prom_cost_model *model)
{
    const char *format = json_string_value(json_object_get(root, "format"));
    if (!format || strcmp(format, FORMAT)) return "format";
    const json_t *version = json_object_get(root, "version");
    json_int_t number = json_integer_value(version);
    if (!json_is_integer(version) || number < OLDEST_VERSION || number > VERSION)
        return "version";
    const char *renderer = json_string_value(json_object_get(root, "renderer"));
    if (!renderer || strlen(renderer) >= sizeof model->renderer) return "renderer";
    memcpy(model->renderer, renderer, strlen(renderer) + 1);
    const json_t *samples = json_object_get(root, "sample_count");
    json_int_t count = json_integer_value(samples);
    if (!json_is_integer(samples) || count < 0 || count > UINT32_MAX) return "sample_count";
    model->sample_count = (uint32_t)count;
    bool old = number == OLDEST_VERSION;
    size_t keys = (size_t)(old ? OLDEST_FIELD_COUNT : FIELD_COUNT);
    const char *fault;
    if (!get_fields(root, (int)keys, model, &fault)) return fault;
    if (!old && !get_form(root, model)) return "form";
    const json_t *pixel = json_object_get(root, "pixel_ms");
    if (json_object_size(pixel) != PROM_COST_KINDS) return "pixel_ms";
    for (int k = 0; k < PROM_COST_KINDS; k++)
        if (!get_number(pixel, shading_keys[k], &model->pixel_ms[k])) return "pixel_ms";
    // format, version, renderer, sample_count and pixel_ms are the other five.
    keys += old ? 5 : 6; // and form
    if (!get_size(root, model, &keys)) return "width and height";
    if (json_object_size(root) != keys) return "a key that nobody knows";
    return model_fault(model);
}

// The whole file as text; NULL with *error.
static char *read_file(const char *path, size_t *bytes, prom_error *error)
{
    FILE *file = fopen(path, "rb");
    if (!file) {
        prom_fail(error, PROM_ERR_INPUT, "%s: cannot read the cost profile: %s", path,
                  strerror(errno));
        return NULL;
    }
    char *text = prom_alloc(FILE_BYTES_MAX + 1, 1);
    *bytes = fread(text, 1, FILE_BYTES_MAX + 1, file);
    bool failed = ferror(file);
    fclose(file);
    if (!failed && *bytes <= FILE_BYTES_MAX) return text;
    prom_fail(error, PROM_ERR_INPUT, "%s: %s", path,
              failed ? "cannot read the cost profile" : "too large to be a cost profile");
    prom_free(text);
    return NULL;
}

prom_status prom_cost_load(const char *path, prom_cost_model *model, prom_error *error)
{
    size_t bytes;
    char *text = read_file(path, &bytes, error);
    if (!text) return PROM_ERR_INPUT;
    json_error_t where;
    json_t *root = json_loadb(text, bytes, JSON_REJECT_DUPLICATES, &where);
    prom_free(text);
    if (!root)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s:%d: not a cost profile: %s; `promenade calibrate -o` writes one",
                         path, where.line, where.text);
    prom_cost_model loaded = {0};
    const char *fault = from_json(root, &loaded);
    json_decref(root);
    if (fault)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s: not a valid cost profile: %s is missing or out of range; "
                         "calibrate again",
                         path, fault);
    *model = loaded;
    return PROM_OK;
}

// ---- the profile's place

// Makes the folders above the last component of an absolute path.
static bool make_parents(char *path)
{
    for (char *c = path + 1; *c; c++) {
        if (*c != '/') continue;
        *c = 0;
        bool made = !mkdir(path, 0700) || errno == EEXIST;
        *c = '/';
        if (!made) return false;
    }
    return true;
}

char *prom_cost_cache_path(const char *renderer, uint32_t width, uint32_t height)
{
    // Letters, digits and dots stay; every run of others becomes one dash.
    char name[96];
    size_t length = 0;
    for (const char *c = renderer; *c && length + 1 < sizeof name; c++) {
        if (isalnum((unsigned char)*c) || (*c == '.' && length))
            name[length++] = *c;
        else if (length && name[length - 1] != '-')
            name[length++] = '-';
    }
    while (length && name[length - 1] == '-') length--;
    name[length] = 0;

    const char *cache = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    char *path = NULL;
    if (cache && cache[0] == '/')
        path = prom_format("%s/promenade/%s-%ux%u.json", cache, name, width, height);
    else if (home && home[0] == '/')
        path = prom_format("%s/.cache/promenade/%s-%ux%u.json", home, name, width, height);
    if (path && !make_parents(path)) {
        prom_free(path);
        return NULL;
    }
    return path;
}
