#include "app/walk_loop.h"

#include "app/frame_step.h"
#include "app/rest.h"
#include "app/walk_motion.h"
#include "app/walk_path.h"
#include "app/walk_size.h"
#include "app/walk_title.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

// A picture at rest is drawn again until what the guarantee knows is of this view only, and
// what frames show of each other has settled.
#define SETTLE_FRAMES (PROM_GUARANTEE_FAST + 7)
// Where more time makes the picture better, it takes over after these.
#define STILL_FRAMES 3
#define REST_WAIT_S 0.25
// The step after a rest: the time before it was no walking.
#define FIRST_STEP_S (1.0 / 60)
#define MOST_SHOTS 9999

typedef struct walk {
    prom_session *session;
    prom_window *window;
    const prom_walk_options *options;
    prom_walk_result *result;
    prom_frame_step step;
    prom_rest rest;
    prom_walk_motion motion;
    prom_walk_title title;
    prom_window_input input;
    prom_camera camera, drawn;
    bool on_path, playing; // on_path: the camera is the path's, not the motion's
    double at_keys;        // on the path
    unsigned same;         // frames drawn of this picture
    double last_ms;        // the last turn's start
} walk;

// ---- input

static int axis(const bool *held, prom_key plus, prom_key plus2, prom_key minus,
                prom_key minus2)
{
    return (held[plus] || held[plus2]) - (held[minus] || held[minus2]);
}

static prom_walk_input walk_input(const prom_window_input *in)
{
    const bool *h = in->held;
    prom_walk_input input = {
        .forward = axis(h, PROM_KEY_W, PROM_KEY_UP, PROM_KEY_S, PROM_KEY_DOWN),
        .right = axis(h, PROM_KEY_D, PROM_KEY_D, PROM_KEY_A, PROM_KEY_A),
        .up = axis(h, PROM_KEY_E, PROM_KEY_SPACE, PROM_KEY_Q, PROM_KEY_C),
        .turn = axis(h, PROM_KEY_RIGHT, PROM_KEY_RIGHT, PROM_KEY_LEFT, PROM_KEY_LEFT),
        .tilt =
            axis(h, PROM_KEY_PAGE_UP, PROM_KEY_PAGE_UP, PROM_KEY_PAGE_DOWN, PROM_KEY_PAGE_DOWN),
        .look_px = {in->look_px[0], in->look_px[1]},
        .scroll = in->scroll,
        .fast = h[PROM_KEY_SHIFT],
        .home = in->pressed[PROM_KEY_HOME],
    };
    return input;
}

static prom_status write_next_shot(walk *w, prom_error *error)
{
    char path[32];
    for (unsigned i = 1; i <= MOST_SHOTS; i++) {
        snprintf(path, sizeof path, "promenade-%04u.png", i);
        if (access(path, F_OK) == 0) continue;
        prom_status status = prom_session_write_png(w->session, path, error);
        if (!status) prom_log(PROM_LOG_INFO, "%s: what the window shows", path);
        return status;
    }
    return prom_fail(error, PROM_ERR_OUTPUT,
                     "promenade-0001.png to promenade-%u.png are there already", MOST_SHOTS);
}

static void take_shot(walk *w)
{
    prom_error error = {0};
    if (write_next_shot(w, &error)) prom_log(PROM_LOG_WARNING, "no picture: %s", error.text);
}

// ---- the camera

static void advance(walk *w, double dt_s)
{
    prom_walk_input input = walk_input(&w->input);
    if (w->input.pressed[PROM_KEY_P]) {
        w->playing = !w->playing;
        w->on_path = w->on_path || w->playing;
    }
    // While the path plays, a nudge of the mouse does not end it; keys do.
    if (w->playing) input.look_px[0] = input.look_px[1] = 0;
    if (input.home) w->at_keys = 0;
    if (prom_walk_input_moves(&input)) {
        if (w->on_path) prom_walk_take_pose(&w->motion, &w->camera);
        w->on_path = w->playing = false;
    }
    prom_walk_step(&w->motion, &input, dt_s);
    if (!w->on_path) {
        prom_walk_camera(&w->motion, &w->camera);
        return;
    }
    prom_walk_path_pose(&w->session->path, w->at_keys, &w->camera);
    if (w->playing)
        w->at_keys += w->options->frames ? 1 : prom_walk_path_keys(&w->session->path, dt_s);
}

static bool same_view(const prom_camera *a, const prom_camera *b)
{
    return !memcmp(a->eye, b->eye, sizeof a->eye) &&
           !memcmp(a->orientation, b->orientation, sizeof a->orientation) &&
           a->width == b->width && a->height == b->height;
}

static prom_status follow_size(walk *w, prom_error *error)
{
    const uint32_t *size = w->input.size_px;
    prom_session *s = w->session;
    if (!size[0] || !size[1] || (size[0] == s->camera.width && size[1] == s->camera.height))
        return PROM_OK;
    prom_status status = prom_session_resize(s, size, error);
    w->camera.width = s->camera.width;
    w->camera.height = s->camera.height;
    return status;
}

// ---- frames

static bool is_shown(const walk *w)
{
    return w->input.size_px[0] && w->input.size_px[1];
}

// The same picture again and again.
static bool is_still(const walk *w)
{
    unsigned settled = w->rest.budget_ms > 0 ? STILL_FRAMES : SETTLE_FRAMES;
    return !w->options->frames && !w->playing && w->same >= settled;
}

// Nothing is left to be drawn.
static bool is_at_rest(const walk *w)
{
    if (w->options->frames) return false;
    return !is_shown(w) || (is_still(w) && prom_rest_is_done(&w->rest));
}

// Returns what showing it took. A device may wait for the screen in it, which is no work; a
// software rasteriser hands the picture over itself.
static double present(walk *w)
{
    double start = prom_clock_ms();
    double copy_ms = prom_window_present(w->window, w->session->target);
    bool software = prom_context_is_software(w->session->context);
    return software ? prom_clock_ms() - start : copy_ms;
}

static void draw(walk *w, double start_ms)
{
    prom_walk_result *r = w->result;
    prom_rest_end(&w->rest);
    w->same = same_view(&w->camera, &w->drawn) ? w->same + 1 : 1;
    prom_frame_record record = prom_frame_step_draw(&w->step, &w->camera, start_ms);
    if (is_shown(w)) record.display_ms = present(w);
    record.frame_ms += record.display_ms;
    prom_frame_step_feed(&w->step, &record);
    w->drawn = w->camera;
    bool miss = record.frame_ms > w->options->budget_ms;
    r->frames++;
    r->misses += miss;
    r->frame_ms += record.frame_ms;
    r->present_ms += record.display_ms;
    r->worst_ms = fmax(r->worst_ms, record.frame_ms);
    prom_walk_title_add(&w->title, record.frame_ms, record.triangles, miss);
}

// No frame of the walk: it takes what time there is, and counts for nothing.
static void refine(walk *w)
{
    bool better = prom_rest_step(&w->rest, &w->camera);
    if (better) w->title.triangles = w->rest.triangles;
    if (better || w->input.exposed) present(w);
}

static void tell(walk *w)
{
    char text[PROM_WALK_TITLE_BYTES];
    prom_walk_title_facts facts = {.name = w->options->name,
                                   .selector = w->options->selector,
                                   .budget_ms = w->options->budget_ms,
                                   .playing = w->playing,
                                   .at_rest = is_still(w),
                                   .refined = prom_rest_shows_all(&w->rest),
                                   .captured = w->input.captured};
    if (prom_walk_title_due(&w->title, &facts, prom_clock_ms(), text))
        prom_window_set_title(w->window, text);
}

static prom_status take_turn(walk *w, prom_error *error)
{
    bool rested = is_at_rest(w);
    prom_window_poll(w->window, rested ? REST_WAIT_S : 0, &w->input);
    double start = prom_clock_ms();
    double dt_s = is_still(w) ? FIRST_STEP_S : (start - w->last_ms) / 1000;
    w->last_ms = start;
    if (w->session->frozen && w->options->frames) dt_s = prom_session_step_s(w->session);
    prom_status status = follow_size(w, error);
    if (status) return status;
    w->step.dt_s = dt_s;
    advance(w, dt_s);
    bool same = same_view(&w->camera, &w->drawn);
    if (same && is_at_rest(w)) {
        if (w->input.exposed) present(w);
    } else if (same && is_still(w)) {
        refine(w);
    } else {
        draw(w, start);
    }
    if (w->input.pressed[PROM_KEY_F12]) take_shot(w);
    tell(w);
    return PROM_OK;
}

static bool goes_on(const walk *w)
{
    if (w->input.closing || w->input.pressed[PROM_KEY_ESCAPE]) return false;
    return !w->options->frames || w->result->frames < w->options->frames;
}

static void begin(walk *w)
{
    w->camera = w->session->camera;
    prom_path_pose(&w->session->path, 0, &w->camera);
    prom_walk_init(&w->motion, &w->camera, prom_walk_size(&w->session->model));
    w->on_path = true;
    w->playing = w->options->play;
    prom_frame_step_warm(&w->step, &w->camera);
    prom_window_show(w->window);
    w->last_ms = prom_clock_ms();
}

prom_status prom_walk_run(prom_session *session, prom_window *window,
                          const prom_walk_options *options, prom_walk_result *result,
                          prom_error *error)
{
    walk w = {.session = session, .window = window, .options = options, .result = result};
    *result = (prom_walk_result){0};
    prom_status status = prom_frame_step_init(&w.step, session, options->selector,
                                              options->budget_ms, options->rule_scale, error);
    if (status) return status;
    status =
        prom_rest_init(&w.rest, &w.step, options->selector, options->rest_budget_ms, error);
    if (!status) begin(&w);
    while (!status && goes_on(&w)) status = take_turn(&w, error);
    if (result->frames) {
        result->frame_ms /= (double)result->frames;
        result->present_ms /= (double)result->frames;
    }
    result->camera = w.camera;
    prom_rest_finish(&w.rest);
    prom_frame_step_finish(&w.step);
    return status;
}

void prom_walk_look_at(const prom_camera *camera, double point[3])
{
    prom_walk_motion motion = {0};
    prom_walk_take_pose(&motion, camera);
    point[0] = camera->eye[0] - sin(motion.yaw) * cos(motion.pitch);
    point[1] = camera->eye[1] + sin(motion.pitch);
    point[2] = camera->eye[2] - cos(motion.yaw) * cos(motion.pitch);
}
