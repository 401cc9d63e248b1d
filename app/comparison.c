#include "app/comparison.h"

#include "benefit/metric.h"

#include <math.h>

#define COVERED 128 // alpha: the tree gives 1, the clear and the background layer 0

prom_status prom_comparison_init(prom_comparison *comparison, const prom_session *session,
                                 bool with_accuracy, prom_error *error)
{
    uint32_t width = session->camera.width, height = session->camera.height;
    size_t pixels = (size_t)width * height;
    prom_comparison *c = comparison;
    *c = (prom_comparison){0};
    c->full = prom_selector_create("full", &session->model, error);
    if (!c->full) return error->status;
    c->truth = prom_alloc(pixels, 4);
    c->shown = prom_alloc(pixels, 4);
    if (!with_accuracy) return PROM_OK;
    c->grey = prom_alloc(pixels, sizeof *c->grey);
    c->truth_features = prom_alloc(pixels, 2 * sizeof *c->truth_features);
    c->shown_features = prom_alloc(pixels, 2 * sizeof *c->shown_features);
    c->scratch = prom_alloc(prom_edge_blur_scratch(width, height), sizeof *c->scratch);
    return PROM_OK;
}

void prom_comparison_finish(prom_comparison *comparison)
{
    prom_selector_destroy(comparison->full);
    prom_cut_finish(&comparison->cut);
    prom_free(comparison->truth);
    prom_free(comparison->shown);
    prom_free(comparison->grey);
    prom_free(comparison->truth_features);
    prom_free(comparison->shown_features);
    prom_free(comparison->scratch);
    *comparison = (prom_comparison){0};
}

static void draw(prom_session *session, const prom_camera *camera, const prom_cut *cut,
                 uint8_t *rgba)
{
    prom_frame_options options = {0};
    prom_session_draw(session, cut, camera, &options);
    prom_target_read_rgba(session->target, 0, 0, camera->width, camera->height, rgba);
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

static void features_of(prom_comparison *c, const uint8_t *rgba, uint32_t width,
                        uint32_t height, float *features)
{
    prom_metric_grey(rgba, (size_t)width * height, c->grey);
    prom_edge_blur_features(c->grey, width, height, features, c->scratch);
}

static double accuracy_of(prom_comparison *c, uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height;
    features_of(c, c->truth, width, height, c->truth_features);
    features_of(c, c->shown, width, height, c->shown_features);
    prom_edge_blur_error(c->truth_features, c->shown_features, width, height, c->grey);
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) sum += c->grey[i];
    return 1 - sum / (double)pixels;
}

prom_difference prom_comparison_run(prom_comparison *comparison, prom_session *session,
                                    const prom_camera *camera, const prom_cut *cut)
{
    prom_comparison *c = comparison;
    prom_session_select(session, c->full, camera, INFINITY, 1, &c->cut);
    draw(session, camera, cut, c->shown);
    draw(session, camera, &c->cut, c->truth);
    prom_difference difference = {
        .holes = holes_share(c->truth, c->shown, (size_t)camera->width * camera->height)};
    if (c->grey) difference.accuracy = accuracy_of(c, camera->width, camera->height);
    return difference;
}
