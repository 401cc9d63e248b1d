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
#define PASSES 2
#define NOISE_MS 20.0 // a frame of about this time is repeated to see the noise
#define NOISE_FRAMES 100

static size_t sample_count(int effort)
{
    static const size_t per_kind[] = {12, 24, 40}; // 77, 149 and 245 samples in all
    return FIXED_SAMPLES + per_kind[effort - 1] * PROM_COST_KINDS;
}

typedef struct calibration {
    prom_renderer *renderer;
    prom_timer *timer;
    prom_draw_list *list;
    prom_target *target, *flat; // flat: without depth, so that nothing hides anything
    prom_pass pass;
    scene_kit kit;
    GLuint query;
} calibration;

static void fill(const calibration *c, const scene_plan *plan, bool solid)
{
    float aspect = (float)c->pass.width / (float)c->pass.height;
    scene_fill_list(&c->kit, plan, aspect, solid, c->list);
}

static void draw(const calibration *c, const scene_plan *plan)
{
    if (plan) fill(c, plan, false);
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
    prom_renderer_take_stats(c->renderer);
    fill(c, plan, false);
    double shown = count_pixels(c, c->target);
    prom_draw_stats stats = prom_renderer_take_stats(c->renderer);
    double shown_and_hidden = count_pixels(c, c->flat);
    fill(c, plan, true);
    double filled = count_pixels(c, c->flat);
    double shaded = shown_and_hidden > 0 ? shown * filled / shown_and_hidden : 0.0;
    f.draws = (double)stats.draws;
    f.vertices = (double)stats.vertices;
    f.triangles = (double)stats.triangles;
    f.pixels[plan->kind] = shaded;
    f.hidden = fmax(filled - shaded, 0.0);
    f.edges = prom_cost_edges(f.triangles, shaded, f.hidden);
    f.hidden_edges = prom_cost_edges(f.triangles, f.hidden, shaded);
    return f;
}

static prom_cost_sample take_sample(const calibration *c, const scene_plan *plan)
{
    prom_cost_sample sample = {.features.fixed = 1};
    if (plan) sample.features = count_features(c, plan);
    draw(c, plan); // to warm
    sample.ms = time_frame(c, plan);
    return sample;
}

// The i-th sample draws this, or nothing.
static bool plan_of(const calibration *c, size_t i, scene_plan *plan)
{
    if (i < FIXED_SAMPLES) return false;
    *plan = scene_plan_at(&c->kit, (uint32_t)(i % PROM_COST_KINDS),
                          (uint32_t)(i / PROM_COST_KINDS));
    return true;
}

// All samples in a fixed order: some empty frames, then the kinds in turn.
static void take_all(const calibration *c, int effort, prom_cost_sample *samples,
                     prom_progress *progress)
{
    for (size_t i = 0; i < sample_count(effort); i++) {
        scene_plan plan;
        prom_cost_sample sample = take_sample(c, plan_of(c, i, &plan) ? &plan : NULL);
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
    calibration c = {.renderer = renderer, .timer = timer};
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
    prom_target_destroy(c.flat);
    prom_renderer_truncate(renderer, meshes, textures);
    prom_renderer_set_materials(renderer, materials, material_count);
    prom_free(materials);
    renderer->stats = stats;
    return status;
}
