// promenade calibrate: measures what drawing costs on this device.
#include "app/calibration.h"
#include "app/command.h"
#include "app/options.h"
#include "app/output.h"

#include <stdio.h>

typedef struct calibrate_options {
    uint32_t size_px[2];
    int effort;
    const char *output;
} calibrate_options;

enum { KEY_RESOLUTION = 0x1000, KEY_EFFORT };

static const struct argp_option options[] = {
    {"output", 'o', "FILE", 0, "Where to write the profile (the cache, for later runs)", 0},
    {"resolution", KEY_RESOLUTION, "W,H", 0, "Size of the picture in pixels (1280,720)", 0},
    {"effort", KEY_EFFORT, "1..3", 0, "From a few seconds to some twenty (2)", 0},
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state)
{
    calibrate_options *o = state->input;
    switch (key) {
    case 'o':
        o->output = text;
        break;
    case KEY_RESOLUTION:
        prom_option_resolution(state, text, o->size_px);
        break;
    case KEY_EFFORT:
        o->effort = (int)prom_option_whole(state, "--effort", text, 1, 3);
        break;
    case ARGP_KEY_ARG:
        argp_error(state, "`%s` is one argument too many", text);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp_child children[] = {{&prom_argp_log, 0, NULL, -1}, {0}};

static const struct argp argp = {
    .options = options,
    .parser = parse,
    .doc = "Measure what drawing costs on this device and fit the cost model to it.",
    .children = children,
};

static void print_model(const prom_cost_model *m, bool queries)
{
    static const char *const kinds[PROM_COST_KINDS] = {"plain",   "textured", "masked",
                                                       "blended", "impostor", "impostor, lit"};
    printf("device       %s\n", m->renderer);
    printf("clock        %s\n", queries ? "the device's timer" : "wall clock around a finish");
    printf("samples      %u\n", m->sample_count);
    printf("frame        %10.4f ms\n", m->fixed_ms);
    printf("draw         %10.4f us\n", m->draw_ms * 1e3);
    printf("vertex       %10.4f ns\n", m->vertex_ms * 1e6);
    printf("triangle     %10.4f ns\n", m->triangle_ms * 1e6);
    printf("edge         %10.4f ns\n", m->edge_ms * 1e6);
    for (int i = 0; i < PROM_COST_KINDS; i++)
        printf("pixel        %10.4f ns  %s\n", m->pixel_ms[i] * 1e6, kinds[i]);
    printf("pixel        %10.4f ns  hidden\n", m->hidden_pixel_ms * 1e6);
    printf("edge         %10.4f ns  hidden\n", m->hidden_edge_ms * 1e6);
    printf("mean error   %10.1f %%\n", 100 * m->mean_error);
    printf("worst under  %10.1f %%\n", 100 * m->worst_under);
    printf("margin       %10.1f %%\n", 100 * m->margin);
}

static prom_status measure(const calibrate_options *o, prom_cost_model *model, bool *queries,
                           prom_error *error)
{
    prom_context *context = prom_context_create_headless(error);
    if (!context) return error->status;
    prom_renderer *renderer = prom_renderer_create(context, error);
    prom_status status = renderer ? PROM_OK : error->status;
    if (!status)
        status = prom_calibration_run(context, renderer, o->size_px, o->effort, model, NULL,
                                      queries, error);
    if (renderer) prom_renderer_destroy(renderer);
    prom_context_destroy(context);
    return status;
}

static prom_status keep(const calibrate_options *o, const prom_cost_model *model,
                        prom_error *error)
{
    char *path = o->output
                     ? prom_strdup(o->output)
                     : prom_cost_cache_path(model->renderer, o->size_px[0], o->size_px[1]);
    if (!path)
        return prom_fail(error, PROM_ERR_OUTPUT,
                         "there is no home folder to keep the profile in; give --output");
    prom_status status = prom_cost_save(model, path, error);
    if (!status) printf("profile      %s\n", path);
    prom_free(path);
    return status;
}

prom_status prom_command_calibrate(int argc, char **argv, prom_error *error)
{
    calibrate_options o = {.size_px = {1280, 720}, .effort = 2};
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    prom_command_files files = {.outputs = {&o.output}};
    prom_status status = prom_outputs_check(&files, error);
    if (status) return status;
    prom_cost_model model = {0};
    bool queries = false;
    status = measure(&o, &model, &queries, error);
    if (status) return status;
    print_model(&model, queries);
    return keep(&o, &model, error);
}
