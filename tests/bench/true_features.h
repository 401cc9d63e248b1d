// What a frame that has been drawn truly asked of the device: its cost features, counted by
// queries around each of its draws. For benchmarks: it looks into render/ and takes much longer
// than the frame.
#ifndef PROM_BENCH_TRUE_FEATURES_H
#define PROM_BENCH_TRUE_FEATURES_H

#include "metaobj/cost_features.h"
#include "render/renderer_private.h"
#include "render/target.h"

typedef struct true_features {
    prom_renderer *renderer;
    prom_draw_list *list;
    prom_target *target;
    PROM_ARRAY(double) covered; // pixels of each draw of the list, whatever is before it
    PROM_ARRAY(double) filled;  // the same without what textures cut out
} true_features;

typedef struct frame_counts {
    double blocks_px; // pixels of the blocks that were shaded, by the device's statistics
    double clipped;   // triangles left by clipping
} frame_counts;

static inline void true_features_finish(true_features *t)
{
    prom_array_finish(&t->covered);
    prom_array_finish(&t->filled);
}

static inline uint32_t kind_of(pipeline p)
{
    static const uint32_t kinds[PIPELINE_COUNT] = {
        [PIPELINE_PLAIN] = PROM_SHADE_PLAIN,
        [PIPELINE_TEXTURED] = PROM_SHADE_TEXTURED,
        [PIPELINE_MASKED] = PROM_SHADE_MASKED,
        [PIPELINE_BLENDED] = PROM_SHADE_BLENDED,
        [PIPELINE_IMPOSTOR_UNLIT] = PROM_SHADE_IMPOSTOR,
        [PIPELINE_IMPOSTOR_LIT] = PROM_COST_IMPOSTOR_LIT,
    };
    return kinds[p];
}

static inline void make_pass(const prom_camera *camera, prom_pass *pass)
{
    *pass = (prom_pass){.width = camera->width, .height = camera->height};
    prom_camera_projection(camera, pass->projection);
}

static inline double ask(GLuint query)
{
    GLuint64 count = 0;
    glGetQueryObjectui64v(query, GL_QUERY_RESULT, &count);
    return (double)count;
}

// Submits one draw of the list, which is prepared, as if it were all; returns its pixels.
static inline double submit_one(true_features *t, const prom_pass *pass, const draw_run *run,
                                uint32_t command, GLuint query)
{
    draw_run one = *run, *runs = t->list->runs.data;
    size_t count = t->list->runs.count;
    one.first = command;
    one.count = 1;
    t->list->runs.data = &one;
    t->list->runs.count = 1;
    glBeginQuery(GL_SAMPLES_PASSED, query);
    prom_draw_list_submit(t->list, t->target, pass);
    glEndQuery(GL_SAMPLES_PASSED);
    t->list->runs.data = runs;
    t->list->runs.count = count;
    return ask(query);
}

// Submits the list draw by draw, each in a query of its own. Where textures decide what is
// there, as many pixels are shaded for each that shows as there are without them.
static inline void count_pixels(true_features *t, const prom_pass *pass, prom_cost_features *f)
{
    GLuint query;
    glGenQueries(1, &query);
    prom_target_clear(t->target, prom_sky_color);
    for (size_t i = 0; i < t->list->runs.count; i++) {
        const draw_run *run = &t->list->runs.data[i];
        for (uint32_t c = run->first; c < run->first + run->count; c++) {
            double shown = submit_one(t, pass, run, c, query);
            double filled = t->filled.data[c], covered = t->covered.data[c];
            double shaded = covered > 0 ? fmin(shown * filled / covered, filled) : 0;
            double triangles = t->list->commands.data[c].count / 3.0;
            f->pixels[kind_of((pipeline)run->state.pipeline)] += shaded;
            f->hidden += filled - shaded;
            f->edges += prom_cost_edges(triangles, shaded, filled - shaded);
            f->hidden_edges += prom_cost_edges(triangles, filled - shaded, shaded);
        }
    }
    glDeleteQueries(1, &query);
}

// What each draw covers by itself, and what it fills without its textures' holes.
static inline void count_covered(true_features *t, const prom_pass *pass)
{
    GLuint query;
    glGenQueries(1, &query);
    prom_array_reserve(&t->covered, t->list->commands.count);
    prom_array_reserve(&t->filled, t->list->commands.count);
    for (size_t i = 0; i < t->list->runs.count; i++) {
        const draw_run *run = &t->list->runs.data[i];
        draw_run whole = *run;
        if (run->state.phase == PHASE_OPAQUE) whole.state.pipeline = PIPELINE_PLAIN;
        for (uint32_t c = run->first; c < run->first + run->count; c++) {
            t->covered.data[c] = submit_one(t, pass, run, c, query);
            t->filled.data[c] = submit_one(t, pass, &whole, c, query);
        }
    }
    glDeleteQueries(1, &query);
}

static inline void attach_depth(const prom_target *target, GLuint depth)
{
    glNamedFramebufferRenderbuffer(target->framebuffer, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                   depth);
    if (target->plain != target->framebuffer)
        glNamedFramebufferRenderbuffer(target->plain, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER,
                                       depth);
}

static inline double submit_counted(true_features *t, const prom_pass *pass, GLenum what)
{
    GLuint query;
    glGenQueries(1, &query); // Mesa 22.3 does not create those of pipeline statistics
    prom_target_clear(t->target, prom_sky_color);
    glBeginQuery(what, query);
    prom_draw_list_submit(t->list, t->target, pass);
    glEndQuery(what);
    double count = ask(query);
    glDeleteQueries(1, &query);
    return count;
}

static inline double sum_pixels(const prom_cost_features *f)
{
    double sum = 0;
    for (int k = 0; k < PROM_COST_KINDS; k++) sum += f->pixels[k];
    return sum;
}

// Of the frame that was drawn last, by prom_renderer_draw_frame. *f must be {0}.
static inline void count_features(true_features *t, const prom_camera *camera,
                                  prom_cost_features *f, frame_counts *counts)
{
    prom_pass pass;
    make_pass(camera, &pass);
    prom_renderer_take_stats(t->renderer);
    counts->blocks_px = submit_counted(t, &pass, GL_FRAGMENT_SHADER_INVOCATIONS);
    prom_draw_stats stats = prom_renderer_take_stats(t->renderer);
    counts->clipped = submit_counted(t, &pass, GL_CLIPPING_OUTPUT_PRIMITIVES);
    attach_depth(t->target, 0);
    count_covered(t, &pass);
    attach_depth(t->target, t->target->depth);
    count_pixels(t, &pass, f);
    f->fixed = 1;
    f->draws = (double)stats.draws;
    f->binds = (double)stats.calls;
    f->vertices = (double)stats.vertices;
    f->triangles = (double)stats.triangles;
}

#endif
