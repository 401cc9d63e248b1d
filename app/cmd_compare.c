// promenade compare: how different two pictures look.
#include "app/command.h"
#include "app/options.h"
#include "app/output.h"

#include "benefit/colour_map.h"
#include "benefit/pool.h"
#include "builder/image_io.h"
#include "builder/picture_file.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/log.h"
#include "metaobj/model.h"

#include <stdio.h>

typedef struct compare_options {
    const char *a, *b, *map;
    const char *metric; // NULL: all
    double ppd;         // 0: of the picture filling a screen
    double threshold;   // below 0: none
    bool json;
} compare_options;

enum { KEY_METRIC = 0x1000, KEY_PPD, KEY_MAP, KEY_JSON, KEY_THRESHOLD };

static const struct argp_option options[] = {
    {"metric", KEY_METRIC, "NAME|all", 0, "What measures the difference, see below (flip)", 0},
    {"ppd", KEY_PPD, "X", 0,
     "Pixels per degree of the viewer's angle, for metrics that ask how far away the viewer is "
     "(those of the picture filling a screen 0.7 m wide, 0.7 m away: 22.34 for 1280 pixels)",
     0},
    {"map", KEY_MAP, "FILE", 0,
     "Write the error of each pixel as a picture (PNG): from black for 0 through violet, red "
     "and orange to white for 1",
     1},
    {"json", KEY_JSON, NULL, 0, "Print JSON instead of text", 1},
    {"threshold", KEY_THRESHOLD, "X", 0,
     "End with exit code 5 if the mean error of a metric is above X", 1},
    {0},
};

static const char *known_metric(const struct argp_state *state, const char *name)
{
    if (!strcmp(name, "all")) return NULL;
    if (prom_metric_named(name)) return name;
    char names[256] = "";
    for (size_t i = 0; i < prom_metric_count(); i++) {
        strncat(names, prom_metric_at(i)->name, sizeof names - strlen(names) - 1);
        strncat(names, ", ", sizeof names - strlen(names) - 1);
    }
    argp_error(state, "--metric: there is no `%s`; there are %sall", name, names);
    return name;
}

static void check(const compare_options *o, const struct argp_state *state)
{
    prom_option_require(state, "the first picture", o->a);
    prom_option_require(state, "the second picture", o->b);
    if (o->map && !o->metric)
        argp_error(state, "--map: shows one metric; name it instead of `--metric all`");
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    compare_options *o = state->input;
    switch (key) {
    case KEY_METRIC:
        o->metric = known_metric(state, text);
        break;
    case KEY_PPD:
        o->ppd = prom_option_number(state, "--ppd", text, PROM_PPD_MIN, PROM_PPD_MAX);
        break;
    case KEY_MAP:
        o->map = text;
        break;
    case KEY_JSON:
        o->json = true;
        break;
    case KEY_THRESHOLD:
        o->threshold = prom_option_number(state, "--threshold", text, 0, 1e9);
        break;
    case ARGP_KEY_ARG:
        prom_option_argument(state, text, o->a ? &o->b : &o->a);
        break;
    case ARGP_KEY_END:
        check(o, state);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

// The metrics' own lines before the rest of the help.
static char *filter_help(int key, const char *text, void *input)
{
    (void)input;
    if (key != ARGP_KEY_HELP_POST_DOC) return (char *)(uintptr_t)text;
    char *list = NULL;
    size_t bytes = 0;
    FILE *out = open_memstream(&list, &bytes);
    if (!out) return (char *)(uintptr_t)text;
    fputs("Metrics:\n", out);
    for (size_t i = 0; i < prom_metric_count(); i++)
        fprintf(out, "  %-10s %s\n", prom_metric_at(i)->name, prom_metric_at(i)->summary);
    fprintf(out, "\n%s", text);
    if (fclose(out) == 0) return list; // argp frees it
    return (char *)(uintptr_t)text;
}

static const struct argp_child children[] = {{&prom_argp_log, 0, NULL, -1}, {0}};

static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "A B",
    .doc =
        "Tell how different two pictures of one size look.\v"
        "Errors are 0 for what is equal and 1 for the largest difference. The weighted median "
        "is the error up to which half of the sum of all errors lies; a pixel differs when any "
        "of its colour values does. Files may be of any format that OpenImageIO reads. Whole "
        "numbers are taken for sRGB-encoded colours, floats for linear light; alpha is left "
        "out, and colours are compared as they are stored.\n\n"
        "JSON: {a, b, width, height, ppd, results: [{metric, mean, weighted_median, p50, p75, "
        "p95, p99, max, differing, differing_mean}]}; `differing` is a share of the pixels.\n\n"
        "Exit codes: 0, 1 for a wrong option, 2 for pictures that cannot be read or differ in "
        "size, 4 when the map cannot be written, 5 above the threshold.",
    .children = children,
    .help_filter = filter_help,
};

// Two pictures, in one form.
typedef struct pair {
    const char *names[2];
    prom_picture_file files[2];
    uint32_t width, height;
    size_t pixels;
    double ppd;
    uint8_t *differs;
    float *map; // of the last metric
} pair;

static void tell_left_out(const char *name, const prom_picture_file *file)
{
    if (file->transparent)
        prom_log(PROM_LOG_WARNING, "%s: is transparent in places; its alpha is left out", name);
    if (file->left_out)
        prom_log(PROM_LOG_WARNING,
                 "%s: %u channels that are neither colour nor alpha are left "
                 "out",
                 name, file->left_out);
}

static prom_status open_pair(pair *p, const compare_options *o, prom_error *error)
{
    *p = (pair){.names = {o->a, o->b}};
    for (int i = 0; i < 2; i++) {
        prom_status status = prom_picture_file_read(p->names[i], &p->files[i], error);
        if (status) return status;
        tell_left_out(p->names[i], &p->files[i]);
    }
    const prom_picture *a = &p->files[0].picture, *b = &p->files[1].picture;
    if (a->width != b->width || a->height != b->height)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%s has %ux%u pixels, %s %ux%u; only pictures of one size can be "
                         "compared",
                         o->a, a->width, a->height, o->b, b->width, b->height);
    prom_picture_files_match(&p->files[0], &p->files[1]);
    p->width = a->width;
    p->height = a->height;
    p->pixels = (size_t)a->width * a->height;
    p->ppd = o->ppd > 0 ? o->ppd : prom_full_screen_ppd(a->width);
    p->differs = prom_alloc(p->pixels, 1);
    p->map = prom_alloc(p->pixels, sizeof *p->map);
    prom_picture_differs(a, b, p->differs);
    return PROM_OK;
}

static void close_pair(pair *p)
{
    for (int i = 0; i < 2; i++) prom_picture_file_finish(&p->files[i]);
    prom_free(p->differs);
    prom_free(p->map);
}

static prom_pooled compare(pair *p, const prom_metric_class *class)
{
    uint32_t side = p->width > p->height ? p->width : p->height;
    prom_metric *metric = prom_metric_create(class->name, p->ppd, side, p->pixels, 0);
    size_t floats = prom_metric_feature_floats(metric, p->width, p->height);
    float *features[2];
    for (int i = 0; i < 2; i++) {
        features[i] = prom_alloc(floats, sizeof *features[i]);
        prom_metric_features(metric, &p->files[i].picture, features[i]);
    }
    prom_metric_compare(metric, features[0], features[1], p->width, p->height, p->map);
    for (int i = 0; i < 2; i++) prom_free(features[i]);
    prom_metric_destroy(metric);
    prom_pooled pooled;
    prom_errors_pool(class, p->map, p->pixels, NULL, p->differs, &pooled);
    return pooled;
}

typedef struct result {
    const prom_metric_class *metric;
    prom_pooled pooled;
} result;

static void print(const pair *p, const result *results, size_t count)
{
    printf("%s, %s: %ux%u pixels, %.2f per degree, %.4g %% of them differ\n", p->names[0],
           p->names[1], p->width, p->height, p->ppd, 100 * results[0].pooled.differing);
    printf("%-10s %9s %9s %9s %9s %9s %9s %9s %9s\n", "metric", "mean", "w.median", "median",
           "p75", "p95", "p99", "max", "differing");
    for (size_t i = 0; i < count; i++) {
        const prom_pooled *r = &results[i].pooled;
        printf("%-10s %9.6f %9.6f %9.6f %9.6f %9.6f %9.6f %9.6f %9.6f\n",
               results[i].metric->name, r->mean, r->weighted_median, r->median, r->p75, r->p95,
               r->p99, r->max, r->differing_mean);
    }
}

static json_t *result_json(const result *r)
{
    const prom_pooled *p = &r->pooled;
    return json_pack("{s:s, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o, s:o}", "metric",
                     r->metric->name, "mean", prom_json_number(p->mean), "weighted_median",
                     prom_json_number(p->weighted_median), "p50", prom_json_number(p->median),
                     "p75", prom_json_number(p->p75), "p95", prom_json_number(p->p95), "p99",
                     prom_json_number(p->p99), "max", prom_json_number(p->max), "differing",
                     prom_json_number(p->differing), "differing_mean",
                     prom_json_number(p->differing_mean));
}

static prom_status print_json(const pair *p, const result *results, size_t count,
                              prom_error *error)
{
    json_t *list = json_array();
    for (size_t i = 0; i < count; i++) json_array_append_new(list, result_json(&results[i]));
    json_t *json = json_pack("{s:o, s:o, s:i, s:i, s:o, s:o}", "a", prom_json_text(p->names[0]),
                             "b", prom_json_text(p->names[1]), "width", (int)p->width, "height",
                             (int)p->height, "ppd", prom_json_number(p->ppd), "results", list);
    return prom_output_print_json(json, error);
}

static prom_status write_map(const char *path, const pair *p, prom_error *error)
{
    uint8_t *rgb = prom_alloc(p->pixels, 3);
    prom_colour_map_paint(p->map, p->pixels, rgb);
    prom_status status = prom_image_write_png(path, p->width, p->height, 3, rgb, error);
    prom_free(rgb);
    return status;
}

static prom_status check_threshold(double threshold, const result *results, size_t count,
                                   prom_error *error)
{
    for (size_t i = 0; i < count && threshold >= 0; i++)
        if (!(results[i].pooled.mean <= threshold))
            return prom_fail(error, PROM_ERR_THRESHOLD,
                             "--threshold %g: the mean error by %s is %.6g", threshold,
                             results[i].metric->name, results[i].pooled.mean);
    return PROM_OK;
}

static prom_status run(const compare_options *o, pair *p, prom_error *error)
{
    result *results = prom_alloc(prom_metric_count(), sizeof *results);
    size_t count = 0;
    for (size_t i = 0; i < prom_metric_count(); i++) {
        const prom_metric_class *class = prom_metric_at(i);
        if (o->metric && strcmp(class->name, o->metric) != 0) continue;
        results[count++] = (result){class, compare(p, class)};
    }
    prom_status status = PROM_OK;
    if (o->json)
        status = print_json(p, results, count, error);
    else
        print(p, results, count);
    if (!status && o->map) status = write_map(o->map, p, error);
    if (!status) status = check_threshold(o->threshold, results, count, error);
    prom_free(results);
    return status;
}

prom_status prom_command_compare(int argc, char **argv, prom_error *error)
{
    compare_options o = {.metric = prom_metric_at(0)->name, .threshold = -1};
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    prom_command_files files = {{o.a, o.b}, {&o.map}};
    prom_status status = prom_outputs_check(&files, error);
    if (status) return status;
    pair p;
    status = open_pair(&p, &o, error);
    if (!status) status = run(&o, &p, error);
    close_pair(&p);
    return status;
}
