#include "app/where.h"

#include "app/options.h"

#include <string.h>

// In cells, by taste: enough to choose from, and so close that a path is in few cells unseen.
#define PATH_SPACING 0.1
#define BOX_SPACING 0.5
// Five minutes: around any layout.
#define AUTO_FRAMES 9000

static bool is_box(const char *text)
{
    return strchr(text, ':') && strspn(text, "+-.,:eE0123456789") == strlen(text);
}

static void parse_box(prom_where *where, const char *text, const struct argp_state *state)
{
    char *low = prom_strdup(text), *high = strchr(low, ':');
    *high++ = 0;
    prom_option_numbers(state, "--view-cells", low, ',', -1e9, 1e9, 3, where->low);
    prom_option_numbers(state, "--view-cells", high, ',', -1e9, 1e9, 3, where->high);
    prom_free(low);
    for (int k = 0; k < 3; k++)
        if (where->low[k] > where->high[k])
            argp_error(state, "--view-cells: the box `%s` ends before it begins along %c", text,
                       "xyz"[k]);
}

void prom_where_parse(prom_where *where, const char *text, const struct argp_state *state)
{
    prom_where_finish(where);
    where->kind = !strcmp(text, "auto") ? PROM_WHERE_AUTO
                  : is_box(text)        ? PROM_WHERE_BOX
                                        : PROM_WHERE_PATHS;
    if (where->kind == PROM_WHERE_BOX) parse_box(where, text, state);
    if (where->kind != PROM_WHERE_PATHS) return;
    for (const char *at = text, *end; at; at = *end ? end + 1 : NULL) {
        end = strchrnul(at, ',');
        if (end == at) argp_error(state, "--view-cells: `%s` has an empty name", text);
        prom_array_push(&where->files, prom_format("%.*s", (int)(end - at), at));
    }
}

void prom_where_finish(prom_where *where)
{
    for (size_t i = 0; i < where->files.count; i++) prom_free(where->files.data[i]);
    prom_array_finish(&where->files);
    prom_array_finish(&where->eyes);
    *where = (prom_where){0};
}

prom_status prom_where_eyes_of_paths(prom_where *where, double cell_size, prom_error *error)
{
    prom_status status = PROM_OK;
    for (size_t i = 0; i < where->files.count && !status; i++) {
        prom_path path;
        status = prom_path_load(where->files.data[i], &path, error);
        if (!status)
            status = prom_eyes_along(&path, PATH_SPACING * cell_size, &where->eyes, error);
        prom_path_finish(&path);
    }
    return status;
}

static prom_status add_from_model(prom_where *where, prom_container *container,
                                  const prom_model *model, double cell_size, prom_error *error)
{
    if (where->kind == PROM_WHERE_BOX)
        return prom_eyes_in_box(container, model, where->low, where->high,
                                BOX_SPACING * cell_size, &where->eyes, error);
    prom_path path;
    prom_status status = prom_path_auto(container, model, AUTO_FRAMES, &path, error);
    if (!status) status = prom_eyes_along(&path, PATH_SPACING * cell_size, &where->eyes, error);
    prom_path_finish(&path);
    return status;
}

prom_status prom_where_eyes_of_model(prom_where *where, const char *model_path,
                                     double cell_size, prom_error *error)
{
    if (where->kind != PROM_WHERE_AUTO && where->kind != PROM_WHERE_BOX) return PROM_OK;
    prom_container *container = prom_container_open(model_path, error);
    if (!container) return error->status;
    prom_model model;
    prom_status status = prom_container_load_model(container, &model, error);
    if (!status) status = add_from_model(where, container, &model, cell_size, error);
    prom_model_finish(&model);
    prom_container_close(container);
    return status;
}
