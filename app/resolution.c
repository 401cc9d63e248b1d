#include "app/resolution.h"

#include "app/scaling_loss.h"

#include "metaobj/base/log.h"

#include <string.h>

static void drop_targets(prom_resolution *r)
{
    for (unsigned i = 1; i < PROM_SCALES; i++)
        if (r->targets[i]) prom_target_destroy(r->targets[i]);
    memset(r->targets, 0, sizeof r->targets);
}

static prom_status make_targets(prom_resolution *r, prom_error *error)
{
    const prom_camera *camera = &r->session->camera;
    bool with_ids = r->session->visibility & PROM_SEE_FRAME;
    drop_targets(r);
    r->size_px[0] = camera->width;
    r->size_px[1] = camera->height;
    for (unsigned i = 1; i < r->scaling.count; i++) {
        uint32_t size_px[2];
        prom_scaled_size(r->size_px, r->scaling.scales[i].factor, size_px);
        r->targets[i] = prom_target_create(size_px[0], size_px[1], with_ids, error);
        if (!r->targets[i]) return error->status;
    }
    return PROM_OK;
}

// The window may have another size than before.
static void follow_size(prom_resolution *r)
{
    const prom_camera *camera = &r->session->camera;
    prom_error error = {0};
    if (r->scaling.count == 1) return;
    if (camera->width == r->size_px[0] && camera->height == r->size_px[1]) return;
    if (!make_targets(r, &error)) return;
    prom_log(PROM_LOG_WARNING, "the resolution stays: %s", error.text);
    prom_scaling_init(&r->scaling, 1);
}

prom_status prom_resolution_init(prom_resolution *resolution, prom_session *session,
                                 const char *selector, const prom_camera *camera,
                                 prom_error *error)
{
    bool budgeted = prom_selector_class_named(selector)->budgeted;
    prom_resolution *r = resolution;
    *r = (prom_resolution){.session = session};
    prom_scaling_init(&r->scaling, budgeted ? session->min_scale : 1);
    if (r->scaling.count == 1) return PROM_OK;
    r->trial = prom_selector_create(selector, &session->model, error);
    prom_status status = r->trial ? make_targets(r, error) : error->status;
    if (!status)
        status = prom_scaling_loss_measure(session, r->targets, &r->scaling, camera, error);
    if (status) prom_resolution_finish(r);
    return status;
}

void prom_resolution_finish(prom_resolution *resolution)
{
    drop_targets(resolution);
    prom_selector_destroy(resolution->trial);
    prom_cut_finish(&resolution->trial_cut);
    *resolution = (prom_resolution){0};
}

static void select_at(const prom_resolution *r, unsigned i, prom_selector *selector,
                      const prom_selection *selection, prom_cut *cut)
{
    prom_selection scaled = *selection;
    prom_cost_model cost = prom_cost_at_scale(selection->cost, r->scaling.scales[i].factor,
                                              (double)r->size_px[0] * r->size_px[1]);
    scaled.cost = &cost;
    prom_selector_run(selector, &scaled, cut);
}

static void swap_cuts(prom_cut *a, prom_cut *b)
{
    prom_cut cut = *a;
    *a = *b;
    *b = cut;
}

void prom_resolution_select(prom_resolution *resolution, prom_selector *selector,
                            const prom_selection *selection, prom_cut *cut)
{
    prom_resolution *r = resolution;
    follow_size(r);
    select_at(r, r->scaling.at, selector, selection, cut);
    unsigned tried;
    do {
        tried = r->scaling.count > 1 ? prom_scaling_try(&r->scaling, cut) : r->scaling.at;
        if (tried == r->scaling.at) break;
        select_at(r, tried, r->trial, selection, &r->trial_cut);
        if (!prom_scaling_decide(&r->scaling, tried, cut, &r->trial_cut)) break;
        swap_cuts(cut, &r->trial_cut);
    } while (!cut->feasible);
}

void prom_resolution_select_best(prom_resolution *resolution, prom_selector *selector,
                                 const prom_selection *selection, prom_cut *cut)
{
    prom_resolution *r = resolution;
    r->scaling.at = 0;
    select_at(r, 0, selector, selection, cut);
    double least = prom_scaling_loss(&r->scaling, 0, cut);
    for (unsigned i = 1; i < r->scaling.count; i++) {
        select_at(r, i, r->trial, selection, &r->trial_cut);
        double loss = prom_scaling_loss(&r->scaling, i, &r->trial_cut);
        if (!(loss < least)) continue;
        least = loss;
        r->scaling.at = i;
        swap_cuts(cut, &r->trial_cut);
    }
}

void prom_resolution_draw(prom_resolution *resolution, prom_sight *sight, const prom_cut *cut,
                          const prom_camera *camera, const prom_frame_options *options)
{
    prom_resolution *r = resolution;
    prom_session *s = r->session;
    unsigned at = r->scaling.at;
    if (!at) {
        prom_sight_draw(sight, cut, camera, options);
        return;
    }
    prom_frame_options scaled = *options;
    prom_scaled_size(r->size_px, prom_resolution_scale(r), scaled.size_px);
    prom_target *whole = s->target;
    s->target = r->targets[at];
    prom_sight_draw(sight, cut, camera, &scaled);
    s->target = whole;
    prom_target_copy_colors(whole, r->targets[at]);
    prom_renderer_finish(s->renderer);
}

double prom_resolution_scale(const prom_resolution *resolution)
{
    return resolution->scaling.scales[resolution->scaling.at].factor;
}
