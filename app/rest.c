#include "app/rest.h"

#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"

#include <math.h>

// From frame to frame, by taste: from 33 ms, 100 ms are reached in the third.
#define GROWTH 1.5
// A part's time is known from a prediction; what one has taken bounds the next.
#define PACE_MIN (1.0 / 64)
#define PACE_DOWN 0.25
#define PACE_UP 1.5

static const prom_frame_options plain = {.ids = PROM_IDS_NONE};

prom_status prom_rest_init(prom_rest *rest, prom_frame_step *step, const char *selector,
                           double budget_ms, prom_error *error)
{
    const prom_model *model = &step->session->model;
    *rest = (prom_rest){.step = step};
    if (!(budget_ms > 0) || !prom_selector_class_named(selector)->budgeted) return PROM_OK;
    rest->budget_ms = budget_ms;
    // Selectors of its own: some start from their last cut, and the walk's shall stay.
    rest->selector = prom_selector_create(selector, model, error);
    rest->full = prom_selector_create("full", model, error);
    if (rest->selector && rest->full) return PROM_OK;
    prom_rest_finish(rest);
    return error->status;
}

void prom_rest_finish(prom_rest *rest)
{
    prom_rest_end(rest);
    prom_selector_destroy(rest->selector);
    prom_selector_destroy(rest->full);
    prom_cut_finish(&rest->grown);
    prom_cut_finish(&rest->detail);
    *rest = (prom_rest){0};
}

bool prom_rest_is_done(const prom_rest *rest)
{
    return !(rest->budget_ms > 0) || rest->phase == PROM_REST_DONE;
}

bool prom_rest_shows_all(const prom_rest *rest)
{
    return rest->phase == PROM_REST_DONE;
}

void prom_rest_end(prom_rest *rest)
{
    rest->phase = PROM_REST_NONE;
    if (rest->aside) prom_target_destroy(rest->aside);
    rest->aside = NULL;
}

// What a cut may be predicted at to be drawn in so much time, as expected: nothing is kept back
// where there is nothing to miss.
static double allowed_ms(const prom_rest *r, double budget_ms)
{
    return budget_ms / prom_guarantee_expected(&r->step->guarantee, 1);
}

static void choose(prom_rest *r, prom_selector *selector, const prom_camera *camera,
                   const prom_visibility *visibility, double predicted_ms, prom_cut *cut)
{
    const prom_frame_step *step = r->step;
    prom_view view;
    prom_view_init(&view, camera);
    prom_selection selection = prom_session_selection(step->session, &view, visibility,
                                                      predicted_ms, step->rule_scale);
    selection.cost = prom_guarantee_cost(&step->guarantee);
    prom_selector_run(selector, &selection, cut);
}

static double take_triangles(const prom_rest *r)
{
    return (double)prom_renderer_take_stats(r->step->session->renderer).triangles;
}

// ---- growing

// Full detail as `shot` draws it, so that it has the same pixels: nothing is known to be
// hidden.
static void begin(prom_rest *r, const prom_camera *camera)
{
    choose(r, r->full, camera, NULL, INFINITY, &r->detail);
    r->grown_ms = r->step->guarantee.options.budget_ms;
    r->pace = 1;
    r->phase = PROM_REST_GROWING;
}

static void grow(prom_rest *r, const prom_camera *camera)
{
    prom_frame_step *step = r->step;
    prom_sight_begin(&step->sight, camera);
    choose(r, r->selector, camera, step->sight.visibility, allowed_ms(r, r->grown_ms),
           &r->grown);
    prom_sight_draw(&step->sight, &r->grown, camera, &(prom_frame_options){0});
    r->triangles = take_triangles(r);
}

// ---- full detail

static bool fits(const prom_rest *r, double budget_ms)
{
    return r->detail.predicted_ms <= allowed_ms(r, budget_ms);
}

// A device without room for another picture keeps the best one that there is.
static bool make_aside(prom_rest *r, const prom_camera *camera)
{
    prom_error error = {0};
    r->aside = prom_target_create(camera->width, camera->height, false, &error);
    if (!r->aside) prom_log(PROM_LOG_WARNING, "no full detail at rest: %s", error.text);
    return r->aside;
}

static void begin_parts(prom_rest *r, const prom_camera *camera)
{
    prom_session *s = r->step->session;
    prom_renderer_prepare_frame(s->list, &s->model, &r->detail, camera, &plain);
    r->next = 0;
    r->triangles = 0;
    r->into = s->target;
    r->phase = PROM_REST_PARTS;
    if (fits(r, r->budget_ms)) return;
    if (make_aside(r, camera))
        r->into = r->aside;
    else
        r->budget_ms = 0;
}

static void adapt_pace(prom_rest *r, double took_ms)
{
    double factor = fmin(fmax(r->budget_ms / took_ms, PACE_DOWN), PACE_UP);
    r->pace = fmin(fmax(r->pace * factor, PACE_MIN), 1);
}

// The fixed part of the time, in which the background is, may be any part's, but leaves it
// half.
static size_t end_of_part(const prom_rest *r)
{
    const prom_draw_list *list = r->step->session->list;
    if (r->into != r->aside) return prom_draw_list_length(list);
    double allowed = allowed_ms(r, r->budget_ms * r->pace);
    double fixed = r->detail.terms_ms[PROM_TERM_FIXED];
    return prom_draw_list_part(list, r->next, fmax(allowed - fixed, allowed / 2));
}

static bool draw_part(prom_rest *r, const prom_camera *camera)
{
    prom_session *s = r->step->session;
    double start = prom_clock_ms();
    size_t end = end_of_part(r);
    prom_renderer_submit_frame(s->list, r->into, camera, &plain, r->next, end);
    bool complete = end == prom_draw_list_length(s->list);
    if (complete && r->into == r->aside) prom_target_copy_colors(s->target, r->aside);
    prom_renderer_finish(s->renderer);
    adapt_pace(r, prom_clock_ms() - start);
    r->next = end;
    r->triangles += take_triangles(r);
    if (complete) r->phase = PROM_REST_DONE;
    return complete;
}

bool prom_rest_step(prom_rest *rest, const prom_camera *camera)
{
    switch (rest->phase) {
    case PROM_REST_NONE:
        begin(rest, camera);
        return false;
    case PROM_REST_GROWING:
        rest->grown_ms *= GROWTH;
        if (rest->grown_ms <= rest->budget_ms && !fits(rest, rest->grown_ms)) {
            grow(rest, camera);
            return true;
        }
        begin_parts(rest, camera);
        return false;
    case PROM_REST_PARTS:
        return draw_part(rest, camera);
    case PROM_REST_DONE:
        break;
    }
    return false;
}
