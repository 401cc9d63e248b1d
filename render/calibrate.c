#include "render/calibrate.h"

#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"
#include "render/calibrate_scene.h"
#include "render/renderer_private.h"

#include <math.h>
#include <stdlib.h>

#define SAMPLE_MS 5.0 // each sample is drawn for at least this long
#define MIN_REPEATS 3
#define MAX_REPEATS 64
#define FIXED_SAMPLES 5u // empty frames
#define PASSES 2
#define NOISE_MS 20.0 // a frame of about this time is repeated to see the noise
#define NOISE_FRAMES 100

static size_t sample_count(int effort)
{
    static const size_t per_shading[] = {12, 24, 40}; // 65, 125 and 205 samples in all
    return FIXED_SAMPLES + per_shading[effort - 1] * PROM_SHADE_COUNT;
}

typedef struct calibration {
    prom_renderer *renderer;
    prom_timer *timer;
    prom_draw_list *list;
    prom_target *target;
    prom_pass pass;
    scene_kit kit;
    GLuint query;
} calibration;

static void draw(const calibration *c, const scene_plan *plan)
{
    if (plan)
        scene_fill_list(&c->kit, plan, (float)c->pass.width / (float)c->pass.height, c->list);
    prom_target_clear(c->target, prom_sky_color);
    if (plan) prom_draw_list_submit(c->list, c->target, &c->pass);
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

// The median over frames drawn for at least SAMPLE_MS. The list is filled anew in each, as it
// is in the frames that the samples stand for.
static double time_frame(const calibration *c, const scene_plan *plan)
{
    double ms[MAX_REPEATS], sum = 0;
    int count = 0;
    while (count < MAX_REPEATS && (count < MIN_REPEATS || sum < SAMPLE_MS)) {
        prom_timer_begin(c->timer);
        draw(c, plan);
        ms[count] = prom_timer_end(c->timer);
        sum += ms[count++];
    }
    qsort(ms, (size_t)count, sizeof *ms, compare_doubles);
    return count % 2 ? ms[count / 2] : 0.5 * (ms[count / 2 - 1] + ms[count / 2]);
}

// Pixels that the plan's items cover, each layer of blended ones counted, as the device counts
// them; also the frame that is drawn before any is timed.
static double count_pixels(const calibration *c, const scene_plan *plan)
{
    GLuint64 samples = 0;
    glBeginQuery(GL_SAMPLES_PASSED, c->query);
    draw(c, plan);
    glEndQuery(GL_SAMPLES_PASSED);
    glGetQueryObjectui64v(c->query, GL_QUERY_RESULT, &samples);
    return (double)samples;
}

static prom_cost_sample take_sample(const calibration *c, const scene_plan *plan)
{
    prom_cost_sample sample = {.features.fixed = 1};
    double pixels = count_pixels(c, plan);
    if (plan) {
        prom_renderer_take_stats(c->renderer);
        draw(c, plan);
        prom_draw_stats stats = prom_renderer_take_stats(c->renderer);
        sample.features.draws = (double)stats.draws;
        sample.features.vertices = (double)stats.vertices;
        sample.features.triangles = (double)stats.triangles;
        sample.features.pixels[plan->shading] = pixels;
    }
    sample.ms = time_frame(c, plan);
    return sample;
}

// All samples in a fixed order: some empty frames, then the shadings in turn.
static void take_all(const calibration *c, int effort, prom_cost_sample *samples,
                     prom_progress *progress)
{
    for (size_t i = 0; i < sample_count(effort); i++) {
        scene_plan plan;
        bool empty = i < FIXED_SAMPLES;
        if (!empty)
            plan = scene_plan_at(&c->kit, (prom_shading)(i % PROM_SHADE_COUNT),
                                 (uint32_t)(i / PROM_SHADE_COUNT));
        prom_cost_sample sample = take_sample(c, empty ? NULL : &plan);
        if (samples[i].features.fixed == 0 || sample.ms < samples[i].ms) samples[i] = sample;
        prom_progress_step(progress, 1);
    }
}

// Whatever else the machine does comes in bursts longer than a sample: the whole set is taken
// more than once, and of each sample the quickest time counts.
static void take_passes(const calibration *c, int effort, prom_cost_samples *samples)
{
    prom_progress progress;
    size_t count = sample_count(effort);
    prom_progress_begin(&progress, "calibrating", count * PASSES);
    prom_cost_sample *first = prom_array_extend(samples, count);
    for (int pass = 0; pass < PASSES; pass++) take_all(c, effort, first, &progress);
    prom_progress_end(&progress);
}

// How far the slow frames of one and the same picture lie above its median: 95th percentile
// over median, less 1. The sample that takes nearest to a frame's usual time is drawn again.
static double measure_noise(const calibration *c, const prom_cost_sample *samples, size_t count)
{
    size_t best = FIXED_SAMPLES;
    for (size_t i = FIXED_SAMPLES; i < count; i++)
        if (fabs(samples[i].ms - NOISE_MS) < fabs(samples[best].ms - NOISE_MS)) best = i;
    scene_plan plan = scene_plan_at(&c->kit, (prom_shading)(best % PROM_SHADE_COUNT),
                                    (uint32_t)(best / PROM_SHADE_COUNT));
    double ms[NOISE_FRAMES];
    for (int i = 0; i < NOISE_FRAMES; i++) {
        prom_timer_begin(c->timer);
        draw(c, &plan);
        ms[i] = prom_timer_end(c->timer);
    }
    qsort(ms, NOISE_FRAMES, sizeof *ms, compare_doubles);
    return ms[NOISE_FRAMES * 95 / 100] / ms[NOISE_FRAMES / 2] - 1.0;
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
    calibration c = {.renderer = renderer, .timer = timer};
    c.pass =
        (prom_pass){.projection = GLM_MAT4_IDENTITY_INIT, .width = width, .height = height};
    c.target = prom_target_create(width, height, false, error);
    if (!c.target) return PROM_ERR_UNSUPPORTED;
    uint32_t meshes = prom_renderer_mesh_count(renderer), material_count;
    uint32_t textures = prom_renderer_texture_count(renderer);
    prom_draw_stats stats = renderer->stats;
    prom_material *materials;
    keep_materials(renderer, &materials, &material_count);
    c.list = prom_draw_list_create(renderer);
    glCreateQueries(GL_SAMPLES_PASSED, 1, &c.query);

    prom_status status = PROM_OK;
    size_t before = samples->count;
    if (scene_kit_upload(&c.kit, renderer)) {
        take_passes(&c, effort, samples);
        *noise = measure_noise(&c, samples->data + before, samples->count - before);
    } else {
        status = renderer_out_of_memory(error);
    }

    glDeleteQueries(1, &c.query);
    prom_draw_list_destroy(c.list);
    prom_target_destroy(c.target);
    prom_renderer_truncate(renderer, meshes, textures);
    prom_renderer_set_materials(renderer, materials, material_count);
    prom_free(materials);
    renderer->stats = stats;
    return status;
}
