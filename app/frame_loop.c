#include "app/frame_loop.h"

#include "app/comparison.h"
#include "app/cut_change.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"

#include <math.h>
#include <stdio.h>
#include <time.h>

// From one frame to the next. By taste: faster than a walk that anyone would follow.
#define FAST_TURN (M_PI / 6)
#define JUMP_STEPS 10.0  // of the path's mean step
#define JUMP_RADIUS 0.01 // and of the scene's radius

typedef struct loop {
    prom_frame_step step;
    const prom_loop_options *options;
    prom_comparison comparison;
    prom_popping popping;
    prom_cut cut_before; // of the frame before, where popping is looked for
    prom_camera camera_before;
    prom_loop_result *result;
    double jump; // a longer way from one frame to the next is one
} loop;

static double memory_mb(void)
{
    uint64_t mapped, resident;
    prom_memory_use(&mapped, &resident);
    return (double)resident / (1 << 20);
}

// Of prom_clock_ms' start, so that frames can be laid beside what else went on.
static double clock_start_unix_s(void)
{
    struct timespec now;
    clock_gettime(CLOCK_REALTIME, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec - prom_clock_ms() / 1000.0;
}

static double distance(const double a[3], const double b[3])
{
    return sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
}

static double jump_of(const prom_session *session)
{
    const prom_path_key *keys = session->path.keys.data;
    size_t steps = session->path.keys.count - 1;
    double way = 0;
    for (size_t i = 0; i < steps; i++) way += distance(keys[i].position, keys[i + 1].position);
    double least = JUMP_RADIUS * (double)session->model.radius[0];
    return fmax(steps ? JUMP_STEPS * way / (double)steps : 0, least);
}

// Whether the next view has little to do with the last one.
static bool is_fast_turn(const loop *l, const prom_camera *before, const prom_camera *now)
{
    double cosine = 0; // of half the angle
    for (int i = 0; i < 4; i++)
        cosine += (double)before->orientation[i] * (double)now->orientation[i];
    return fabs(cosine) < cos(FAST_TURN / 2) || distance(before->eye, now->eye) > l->jump;
}

static prom_frame_record draw_frame(loop *l, uint64_t pose)
{
    prom_session *s = l->step.session;
    prom_camera camera = s->camera;
    prom_camera before = l->step.view.camera;
    bool first = !l->step.last.number;
    double start = prom_clock_ms();
    prom_path_pose(&s->path, pose, &camera);
    prom_frame_record record = prom_frame_step_draw(&l->step, &camera, start);
    record.t_s = l->step.dt_s * (double)pose;
    record.turned = !first && is_fast_turn(l, &before, &camera);
    if (l->result->cold.count < PROM_COLD_FRAMES) prom_array_push(&l->result->cold, record);
    return record;
}

static void note_infeasible(const loop *l)
{
    prom_loop_result *result = l->result;
    result->infeasible_frames++;
    double needed = prom_guarantee_least_budget(&l->step.guarantee, l->step.cut.cmin_ms);
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

// How many of `wanted` things, spaced evenly over `frames`, fall on frame i.
static uint32_t spaced_at(uint32_t i, uint32_t wanted, uint32_t frames)
{
    uint64_t before = (uint64_t)i * wanted / frames;
    uint64_t after = (uint64_t)(i + 1) * wanted / frames;
    return (uint32_t)(after - before);
}

// What frame i is to be compared for.
static unsigned wanted_of(const prom_loop_options *o, uint32_t i)
{
    unsigned wanted = 0;
    if (spaced_at(i, o->check_holes, o->frames)) wanted |= PROM_COMPARE_HOLES;
    if (spaced_at(i, o->check_accuracy, o->frames)) wanted |= PROM_COMPARE_ACCURACY;
    if (spaced_at(i, o->quality_frames, o->frames)) wanted |= PROM_COMPARE_QUALITY;
    return wanted;
}

// Before frame i is drawn; the first of all has none before it.
static void keep_before(loop *l, uint32_t i)
{
    l->camera_before.width = 0;
    if (!spaced_at(i, l->options->popping_frames, l->options->frames)) return;
    if (!l->step.last.number) return;
    prom_cut_copy(&l->step.cut, &l->cut_before);
    l->camera_before = l->step.view.camera;
}

// Pictures and comparisons after a frame. They disturb the caches, and `full` the device's
// memory: the cut is drawn again, untimed and uncounted.
static prom_status between_frames(loop *l, uint32_t i, prom_frame_record *record,
                                  prom_error *error)
{
    const prom_loop_options *o = l->options;
    bool keep = o->keep_folder && i % o->keep_every == 0;
    unsigned wanted = wanted_of(o, i);
    bool popping = l->camera_before.width;
    if (!keep && !wanted && !popping) return PROM_OK;
    prom_camera camera = l->step.session->camera;
    prom_path_pose(&l->step.session->path, i, &camera);
    if (wanted)
        record->difference =
            prom_comparison_run(&l->comparison, l->step.session, &camera, &l->step.cut, wanted);
    if (keep) {
        prom_status status = keep_pictures(l, i, &camera, error);
        if (status) return status;
    }
    if (popping)
        record->popped = prom_popping_look(&l->popping, l->step.session, &l->cut_before,
                                           &l->camera_before, &l->step.cut, &camera);
    prom_session_draw(l->step.session, &l->step.cut, &camera, &(prom_frame_options){0});
    prom_renderer_take_stats(l->step.session->renderer);
    return PROM_OK;
}

static void warm_up(loop *l)
{
    prom_camera camera = l->step.session->camera;
    prom_path_pose(&l->step.session->path, l->options->warmup, &camera);
    prom_frame_step_warm(&l->step, &camera);
    // Towards the start, so that the first recorded frame follows its neighbour.
    for (uint32_t i = l->options->warmup; i > 0; i--) {
        prom_frame_record record = draw_frame(l, i);
        prom_frame_step_feed(&l->step, &record);
    }
}

static void draw_floor(loop *l, uint32_t i)
{
    uint32_t repeats = spaced_at(i, l->options->noise_floor, l->options->frames);
    while (repeats--) prom_noise_floor_draw(&l->result->floor, l->step.session);
}

static prom_status walk(loop *l, prom_error *error)
{
    const prom_loop_options *o = l->options;
    prom_loop_result *result = l->result;
    prom_array_reserve(&result->frames, o->frames);
    prom_array_reserve(&result->cold, PROM_COLD_FRAMES);
    prom_array_reserve(&result->floor.ms, o->noise_floor);
    result->start_unix_s = clock_start_unix_s();
    warm_up(l);
    result->memory_start_mb = memory_mb();
    prom_progress progress;
    prom_progress_begin(&progress, "frames", o->frames);
    prom_status status = PROM_OK;
    for (uint32_t i = 0; i < o->frames && !status; i++) {
        keep_before(l, i);
        prom_frame_record record = draw_frame(l, i);
        if (!record.feasible) note_infeasible(l);
        prom_frame_step_feed(&l->step, &record);
        status = between_frames(l, i, &record, error);
        prom_array_push(&result->frames, record);
        draw_floor(l, i);
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
    prom_session *s = l->step.session;
    double ppd = prom_session_ppd(s);
    prom_status status = PROM_OK;
    if (wanted) status = prom_comparison_init(&l->comparison, s, wanted, ppd, error);
    if (!status && l->options->popping_frames)
        status = prom_popping_init(&l->popping, s, ppd, error);
    return status;
}

static prom_status find_floor(prom_session *session, const prom_loop_options *o,
                              prom_loop_result *result, prom_error *error)
{
    if (!o->noise_floor) return PROM_OK;
    return prom_noise_floor_init(&result->floor, session, o->budget_ms, o->frames, error);
}

prom_status prom_frame_loop_run(prom_session *session, const prom_loop_options *options,
                                prom_loop_result *result, prom_error *error)
{
    loop l = {.options = options, .result = result};
    prom_status status = find_floor(session, options, result, error);
    if (status) return status;
    status = prom_frame_step_init(&l.step, session, options->selector, options->budget_ms,
                                  options->rule_scale, error);
    if (status) return status;
    l.step.dt_s = prom_session_step_s(session);
    l.step.certify = true;
    l.jump = jump_of(session);
    status = open_comparison(&l, error);
    if (!status) status = walk(&l, error);
    prom_comparison_finish(&l.comparison);
    prom_popping_finish(&l.popping);
    prom_cut_finish(&l.cut_before);
    prom_frame_step_finish(&l.step);
    return status;
}

void prom_loop_result_finish(prom_loop_result *result)
{
    prom_array_finish(&result->frames);
    prom_array_finish(&result->cold);
    prom_noise_floor_finish(&result->floor);
}
