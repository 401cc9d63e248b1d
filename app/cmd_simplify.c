// promenade simplify: a mesh with fewer triangles that looks and lies as near as it can.
#include "app/command.h"
#include "app/options.h"
#include "app/output.h"

#include "builder/mesh_write.h"
#include "builder/simplify/mesh_collapse.h"
#include "builder/simplify/repair.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"

#include <math.h>

// Stops on the way, for the progress that is shown. A stop costs next to nothing.
#define STEPS 50

typedef struct simplify_options {
    const char *input, *output, *report;
    const prom_collapse_metric_class *metric;
    double ratio;       // below 0: not given
    uint64_t triangles; // 0: not given
    double max_error;   // units; below 0: not given
    double weld;        // of the bounding radius; below 0: not given
    float pair_distance;
    bool half_edge, lock_border, loose, no_repair;
} simplify_options;

enum {
    KEY_METRIC = 0x1000,
    KEY_RATIO,
    KEY_TRIANGLES,
    KEY_MAX_ERROR,
    KEY_HALF_EDGE,
    KEY_LOCK_BORDER,
    KEY_LOOSE,
    KEY_PAIR_DISTANCE,
    KEY_WELD,
    KEY_NO_REPAIR,
    KEY_REPORT,
};

static const struct argp_option options[] = {
    {"output", 'o', "FILE", 0, "The mesh to write: X.obj, X.ply or X.glb", 0},
    {"ratio", KEY_RATIO, "R", 0, "Keep this share of the triangles, above 0 to 1", 0},
    {"triangles", KEY_TRIANGLES, "N", 0, "Keep at most N triangles", 0},
    {"max-error", KEY_MAX_ERROR, "E", 0,
     "Stop before the error, by the metric's own estimate, is above E units of the scene; "
     "alone "
     "or with one of the above",
     0},
    {"metric", KEY_METRIC, "NAME", 0,
     "What a collapse costs: qem-attributes (the default) knows the surface, normals, texture "
     "and colours; qem the surface alone; shortest takes the shortest edge",
     1},
    {"half-edge", KEY_HALF_EDGE, NULL, 0, "Keep only vertices of the original, move none", 1},
    {"lock-border", KEY_LOCK_BORDER, NULL, 0, "Leave open borders exactly as they are", 1},
    {"loose", KEY_LOOSE, NULL, 0,
     "Connections may change: holes close, small parts become one with others or vanish", 1},
    {"pair-distance", KEY_PAIR_DISTANCE, "D", 0,
     "Let pieces that are nearer than D units grow together", 1},
    {"weld", KEY_WELD, "T", 0,
     "Vertices nearer than T of the bounding radius are at one place (1e-5); 0 moves none", 2},
    {"no-repair", KEY_NO_REPAIR, NULL, 0,
     "Do not weld, drop broken faces or turn those that look the wrong way", 2},
    {"report", KEY_REPORT, "FILE", 0, "Write what was done as JSON", 3},
    {0},
};

static const prom_collapse_metric_class *parse_metric(const struct argp_state *state,
                                                      const char *text)
{
    const prom_collapse_metric_class *metric = prom_collapse_metric_find(text);
    if (metric) return metric;
    char *names = prom_strdup("");
    for (uint32_t i = 0; prom_collapse_metric_at(i); i++) {
        char *more =
            prom_format("%s%s%s", names, i ? ", " : "", prom_collapse_metric_at(i)->name);
        prom_free(names);
        names = more;
    }
    argp_error(state, "--metric: `%s` is none of %s", text, names);
    return NULL;
}

static void check(const simplify_options *o, const struct argp_state *state)
{
    prom_option_require(state, "the mesh's file", o->input);
    prom_option_require(state, "--output", o->output);
    if (!prom_mesh_write_known(o->output))
        argp_error(state, "--output: `%s` must end with .obj, .ply or .glb", o->output);
    if (o->ratio < 0 && !o->triangles && o->max_error < 0)
        argp_error(state, "how far? give --ratio, --triangles or --max-error");
    if (o->ratio >= 0 && o->triangles)
        argp_error(state, "--ratio and --triangles: give one of them");
    if (o->no_repair && o->weld >= 0) argp_error(state, "--weld: not with --no-repair");
}

static error_t parse_way(int key, char *text, const struct argp_state *state)
{
    simplify_options *o = state->input;
    switch (key) {
    case KEY_METRIC:
        o->metric = parse_metric(state, text);
        break;
    case KEY_HALF_EDGE:
        o->half_edge = true;
        break;
    case KEY_LOCK_BORDER:
        o->lock_border = true;
        break;
    case KEY_LOOSE:
        o->loose = true;
        break;
    case KEY_PAIR_DISTANCE:
        o->pair_distance = (float)prom_option_number(state, "--pair-distance", text, 0, 1e9);
        break;
    case KEY_WELD:
        o->weld = prom_option_number(state, "--weld", text, 0, 0.1);
        break;
    case KEY_NO_REPAIR:
        o->no_repair = true;
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    simplify_options *o = state->input;
    switch (key) {
    case 'o':
        o->output = text;
        break;
    case KEY_RATIO:
        o->ratio = prom_option_number(state, "--ratio", text, 0, 1);
        if (o->ratio <= 0) argp_error(state, "--ratio: wants a share above 0");
        break;
    case KEY_TRIANGLES:
        o->triangles = prom_option_whole(state, "--triangles", text, 1, UINT32_MAX);
        break;
    case KEY_MAX_ERROR:
        o->max_error = prom_option_number(state, "--max-error", text, 0, 1e30);
        break;
    case KEY_REPORT:
        o->report = text;
        break;
    case ARGP_KEY_ARG:
        prom_option_argument(state, text, &o->input);
        break;
    case ARGP_KEY_END:
        check(o, state);
        break;
    default:
        return parse_way(key, text, state);
    }
    return 0;
}

static const struct argp_child children[] = {{&prom_argp_log, 0, NULL, -1}, {0}};

static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "IN -o OUT",
    .doc =
        "Simplify a mesh by collapsing edges, the cheapest first.\v"
        "IN may be of any format that `build` reads; all that a scene holds becomes one mesh, "
        "y "
        "upwards, in metres where the format has units. Materials keep their borders: these "
        "never crack. The mesh is mended first.\n\n"
        "An OBJ names the pictures of IN where they are files, and gets others beside it; a "
        "GLB "
        "holds them. A PLY has no materials: their colours go into the vertices, and a picture "
        "is named if all share it.\n\n"
        "JSON: {input, output, metric, half_edge, lock_border, loose, pair_distance_units, "
        "before, after: {triangles, vertices}, target_triangles, reached, error_units, "
        "error_percent (of the diagonal of the bounds), collapses, rejected: {flip, link, "
        "degenerate, lock}, repair (null without), peak_bytes, read_ms, repair_ms, init_ms, "
        "run_ms, write_ms}. The error is the metric's estimate of the greatest; "
        "`compare-mesh` measures.\n\n"
        "Exit codes: 0, 1 for a wrong option, 2 for meshes that cannot be read or have no "
        "triangles, 4 when an output cannot be written.",
    .children = children,
};

typedef struct job {
    const simplify_options *options;
    prom_mesh_file file;
    prom_repair_report repair;
    prom_collapse_stats stats;
    uint32_t triangles, vertices, target; // before, and wanted
    double diagonal, error;               // units
    double read_ms, repair_ms, init_ms, run_ms, write_ms;
} job;

static prom_status read_file(job *j, prom_error *error)
{
    // Pictures go on as they are.
    const prom_import_options whole = {.max_texture_px = PROM_TEXTURE_MAX};
    const double start = prom_clock_ms();
    prom_status status = prom_mesh_file_read(j->options->input, &whole, NULL, &j->file, error);
    if (status) return status;
    const prom_box box = prom_mesh_bounds(&j->file.mesh);
    j->diagonal = (double)prom_box_diagonal(&box);
    j->triangles = j->file.mesh.index_count / 3;
    j->vertices = j->file.mesh.vertex_count;
    j->read_ms = prom_clock_ms() - start;
    return PROM_OK;
}

static void repair(job *j)
{
    const simplify_options *o = j->options;
    if (o->no_repair) return;
    const double start = prom_clock_ms();
    prom_repair_options how = {0};
    if (o->weld >= 0) how.tolerance = o->weld > 0 ? (float)o->weld : -1;
    prom_mesh_repair(&j->file.mesh, &how, &j->repair);
    j->repair_ms = prom_clock_ms() - start;
    if (!prom_repair_mended(&j->repair)) return;
    char *text = prom_repair_text(&j->repair);
    prom_log(PROM_LOG_INFO, "%s: mended: %s", o->input, text);
    prom_free(text);
}

static uint32_t target_of(const simplify_options *o, uint32_t triangles)
{
    if (o->triangles) return (uint32_t)o->triangles;
    if (o->ratio >= 0) return (uint32_t)fmax(1, round(o->ratio * triangles));
    return 0;
}

// In steps down to the target, which may be out of reach.
static void collapse(job *j, prom_mesh_collapse *c)
{
    const float most = j->options->max_error < 0 ? INFINITY : (float)j->options->max_error;
    const uint32_t from = prom_mesh_collapse_triangles(c),
                   to = j->target < from ? j->target : from;
    if (from == to) return;
    prom_progress progress;
    prom_progress_begin(&progress, "simplify", from - to);
    float error = 0;
    uint32_t left = from;
    for (uint32_t i = 1; i <= STEPS && left > to; i++) {
        const uint32_t stop = from - (uint32_t)((uint64_t)(from - to) * i / STEPS);
        error = fmaxf(error, prom_mesh_collapse_run(c, stop, most));
        const uint32_t now = prom_mesh_collapse_triangles(c);
        prom_progress_step(&progress, left - now);
        left = now;
        if (left > stop) break; // no further
    }
    prom_progress_end(&progress);
    j->error = (double)error;
}

static prom_status simplify(job *j, prom_error *error)
{
    const simplify_options *o = j->options;
    const prom_collapse_options how = {.metric = o->metric,
                                       .half_edge = o->half_edge,
                                       .lock_border = o->lock_border,
                                       .loose = o->loose,
                                       .pair_distance = o->pair_distance};
    prom_mesh_collapse c;
    const double start = prom_clock_ms();
    prom_mesh_collapse_init(&c, &j->file.mesh, &how);
    const double ready = prom_clock_ms();
    j->target = target_of(o, j->triangles);
    prom_status status = PROM_OK;
    if (!c.mesh.triangles)
        status = prom_fail(error, PROM_ERR_INPUT, "%s: has no triangle with an area", o->input);
    else
        collapse(j, &c);
    j->init_ms = ready - start;
    j->run_ms = prom_clock_ms() - ready;
    prom_collapser_stats(c.collapser, &j->stats);
    prom_mesh_finish(&j->file.mesh);
    prom_mesh_collapse_emit(&c, &j->file.mesh);
    prom_mesh_collapse_finish(&c);
    return status;
}

static bool reached(const job *j)
{
    return !j->target || j->file.mesh.index_count / 3 <= j->target;
}

static double percent(const job *j, double units)
{
    return j->diagonal > 0 ? 100 * units / j->diagonal : 0;
}

static json_t *size_json(uint32_t triangles, uint32_t vertices)
{
    return json_pack("{s:I, s:I}", "triangles", (json_int_t)triangles, "vertices",
                     (json_int_t)vertices);
}

static json_t *repair_json(const job *j)
{
    if (j->options->no_repair) return json_null();
    char *text = prom_repair_json(&j->repair);
    json_t *json = json_loads(text, 0, NULL);
    prom_free(text);
    return json;
}

static json_t *report_json(const job *j)
{
    const simplify_options *o = j->options;
    const prom_collapse_stats *s = &j->stats;
    json_t *json =
        json_pack("{s:o, s:o, s:s, s:b, s:b, s:b, s:f}", "input", prom_json_text(o->input),
                  "output", prom_json_text(o->output), "metric", o->metric->name, "half_edge",
                  o->half_edge, "lock_border", o->lock_border, "loose", o->loose,
                  "pair_distance_units", (double)o->pair_distance);
    json_object_set_new(json, "before", size_json(j->triangles, j->vertices));
    json_object_set_new(json, "after",
                        size_json(j->file.mesh.index_count / 3, j->file.mesh.vertex_count));
    json_object_set_new(json, "target_triangles",
                        j->target ? json_integer(j->target) : json_null());
    json_object_set_new(json, "reached", json_boolean(reached(j)));
    json_object_set_new(json, "error_units", prom_json_number(j->error));
    json_object_set_new(json, "error_percent", prom_json_number(percent(j, j->error)));
    json_object_set_new(json, "collapses", json_integer(s->collapses));
    json_object_set_new(json, "rejected",
                        json_pack("{s:I, s:I, s:I, s:I}", "flip", (json_int_t)s->rejected_flip,
                                  "link", (json_int_t)s->rejected_link, "degenerate",
                                  (json_int_t)s->rejected_degenerate, "lock",
                                  (json_int_t)s->rejected_lock));
    json_object_set_new(json, "repair", repair_json(j));
    json_object_set_new(json, "peak_bytes", json_integer((json_int_t)s->peak_bytes));
    json_object_set_new(json, "read_ms", prom_json_number(j->read_ms));
    json_object_set_new(json, "repair_ms", prom_json_number(j->repair_ms));
    json_object_set_new(json, "init_ms", prom_json_number(j->init_ms));
    json_object_set_new(json, "run_ms", prom_json_number(j->run_ms));
    json_object_set_new(json, "write_ms", prom_json_number(j->write_ms));
    return json;
}

static void tell(const job *j)
{
    const uint32_t left = j->file.mesh.index_count / 3;
    if (!reached(j))
        prom_log(PROM_LOG_WARNING, "%s: %u triangles are left, not %u: the rest %s",
                 j->options->input, left, j->target,
                 j->options->max_error < 0 ? "cannot be collapsed; --loose lets more go"
                                           : "is above --max-error or cannot be collapsed");
    printf(
        "%s: %u to %u triangles (%.4g %%), error up to %.4g units (%.4g %% of the diagonal), "
        "%.2f s\n",
        j->options->output, j->triangles, left, 100.0 * left / j->triangles, j->error,
        percent(j, j->error), (j->init_ms + j->run_ms) / 1e3);
}

static prom_status run(job *j, prom_error *error)
{
    const simplify_options *o = j->options;
    prom_status status = read_file(j, error);
    if (status) return status;
    repair(j);
    status = simplify(j, error);
    if (status) return status;
    const double start = prom_clock_ms();
    status = prom_mesh_write(o->output, &j->file, o->input, error);
    j->write_ms = prom_clock_ms() - start;
    if (!status && o->report) status = prom_output_write_json(o->report, report_json(j), error);
    if (!status) tell(j);
    return status;
}

prom_status prom_command_simplify(int argc, char **argv, prom_error *error)
{
    simplify_options o = {
        .metric = &prom_collapse_attributes, .ratio = -1, .max_error = -1, .weld = -1};
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    const prom_command_files files = {{o.input}, {&o.output, &o.report}};
    prom_status status = prom_outputs_check(&files, error);
    if (status) return status;
    job j = {.options = &o};
    status = run(&j, error);
    prom_mesh_file_finish(&j.file);
    return status;
}
