// promenade compare-mesh: how far apart two meshes are, and how different they look.
#include "app/command.h"
#include "app/mesh_report.h"
#include "app/mesh_sheet.h"
#include "app/options.h"
#include "app/output.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/log.h"

#include <math.h>

#define DEFAULT_SIZE_PX 512

typedef struct compare_mesh_options {
    const char *a, *b, *report, *pictures;
    uint64_t samples; // 0: by the meshes
    uint32_t views, size_px;
    double ppd; // 0: of the picture filling a screen
    double max_rms_percent, max_hausdorff_percent, max_flip; // below 0: none
    bool json;
} compare_mesh_options;

enum {
    KEY_SAMPLES = 0x1000,
    KEY_VIEWS,
    KEY_SIZE,
    KEY_PPD,
    KEY_REPORT,
    KEY_PICTURES,
    KEY_JSON,
    KEY_MAX_RMS,
    KEY_MAX_HAUSDORFF,
    KEY_MAX_FLIP,
};

static const struct argp_option options[] = {
    {"samples", KEY_SAMPLES, "N", 0,
     "Points of each surface whose distance is measured (500000, or 10 for each face up to "
     "5000000)",
     0},
    {"views", KEY_VIEWS, "N", 0,
     "Look from so many sides of a cube: 6 faces, then 12 edges, then 8 corners (26); 0 needs "
     "no GL",
     0},
    {"size-px", KEY_SIZE, "N", 0, "Pixels along a side of a view (512)", 0},
    {"ppd", KEY_PPD, "X", 0,
     "Pixels per degree of the viewer's angle, for flip (those of the view filling a screen "
     "0.7 m wide, 0.7 m away: 8.94 for 512 pixels)",
     0},
    {"json", KEY_JSON, NULL, 0, "Print JSON instead of text", 1},
    {"report", KEY_REPORT, "FILE", 0, "Write the JSON to a file", 1},
    {"pictures", KEY_PICTURES, "DIR", 0,
     "Write DIR/worst_views.png: the six views that differ most by flip, of A, of B, and the "
     "error of each pixel",
     1},
    {"max-rms-percent", KEY_MAX_RMS, "X", 0,
     "End with exit code 5 if the RMS distance is above X percent of A's diagonal", 1},
    {"max-hausdorff-percent", KEY_MAX_HAUSDORFF, "X", 0, "The same for the greatest distance",
     1},
    {"max-flip", KEY_MAX_FLIP, "X", 0, "The same for the mean of flip over all views", 1},
    {0},
};

static void check(const compare_mesh_options *o, const struct argp_state *state)
{
    prom_option_require(state, "the first mesh", o->a);
    prom_option_require(state, "the second mesh", o->b);
    if (!o->views && o->pictures) argp_error(state, "--pictures: wants --views above 0");
    if (!o->views && o->max_flip >= 0) argp_error(state, "--max-flip: wants --views above 0");
}

static error_t parse_threshold(int key, char *text, const struct argp_state *state)
{
    compare_mesh_options *o = state->input;
    switch (key) {
    case KEY_MAX_RMS:
        o->max_rms_percent = prom_option_number(state, "--max-rms-percent", text, 0, 1e9);
        break;
    case KEY_MAX_HAUSDORFF:
        o->max_hausdorff_percent =
            prom_option_number(state, "--max-hausdorff-percent", text, 0, 1e9);
        break;
    case KEY_MAX_FLIP:
        o->max_flip = prom_option_number(state, "--max-flip", text, 0, 1);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    compare_mesh_options *o = state->input;
    switch (key) {
    case KEY_SAMPLES:
        o->samples = prom_option_whole(state, "--samples", text, 1, 1000000000);
        break;
    case KEY_VIEWS:
        o->views = (uint32_t)prom_option_whole(state, "--views", text, 0, PROM_CUBE_VIEWS);
        break;
    case KEY_SIZE:
        o->size_px = (uint32_t)prom_option_whole(state, "--size-px", text, 16, 2048);
        break;
    case KEY_PPD:
        o->ppd = prom_option_number(state, "--ppd", text, PROM_PPD_MIN, PROM_PPD_MAX);
        break;
    case KEY_JSON:
        o->json = true;
        break;
    case KEY_REPORT:
        o->report = text;
        break;
    case KEY_PICTURES:
        o->pictures = text;
        break;
    case ARGP_KEY_ARG:
        prom_option_argument(state, text, o->a ? &o->b : &o->a);
        break;
    case ARGP_KEY_END:
        check(o, state);
        break;
    default:
        return parse_threshold(key, text, state);
    }
    return 0;
}

static const struct argp_child children[] = {{&prom_argp_log, 0, NULL, -1}, {0}};

static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "A B",
    .doc =
        "Tell how far apart the surfaces of two meshes are and how different they look; A is "
        "the true one.\v"
        "Files may be of any format that `build` reads; all that a scene holds is one mesh. "
        "Distances are from points of one surface, uniform by area, to the nearest ones of the "
        "other, as Metro measures them; maxima see all vertices too (the greater of both ways "
        "is the Hausdorff distance). Normals differ by the angle of the shading normals at "
        "these points, root mean square, in degrees. Meshes whose faces do not enclose a "
        "volume are called open.\n\n"
        "Views are orthographic and show the bounding sphere of A. `mean` is over all pixels, "
        "`object` over those that one of the meshes covers; `worst` is the greatest mean of a "
        "view.\n\n"
        "JSON: {a, b: {path, triangles, vertices, diagonal_units, area_square_units, closed, "
        "volume_cubic_units}, volume_difference_percent, a_to_b, b_to_a: {mean, rms, max (each "
        "_units and _percent of A's diagonal), max_from, max_to (x, y, z), normal_rms_degrees, "
        "samples}, rms and hausdorff (the greater of both "
        "ways), views, size_px, ppd, looks: [{metric, mean, object_mean, worst, "
        "worst_direction, views}]}; null where nothing is known.\n\n"
        "Exit codes: 0, 1 for a wrong option, 2 for meshes that cannot be read, 3 without GL, "
        "4 "
        "when an output cannot be written, 5 above a threshold.",
    .children = children,
};

typedef struct job {
    const compare_mesh_options *options;
    const char *sheet; // path, or NULL
    prom_mesh_file files[2];
    prom_mesh_comparison found;
} job;

static prom_status read_files(job *j, prom_error *error)
{
    const char *paths[2] = {j->options->a, j->options->b};
    for (int i = 0; i < 2; i++) {
        prom_status status = prom_mesh_file_read(paths[i], NULL, i ? j->files[0].origin : NULL,
                                                 &j->files[i], error);
        if (status) return status;
        j->found.facts[i].path = paths[i];
        prom_mesh_facts_find(&j->files[i].mesh, &j->found.facts[i]);
    }
    memcpy(j->found.origin, j->files[0].origin, sizeof j->found.origin);
    return PROM_OK;
}

static prom_status look(job *j, prom_error *error)
{
    const compare_mesh_options *o = j->options;
    prom_mesh_comparison *found = &j->found;
    if (!o->views) return PROM_OK;
    found->ppd = o->ppd > 0 ? o->ppd : prom_full_screen_ppd(o->size_px);
    prom_mesh_pictures *pictures =
        prom_mesh_pictures_create(&j->files[0], &j->files[1], o->size_px, found->ppd, error);
    if (!pictures) return error->status;
    found->size_px = o->size_px;
    found->view_count = o->views;
    prom_progress progress;
    prom_progress_begin(&progress, "views", o->views);
    for (uint32_t v = 0; v < o->views; v++) {
        prom_mesh_pictures_compare(pictures, v, found->views[v]);
        prom_progress_step(&progress, 1);
    }
    prom_progress_end(&progress);
    prom_looks_sum_up(found);
    prom_status status = PROM_OK;
    if (j->sheet) status = prom_mesh_sheet_write(pictures, found, j->sheet, error);
    prom_mesh_pictures_destroy(pictures);
    return status;
}

static prom_status tell(const job *j, prom_error *error)
{
    if (j->options->report) {
        json_t *json = prom_mesh_comparison_json(&j->found);
        prom_status status = prom_output_write_json(j->options->report, json, error);
        if (status) return status;
    }
    if (j->options->json)
        return prom_output_print_json(prom_mesh_comparison_json(&j->found), error);
    prom_mesh_comparison_print(&j->found);
    return PROM_OK;
}

static prom_status check_thresholds(const job *j, prom_error *error)
{
    const compare_mesh_options *o = j->options;
    const prom_mesh_comparison *f = &j->found;
    const struct {
        const char *option, *what;
        double most, value;
    } limits[] = {
        {"--max-rms-percent", "the RMS distance in percent", o->max_rms_percent,
         prom_percent_of_diagonal(f, f->distances.rms)},
        {"--max-hausdorff-percent", "the greatest distance in percent",
         o->max_hausdorff_percent, prom_percent_of_diagonal(f, f->distances.hausdorff)},
        {"--max-flip", "the mean of flip", o->max_flip, f->looks[PROM_LOOK_FLIP].mean},
    };
    for (size_t i = 0; i < sizeof limits / sizeof *limits; i++)
        if (limits[i].most >= 0 && !(limits[i].value <= limits[i].most))
            return prom_fail(error, PROM_ERR_THRESHOLD, "%s %g: %s is %.6g", limits[i].option,
                             limits[i].most, limits[i].what, limits[i].value);
    return PROM_OK;
}

static prom_status run(job *j, prom_error *error)
{
    prom_status status = read_files(j, error);
    if (status) return status;
    prom_mesh_distances_measure(&j->files[0].mesh, &j->files[1].mesh, j->options->samples,
                                &j->found.distances);
    status = look(j, error);
    if (!status) status = tell(j, error);
    if (!status) status = check_thresholds(j, error);
    return status;
}

prom_status prom_command_compare_mesh(int argc, char **argv, prom_error *error)
{
    compare_mesh_options o = {.views = PROM_CUBE_VIEWS,
                              .size_px = DEFAULT_SIZE_PX,
                              .max_rms_percent = -1,
                              .max_hausdorff_percent = -1,
                              .max_flip = -1};
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    job *j = prom_calloc(1, sizeof *j);
    j->options = &o;
    prom_status status = PROM_OK;
    char *sheet = o.pictures ? prom_format("%s/worst_views.png", o.pictures) : NULL;
    if (o.pictures) status = prom_output_make_folder(o.pictures, error);
    j->sheet = sheet;
    prom_command_files files = {{o.a, o.b}, {&o.report, &j->sheet}};
    if (!status) status = prom_outputs_check(&files, error);
    if (!status) status = run(j, error);
    for (int i = 0; i < 2; i++) prom_mesh_file_finish(&j->files[i]);
    prom_free(sheet);
    prom_free(j);
    return status;
}
