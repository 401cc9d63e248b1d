#include "app/frame_step.h"

#include "metaobj/base/clock.h"

#include <string.h>

prom_status prom_frame_step_init(prom_frame_step *step, prom_session *session,
                                 const char *selector, double budget_ms, double rule_scale,
                                 prom_error *error)
{
    *step = (prom_frame_step){
        .session = session, .budget_ms = budget_ms, .rule_scale = rule_scale};
    prom_governor_init(&step->governor, session->cost.margin);
    prom_last_cut_init(&step->last, &session->model);
    step->selector = prom_selector_create(selector, &session->model, error);
    prom_status status = step->selector ? PROM_OK : error->status;
    if (!status) status = prom_sight_init(&step->sight, session, error);
    if (status) prom_frame_step_finish(step);
    return status;
}

void prom_frame_step_finish(prom_frame_step *step)
{
    prom_cut_finish(&step->cut);
    prom_selector_destroy(step->selector);
    prom_sight_finish(&step->sight);
    prom_last_cut_finish(&step->last);
}

static bool same_pose(const prom_camera *a, const prom_camera *b)
{
    return !memcmp(a->eye, b->eye, sizeof a->eye) &&
           !memcmp(a->orientation, b->orientation, sizeof a->orientation);
}

// At rest nothing is stayed with: the best picture is wanted then.
static prom_switches choose(prom_frame_step *step, const prom_camera *camera, double allowed_ms)
{
    prom_view before = step->view;
    prom_view_init(&step->view, camera);
    prom_selection selection = prom_session_selection(
        step->session, &step->view, step->sight.visibility, allowed_ms, step->rule_scale);
    selection.last = &step->last;
    if (step->last.number) selection.weighting.before = &before;
    if (same_pose(&before.camera, camera)) selection.hysteresis = 0.0f;
    selection.weighting.dt_s = step->dt_s;
    prom_selector_run(step->selector, &selection, &step->cut);
    return prom_last_cut_note(&step->last, &step->cut);
}

// What the frame may be predicted at, and what its prediction is corrected by, are those of its
// start: the feedback comes after it.
prom_frame_record prom_frame_step_draw(prom_frame_step *step, const prom_camera *camera,
                                       double start_ms)
{
    prom_session *s = step->session;
    prom_frame_options plain = {0};
    double ratio = step->governor.ratio;

    double allowed = prom_governor_budget(&step->governor, step->budget_ms);
    prom_sight_begin(&step->sight, camera);
    prom_switches switches = choose(step, camera, allowed);
    double selected = prom_clock_ms();
    prom_sight_draw(&step->sight, &step->cut, camera, &plain);
    double end = prom_clock_ms();

    prom_draw_stats stats = prom_renderer_take_stats(s->renderer);
    prom_frame_record record = {
        .frame_ms = end - start_ms,
        .select_ms = selected - start_ms,
        .draw_ms = end - selected,
        .predicted_ms = step->cut.predicted_ms * ratio,
        .triangles = (double)stats.triangles,
        .draws = (double)stats.draws,
        .benefit_px = step->cut.benefit,
        .loss_px = step->cut.loss,
        .cut_nodes = (uint32_t)step->cut.entries.count,
        .switches = switches,
        .feasible = step->cut.cmin_ms <= allowed,
    };
    return record;
}

void prom_frame_step_feed(prom_frame_step *step, const prom_frame_record *record)
{
    prom_governor_feed(&step->governor, step->cut.predicted_ms, record->draw_ms,
                       record->select_ms);
}
