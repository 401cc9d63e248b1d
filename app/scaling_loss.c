#include "app/scaling_loss.h"

#include "benefit/metric.h"

#include <math.h>

#define VIEWS 2
#define CUT_MS 100.0
#define COVERED 128 // alpha: the tree gives 1, the clear and the background layer 0

typedef struct measuring {
    prom_session *session;
    prom_selector *selector;
    prom_cut cut;
    prom_metric *metric;
    uint32_t width, height;
    uint8_t *whole, *scaled; // rgba
    float *whole_features, *scaled_features, *errors;
} measuring;

// Tables made by a metric that this program does not know are compared with `flip`.
static prom_status begin(measuring *m, prom_session *session, prom_error *error)
{
    const char *name = session->model.measured.metric;
    uint32_t width = session->camera.width, height = session->camera.height;
    size_t pixels = (size_t)width * height;
    *m = (measuring){.session = session, .width = width, .height = height};
    m->selector = prom_selector_create(PROM_SELECTOR_DEFAULT, &session->model, error);
    if (!m->selector) return error->status;
    m->metric =
        prom_metric_create(prom_metric_named(name) ? name : "flip", prom_session_ppd(session),
                           width > height ? width : height, pixels, 0);
    size_t floats = prom_metric_feature_floats(m->metric, width, height);
    m->whole = prom_alloc(pixels, 4);
    m->scaled = prom_alloc(pixels, 4);
    m->whole_features = prom_alloc(floats, sizeof(float));
    m->scaled_features = prom_alloc(floats, sizeof(float));
    m->errors = prom_alloc(pixels, sizeof(float));
    return PROM_OK;
}

static void end(measuring *m)
{
    prom_selector_destroy(m->selector);
    prom_metric_destroy(m->metric);
    prom_cut_finish(&m->cut);
    prom_free(m->whole);
    prom_free(m->scaled);
    prom_free(m->whole_features);
    prom_free(m->scaled_features);
    prom_free(m->errors);
}

// The picture that the session's target holds.
static void look(measuring *m, uint8_t *rgba, float *features)
{
    prom_target_read_rgba(m->session->target, 0, 0, m->width, m->height, rgba);
    const prom_picture picture = {
        .width = m->width, .height = m->height, .channels = 4, .pixels = rgba};
    prom_metric_features(m->metric, &picture, features);
}

static void draw_whole(measuring *m, const prom_camera *camera)
{
    prom_session *s = m->session;
    double allowed = prom_session_allowed_ms(s, CUT_MS);
    prom_session_select(s, m->selector, NULL, camera, allowed, 1, &m->cut);
    prom_session_draw(s, &m->cut, camera, &(prom_frame_options){.ids = PROM_IDS_NONE});
    look(m, m->whole, m->whole_features);
}

static double loss_of(measuring *m, prom_target *target, double factor,
                      const prom_camera *camera)
{
    prom_session *s = m->session;
    prom_frame_options options = {.ids = PROM_IDS_NONE};
    prom_scaled_size((uint32_t[]){m->width, m->height}, factor, options.size_px);
    prom_renderer_draw_frame(s->renderer, s->list, target, &s->model, &m->cut, camera,
                             &options);
    prom_target_copy_colors(s->target, target);
    look(m, m->scaled, m->scaled_features);
    prom_metric_compare(m->metric, m->whole_features, m->scaled_features, m->width, m->height,
                        m->errors);
    double sum = 0;
    size_t covered = 0, pixels = (size_t)m->width * m->height;
    for (size_t i = 0; i < pixels; i++) {
        if (m->whole[4 * i + 3] < COVERED) continue;
        sum += (double)m->errors[i];
        covered++;
    }
    return covered ? sum / (double)covered : 0;
}

static void measure_from(measuring *m, prom_target *const targets[PROM_SCALES],
                         const prom_camera *camera, double losses[PROM_SCALES],
                         const prom_scaling *scaling)
{
    draw_whole(m, camera);
    for (unsigned i = 1; i < scaling->count; i++)
        losses[i] += loss_of(m, targets[i], scaling->scales[i].factor, camera);
}

prom_status prom_scaling_loss_measure(prom_session *session,
                                      prom_target *const targets[PROM_SCALES],
                                      prom_scaling *scaling, const prom_camera *camera,
                                      prom_error *error)
{
    measuring m;
    double losses[PROM_SCALES] = {0};
    int views = camera ? 1 : VIEWS;
    prom_status status = begin(&m, session, error);
    for (int v = 0; v < views && !status; v++) {
        prom_camera here = session->camera;
        size_t keys = session->path.keys.count;
        if (!camera) prom_path_pose(&session->path, (2 * v + 1) * keys / (2 * VIEWS), &here);
        measure_from(&m, targets, camera ? camera : &here, losses, scaling);
    }
    for (unsigned i = 1; i < scaling->count && !status; i++)
        scaling->scales[i].loss = fmax(losses[i] / views, scaling->scales[i - 1].loss);
    prom_renderer_take_stats(session->renderer);
    end(&m);
    return status;
}
