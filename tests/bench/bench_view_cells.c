// LINK: prom_scenes prom_traverse prom_render prom_metaobj
// What a model's view cells know of the frames of a walk: full detail is drawn at 1280x720 and
// 60 degrees, and each leaf that shows is looked for in the cell of the eye.
// Usage: bench_view_cells MODEL PATH [EVERY] [SIDE_M]  EVERY: of the path's frames, 10; SIDE_M:
// so far beside the path, 0.
#include "render/renderer.h"
#include "scenes/path.h"
#include "traverse/selector.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#define WIDTH 1280u
#define HEIGHT 720u

typedef struct bench {
    prom_container *container;
    prom_model model;
    prom_view_cells cells;
    prom_path path;
    prom_context *context;
    prom_renderer *renderer;
    prom_draw_list *list;
    prom_target *target;
    prom_selector *selector;
    prom_cut cut;
    uint32_t *ids, *px; // of the picture; per node
    float *shares;      // per node
    double frames, without_cell;
    double leaves, listed, showing, missing; // in view; of them in the cell, seen, seen only
    double seen_px, missing_px, worst;       // worst: part of a frame's pixels
    double footprint_px, share_px;           // in view; of that what the cells let through
} bench;

static prom_status open_bench(bench *b, char **argv, prom_error *error)
{
    b->container = prom_container_open(argv[1], error);
    if (!b->container) return error->status;
    prom_status status = prom_container_load_model(b->container, &b->model, error);
    if (!status)
        status = prom_container_read_view_cells(b->container, &b->model, &b->cells, error);
    if (!status) status = prom_path_load(argv[2], &b->path, error);
    if (status) return status;
    b->selector = prom_selector_create("full", &b->model, error);
    if (b->selector) b->context = prom_context_create_headless(error);
    if (b->context) b->renderer = prom_renderer_create(b->context, error);
    if (b->renderer) b->target = prom_target_create(WIDTH, HEIGHT, true, error);
    if (!b->target) return error->status;
    b->list = prom_draw_list_create(b->renderer);
    b->ids = prom_alloc((size_t)WIDTH * HEIGHT, sizeof *b->ids);
    b->px = prom_calloc(b->model.node_count, sizeof *b->px);
    b->shares = prom_calloc(b->model.node_count, sizeof *b->shares);
    return prom_renderer_load(b->renderer, b->container, &b->model, error);
}

static void close_bench(bench *b)
{
    if (b->target) prom_target_destroy(b->target);
    if (b->list) prom_draw_list_destroy(b->list);
    prom_renderer_destroy(b->renderer);
    prom_context_destroy(b->context);
    prom_selector_destroy(b->selector);
    prom_cut_finish(&b->cut);
    prom_free(b->ids);
    prom_free(b->px);
    prom_free(b->shares);
    prom_path_finish(&b->path);
    prom_view_cells_finish(&b->cells);
    prom_model_finish(&b->model);
    prom_container_close(b->container);
}

// Blended ones count over what shows through them.
static void count_px(bench *b, const prom_camera *camera)
{
    memset(b->px, 0, b->model.node_count * sizeof *b->px);
    for (prom_ids which = PROM_IDS_OPAQUE; which <= PROM_IDS_BLENDED; which++) {
        prom_frame_options options = {.ids = which, .no_background = true};
        prom_renderer_draw_frame(b->renderer, b->list, b->target, &b->model, &b->cut, camera,
                                 &options);
        prom_target_read_ids(b->target, 0, 0, WIDTH, HEIGHT, b->ids);
        for (size_t i = 0; i < (size_t)WIDTH * HEIGHT; i++)
            if (b->ids[i] < b->model.tree_count) b->px[b->ids[i]]++;
    }
}

static void run_frame(bench *b, const prom_camera *camera)
{
    prom_cost_model cost = {.fixed_ms = 1};
    prom_view view;
    prom_view_init(&view, camera);
    prom_selection selection = {.view = &view, .cost = &cost, .budget_ms = 1e9};
    prom_selector_run(b->selector, &selection, &b->cut);
    const prom_view_cell *cell = prom_view_cells_at(&b->cells, camera->eye);
    b->frames++;
    b->without_cell += !cell;
    if (!cell) return;
    memset(b->shares, 0, b->model.node_count * sizeof *b->shares);
    for (uint32_t i = cell->first; i < cell->first + cell->count; i++)
        b->shares[b->cells.leaves[i]] = prom_view_share_decode(b->cells.shares[i]);
    count_px(b, camera);
    double seen = 0, missing = 0;
    for (size_t i = 0; i < b->cut.entries.count; i++) {
        const prom_cut_entry *e = &b->cut.entries.data[i];
        double px = b->px[e->node];
        bool listed = b->shares[e->node] > 0;
        seen += px;
        missing += listed ? 0 : px;
        b->leaves++;
        b->listed += listed;
        b->showing += px > 0;
        b->missing += px > 0 && !listed;
        b->footprint_px += (double)e->footprint_px;
        b->share_px += (double)(e->footprint_px * b->shares[e->node]);
    }
    b->seen_px += seen;
    b->missing_px += missing;
    if (seen > 0) b->worst = fmax(b->worst, missing / seen);
}

int main(int argc, char **argv)
{
    bench b = {0};
    prom_error error = {0};
    if (argc < 3 || open_bench(&b, argv, &error)) {
        fprintf(stderr, "%s\n",
                argc < 3 ? "usage: bench_view_cells MODEL PATH [EVERY] [SIDE_M]" : error.text);
        close_bench(&b);
        return 1;
    }
    uint32_t every = argc > 3 ? (uint32_t)strtoul(argv[3], NULL, 10) : 10;
    double side = argc > 4 ? strtod(argv[4], NULL) : 0;
    for (size_t i = 0; i < b.path.keys.count; i += every ? every : 1) {
        prom_camera camera = {
            .fov_y = (float)(M_PI / 3), .z_near = 0.1f, .width = WIDTH, .height = HEIGHT};
        prom_path_pose(&b.path, i, &camera);
        vec3 right = {1, 0, 0};
        glm_quat_rotatev(camera.orientation, right, right);
        for (int k = 0; k < 3; k++) camera.eye[k] += side * (double)right[k];
        run_frame(&b, &camera);
    }
    printf("frames %.0f, of them outside all cells %.0f\n", b.frames, b.without_cell);
    printf("leaves in view: %.1f %% in the cell, %.1f %% show, %.2f %% show unlisted\n",
           100 * b.listed / b.leaves, 100 * b.showing / b.leaves, 100 * b.missing / b.leaves);
    printf("pixels unlisted: %.4f %%, in the worst frame %.4f %%\n",
           100 * b.missing_px / b.seen_px, 100 * b.worst);
    printf("of screens: footprints %.2f, by the shares %.2f, seen %.2f\n",
           b.footprint_px / b.frames / (WIDTH * HEIGHT),
           b.share_px / b.frames / (WIDTH * HEIGHT), b.seen_px / b.frames / (WIDTH * HEIGHT));
    close_bench(&b);
    return 0;
}
