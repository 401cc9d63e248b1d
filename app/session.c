#include "app/session.h"

#include "app/calibration.h"
#include "benefit/metric.h"
#include "builder/image_io.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "traverse/guarantee.h"

#include <math.h>
#include <string.h>

static prom_status open_model(prom_session *s, const char *model_path, prom_error *error)
{
    s->container = prom_container_open(model_path, error);
    if (!s->container) return error->status;
    prom_status status = prom_container_load_model(s->container, &s->model, error);
    if (!status && s->visibility & PROM_SEE_CELLS)
        status = prom_container_read_view_cells(s->container, &s->model, &s->cells, error);
    if (!status && s->visibility == PROM_SEE_CELLS && !s->cells.cell_count)
        prom_log(PROM_LOG_WARNING,
                 "%s has no view cells: nothing counts as hidden (see `build --view-cells`)",
                 model_path);
    if (!s->cells.cell_count) s->visibility &= ~(unsigned)PROM_SEE_CELLS;
    return status;
}

static void find_semantics(prom_session *s)
{
    prom_weights_apply(&s->choice.rules, &s->model);
    prom_weight_rules_warn(&s->choice.rules);
    s->semantics = prom_alloc(s->model.tree_count, sizeof *s->semantics);
    if (prom_weights_gather(&s->model, s->semantics)) return;
    prom_free(s->semantics);
    s->semantics = NULL;
}

static bool with_ids(const prom_session *s)
{
    return s->visibility & PROM_SEE_FRAME;
}

static prom_context *create_headless(void *user, uint32_t size_px[2], prom_error *error)
{
    (void)user, (void)size_px;
    return prom_context_create_headless(error);
}

static const prom_session_device headless = {create_headless, NULL};

static prom_status open_device(prom_session *s, const prom_session_device *device,
                               uint32_t size_px[2], prom_error *error)
{
    s->context = device->create(device->user, size_px, error);
    if (!s->context) return error->status;
    s->renderer = prom_renderer_create(s->context, error);
    if (!s->renderer) return error->status;
    s->list = prom_draw_list_create(s->renderer);
    s->target = prom_target_create(size_px[0], size_px[1], with_ids(s), error);
    return s->target ? PROM_OK : error->status;
}

static prom_status open_path(prom_session *s, const char *path, uint32_t frames,
                             prom_error *error)
{
    if (!path || !strcmp(path, "auto"))
        return prom_path_auto(s->container, &s->model, frames, &s->path, error);
    return prom_path_load(path, &s->path, error);
}

static void set_camera(prom_session *s, const prom_view_options *options,
                       const uint32_t size_px[2])
{
    s->camera = (prom_camera){
        .orientation = {0, 0, 0, 1},
        .fov_y = (float)(options->fov_degrees * M_PI / 180.0),
        // Near enough for a close wall in any unit of length.
        .z_near = fminf(0.1f, s->model.radius[0] / 1000.0f),
        .width = size_px[0],
        .height = size_px[1],
    };
    if (!(s->camera.z_near > 0)) s->camera.z_near = 1e-4f; // a model of a single point
}

// Whether anything but the prediction depends on the cost model.
static bool need_cost(const prom_view_options *options)
{
    return options->budget_ms > 0 || prom_selector_class_named(options->selector)->uses_cost;
}

static prom_status open_all(prom_session *s, const prom_session_device *device,
                            const char *model_path, const prom_view_options *options,
                            bool with_path, uint32_t path_frames, prom_error *error)
{
    uint32_t size_px[2] = {options->size_px[0], options->size_px[1]};
    s->ppd = options->ppd;
    s->choice = options->choice;
    s->miss_rate = options->miss_rate;
    s->min_scale = options->min_scale;
    s->frozen = options->profile;
    double start = prom_clock_ms();
    // What does not choose by cost and benefit has no use for it.
    if (prom_selector_class_named(options->selector)->uses_cost)
        s->visibility = options->visibility;
    prom_status status = open_model(s, model_path, error);
    if (!status) find_semantics(s);
    if (!status && with_path) status = open_path(s, options->path, path_frames, error);
    if (!status) status = open_device(s, device, size_px, error);
    if (status) return status;
    double before = prom_clock_ms();
    status = prom_calibration_get(s->context, s->renderer, options->profile, size_px,
                                  need_cost(options), &s->cost, error);
    if (status) return status;
    double calibrated = prom_clock_ms();
    status = prom_renderer_load(s->renderer, s->container, &s->model, error);
    if (status) return status;
    set_camera(s, options, size_px);
    s->calibration_s = (calibrated - before) / 1000.0;
    s->start_s = (prom_clock_ms() - start) / 1000.0 - s->calibration_s;
    return PROM_OK;
}

prom_status prom_session_open(prom_session *session, const char *model_path,
                              const prom_view_options *options, bool with_path,
                              uint32_t path_frames, prom_error *error)
{
    return prom_session_open_on(session, &headless, model_path, options, with_path, path_frames,
                                error);
}

prom_status prom_session_open_on(prom_session *session, const prom_session_device *device,
                                 const char *model_path, const prom_view_options *options,
                                 bool with_path, uint32_t path_frames, prom_error *error)
{
    *session = (prom_session){0};
    prom_status status =
        open_all(session, device, model_path, options, with_path, path_frames, error);
    if (status) prom_session_close(session);
    return status;
}

void prom_session_close(prom_session *session)
{
    prom_path_finish(&session->path);
    if (session->target) prom_target_destroy(session->target);
    if (session->list) prom_draw_list_destroy(session->list);
    if (session->renderer) prom_renderer_destroy(session->renderer);
    prom_context_destroy(session->context);
    prom_view_cells_finish(&session->cells);
    prom_free(session->semantics);
    prom_model_finish(&session->model);
    prom_container_close(session->container);
    *session = (prom_session){0};
}

prom_status prom_session_resize(prom_session *session, const uint32_t size_px[2],
                                prom_error *error)
{
    prom_target *target = prom_target_create(size_px[0], size_px[1], with_ids(session), error);
    if (!target) return error->status;
    prom_target_destroy(session->target);
    session->target = target;
    session->camera.width = size_px[0];
    session->camera.height = size_px[1];
    return PROM_OK;
}

double prom_session_ppd(const prom_session *session)
{
    if (session->ppd > 0) return session->ppd;
    return prom_full_screen_ppd(session->camera.width);
}

// Metrics that look at pixels, whatever their angle, are right at the sizes that they measured.
static float table_px(const prom_session *session)
{
    const prom_measured *measured = &session->model.measured;
    const prom_metric_class *metric = prom_metric_named(measured->metric);
    bool by_angle = metric && metric->uses_ppd;
    return by_angle ? measured->ppd / (float)prom_session_ppd(session) : 1.0f;
}

double prom_session_allowed_ms(const prom_session *session, double budget_ms)
{
    prom_guarantee guarantee;
    const prom_guarantee_options options = {
        .budget_ms = budget_ms, .miss_rate = session->miss_rate, .frozen = true};
    prom_guarantee_init(&guarantee, &session->cost, &options);
    return prom_guarantee_allowed(&guarantee);
}

double prom_session_step_s(const prom_session *session)
{
    size_t keys = session->path.keys.count;
    if (keys < 2) return 1.0 / PROM_PATH_RATE;
    return (session->path.keys.data[keys - 1].t - session->path.keys.data[0].t) /
           (double)(keys - 1);
}

prom_selection prom_session_selection(const prom_session *session, const prom_view *view,
                                      const prom_visibility *visibility, double budget_ms,
                                      double rule_scale)
{
    return (prom_selection){
        .view = view,
        .cost = &session->cost,
        .budget_ms = budget_ms,
        .rule_scale = (float)rule_scale,
        .table_px = table_px(session),
        .visibility = visibility,
        .weighting = {.use = session->choice.weights, .semantics = session->semantics},
        .order = session->choice.order,
        .priors = session->choice.priors,
        .hysteresis = (float)session->choice.hysteresis,
        .max_switches = session->choice.max_switches,
    };
}

void prom_session_select(const prom_session *session, prom_selector *selector,
                         const prom_visibility *visibility, const prom_camera *camera,
                         double budget_ms, double rule_scale, prom_cut *cut)
{
    prom_view view;
    prom_view_init(&view, camera);
    prom_selection selection =
        prom_session_selection(session, &view, visibility, budget_ms, rule_scale);
    prom_selector_run(selector, &selection, cut);
}

void prom_session_submit(prom_session *session, const prom_cut *cut, const prom_camera *camera,
                         const prom_frame_options *options)
{
    prom_renderer_draw_frame(session->renderer, session->list, session->target, &session->model,
                             cut, camera, options);
}

void prom_session_draw(prom_session *session, const prom_cut *cut, const prom_camera *camera,
                       const prom_frame_options *options)
{
    prom_session_submit(session, cut, camera, options);
    prom_renderer_finish(session->renderer);
}

prom_status prom_session_write_png(prom_session *session, const char *path, prom_error *error)
{
    uint32_t width = session->camera.width, height = session->camera.height;
    size_t pixels = (size_t)width * height;
    uint8_t *rgba = prom_alloc(pixels, 4);
    prom_target_read_rgba(session->target, 0, 0, width, height, rgba);
    // Alpha says what the tree covers; a picture to look at is opaque. Packs in place.
    for (size_t i = 0; i < pixels; i++) memmove(rgba + 3 * i, rgba + 4 * i, 3);
    prom_status status = prom_image_write_png(path, width, height, 3, rgba, error);
    prom_free(rgba);
    return status;
}
