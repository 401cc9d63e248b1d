#include "app/comparison.h"

#include "app/counted_picture.h"
#include "app/pixel_shares.h"

#include <math.h>

#define COVERED 128 // alpha: the tree gives 1, the clear and the background layer 0

static prom_compared new_compared(const prom_session *session, size_t feature_floats,
                                  bool counted)
{
    size_t pixels = (size_t)session->camera.width * session->camera.height;
    prom_compared picture = {.rgba = prom_alloc(pixels, 4),
                             .features = prom_alloc(feature_floats, sizeof(float))};
    if (counted) picture.px = prom_alloc(session->model.tree_count, sizeof *picture.px);
    return picture;
}

static void finish_compared(prom_compared *picture)
{
    prom_free(picture->rgba);
    prom_free(picture->features);
    prom_free(picture->px);
}

// Of one of the metrics; all cores work on it.
static prom_metric *new_metric(const char *name, double ppd, uint32_t width, uint32_t height,
                               size_t *feature_floats)
{
    uint32_t side = width > height ? width : height;
    prom_metric *metric = prom_metric_create(name, ppd, side, (size_t)width * height, 0);
    size_t floats = prom_metric_feature_floats(metric, width, height);
    if (floats > *feature_floats) *feature_floats = floats;
    return metric;
}

prom_status prom_comparison_init(prom_comparison *comparison, const prom_session *session,
                                 unsigned wanted, double ppd, prom_error *error)
{
    uint32_t width = session->camera.width, height = session->camera.height;
    size_t pixels = (size_t)width * height, feature_floats = 0;
    bool quality = wanted & PROM_COMPARE_QUALITY;
    prom_comparison *c = comparison;
    *c = (prom_comparison){0};
    c->full = prom_selector_create("full", &session->model, error);
    if (!c->full) return error->status;
    c->target = prom_target_create(width, height, quality, error);
    if (!c->target) return error->status;
    if (wanted & PROM_COMPARE_ACCURACY)
        c->edge_blur = new_metric("edge-blur", ppd, width, height, &feature_floats);
    if (quality) c->flip = new_metric("flip", ppd, width, height, &feature_floats);
    c->truth = new_compared(session, feature_floats, quality);
    c->shown = new_compared(session, feature_floats, quality);
    c->errors = prom_alloc(pixels, sizeof *c->errors);
    if (!quality) return PROM_OK;
    c->ids = prom_alloc(pixels, sizeof *c->ids);
    c->node_accuracy = prom_alloc(session->model.tree_count, sizeof *c->node_accuracy);
    return PROM_OK;
}

void prom_comparison_finish(prom_comparison *comparison)
{
    prom_selector_destroy(comparison->full);
    prom_cut_finish(&comparison->cut);
    if (comparison->target) prom_target_destroy(comparison->target);
    finish_compared(&comparison->truth);
    finish_compared(&comparison->shown);
    prom_metric_destroy(comparison->edge_blur);
    prom_metric_destroy(comparison->flip);
    prom_free(comparison->errors);
    prom_free(comparison->ids);
    prom_free(comparison->node_accuracy);
    *comparison = (prom_comparison){0};
}

static void look(const prom_comparison *c, prom_session *session, const prom_camera *camera,
                 const prom_cut *cut, bool counted, prom_compared *picture)
{
    if (counted) {
        prom_picture_draw_counted(session, c->target, camera, cut, picture->rgba, picture->px,
                                  c->ids);
        return;
    }
    prom_picture_draw(session, c->target, camera, cut, PROM_IDS_NONE);
    prom_target_read_rgba(c->target, 0, 0, camera->width, camera->height, picture->rgba);
}

static double holes_share(const uint8_t *truth, const uint8_t *shown, size_t pixels)
{
    size_t covered = 0, missing = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (truth[4 * i + 3] < COVERED) continue;
        covered++;
        missing += shown[4 * i + 3] < COVERED;
    }
    return covered ? (double)missing / (double)covered : 0;
}

// Mean over the frame.
static double error_of(const prom_comparison *c, prom_metric *metric, const prom_camera *camera)
{
    uint32_t width = camera->width, height = camera->height;
    size_t pixels = (size_t)width * height;
    prom_picture picture = {.width = width, .height = height, .channels = 4};
    const prom_compared *both[] = {&c->truth, &c->shown};
    for (int i = 0; i < 2; i++) {
        picture.pixels = both[i]->rgba;
        prom_metric_features(metric, &picture, both[i]->features);
    }
    prom_metric_compare(metric, c->truth.features, c->shown.features, width, height, c->errors);
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) sum += c->errors[i];
    return sum / (double)pixels;
}

static void add_quality(const prom_comparison *c, const prom_model *model,
                        const prom_camera *camera, const prom_cut *cut,
                        prom_difference *difference)
{
    prom_hidden_share hidden = prom_hidden_share_of(cut, c->shown.px);
    difference->flip = error_of(c, c->flip, camera);
    difference->loss = prom_loss_share(model, cut, c->truth.px, c->node_accuracy);
    difference->hidden_cost = hidden.cost;
    difference->hidden_nodes = hidden.nodes;
}

prom_difference prom_comparison_run(prom_comparison *comparison, prom_session *session,
                                    const prom_camera *camera, const prom_cut *cut,
                                    unsigned wanted)
{
    prom_comparison *c = comparison;
    bool quality = wanted & PROM_COMPARE_QUALITY;
    prom_difference difference = {.found = wanted};
    prom_session_select(session, c->full, NULL, camera, INFINITY, 1, &c->cut);
    if (quality) look(c, session, camera, cut, true, &c->shown); // for the pixels of its nodes
    prom_target_read_rgba(session->target, 0, 0, camera->width, camera->height, c->shown.rgba);
    look(c, session, camera, &c->cut, quality, &c->truth);
    if (wanted & PROM_COMPARE_HOLES)
        difference.holes =
            holes_share(c->truth.rgba, c->shown.rgba, (size_t)camera->width * camera->height);
    if (wanted & PROM_COMPARE_ACCURACY)
        difference.accuracy = 1 - error_of(c, c->edge_blur, camera);
    if (quality) add_quality(c, &session->model, camera, cut, &difference);
    return difference;
}
