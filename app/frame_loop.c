#include "app/frame_loop.h"

#include "app/comparison.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"

#include <stdio.h>

typedef struct loop {
    prom_frame_step step;
    const prom_loop_options *options;
    prom_comparison comparison;
} loop;

static double memory_mb(void)
{
    uint64_t mapped, resident;
    prom_memory_use(&mapped, &resident);
    return (double)resident / (1 << 20);
}

static double path_step_s(const prom_path *path)
{
    size_t keys = path->keys.count;
    if (keys < 2) return 1.0 / PROM_PATH_RATE;
    return (path->keys.data[keys - 1].t - path->keys.data[0].t) / (double)(keys - 1);
}

static prom_frame_record draw_frame(loop *l, uint64_t pose)
{
    prom_session *s = l->step.session;
    prom_camera camera = s->camera;
    double start = prom_clock_ms();
    prom_path_pose(&s->path, pose, &camera);
    prom_frame_record record = prom_frame_step_draw(&l->step, &camera, start);
    record.t_s = l->step.dt_s * (double)pose;
    return record;
}

// The least budget from which the governor leaves `needed_ms` for the cut; it is monotone.
static double budget_for(const prom_governor *governor, double needed_ms)
{
    double low = 0, high = 1;
    while (high < 1e9 && prom_governor_budget(governor, high) < needed_ms) high *= 2;
    for (int i = 0; i < 40; i++) {
        double middle = (low + high) / 2;
        if (prom_governor_budget(governor, middle) < needed_ms)
            low = middle;
        else
            high = middle;
    }
    return high;
}

static void note_infeasible(const loop *l, prom_loop_result *result)
{
    result->infeasible_frames++;
    double needed = budget_for(&l->step.governor, l->step.cut.cmin_ms);
    if (needed > result->least_budget_ms) result->least_budget_ms = needed;
}

static prom_status keep_picture(loop *l, uint32_t frame, const char *suffix, prom_error *error)
{
    char *path = prom_format("%s/frame-%05u%s.png", l->options->keep_folder, frame, suffix);
    prom_status status = prom_session_write_png(l->step.session, path, error);
    prom_free(path);
    return status;
}

// The picture that the target holds, and the same cut again in false colours.
static prom_status keep_pictures(loop *l, uint32_t frame, const prom_camera *camera,
                                 prom_error *error)
{
    prom_frame_options tinted = {.output = PROM_OUTPUT_TINT};
    prom_status status = keep_picture(l, frame, "", error);
    if (status || !l->options->keep_colours) return status;
    prom_session_draw(l->step.session, &l->step.cut, camera, &tinted);
    return keep_picture(l, frame, "-colours", error);
}

// Whether frame i is one of `wanted` evenly spaced ones out of `frames`.
static bool is_spaced(uint32_t i, uint32_t wanted, uint32_t frames)
{
    uint64_t before = (uint64_t)i * wanted / frames;
    uint64_t after = (uint64_t)(i + 1) * wanted / frames;
    return after > before;
}

// What frame i is to be compared for.
static unsigned wanted_of(const prom_loop_options *o, uint32_t i)
{
    unsigned wanted = 0;
    if (is_spaced(i, o->check_holes, o->frames)) wanted |= PROM_COMPARE_HOLES;
    if (is_spaced(i, o->check_accuracy, o->frames)) wanted |= PROM_COMPARE_ACCURACY;
    if (is_spaced(i, o->quality_frames, o->frames)) wanted |= PROM_COMPARE_QUALITY;
    return wanted;
}

// Pictures and comparisons after a frame. They disturb the caches, and `full` the device's
// memory: the cut is drawn again, untimed and uncounted.
static prom_status between_frames(loop *l, uint32_t i, prom_frame_record *record,
                                  prom_error *error)
{
    const prom_loop_options *o = l->options;
    bool keep = o->keep_folder && i % o->keep_every == 0;
    unsigned wanted = wanted_of(o, i);
    if (!keep && !wanted) return PROM_OK;
    prom_camera camera = l->step.session->camera;
    prom_path_pose(&l->step.session->path, i, &camera);
    if (keep) {
        prom_status status = keep_pictures(l, i, &camera, error);
        if (status) return status;
    }
    if (wanted)
        record->difference =
            prom_comparison_run(&l->comparison, l->step.session, &camera, &l->step.cut, wanted);
    prom_session_draw(l->step.session, &l->step.cut, &camera, &(prom_frame_options){0});
    prom_renderer_take_stats(l->step.session->renderer);
    return PROM_OK;
}

static void warm_up(loop *l)
{
    // Towards the start, so that the first recorded frame follows its neighbour.
    for (uint32_t i = l->options->warmup; i > 0; i--) {
        prom_frame_record record = draw_frame(l, i);
        prom_frame_step_feed(&l->step, &record);
    }
}

static prom_status walk(loop *l, prom_loop_result *result, prom_error *error)
{
    const prom_loop_options *o = l->options;
    prom_array_reserve(&result->frames, o->frames);
    warm_up(l);
    result->memory_start_mb = memory_mb();
    prom_progress progress;
    prom_progress_begin(&progress, "frames", o->frames);
    prom_status status = PROM_OK;
    for (uint32_t i = 0; i < o->frames && !status; i++) {
        prom_frame_record record = draw_frame(l, i);
        if (!record.feasible) note_infeasible(l, result);
        prom_frame_step_feed(&l->step, &record);
        status = between_frames(l, i, &record, error);
        prom_array_push(&result->frames, record);
        prom_progress_step(&progress, 1);
    }
    prom_progress_end(&progress);
    result->memory_end_mb = memory_mb();
    return status;
}

static prom_status open_comparison(loop *l, prom_error *error)
{
    unsigned wanted = 0;
    for (uint32_t i = 0; i < l->options->frames; i++) wanted |= wanted_of(l->options, i);
    if (!wanted) return PROM_OK;
    prom_session *s = l->step.session;
    return prom_comparison_init(&l->comparison, s, wanted, prom_session_ppd(s), error);
}

prom_status prom_frame_loop_run(prom_session *session, const prom_loop_options *options,
                                prom_loop_result *result, prom_error *error)
{
    loop l = {.options = options};
    prom_status status =
        prom_frame_step_init(&l.step, session, options->selector, options->budget_ms,
                             options->rule_scale, error);
    if (status) return status;
    l.step.dt_s = path_step_s(&session->path);
    status = open_comparison(&l, error);
    if (!status) status = walk(&l, result, error);
    prom_comparison_finish(&l.comparison);
    prom_frame_step_finish(&l.step);
    return status;
}

void prom_loop_result_finish(prom_loop_result *result)
{
    prom_array_finish(&result->frames);
}
