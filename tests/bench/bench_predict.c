// LINK: prom_scenes prom_render prom_traverse prom_benefit prom_metaobj
// Walks a model and compares the time of its frames with what the cost model says: with the
// frame's true features (does the model of the device hold?) and with those that the selector
// predicted (do the features hold?).
//
// Usage: bench_predict X.prom PATH|auto [FRAMES [W,H [PROFILE]]]
// Without a PROFILE the device is calibrated first. Columns of the second table: time,
// triangles; true over predicted draws, vertices, triangles; triangles left by clipping; pixels
// shaded over visible ones, pixels filled over footprints, pixels of shaded blocks over pixels
// shaded; milliseconds of all pixels by their true number over those predicted.
#include "render/calibrate.h"
#include "render/timer.h"
#include "scenes/path.h"
#include "traverse/selector.h"
#include "true_features.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { ROUNDS = 4, CASES = 5 };

// Cuts that are walked; `share` of what lies between the cheapest and full detail.
static const struct {
    const char *selector;
    double share;
} cases[CASES] = {
    {"full", 1}, {"greedy", 0.4}, {"greedy", 0.2}, {"greedy", 0.1}, {"coarsest", 0}};

typedef struct bench {
    prom_container *container;
    prom_model model;
    prom_context *context;
    prom_renderer *renderer;
    prom_draw_list *list;
    prom_target *target;
    prom_timer *timer;
    prom_cost_model cost;
    prom_path path;
    prom_camera camera;
    prom_selector *selectors[CASES]; // as `cases` names them
    prom_cut cut;
    true_features counter;
} bench;

typedef struct frame {
    prom_cost_features is, said; // true features; those of the cut
    double said_pixel_ms, said_ms;
    double footprint_px;
    frame_counts counts;
    double ms;
} frame;

// ---- predicted features

static void add_rep(frame *f, const prom_representation *rep)
{
    f->said.draws += rep->draws;
    f->said.vertices += rep->vertices;
    f->said.triangles += rep->triangles;
}

static void predict_features(const bench *b, frame *f)
{
    const prom_model *m = &b->model;
    f->said.fixed = 1;
    for (size_t i = 0; i < b->cut.entries.count; i++) {
        const prom_cut_entry *e = &b->cut.entries.data[i];
        add_rep(f, &m->reps[e->rep]);
        f->said.pixels[prom_cost_kind(&m->reps[e->rep])] += (double)e->visible_px;
        f->footprint_px += (double)e->footprint_px;
    }
    for (uint32_t node = m->tree_count; node < m->node_count; node++) {
        const prom_prototype *p = &m->prototypes[m->prototype[node]];
        if (p->rep_count) add_rep(f, &m->reps[p->first_rep]);
    }
    prom_cost_features geometry = f->said;
    memset(geometry.pixels, 0, sizeof geometry.pixels);
    f->said_ms = b->cut.predicted_ms;
    f->said_pixel_ms = f->said_ms - prom_cost_predict(&b->cost, &geometry);
}

// ---- frames

static void select_cut(bench *b, prom_selector *selector, const prom_camera *camera,
                       double budget_ms)
{
    prom_view view;
    prom_view_init(&view, camera);
    prom_selection selection = {.view = &view, .cost = &b->cost, .budget_ms = budget_ms};
    prom_selector_run(selector, &selection, &b->cut);
}

// What a share of full detail is predicted at.
static double budget_of(bench *b, const prom_camera *camera, double share)
{
    select_cut(b, b->selectors[0], camera, INFINITY);
    double full = b->cut.predicted_ms;
    select_cut(b, b->selectors[CASES - 1], camera, INFINITY);
    return b->cut.predicted_ms + share * (full - b->cut.predicted_ms);
}

static double time_frame(bench *b, const prom_camera *camera)
{
    prom_timer_begin(b->timer);
    prom_renderer_draw_frame(b->renderer, b->list, b->target, &b->model, &b->cut, camera, NULL);
    return prom_timer_end(b->timer);
}

// The frame at a place of the path with one of the cases' cuts. What else the machine does
// comes in bursts: each is taken in several rounds over all, and the quickest time counts.
static void take_frame(bench *b, int which, uint64_t at, frame *f)
{
    bool first = f->ms == 0;
    prom_camera camera = b->camera;
    prom_path_pose(&b->path, at, &camera);
    double budget_ms = budget_of(b, &camera, cases[which].share);
    select_cut(b, b->selectors[which], &camera, budget_ms);
    if (first) {
        predict_features(b, f);
        time_frame(b, &camera); // to warm
        b->counter.renderer = b->renderer;
        b->counter.list = b->list;
        b->counter.target = b->target;
        count_features(&b->counter, &camera, &f->is, &f->counts);
        f->ms = INFINITY;
    }
    f->ms = fmin(f->ms, time_frame(b, &camera));
}

// ---- what came of it

typedef struct score {
    double ratio, error, worst;        // mean actual / predicted; mean |ratio - 1|; greatest
    double error_scaled, worst_scaled; // the same after dividing by the mean ratio
} score;

static score score_of(const double *actual, const double *predicted, size_t count)
{
    score s = {0};
    for (size_t i = 0; i < count; i++) s.ratio += actual[i] / predicted[i] / (double)count;
    for (size_t i = 0; i < count; i++) {
        double r = actual[i] / predicted[i];
        s.error += fabs(r - 1) / (double)count;
        s.worst = fmax(s.worst, r - 1);
        s.error_scaled += fabs(r / s.ratio - 1) / (double)count;
        s.worst_scaled = fmax(s.worst_scaled, r / s.ratio - 1);
    }
    return s;
}

static void print_score(const char *name, bool is_true, const frame *frames, size_t count,
                        const prom_cost_model *cost)
{
    double *actual = prom_alloc(count, sizeof *actual), *said = prom_alloc(count, sizeof *said);
    for (size_t i = 0; i < count; i++) {
        actual[i] = frames[i].ms;
        const frame *f = &frames[i];
        said[i] = is_true ? prom_cost_predict(cost, &f->is) : f->said_ms;
    }
    score s = score_of(actual, said, count);
    printf("%-14s %-10s %8.3f %8.1f %8.1f %8.1f %8.1f\n", name, is_true ? "true" : "predicted",
           s.ratio, 100 * s.error, 100 * s.worst, 100 * s.error_scaled, 100 * s.worst_scaled);
    prom_free(actual);
    prom_free(said);
}

static double pixel_ms(const prom_cost_model *cost, const prom_cost_features *f)
{
    prom_cost_features pixels = *f;
    pixels.fixed = pixels.binds = pixels.draws = 0;
    pixels.vertices = pixels.triangles = 0;
    return prom_cost_predict(cost, &pixels);
}

// Sums over frames; each feature as true / predicted.
static void print_features(const char *name, const frame *frames, size_t count,
                           const prom_cost_model *cost)
{
    frame sum = {0};
    double is_pixel_ms = 0, shaded = 0, said_shaded = 0;
    for (size_t i = 0; i < count; i++) {
        const frame *f = &frames[i];
        sum.is.draws += f->is.draws, sum.said.draws += f->said.draws;
        sum.is.vertices += f->is.vertices, sum.said.vertices += f->said.vertices;
        sum.is.triangles += f->is.triangles, sum.said.triangles += f->said.triangles;
        sum.is.hidden += f->is.hidden;
        sum.said_pixel_ms += f->said_pixel_ms;
        sum.footprint_px += f->footprint_px;
        sum.counts.clipped += f->counts.clipped;
        sum.counts.blocks_px += f->counts.blocks_px;
        sum.ms += f->ms;
        is_pixel_ms += pixel_ms(cost, &f->is);
        shaded += sum_pixels(&f->is), said_shaded += sum_pixels(&f->said);
    }
    printf("%-14s %8.2f %8.0f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f %8.3f\n", name,
           sum.ms / (double)count, sum.is.triangles / (double)count,
           sum.is.draws / sum.said.draws, sum.is.vertices / sum.said.vertices,
           sum.is.triangles / sum.said.triangles, sum.counts.clipped / sum.is.triangles,
           shaded / said_shaded, (shaded + sum.is.hidden) / sum.footprint_px,
           sum.counts.blocks_px / shaded, is_pixel_ms / sum.said_pixel_ms);
}

static void run(bench *b, uint32_t count)
{
    frame *frames = prom_calloc((size_t)CASES * count, sizeof *frames);
    // Spread over the whole path.
    for (int round = 0; round < ROUNDS; round++)
        for (uint32_t i = 0; i < count; i++)
            for (int c = 0; c < CASES; c++)
                take_frame(b, c, (uint64_t)i * b->path.keys.count / count,
                           &frames[(size_t)c * count + i]);
    printf("%-14s %-10s %8s %8s %8s %8s %8s\n", "actual/said", "features", "mean", "error %",
           "under %", "scaled %", "under %");
    for (int c = 0; c <= CASES; c++) {
        char name[32] = "all";
        if (c < CASES)
            snprintf(name, sizeof name, "%s %.0f%%", cases[c].selector, 100 * cases[c].share);
        const frame *first = &frames[(size_t)(c % CASES) * count];
        size_t n = c < CASES ? count : (size_t)CASES * count;
        print_score(name, true, first, n, &b->cost);
        print_score(name, false, first, n, &b->cost);
    }
    printf("%-14s %8s %8s %8s %8s %8s %8s %8s %8s %8s %8s\n", "true/predicted", "ms", "triang.",
           "draws", "vertices", "triang.", "clipped", "shaded", "filled", "blocks", "pixel ms");
    for (int c = 0; c < CASES; c++) {
        print_features(cases[c].selector, &frames[(size_t)c * count], count, &b->cost);
    }
    prom_free(frames);
}

// ---- opening

static prom_status get_cost(bench *b, const char *profile, prom_error *error)
{
    if (profile) return prom_cost_load(profile, &b->cost, error);
    prom_cost_samples samples = {0};
    double noise;
    prom_status status = prom_calibrate_run(b->renderer, b->timer, b->camera.width,
                                            b->camera.height, 1, &samples, &noise, error);
    if (!status) status = prom_cost_fit(samples.data, samples.count, &b->cost, error);
    prom_array_finish(&samples);
    return status;
}

static void print_cost(const prom_cost_model *c)
{
    printf("fixed %.3f ms, draw %.3f us, vertex %.1f ns, triangle %.1f ns, pixel", c->fixed_ms,
           c->draw_ms * 1e3, c->vertex_ms * 1e6, c->triangle_ms * 1e6);
    for (int k = 0; k < PROM_COST_KINDS; k++) printf(" %.2f", c->pixel_ms[k] * 1e6);
    printf(" edge %.2f hidden %.2f ns; error %.1f %%, under %.1f %%\n", c->edge_ms * 1e6,
           c->hidden_pixel_ms * 1e6, 100 * c->mean_error, 100 * c->worst_under);
}

static prom_status open_bench(bench *b, const char *model, const char *path, uint32_t frames,
                              const char *profile, prom_error *error)
{
    b->container = prom_container_open(model, error);
    if (!b->container) return error->status;
    prom_status status = prom_container_load_model(b->container, &b->model, error);
    if (!status)
        status = strcmp(path, "auto")
                     ? prom_path_load(path, &b->path, error)
                     : prom_path_auto(b->container, &b->model, 8 * frames, &b->path, error);
    if (status) return status;
    b->context = prom_context_create_headless(error);
    b->renderer = b->context ? prom_renderer_create(b->context, error) : NULL;
    if (!b->renderer) return error->status;
    b->list = prom_draw_list_create(b->renderer);
    b->timer = prom_timer_create(b->renderer);
    b->target = prom_target_create(b->camera.width, b->camera.height, false, error);
    if (!b->target) return error->status;
    b->camera.z_near = fminf(0.1f, b->model.radius[0] / 1000.0f);
    status = get_cost(b, profile, error);
    if (!status) status = prom_renderer_load(b->renderer, b->container, &b->model, error);
    if (status) return status;
    for (int c = 0; c < CASES; c++) {
        b->selectors[c] = prom_selector_create(cases[c].selector, &b->model, error);
        if (!b->selectors[c]) return error->status;
    }
    return PROM_OK;
}

static void close_bench(bench *b)
{
    prom_cut_finish(&b->cut);
    for (int c = 0; c < CASES; c++)
        if (b->selectors[c]) prom_selector_destroy(b->selectors[c]);
    prom_path_finish(&b->path);
    if (b->target) prom_target_destroy(b->target);
    prom_timer_destroy(b->timer);
    if (b->list) prom_draw_list_destroy(b->list);
    if (b->renderer) prom_renderer_destroy(b->renderer);
    prom_context_destroy(b->context);
    prom_model_finish(&b->model);
    prom_container_close(b->container);
    true_features_finish(&b->counter);
}

int main(int argc, char **argv)
{
    unsigned frames = 40, width = 1280, height = 720;
    if (argc < 3 || (argc > 3 && sscanf(argv[3], "%u", &frames) != 1) || !frames ||
        (argc > 4 && sscanf(argv[4], "%u,%u", &width, &height) != 2)) {
        fprintf(stderr,
                "error: usage: bench_predict X.prom PATH|auto [FRAMES [W,H [PROFILE]]]\n");
        return 1;
    }
    bench b = {.camera = {.orientation = {0, 0, 0, 1},
                          .fov_y = (float)M_PI / 3,
                          .width = width,
                          .height = height}};
    prom_error error = {0};
    prom_status status =
        open_bench(&b, argv[1], argv[2], frames, argc > 5 ? argv[5] : NULL, &error);
    if (!status) {
        print_cost(&b.cost);
        run(&b, frames);
    }
    close_bench(&b);
    if (status) fprintf(stderr, "error: %s\n", error.text);
    return status ? 1 : 0;
}
