#include "app/popping.h"

#include "app/counted_picture.h"
#include "app/warp.h"

#include <math.h>

static void frame_init(prom_popping_frame *frame, size_t pixels)
{
    frame->full = prom_alloc(pixels, 4);
    frame->shown = prom_alloc(pixels, 4);
    frame->depth = prom_alloc(pixels, sizeof *frame->depth);
}

static void frame_finish(prom_popping_frame *frame)
{
    prom_free(frame->full);
    prom_free(frame->shown);
    prom_free(frame->depth);
}

prom_status prom_popping_init(prom_popping *popping, const prom_session *session, double ppd,
                              prom_error *error)
{
    uint32_t width = session->camera.width, height = session->camera.height;
    size_t pixels = (size_t)width * height;
    prom_popping *p = popping;
    *p = (prom_popping){0};
    p->select_full = prom_selector_create("full", &session->model, error);
    if (!p->select_full) return error->status;
    p->target = prom_target_create(width, height, false, error);
    if (!p->target) return error->status;
    p->metric = prom_metric_create("flip", ppd, width > height ? width : height, pixels, 0);
    size_t floats = prom_metric_feature_floats(p->metric, width, height);
    for (int i = 0; i < 2; i++) p->features[i] = prom_alloc(floats, sizeof(float));
    frame_init(&p->before, pixels);
    frame_init(&p->now, pixels);
    p->from = prom_alloc(pixels, sizeof *p->from);
    p->warped = prom_alloc(pixels, sizeof *p->warped);
    p->errors = prom_alloc(pixels, sizeof *p->errors);
    return PROM_OK;
}

void prom_popping_finish(prom_popping *popping)
{
    prom_selector_destroy(popping->select_full);
    prom_cut_finish(&popping->full);
    if (popping->target) prom_target_destroy(popping->target);
    prom_metric_destroy(popping->metric);
    for (int i = 0; i < 2; i++) prom_free(popping->features[i]);
    frame_finish(&popping->before);
    frame_finish(&popping->now);
    prom_free(popping->from);
    prom_free(popping->warped);
    prom_free(popping->errors);
    *popping = (prom_popping){0};
}

static void draw(const prom_popping *p, prom_session *session, const prom_camera *camera,
                 const prom_cut *cut, uint8_t *rgba)
{
    prom_picture_draw(session, p->target, camera, cut, PROM_IDS_NONE);
    prom_target_read_rgba(p->target, 0, 0, camera->width, camera->height, rgba);
}

// The background layer's depths as if it were of the tree; these have no depth so small.
static void bring_background_near(float *depth, size_t pixels)
{
    const float shift = 0x1p-40f; // see prom_target_read_depth
    for (size_t i = 0; i < pixels; i++)
        if (depth[i] <= shift) depth[i] /= shift;
}

// Full detail last, so that the target holds its depth.
static void look(prom_popping *p, prom_session *session, const prom_camera *camera,
                 const prom_cut *cut, prom_popping_frame *frame)
{
    prom_session_select(session, p->select_full, NULL, camera, INFINITY, 1, &p->full);
    draw(p, session, camera, cut, frame->shown);
    draw(p, session, camera, &p->full, frame->full);
    prom_target_read_depth(p->target, 0, 0, camera->width, camera->height, frame->depth);
    bring_background_near(frame->depth, (size_t)camera->width * camera->height);
}

// Mean error over the pixels with a place; the others are equal, but their neighbours' errors
// reach into them.
static double error_of(prom_popping *p, const prom_camera *camera, const uint8_t *before,
                       const uint8_t *now, size_t valid)
{
    uint32_t width = camera->width, height = camera->height;
    prom_warp_apply(p->from, width, height, before, now, p->warped);
    const prom_picture pictures[2] = {
        {.width = width, .height = height, .channels = 3, .floats = true, .pixels = p->warped},
        {.width = width, .height = height, .channels = 4, .pixels = now}};
    for (int i = 0; i < 2; i++) prom_metric_features(p->metric, &pictures[i], p->features[i]);
    prom_metric_compare(p->metric, p->features[0], p->features[1], width, height, p->errors);
    double sum = 0;
    size_t pixels = (size_t)width * height;
    for (size_t i = 0; i < pixels; i++)
        if (!isnan(p->from[i][0])) sum += (double)p->errors[i];
    return valid ? sum / (double)valid : 0;
}

prom_popped prom_popping_look(prom_popping *popping, prom_session *session,
                              const prom_cut *cut_before, const prom_camera *camera_before,
                              const prom_cut *cut, const prom_camera *camera)
{
    prom_popping *p = popping;
    look(p, session, camera_before, cut_before, &p->before);
    look(p, session, camera, cut, &p->now);
    size_t valid = prom_warp_find(&(prom_warp_view){*camera_before, p->before.depth},
                                  &(prom_warp_view){*camera, p->now.depth}, p->from);
    double floor = error_of(p, camera, p->before.full, p->now.full, valid);
    double flip = error_of(p, camera, p->before.shown, p->now.shown, valid);
    size_t pixels = (size_t)camera->width * camera->height;
    return (prom_popped){flip, floor, (double)valid / (double)pixels};
}
