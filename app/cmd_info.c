// promenade info: what a model holds.
#include "app/command.h"
#include "app/info_object.h"
#include "app/info_report.h"
#include "app/info_sheet.h"
#include "app/info_tables.h"
#include "app/options.h"
#include "app/output.h"

#include <inttypes.h>
#include <stdio.h>

#define LISTED 8 // other objects that a name means

typedef struct info_options {
    const char *model, *object, *tables, *sheet_path;
    prom_sheet_options sheet;
    bool json;
} info_options;

enum { KEY_JSON = 0x1000, KEY_OBJECT, KEY_TABLES, KEY_SHEET, KEY_SIZE_PX, KEY_DIRECTIONS };

static const struct argp_option options[] = {
    {"json", KEY_JSON, NULL, 0, "Print JSON instead of text", 0},
    {"tables", KEY_TABLES, "FILE", 0,
     "Write the accuracy of each representation from each direction at each size (CSV)", 1},
    {"object", KEY_OBJECT, "NAME", 0,
     "For --sheet and --tables: an object by its name or a pattern of names, or #N, prototype "
     "N "
     "(clusters have no names)",
     1},
    {"sheet", KEY_SHEET, "FILE", 0,
     "Draw how the object's representations look and where they err, with their accuracies "
     "(PNG)",
     1},
    {"size-px", KEY_SIZE_PX, "PX", 0,
     "For --sheet: size of the object in the pictures, 8 to 512; the nearest that is stored "
     "(128)",
     1},
    {"directions", KEY_DIRECTIONS, "N", 0,
     "For --sheet: directions, 1 to 66 (9); above 128 px there are 6", 1},
    {0},
};

static void check(const info_options *o, const struct argp_state *state)
{
    if (o->sheet_path && !o->object) argp_error(state, "--sheet: name the --object");
    if (o->object && !o->sheet_path && !o->tables)
        argp_error(state, "--object: give --sheet or --tables too");
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    info_options *o = state->input;
    switch (key) {
    case KEY_JSON:
        o->json = true;
        break;
    case KEY_OBJECT:
        o->object = text;
        break;
    case KEY_TABLES:
        o->tables = text;
        break;
    case KEY_SHEET:
        o->sheet_path = text;
        break;
    case KEY_SIZE_PX:
        o->sheet.size_px = (float)prom_option_number(state, "--size-px", text, PROM_SIZE_MIN_PX,
                                                     PROM_SIZE_MAX_LARGE_PX);
        break;
    case KEY_DIRECTIONS:
        o->sheet.directions =
            (uint32_t)prom_option_whole(state, "--directions", text, 1, PROM_DIRS);
        break;
    case ARGP_KEY_END:
        prom_option_model(key, text, state, &o->model);
        check(o, state);
        break;
    default:
        return prom_option_model(key, text, state, &o->model);
    }
    return 0;
}

static const struct argp_child children[] = {{&prom_argp_log, 0, NULL, -1}, {0}};

static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "X.prom",
    .doc =
        "Tell what a model holds and how it was made.\v"
        "With --tables or --sheet, only what was written is told, unless --json asks for all.",
    .children = children,
};

static prom_status report(const info_options *o, prom_container *container,
                          const prom_model *model, prom_error *error)
{
    prom_info_facts facts;
    prom_status status = prom_info_gather(&facts, o->model, container, model, error);
    if (!status && o->json)
        status = prom_output_print_json(prom_info_json(&facts), error);
    else if (!status)
        prom_info_print(&facts);
    prom_info_finish(&facts);
    return status;
}

static prom_status write_tables(const info_options *o, const prom_model *model,
                                const prom_node_list *nodes, prom_error *error)
{
    uint64_t rows;
    prom_status status =
        prom_info_write_tables(model, o->object ? nodes : NULL, o->tables, &rows, error);
    if (!status && !o->json) printf("%s: %" PRIu64 " rows\n", o->tables, rows);
    return status;
}

static void print_others(const prom_model *model, const prom_node_list *nodes)
{
    for (size_t i = 1; i < nodes->count && i <= LISTED; i++) {
        char *title = prom_object_title(model, nodes->data[i]);
        printf("%s%s", i > 1 ? ", " : "the name also means ", title);
        prom_free(title);
    }
    if (nodes->count > LISTED + 1) printf(" and %zu more", nodes->count - LISTED - 1);
    if (nodes->count > 1) putchar('\n');
}

static prom_status write_sheet(const info_options *o, prom_container *container,
                               const prom_model *model, const prom_node_list *nodes,
                               prom_error *error)
{
    prom_status status = prom_info_write_sheet(container, model, nodes->data[0], &o->sheet,
                                               o->sheet_path, error);
    if (status || o->json) return status;
    char *title = prom_object_title(model, nodes->data[0]);
    printf("%s: %s\n", o->sheet_path, title);
    prom_free(title);
    print_others(model, nodes);
    return PROM_OK;
}

static prom_status run(const info_options *o, prom_container *container,
                       const prom_model *model, prom_error *error)
{
    prom_node_list nodes = {0};
    prom_status status = PROM_OK;
    if (o->object) status = prom_find_objects(model, o->object, &nodes, error);
    if (!status && o->tables) status = write_tables(o, model, &nodes, error);
    if (!status && o->sheet_path) status = write_sheet(o, container, model, &nodes, error);
    if (!status && (o->json || (!o->tables && !o->sheet_path)))
        status = report(o, container, model, error);
    prom_array_finish(&nodes);
    return status;
}

prom_status prom_command_info(int argc, char **argv, prom_error *error)
{
    info_options o = {.sheet = {.size_px = PROM_SIZE_MAX_PX, .directions = 9}};
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    prom_command_files files = {{o.model}, {&o.tables, &o.sheet_path}};
    prom_status status = prom_outputs_check(&files, error);
    if (status) return status;
    prom_container *container = prom_container_open(o.model, error);
    if (!container) return error->status;
    prom_model model;
    status = prom_container_load_model(container, &model, error);
    if (!status) status = run(&o, container, &model, error);
    prom_model_finish(&model);
    prom_container_close(container);
    return status;
}
