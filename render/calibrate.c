#include "render/calibrate.h"

#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "render/calibrate_scene.h"
#include "render/renderer_private.h"
#include "render/target.h"

#include <math.h>
#include <stdlib.h>

#define SAMPLE_MS 5.0 // each sample is drawn for at least this long
#define MIN_REPEATS 3
#define MAX_REPEATS 64
#define FIXED_SAMPLES 5u // empty frames
// Whatever else the machine does slows samples down, in bursts longer than one. So the whole
// set is taken twice, and of each sample the quickest time counts; those whose two quickest
// are further apart than AGREE are taken again, once or twice if time allows.
#define PASSES 2
#define MOST_PASSES 4
#define AGREE 1.08
// A sample that takes this much longer for its processor time than most is taken for disturbed
// even if its times agree: all of them may be (by taste; undisturbed ones lie within 1.3).
#define SLOWER 1.5
#define NOISE_MS 20.0 // a frame of about this time is repeated to see the noise
#define NOISE_FRAMES 100

// Of each series, by effort; and when no more is taken again.
static const struct {
    size_t samples;
    double limit_ms;
} efforts[] = {{12, 8e3}, {24, 20e3}, {40, 40e3}};

static size_t sample_count(int effort)
{
    return FIXED_SAMPLES + efforts[effort - 1].samples * SCENE_SERIES; // 101, 197 and 325
}

typedef struct sample_times {
    double ms, second_ms; // the quickest of the passes, and the one after it
    double busy_ms;       // of the processors (prom_timer_busy_ms), the least of the passes
} sample_times;

typedef struct calibration {
    prom_renderer *renderer;
    prom_timer *timer;
    prom_draw_list *list;
    prom_target *target, *flat; // flat: without depth, so that nothing hides anything
    prom_pass pass;
    scene_kit kit;
    GLuint query;
    int effort;
    double start_ms;
    size_t count; // of the samples
    prom_cost_sample *samples;
    sample_times *times; // of each
} calibration;

static void fill(const calibration *c, const scene_plan *plan, bool solid)
{
    float aspect = (float)c->pass.width / (float)c->pass.height;
    scene_fill_list(&c->kit, plan, aspect, solid, c->list);
}

static void draw(const calibration *c, const scene_plan *plan)
{
    if (plan) {
        if (plan->copies) scene_send(&c->kit, plan, c->renderer);
        fill(c, plan, false);
    }
    prom_target_clear(c->target, prom_sky_color);
    if (plan) prom_draw_list_submit(c->list, c->target, &c->pass);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(double *values, int count)
{
    qsort(values, (size_t)count, sizeof *values, compare_doubles);
    return count % 2 ? values[count / 2] : 0.5 * (values[count / 2 - 1] + values[count / 2]);
}

// Medians over frames that keep the device busy for SAMPLE_MS at least, whoever else is. The
// list is filled anew in each, as it is in the frames that the samples stand for.
static double time_frame(const calibration *c, const scene_plan *plan, double *busy_ms)
{
    double ms[MAX_REPEATS], busy[MAX_REPEATS], sum = 0;
    int count = 0;
    while (count < MAX_REPEATS && (count < MIN_REPEATS || sum < SAMPLE_MS)) {
        prom_timer_begin(c->timer);
        draw(c, plan);
        ms[count] = prom_timer_end(c->timer);
        busy[count] = prom_timer_busy_ms(c->timer);
        sum += busy[count] > 0 ? busy[count] : ms[count];
        count++;
    }
    *busy_ms = median(busy, count);
    return median(ms, count);
}

// Pixels of the list that pass the depth test of a target, as the device counts them.
static double count_pixels(const calibration *c, prom_target *target)
{
    GLuint64 samples = 0;
    prom_target_clear(target, prom_sky_color);
    glBeginQuery(GL_SAMPLES_PASSED, c->query);
    prom_draw_list_submit(c->list, target, &c->pass);
    glEndQuery(GL_SAMPLES_PASSED);
    glGetQueryObjectui64v(c->query, GL_QUERY_RESULT, &samples);
    return (double)samples;
}

// Where textures decide what is there, pixels that show nothing are shaded as well: as many for
// each that shows as the items have without the textures' holes.
static prom_cost_features count_features(const calibration *c, const scene_plan *plan)
{
    prom_cost_features f = {.fixed = 1};
    f.upload_bytes = (double)scene_send(&c->kit, plan, c->renderer);
    f.uploads = f.upload_bytes > 0;
    prom_renderer_take_stats(c->renderer);
    fill(c, plan, false);
    double shown = count_pixels(c, c->target);
    prom_draw_stats stats = prom_renderer_take_stats(c->renderer);
    double shown_and_hidden = count_pixels(c, c->flat);
    double filled = shown_and_hidden;
    if (scene_is_cut(plan)) {
        fill(c, plan, true);
        filled = count_pixels(c, c->flat);
    }
    double shaded = shown_and_hidden > 0 ? shown * filled / shown_and_hidden : 0.0;
    uint32_t kind = plan->series < PROM_COST_KINDS ? plan->series : PROM_SHADE_TEXTURED;
    double plain = scene_plain_share(plan);
    f.draws = (double)stats.draws;
    f.binds = (double)stats.calls;
    f.vertices = (double)stats.vertices;
    f.triangles = (double)stats.triangles;
    f.pixels[kind] = (1.0 - plain) * shaded;
    f.pixels[PROM_SHADE_PLAIN] += plain * shaded;
    f.hidden = fmax(filled - shaded, 0.0);
    f.edges = prom_cost_edges(f.triangles, shaded, f.hidden);
    f.hidden_edges = prom_cost_edges(f.triangles, f.hidden, shaded);
    return f;
}

// The i-th sample draws this, or nothing: some empty frames come first, then the series in
// turn.
static bool plan_of(const calibration *c, size_t i, scene_plan *plan)
{
    if (i < FIXED_SAMPLES) return false;
    *plan = scene_plan_at(&c->kit, (uint32_t)(i % SCENE_SERIES), (uint32_t)(i / SCENE_SERIES));
    return true;
}

static void take_sample(const calibration *c, size_t i)
{
    scene_plan plan;
    bool planned = plan_of(c, i, &plan);
    prom_cost_features *features = &c->samples[i].features;
    sample_times *t = &c->times[i];
    bool counted = features->fixed > 0;
    if (!counted) {
        *features = planned ? count_features(c, &plan) : (prom_cost_features){.fixed = 1};
        *t = (sample_times){INFINITY, INFINITY, INFINITY};
    }
    if (counted || !planned) draw(c, planned ? &plan : NULL); // to warm, as counting does
    double busy_ms, ms = time_frame(c, planned ? &plan : NULL, &busy_ms);
    t->second_ms = fmin(t->second_ms, fmax(ms, t->ms));
    t->ms = fmin(t->ms, ms);
    t->busy_ms = fmin(t->busy_ms, busy_ms);
}

static bool is_late(const calibration *c)
{
    return prom_clock_ms() - c->start_ms > efforts[c->effort - 1].limit_ms;
}

// Those of a lesser effort are taken in any case; they are spread as evenly as all of them.
static void take_all(calibration *c)
{
    prom_progress progress;
    prom_progress_begin(&progress, "calibrating", c->count * PASSES);
    size_t least = sample_count(1), taken = 0;
    for (; taken < c->count && !(taken >= least && is_late(c)); taken++) {
        take_sample(c, taken);
        prom_progress_step(&progress, 1);
    }
    c->count = taken;
    for (size_t i = 0; i < c->count * (PASSES - 1) && !is_late(c); i++) {
        take_sample(c, i % c->count);
        prom_progress_step(&progress, 1);
    }
    prom_progress_end(&progress);
}

static bool times_agree(const sample_times *t)
{
    return t->second_ms <= AGREE * t->ms;
}

static void take_again(const calibration *c)
{
    for (int pass = PASSES; pass < MOST_PASSES; pass++)
        for (size_t i = 0; i < c->count; i++)
            if (!times_agree(&c->times[i]) && !is_late(c)) take_sample(c, i);
}

// The median of time over processor time; 0 where the device has none. On a busy machine the
// level of all costs is that of the busy machine, as it is for the frames that follow.
static double usual_ratio(const calibration *c)
{
    double *ratios = prom_alloc(c->count, sizeof *ratios);
    for (size_t i = 0; i < c->count; i++)
        ratios[i] = c->times[i].busy_ms > 0 ? c->times[i].ms / c->times[i].busy_ms : 0;
    double ratio = median(ratios, (int)c->count);
    prom_free(ratios);
    return ratio;
}

static double usual_ms(const sample_times *t, double ratio)
{
    return ratio > 0 ? ratio * t->busy_ms : INFINITY;
}

static bool is_fine(const sample_times *t, double ratio)
{
    return times_agree(t) && t->ms <= SLOWER * usual_ms(t, ratio);
}

// The times that count. What was disturbed all the time takes what is usual for the time that
// the processors spent on it, which others' work leaves as it is; so does everything when most
// was disturbed. (Measured with ten others at work on two processors: the times of one sample
// are a factor of 1.4 to 3.7 apart, its processor times 1.02 to 1.1.)
static void settle_times(const calibration *c)
{
    size_t disturbed = 0;
    double ratio = usual_ratio(c);
    for (size_t i = 0; i < c->count; i++) disturbed += !is_fine(&c->times[i], ratio);
    bool all = disturbed > c->count / 2 && ratio > 0;
    for (size_t i = 0; i < c->count; i++) {
        const sample_times *t = &c->times[i];
        double usual = usual_ms(t, ratio);
        c->samples[i].ms = all ? usual : is_fine(t, ratio) ? t->ms : fmin(t->ms, usual);
    }
    if (disturbed > c->count / 4)
        prom_log(PROM_LOG_WARNING,
                 "the machine was busy: %zu of %zu calibration samples never took the same "
                 "time twice%s; costs may come out too high",
                 disturbed, c->count, ratio > 0 ? ", their processor time stands in" : "");
}

static void take_samples(calibration *c, prom_cost_samples *samples)
{
    size_t before = samples->count;
    c->count = sample_count(c->effort);
    c->samples = prom_array_extend(samples, c->count);
    c->times = prom_alloc(c->count, sizeof *c->times);
    c->start_ms = prom_clock_ms();
    take_all(c);
    take_again(c);
    settle_times(c);
    samples->count = before + c->count;
    prom_free(c->times);
}

// How far the slow frames of one and the same picture lie above its median: 95th percentile
// over median, less 1. The sample that takes nearest to a frame's usual time is drawn again.
static double measure_noise(const calibration *c)
{
    size_t best = FIXED_SAMPLES;
    for (size_t i = FIXED_SAMPLES; i < c->count; i++)
        if (fabs(c->samples[i].ms - NOISE_MS) < fabs(c->samples[best].ms - NOISE_MS)) best = i;
    scene_plan plan;
    plan_of(c, best, &plan);
    double ms[NOISE_FRAMES];
    for (int i = 0; i < NOISE_FRAMES; i++) {
        prom_timer_begin(c->timer);
        draw(c, &plan);
        ms[i] = prom_timer_end(c->timer);
    }
    qsort(ms, NOISE_FRAMES, sizeof *ms, compare_doubles);
    return ms[NOISE_FRAMES * 95 / 100] / ms[NOISE_FRAMES / 2] - 1.0;
}

static prom_target *create_flat(uint32_t width, uint32_t height, prom_error *error)
{
    prom_target *target = prom_target_create(width, height, false, error);
    if (!target) return NULL;
    const GLuint framebuffers[] = {target->framebuffer, target->plain};
    for (int i = 0; i < 2; i++)
        glNamedFramebufferRenderbuffer(framebuffers[i], GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                       0);
    return target;
}

// The materials are the one thing that truncating does not bring back.
static void keep_materials(const prom_renderer *r, prom_material **kept, uint32_t *count)
{
    *count = (uint32_t)r->materials.count;
    *kept = prom_alloc(*count, sizeof **kept);
    if (*count) memcpy(*kept, r->materials.data, *count * sizeof **kept);
}

prom_status prom_calibrate_run(prom_renderer *renderer, prom_timer *timer, uint32_t width,
                               uint32_t height, int effort, prom_cost_samples *samples,
                               double *noise, prom_error *error)
{
    if (effort < 1 || effort > 3)
        return prom_fail(error, PROM_ERR_USAGE, "calibration effort %d: give 1, 2 or 3",
                         effort);
    calibration c = {.renderer = renderer, .timer = timer, .effort = effort};
    c.pass =
        (prom_pass){.projection = GLM_MAT4_IDENTITY_INIT, .width = width, .height = height};
    c.target = prom_target_create(width, height, false, error);
    c.flat = c.target ? create_flat(width, height, error) : NULL;
    if (!c.flat) {
        if (c.target) prom_target_destroy(c.target);
        return PROM_ERR_UNSUPPORTED;
    }
    uint32_t meshes = prom_renderer_mesh_count(renderer), material_count;
    uint32_t textures = prom_renderer_texture_count(renderer);
    prom_draw_stats stats = renderer->stats;
    prom_material *materials;
    keep_materials(renderer, &materials, &material_count);
    c.list = prom_draw_list_create(renderer);
    glCreateQueries(GL_SAMPLES_PASSED, 1, &c.query);

    prom_status status = PROM_OK;
    if (scene_kit_upload(&c.kit, renderer)) {
        take_samples(&c, samples);
        *noise = measure_noise(&c);
    } else {
        status = renderer_out_of_memory(error);
    }

    scene_kit_finish(&c.kit);
    glDeleteQueries(1, &c.query);
    prom_draw_list_destroy(c.list);
    prom_target_destroy(c.target);
    prom_target_destroy(c.flat);
    prom_renderer_truncate(renderer, meshes, textures);
    prom_renderer_set_materials(renderer, materials, material_count);
    prom_free(materials);
    renderer->stats = stats;
    return status;
}
