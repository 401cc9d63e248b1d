// LINK: prom_scenes prom_traverse prom_render prom_metaobj
// What ids cost on real frames: the attachment, the gathering, the counting; and what drawing
// last what is hidden gains. Each frame is drawn in all ways in turn, and each way is compared
// with the plain one of the same turn. Usage: bench_ids MODEL PATH [FRAMES] [ROUNDS] [SELECTOR]
#include "metaobj/base/alloc.h"
#include "metaobj/base/clock.h"
#include "render/id_counter.h"
#include "render/renderer.h"
#include "scenes/path.h"
#include "traverse/selector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define WIDTH 1280u
#define HEIGHT 720u
#define BUDGET_MS 33.0

typedef enum way {
    WAY_PLAIN,  // a target without ids
    WAY_NONE,   // a target with ids, none written
    WAY_OPAQUE, // ids written
    WAY_HIDDEN, // a target without ids, what is hidden last
    WAY_COUNT
} way;

typedef struct bench {
    prom_container *container;
    prom_model model;
    prom_path path;
    prom_context *context;
    prom_renderer *renderer;
    prom_draw_list *list;
    prom_target *targets[2]; // with ids: 1
    prom_id_counter *counter;
    prom_selector *selector;
    prom_cut cut;
    float *px; // per node
    PROM_ARRAY(double) ms[WAY_COUNT];
    PROM_ARRAY(double) extra[WAY_COUNT]; // over the plain way
    PROM_ARRAY(double) start_ms;
    PROM_ARRAY(double) take_ms;
    double entries, hidden;
} bench;

static prom_status open_bench(bench *b, char **argv, const char *selector, prom_error *error)
{
    b->container = prom_container_open(argv[1], error);
    if (!b->container) return error->status;
    prom_status status = prom_container_load_model(b->container, &b->model, error);
    if (!status) status = prom_path_load(argv[2], &b->path, error);
    if (status) return status;
    b->selector = prom_selector_create(selector, &b->model, error);
    if (b->selector) b->context = prom_context_create_headless(error);
    if (b->context) b->renderer = prom_renderer_create(b->context, error);
    if (!b->renderer) return error->status;
    b->list = prom_draw_list_create(b->renderer);
    for (int i = 0; i < 2; i++) {
        b->targets[i] = prom_target_create(WIDTH, HEIGHT, i, error);
        if (!b->targets[i]) return error->status;
    }
    b->counter = prom_id_counter_create(b->model.tree_count, error);
    b->px = prom_calloc(b->model.tree_count, sizeof *b->px);
    if (!b->counter) return error->status;
    return prom_renderer_load(b->renderer, b->container, &b->model, error);
}

static void close_bench(bench *b)
{
    prom_id_counter_destroy(b->counter);
    for (int i = 0; i < 2; i++) prom_target_destroy(b->targets[i]);
    if (b->list) prom_draw_list_destroy(b->list);
    prom_renderer_destroy(b->renderer);
    prom_context_destroy(b->context);
    prom_selector_destroy(b->selector);
    prom_cut_finish(&b->cut);
    prom_free(b->px);
    prom_path_finish(&b->path);
    prom_model_finish(&b->model);
    prom_container_close(b->container);
    for (way w = 0; w < WAY_COUNT; w++) {
        prom_array_finish(&b->ms[w]);
        prom_array_finish(&b->extra[w]);
    }
    prom_array_finish(&b->start_ms);
    prom_array_finish(&b->take_ms);
}

// ---- a frame

static void select_cut(bench *b, const prom_camera *camera)
{
    // Near enough to llvmpipe's for a cut of some milliseconds; only ratios are reported.
    prom_cost_model cost = {
        .fixed_ms = 1, .draw_ms = 5e-4, .triangle_ms = 1.2e-4, .hidden_pixel_ms = 5e-7};
    for (int k = 0; k < PROM_SHADE_COUNT; k++) cost.pixel_ms[k] = 4e-6;
    prom_view view;
    prom_view_init(&view, camera);
    prom_selection selection = {.view = &view, .cost = &cost, .budget_ms = BUDGET_MS};
    prom_selector_run(b->selector, &selection, &b->cut);
}

static double draw_ms(bench *b, const prom_camera *camera, way w)
{
    bool ids = w == WAY_NONE || w == WAY_OPAQUE;
    prom_frame_options options = {.ids = w == WAY_NONE ? PROM_IDS_NONE : PROM_IDS_OPAQUE};
    for (size_t i = 0; i < b->cut.entries.count; i++) {
        prom_cut_entry *e = &b->cut.entries.data[i];
        e->visible_px = w == WAY_HIDDEN ? b->px[e->node] : e->footprint_px;
    }
    prom_renderer_finish(b->renderer);
    double start = prom_clock_ms();
    prom_renderer_draw_frame(b->renderer, b->list, b->targets[ids], &b->model, &b->cut, camera,
                             &options);
    prom_renderer_finish(b->renderer);
    return prom_clock_ms() - start;
}

static void count_ids(bench *b, bool keep)
{
    prom_id_counts counts;
    double start = prom_clock_ms();
    prom_id_counter_start(b->counter, b->targets[1], 0);
    prom_renderer_finish(b->renderer);
    double started = prom_clock_ms();
    if (!prom_id_counter_take(b->counter, true, &counts)) return;
    double taken = prom_clock_ms();
    for (size_t i = 0; i < counts.count; i++) b->px[counts.counts[i].id] += counts.counts[i].px;
    if (!keep) return;
    prom_array_push(&b->start_ms, started - start);
    prom_array_push(&b->take_ms, taken - started);
}

// The first round warms. Before it, the visible pixels are counted exactly, by all phases of
// the counter.
static void run_frame(bench *b, const prom_camera *camera, int rounds)
{
    select_cut(b, camera);
    for (uint32_t i = 0; i < b->model.tree_count; i++) b->px[i] = 0;
    draw_ms(b, camera, WAY_OPAQUE);
    for (int i = 0; i < PROM_ID_STEP * PROM_ID_STEP; i++) count_ids(b, false);
    for (size_t i = 0; i < b->cut.entries.count; i++)
        b->hidden += b->px[b->cut.entries.data[i].node] <= 0;
    b->entries += (double)b->cut.entries.count;
    for (int round = -1; round < rounds; round++) {
        double ms[WAY_COUNT];
        for (int i = 0; i < WAY_COUNT; i++) { // none is always the first
            way w = (way)((i + round + 1) % WAY_COUNT);
            ms[w] = draw_ms(b, camera, w);
            if (w == WAY_OPAQUE) count_ids(b, round >= 0);
        }
        for (way w = 0; round >= 0 && w < WAY_COUNT; w++) {
            prom_array_push(&b->ms[w], ms[w]);
            prom_array_push(&b->extra[w], ms[w] - ms[WAY_PLAIN]);
        }
    }
}

// ---- the report

static int by_value(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, size_t count)
{
    qsort(values, count, sizeof *values, by_value);
    return values[count / 2];
}

static void report(bench *b)
{
    static const char *const names[WAY_COUNT] = {"plain", "ids: none", "ids: opaque",
                                                 "hidden last"};
    for (way w = 0; w < WAY_COUNT; w++) {
        double ms = median(b->ms[w].data, b->ms[w].count);
        double extra = median(b->extra[w].data, b->extra[w].count);
        printf("%-12s %8.2f ms  %+7.3f ms  %+6.2f %%\n", names[w], ms, extra,
               100 * extra / median(b->ms[WAY_PLAIN].data, b->ms[WAY_PLAIN].count));
    }
    printf("gather       %8.3f ms\n", median(b->start_ms.data, b->start_ms.count));
    printf("count        %8.3f ms\n", median(b->take_ms.data, b->take_ms.count));
    printf("%.1f %% of the entries show nothing\n", 100 * b->hidden / fmax(b->entries, 1));
}

int main(int argc, char **argv)
{
    long frames = argc > 3 ? strtol(argv[3], NULL, 10) : 8;
    long rounds = argc > 4 ? strtol(argv[4], NULL, 10) : 15;
    if (argc < 3 || frames < 1 || rounds < 1 || frames > 10000 || rounds > 10000) {
        fprintf(stderr, "error: usage: bench_ids MODEL PATH [FRAMES] [ROUNDS] [SELECTOR]\n");
        return 1;
    }
    bench b = {0};
    prom_error error = {0};
    prom_status status = open_bench(&b, argv, argc > 5 ? argv[5] : "full", &error);
    if (status) fprintf(stderr, "error: %s\n", error.text);
    for (long f = 0; !status && f < frames; f++) {
        prom_camera camera = {.fov_y = 1.0471976f,
                              .z_near = fminf(0.1f, b.model.radius[0] / 1000),
                              .width = WIDTH,
                              .height = HEIGHT};
        prom_path_pose(&b.path, (uint64_t)f * b.path.keys.count / (uint64_t)frames, &camera);
        run_frame(&b, &camera, (int)rounds);
    }
    if (!status) report(&b);
    close_bench(&b);
    return status != PROM_OK;
}
