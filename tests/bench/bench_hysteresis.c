// LINK: prom_scenes prom_traverse prom_metaobj
// What staying with the last cut is worth: a walk is selected, without drawing, for several
// strengths; how much switches from frame to frame, and what it costs of the benefit.
// Usage: bench_hysteresis X.prom PATH PROFILE [BUDGET_MS [WIDTH,HEIGHT [SELECTOR]]]
// The budget is for the prediction; nothing is known to be hidden unless the model has view
// cells.
#include "metaobj/base/clock.h"
#include "metaobj/container.h"
#include "scenes/path.h"
#include "traverse/selector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

typedef struct bench {
    prom_container *container;
    prom_model model;
    prom_view_cells cells;
    prom_path path;
    prom_cost_model cost;
    prom_camera camera;
    const char *selector;
    double budget_ms;
} bench;

static prom_status open_bench(bench *b, char **argv, prom_error *error)
{
    b->container = prom_container_open(argv[1], error);
    prom_status status = b->container ? PROM_OK : error->status;
    if (!status) status = prom_container_load_model(b->container, &b->model, error);
    if (!status)
        status = prom_container_read_view_cells(b->container, &b->model, &b->cells, error);
    if (!status) status = prom_path_load(argv[2], &b->path, error);
    return status ? status : prom_cost_load(argv[3], &b->cost, error);
}

static void close_bench(bench *b)
{
    prom_path_finish(&b->path);
    prom_view_cells_finish(&b->cells);
    prom_model_finish(&b->model);
    prom_container_close(b->container);
}

static void walk(bench *b, float hysteresis)
{
    prom_selector *selector = prom_selector_create(b->selector, &b->model, NULL);
    prom_visibility *visibility =
        b->cells.cell_count ? prom_visibility_create(&b->model, &b->cells) : NULL;
    prom_last_cut last;
    prom_cut cut = {0};
    prom_last_cut_init(&last, &b->model);
    double switches = 0, px = 0, entries = 0, benefit = 0, loss = 0, ms = 0, used = 0;
    size_t frames = b->path.keys.count;
    for (size_t i = 0; i < frames; i++) {
        prom_camera camera = b->camera;
        prom_view view;
        prom_path_pose(&b->path, i, &camera);
        double start = prom_clock_ms();
        prom_view_init(&view, &camera);
        if (visibility) prom_visibility_begin(visibility, &camera);
        prom_selection selection = {.view = &view,
                                    .cost = &b->cost,
                                    .budget_ms = b->budget_ms,
                                    .visibility = visibility,
                                    .last = &last,
                                    .hysteresis = hysteresis};
        prom_selector_run(selector, &selection, &cut);
        ms += prom_clock_ms() - start;
        prom_switches s = prom_last_cut_note(&last, &cut);
        switches += s.count, px += s.px;
        entries += (double)cut.entries.count;
        benefit += cut.benefit, loss += cut.loss;
        used += cut.predicted_ms / b->budget_ms;
    }
    printf("%10.3f %9.2f %9.0f %9.0f %10.3f %8.1f %9.1f\n", (double)hysteresis,
           switches / (double)frames, px / (double)frames, entries / (double)frames,
           100 * loss / (benefit + loss), 100 * used / (double)frames,
           1e3 * ms / (double)frames);
    prom_last_cut_finish(&last);
    prom_cut_finish(&cut);
    prom_visibility_destroy(visibility);
    prom_selector_destroy(selector);
}

int main(int argc, char **argv)
{
    bench b = {.selector = argc > 6 ? argv[6] : "greedy"};
    prom_error error = {0};
    unsigned width = 1280, height = 720;
    bool good = argc > 3 && (argc < 6 || sscanf(argv[5], "%u,%u", &width, &height) == 2) &&
                prom_selector_class_named(b.selector);
    if (!good || open_bench(&b, argv, &error)) {
        fprintf(stderr, "%s\n",
                good ? error.text
                     : "usage: bench_hysteresis X.prom PATH PROFILE [BUDGET_MS [W,H "
                       "[SELECTOR]]]");
        close_bench(&b);
        return 1;
    }
    b.budget_ms = argc > 4 ? strtod(argv[4], NULL) : 20;
    b.camera = (prom_camera){
        .fov_y = (float)(M_PI / 3), .z_near = 0.1f, .width = width, .height = height};
    printf("%zu frames, %s within %g ms\n", b.path.keys.count, b.selector, b.budget_ms);
    printf("%10s %9s %9s %9s %10s %8s %9s\n", "hysteresis", "switches", "their px", "entries",
           "loss %", "used %", "select us");
    static const float strengths[] = {0, 0.005f, 0.01f, 0.02f, 0.05f, 0.1f, 0.2f, 0.5f};
    for (size_t i = 0; i < sizeof strengths / sizeof *strengths; i++) walk(&b, strengths[i]);
    close_bench(&b);
    return 0;
}
