// promenade bench: walks a path within a budget and reports every frame.
#include "app/bench_csv.h"
#include "app/bench_report.h"
#include "app/command.h"
#include "app/output.h"
#include "app/swap_report.h"

#include "metaobj/base/log.h"

#define DEFAULT_BUDGET_MS 33.0
#define AUTO_FRAMES 300
#define QUALITY_FRAMES 20
#define SWAPS 4
#define ORACLE_FRAMES 5

typedef struct bench_options {
    prom_view_options view;
    prom_loop_options loop;
    const char *model, *report, *csv;
    uint32_t swap_frames, swaps;
    const char *swap_csv, *swap_plot;
    uint32_t oracle_tries, oracle_frames;
} bench_options;

enum {
    KEY_FRAMES = 0x1000,
    KEY_WARMUP,
    KEY_REPORT,
    KEY_CSV,
    KEY_KEEP,
    KEY_EVERY,
    KEY_COLOURS,
    KEY_HOLES,
    KEY_ACCURACY,
    KEY_QUALITY,
    KEY_POPPING,
    KEY_NOISE_FLOOR,
    KEY_SWAP_TEST,
    KEY_SWAPS,
    KEY_SWAP_CSV,
    KEY_SWAP_PLOT,
    KEY_ORACLE,
    KEY_ORACLE_FRAMES,
};

static const struct argp_option options[] = {
    {"frames", KEY_FRAMES, "N", 0,
     "Frames to walk; past its end the path is walked to and fro (the path's length)", 0},
    {"warmup", KEY_WARMUP, "N", 0, "Frames drawn before and not reported (30)", 0},
    {"report", KEY_REPORT, "FILE", 0, "Write a report as JSON", 1},
    {"csv", KEY_CSV, "FILE", 0, "Write one row a frame", 1},
    {"keep-frames", KEY_KEEP, "DIR", 0, "Write pictures of frames into this folder", 1},
    {"every", KEY_EVERY, "K", 0, "With --keep-frames: of every K-th frame (30)", 1},
    {"false-colours", KEY_COLOURS, NULL, 0,
     "With --keep-frames: also colour each by kind of representation, as `shot` does", 1},
    {"check-holes", KEY_HOLES, "N", 0,
     "On N frames also draw full detail and report where it covers the background and the cut "
     "does not",
     1},
    {"check-accuracy", KEY_ACCURACY, "N", 0,
     "On N frames also draw full detail and report how much the picture looks like it: 1 - the "
     "mean error of `edge-blur`",
     1},
    {"quality-frames", KEY_QUALITY, "N", 0,
     "On N frames also draw full detail and report how different the picture looks (mean "
     "FLIP), the share of visible pixels lost, and the shares of cost and nodes that show no "
     "pixel (20)",
     1},
    {"popping-frames", KEY_POPPING, "N", 0,
     "On N frames report popping: how different the frame looks (mean FLIP) from the one "
     "before "
     "taken to where its points are now, beside the same of full detail (0)",
     1},
    {"noise-floor", KEY_NOISE_FLOOR, "N", 0,
     "Draw one cut that takes about the budget N times between the walk's frames, and report "
     "how even these are beside how even the walk's are (300, say)",
     1},
    {"swap-test", KEY_SWAP_TEST, "N", 0,
     "After the walk, in N of its views draw one entry of the cut at a time in another way, "
     "and "
     "report how well the change of the picture's error (FLIP, against full detail) was "
     "predicted",
     2},
    {"swaps", KEY_SWAPS, "K", 0, "With --swap-test: swaps in each view (4)", 2},
    {"swap-csv", KEY_SWAP_CSV, "FILE", 0, "With --swap-test: write one row a swap", 2},
    {"swap-plot", KEY_SWAP_PLOT, "FILE.svg", 0,
     "With --swap-test: draw predicted against measured change", 2},
    {"oracle", KEY_ORACLE, "N", 0,
     "After the walk, in some of its views try N cuts of no more predicted cost (1000, say), "
     "and "
     "report the mean FLIP of the best beside that of the selector's",
     2},
    {"oracle-frames", KEY_ORACLE_FRAMES, "K", 0, "With --oracle: views to try in (5)", 2},
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state)
{
    bench_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[1] = &o->view;
        break;
    case KEY_FRAMES:
        o->loop.frames = (uint32_t)prom_option_whole(state, "--frames", text, 1, 10000000);
        break;
    case KEY_WARMUP:
        o->loop.warmup = (uint32_t)prom_option_whole(state, "--warmup", text, 0, 100000);
        break;
    case KEY_REPORT:
        o->report = text;
        break;
    case KEY_CSV:
        o->csv = text;
        break;
    case KEY_KEEP:
        o->loop.keep_folder = text;
        break;
    case KEY_EVERY:
        o->loop.keep_every = (uint32_t)prom_option_whole(state, "--every", text, 1, 10000000);
        break;
    case KEY_COLOURS:
        o->loop.keep_colours = true;
        break;
    case KEY_HOLES:
        o->loop.check_holes =
            (uint32_t)prom_option_whole(state, "--check-holes", text, 0, 100000);
        break;
    case KEY_ACCURACY:
        o->loop.check_accuracy =
            (uint32_t)prom_option_whole(state, "--check-accuracy", text, 0, 100000);
        break;
    case KEY_QUALITY:
        o->loop.quality_frames =
            (uint32_t)prom_option_whole(state, "--quality-frames", text, 0, 100000);
        break;
    case KEY_POPPING:
        o->loop.popping_frames =
            (uint32_t)prom_option_whole(state, "--popping-frames", text, 0, 100000);
        break;
    case KEY_NOISE_FLOOR:
        o->loop.noise_floor =
            (uint32_t)prom_option_whole(state, "--noise-floor", text, 0, 100000);
        break;
    case KEY_SWAP_TEST:
        o->swap_frames = (uint32_t)prom_option_whole(state, "--swap-test", text, 1, 100000);
        break;
    case KEY_SWAPS:
        o->swaps = (uint32_t)prom_option_whole(state, "--swaps", text, 1, 10000);
        break;
    case KEY_SWAP_CSV:
        o->swap_csv = text;
        break;
    case KEY_SWAP_PLOT:
        o->swap_plot = text;
        break;
    case KEY_ORACLE:
        o->oracle_tries = (uint32_t)prom_option_whole(state, "--oracle", text, 1, 10000000);
        break;
    case KEY_ORACLE_FRAMES:
        o->oracle_frames =
            (uint32_t)prom_option_whole(state, "--oracle-frames", text, 1, 100000);
        break;
    case ARGP_KEY_END:
        if ((o->swap_csv || o->swap_plot) && !o->swap_frames)
            argp_error(state, "--swap-csv and --swap-plot need --swap-test");
        return prom_option_model(key, text, state, &o->model);
    default:
        return prom_option_model(key, text, state, &o->model);
    }
    return 0;
}

static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "X.prom",
    .doc =
        "Walk a path through a model within a time per frame, and report it.\v"
        "The selector is `greedy` and the budget 33 ms unless given. A frame's time runs from "
        "its start to the finished image; a frame over the budget is a miss. Frames that are "
        "compared with full detail are drawn again between the measured ones.",
    .children = prom_view_children,
};

static bool heeds_budget(const char *selector)
{
    const prom_selector_class *class = prom_selector_class_named(selector);
    return class && class->budgeted;
}

static void warn_infeasible(const bench_options *o, const prom_loop_result *result)
{
    if (!result->infeasible_frames || !heeds_budget(o->loop.selector)) return;
    prom_log(PROM_LOG_WARNING,
             "budget %g ms: in %u of %zu frames even the cheapest cut is predicted to take "
             "longer; %.1f ms would do",
             o->loop.budget_ms, result->infeasible_frames, result->frames.count,
             result->least_budget_ms);
}

static prom_status write_reports(const bench_options *o, const prom_run_facts *facts,
                                 prom_error *error)
{
    prom_status status = PROM_OK;
    if (o->report) status = prom_output_write_json(o->report, prom_bench_json(facts), error);
    if (!status && o->csv)
        status = prom_bench_write_csv(o->csv, &o->loop, facts->result, error);
    if (!status && o->swap_csv)
        status = prom_swap_write_csv(o->swap_csv, &facts->session->model, facts->swap, error);
    if (!status && o->swap_plot)
        status = prom_swap_write_plot(o->swap_plot, facts->scene, facts->swap, error);
    return status;
}

// The views that trials are made in.
static prom_still_options views_of(const bench_options *o, uint32_t views)
{
    return (prom_still_options){.selector = o->loop.selector,
                                .budget_ms = o->loop.budget_ms,
                                .rule_scale = o->loop.rule_scale,
                                .path_frames = o->loop.frames,
                                .views = views};
}

static prom_status run_trials(const bench_options *o, prom_session *session,
                              prom_swap_result *swap, prom_oracle_result *oracle,
                              prom_error *error)
{
    prom_still_options swap_views = views_of(o, o->swap_frames);
    prom_still_options oracle_views = views_of(o, o->oracle_frames);
    prom_status status = PROM_OK;
    if (o->swap_frames)
        status = prom_swap_test_run(session, &swap_views, o->swaps, swap, error);
    if (!status && o->oracle_tries)
        status = prom_oracle_run(session, &oracle_views, o->oracle_tries, oracle, error);
    return status;
}

static prom_status run_loop(bench_options *o, prom_session *session, prom_error *error)
{
    if (!o->loop.frames) o->loop.frames = (uint32_t)session->path.keys.count;
    prom_loop_result result = {0};
    prom_swap_result swap = {0};
    prom_oracle_result oracle = {0};
    prom_status status = PROM_OK;
    if (o->loop.keep_folder) status = prom_output_make_folder(o->loop.keep_folder, error);
    if (!status) status = prom_frame_loop_run(session, &o->loop, &result, error);
    if (!status) status = run_trials(o, session, &swap, &oracle, error);
    if (!status) {
        prom_run_facts facts = {.session = session,
                                .options = &o->loop,
                                .result = &result,
                                .swap = o->swap_frames ? &swap : NULL,
                                .oracle = o->oracle_tries ? &oracle : NULL,
                                .scene = o->model,
                                .path = o->view.path ? o->view.path : "auto"};
        warn_infeasible(o, &result);
        prom_bench_print(&facts);
        status = write_reports(o, &facts, error);
    }
    prom_swap_result_finish(&swap);
    prom_oracle_result_finish(&oracle);
    prom_loop_result_finish(&result);
    return status;
}

prom_status prom_command_bench(int argc, char **argv, prom_error *error)
{
    bench_options o = {
        .view = prom_view_options_default,
        .loop = {.warmup = 30, .keep_every = 30, .quality_frames = QUALITY_FRAMES},
        .swaps = SWAPS,
        .oracle_frames = ORACLE_FRAMES};
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    if (!o.view.selector) o.view.selector = PROM_SELECTOR_DEFAULT;
    if (!(o.view.budget_ms > 0)) o.view.budget_ms = DEFAULT_BUDGET_MS;
    o.loop.selector = o.view.selector;
    o.loop.budget_ms = o.view.budget_ms;
    o.loop.rule_scale = o.view.rule_scale;
    prom_command_files files = {{o.model, prom_view_path_file(&o.view), o.view.profile},
                                {&o.report, &o.csv, &o.swap_csv, &o.swap_plot}};
    prom_status status = prom_outputs_check(&files, error);
    if (status) return status;
    prom_session session;
    status = prom_session_open(&session, o.model, &o.view, true,
                               o.loop.frames ? o.loop.frames : AUTO_FRAMES, error);
    if (status) return status;
    status = run_loop(&o, &session, error);
    prom_session_close(&session);
    return status;
}
