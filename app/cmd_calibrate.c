// promenade calibrate: measures what drawing costs on this device.
#include "app/calibration.h"
#include "app/calibration_report.h"
#include "app/command.h"
#include "app/options.h"
#include "app/output.h"

#include "metaobj/base/clock.h"

#include <stdio.h>

typedef struct calibrate_options {
    uint32_t size_px[2];
    int effort;
    const char *output, *residuals, *plot, *report;
} calibrate_options;

enum { KEY_RESOLUTION = 0x1000, KEY_EFFORT, KEY_RESIDUALS, KEY_PLOT, KEY_REPORT };

static const struct argp_option options[] = {
    {"output", 'o', "FILE", 0, "Where to write the profile (the cache, for later runs)", 0},
    {"resolution", KEY_RESOLUTION, "W,H", 0, "Size of the picture in pixels (1280,720)", 0},
    {"effort", KEY_EFFORT, "1..3", 0, "From a few seconds to forty (2)", 0},
    {"residuals", KEY_RESIDUALS, "FILE.csv", 0,
     "Table of the samples: what they draw, their times, and those predicted", 0},
    {"plot", KEY_PLOT, "FILE.svg", 0, "Plot of predicted against measured times", 0},
    {"report", KEY_REPORT, "FILE.json", 0, "The fit and its errors", 0},
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
    case KEY_RESIDUALS:
        o->residuals = text;
        break;
    case KEY_PLOT:
        o->plot = text;
        break;
    case KEY_REPORT:
        o->report = text;
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

typedef struct measurement {
    prom_cost_model model;
    prom_cost_samples samples;
    bool queries;
    double seconds;
} measurement;

static prom_status measure(const calibrate_options *o, measurement *m, prom_error *error)
{
    prom_context *context = prom_context_create_headless(error);
    if (!context) return error->status;
    prom_renderer *renderer = prom_renderer_create(context, error);
    prom_status status = renderer ? PROM_OK : error->status;
    double start_ms = prom_clock_ms();
    if (!status)
        status = prom_calibration_run(context, renderer, o->size_px, o->effort, &m->model,
                                      &m->samples, &m->queries, error);
    m->seconds = (prom_clock_ms() - start_ms) * 1e-3;
    if (renderer) prom_renderer_destroy(renderer);
    prom_context_destroy(context);
    return status;
}

static prom_status report_on(const calibrate_options *o, const measurement *m,
                             prom_error *error)
{
    prom_calibration_report report;
    prom_status status = PROM_OK;
    prom_calibration_report_init(&report, &m->model, &m->samples);
    report.queries = m->queries;
    report.seconds = m->seconds;
    prom_calibration_print(&report);
    if (o->residuals) status = prom_calibration_write_residuals(&report, o->residuals, error);
    if (!status && o->plot) status = prom_calibration_write_plot(&report, o->plot, error);
    if (!status && o->report)
        status = prom_output_write_json(o->report, prom_calibration_json(&report), error);
    prom_calibration_report_finish(&report);
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
    prom_command_files files = {.outputs = {&o.output, &o.residuals, &o.plot, &o.report}};
    prom_status status = prom_outputs_check(&files, error);
    if (status) return status;
    measurement m = {0};
    status = measure(&o, &m, error);
    if (!status) status = report_on(&o, &m, error);
    if (!status) status = keep(&o, &m.model, error);
    prom_array_finish(&m.samples);
    return status;
}
