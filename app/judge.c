#include "app/judge.h"

#include "app/counted_picture.h"

#include <math.h>

prom_status prom_judge_init(prom_judge *judge, prom_session *session, prom_error *error)
{
    uint32_t width = session->camera.width, height = session->camera.height;
    prom_judge *j = judge;
    *j = (prom_judge){.session = session, .pixels = (size_t)width * height};
    j->full = prom_selector_create("full", &session->model, error);
    if (!j->full) return error->status;
    j->target = prom_target_create(width, height, true, error);
    if (!j->target) return error->status;
    uint32_t side = width > height ? width : height;
    j->metric = prom_metric_create("flip", prom_session_ppd(session), side, j->pixels, 0);
    size_t floats = prom_metric_feature_floats(j->metric, width, height);
    j->truth = prom_alloc(floats, sizeof *j->truth);
    j->shown = prom_alloc(floats, sizeof *j->shown);
    j->map = prom_alloc(j->pixels, sizeof *j->map);
    j->rgba = prom_alloc(j->pixels, 4);
    j->ids = prom_alloc(j->pixels, sizeof *j->ids);
    j->px = prom_alloc(session->model.tree_count, sizeof *j->px);
    return PROM_OK;
}

void prom_judge_finish(prom_judge *judge)
{
    prom_selector_destroy(judge->full);
    if (judge->target) prom_target_destroy(judge->target);
    prom_metric_destroy(judge->metric);
    prom_cut_finish(&judge->cut);
    prom_free(judge->px);
    prom_free(judge->truth);
    prom_free(judge->shown);
    prom_free(judge->map);
    prom_free(judge->rgba);
    prom_free(judge->ids);
    *judge = (prom_judge){0};
}

// Of the picture in j->rgba.
static void find_features(prom_judge *j, float *features)
{
    const prom_picture picture = {
        .width = j->camera.width, .height = j->camera.height, .channels = 4, .pixels = j->rgba};
    prom_metric_features(j->metric, &picture, features);
}

void prom_judge_look(prom_judge *judge, const prom_camera *camera)
{
    prom_judge *j = judge;
    const prom_model *m = &j->session->model;
    j->camera = *camera;
    prom_session_select(j->session, j->full, NULL, camera, INFINITY, 1, &j->cut);
    prom_picture_draw_counted(j->session, j->target, camera, &j->cut, j->rgba, j->px, j->ids);
    for (uint32_t n = m->tree_count; n-- > 1;) j->px[m->parent[n]] += j->px[n];
    find_features(j, j->truth);
}

// Of the picture in the target with full detail's.
static double compare(prom_judge *j)
{
    uint32_t width = j->camera.width, height = j->camera.height;
    prom_target_read_rgba(j->target, 0, 0, width, height, j->rgba);
    find_features(j, j->shown);
    prom_metric_compare(j->metric, j->truth, j->shown, width, height, j->map);
    double sum = 0;
    for (size_t i = 0; i < j->pixels; i++) sum += (double)j->map[i];
    return sum;
}

double prom_judge_run(prom_judge *judge, const prom_cut *cut)
{
    prom_picture_draw(judge->session, judge->target, &judge->camera, cut, PROM_IDS_NONE);
    return compare(judge);
}

double prom_judge_nodes(prom_judge *judge, const prom_cut *cut, double *error)
{
    prom_judge *j = judge;
    uint32_t tree_count = j->session->model.tree_count;
    prom_picture_draw(j->session, j->target, &j->camera, cut, PROM_IDS_OPAQUE);
    double sum = compare(j);
    prom_target_read_ids(j->target, 0, 0, j->camera.width, j->camera.height, j->ids);
    memset(error, 0, tree_count * sizeof *error);
    for (size_t i = 0; i < j->pixels; i++)
        if (j->ids[i] < tree_count) error[j->ids[i]] += (double)j->map[i];
    return sum;
}
