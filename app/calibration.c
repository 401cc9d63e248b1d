#include "app/calibration.h"

#include "metaobj/base/log.h"
#include "render/calibrate.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

// The prediction's own mean error on walks through real scenes (measured: 3 to 12 %).
#define WALK_ERROR 0.08
// A disturbed calibration must not waste half of each frame, nor a lucky one promise too much.
#define LEAST_MARGIN 0.15
#define MOST_MARGIN 0.30

// The part of the budget to keep back so that the slow frames of a picture predicted at the
// rest still fit.
static double margin_for(double noise)
{
    double margin = 1.0 - 1.0 / ((1.0 + noise) * (1.0 + WALK_ERROR));
    return fmin(fmax(margin, LEAST_MARGIN), MOST_MARGIN);
}

prom_status prom_calibration_run(prom_context *context, prom_renderer *renderer,
                                 const uint32_t size_px[2], int effort, prom_cost_model *model,
                                 prom_cost_samples *samples, bool *queries, prom_error *error)
{
    prom_cost_samples own = {0};
    prom_cost_samples *all = samples ? samples : &own;
    prom_timer *timer = prom_timer_create(renderer);
    if (queries) *queries = prom_timer_uses_queries(timer);
    double noise = 0;
    prom_status status =
        prom_calibrate_run(renderer, timer, size_px[0], size_px[1], effort, all, &noise, error);
    if (!status) status = prom_cost_fit(all->data, all->count, model, error);
    if (!status) {
        model->margin = margin_for(noise);
        model->width = size_px[0];
        model->height = size_px[1];
        snprintf(model->renderer, sizeof model->renderer, "%s", prom_context_renderer(context));
    }
    prom_timer_destroy(timer);
    prom_array_finish(&own);
    return status;
}

static prom_status load_profile(const char *profile, const char *renderer,
                                const uint32_t size_px[2], prom_cost_model *model,
                                prom_error *error)
{
    prom_status status = prom_cost_load(profile, model, error);
    if (status) return status;
    if (model->width && (model->width != size_px[0] || model->height != size_px[1]))
        prom_log(PROM_LOG_WARNING, "%s: was measured at %ux%u, this is %ux%u; times may be off",
                 profile, model->width, model->height, size_px[0], size_px[1]);
    if (!prom_cost_is_of(model, renderer))
        prom_log(PROM_LOG_WARNING, "%s: was measured on `%s`, this is `%s`; times may be off",
                 profile, model->renderer, renderer);
    return PROM_OK;
}

static bool load_cached(const char *path, const char *renderer, prom_cost_model *model)
{
    if (!path || access(path, F_OK) != 0) return false;
    prom_error error = {0};
    if (prom_cost_load(path, model, &error) == PROM_OK && prom_cost_is_of(model, renderer))
        return true;
    if (error.status) prom_log(PROM_LOG_WARNING, "%s; measuring the device again", error.text);
    return false;
}

static prom_status measure_and_keep(prom_context *context, prom_renderer *renderer,
                                    const uint32_t size_px[2], const char *path,
                                    prom_cost_model *model, prom_error *error)
{
    prom_log(PROM_LOG_INFO, "no cost profile yet for %s at %ux%u: measuring the device once",
             prom_context_renderer(context), size_px[0], size_px[1]);
    prom_status status =
        prom_calibration_run(context, renderer, size_px, 1, model, NULL, NULL, error);
    if (status) return status;
    prom_error unkept = {0};
    if (!path)
        prom_log(PROM_LOG_INFO, "there is no home folder to keep the profile in");
    else if (prom_cost_save(model, path, &unkept))
        prom_log(PROM_LOG_WARNING, "%s", unkept.text);
    else
        prom_log(PROM_LOG_INFO, "kept in %s", path);
    return PROM_OK;
}

prom_status prom_calibration_get(prom_context *context, prom_renderer *renderer,
                                 const char *profile, const uint32_t size_px[2], bool measure,
                                 prom_cost_model *model, prom_error *error)
{
    const char *name = prom_context_renderer(context);
    if (profile) return load_profile(profile, name, size_px, model, error);
    char *path = prom_cost_cache_path(name, size_px[0], size_px[1]);
    prom_status status = PROM_OK;
    if (!load_cached(path, name, model)) {
        *model = (prom_cost_model){0};
        if (measure) status = measure_and_keep(context, renderer, size_px, path, model, error);
    }
    prom_free(path);
    return status;
}
