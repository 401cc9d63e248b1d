#include "app/frame_step.h"

#include "metaobj/base/clock.h"
#include "metaobj/base/hash.h"
#include "traverse/bound.h"

#include <math.h>
#include <string.h>

#define WARM_FRAMES 4     // the second still takes twice as long as the others (measured)
#define COUNTING_RATE 0.1 // of learning
#define STALLED 0.3 // a frame further off was disturbed, and tells no more than one so far

prom_status prom_frame_step_init(prom_frame_step *step, prom_session *session,
                                 const char *selector, double budget_ms, double rule_scale,
                                 prom_error *error)
{
    *step = (prom_frame_step){.session = session, .rule_scale = rule_scale};
    const prom_guarantee_options options = {
        .budget_ms = budget_ms, .miss_rate = session->miss_rate, .frozen = session->frozen};
    prom_guarantee_init(&step->guarantee, &session->cost, &options);
    prom_last_cut_init(&step->last, &session->model);
    step->selector = prom_selector_create(selector, &session->model, error);
    const prom_selector_class *class = prom_selector_class_named(selector);
    step->reacts = class && class->budgeted && !class->uses_cost;
    prom_status status = step->selector ? PROM_OK : error->status;
    if (!status) status = prom_sight_init(&step->sight, session, error);
    if (!status)
        status = prom_resolution_init(&step->resolution, session, selector, NULL, error);
    if (status) prom_frame_step_finish(step);
    return status;
}

void prom_frame_step_finish(prom_frame_step *step)
{
    prom_cut_finish(&step->cut);
    prom_selector_destroy(step->selector);
    prom_sight_finish(&step->sight);
    prom_resolution_finish(&step->resolution);
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
    prom_cost_model cost =
        prom_cost_charged(prom_guarantee_cost(&step->guarantee), step->binds, 0);
    selection.cost = &cost;
    // A selector that reacts is not to be reacted for as well.
    if (step->reacts) selection.budget_ms = step->guarantee.options.budget_ms;
    selection.measured_ms = step->measured_ms;
    selection.certify = step->certify;
    selection.last = &step->last;
    if (step->last.number) selection.weighting.before = &before;
    if (same_pose(&before.camera, camera)) {
        selection.hysteresis = 0.0f;
        selection.max_switches = 0;
    }
    selection.weighting.dt_s = step->dt_s;
    prom_resolution_select(&step->resolution, step->selector, &selection, &step->cut);
    return prom_last_cut_note(&step->last, &step->cut);
}

static uint64_t hash_of(const prom_cut *cut)
{
    uint64_t hash = 0;
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        const uint32_t choice[2] = {e->node, e->rep};
        hash = prom_hash(choice, sizeof choice, hash);
    }
    return hash;
}

// What the cut says of itself.
static void describe(const prom_cut *cut, prom_frame_record *record)
{
    record->benefit_px = cut->benefit;
    record->loss_px = cut->loss;
    record->gap = prom_cut_gap(cut);
    record->cut_nodes = (uint32_t)cut->entries.count;
    record->cut_hash = hash_of(cut);
    record->limited = cut->limited;
}

// Counting takes a frame longer, always by about the same.
static void learn_counting(prom_frame_step *step, double draw_ms)
{
    double expected = step->guarantee.scale * step->cut.predicted_ms,
           stalled = STALLED * expected;
    double beyond = fmin(fmax(draw_ms - expected, -stalled), stalled);
    double *usual = &step->beyond_ms[step->counts];
    *usual += COUNTING_RATE * (beyond - *usual);
}

static double counting_ms(const prom_frame_step *step)
{
    const double *beyond = step->beyond_ms;
    bool known = beyond[false] != 0 && beyond[true] != 0;
    return known && step->counts ? fmax(beyond[true] - beyond[false], 0) : 0;
}

// What the frame may be predicted at, and what its prediction is corrected by, are those of its
// start: the feedback comes after it.
prom_frame_record prom_frame_step_draw(prom_frame_step *step, const prom_camera *camera,
                                       double start_ms)
{
    prom_session *s = step->session;
    prom_guarantee *guarantee = &step->guarantee;
    prom_frame_options plain = {0};

    prom_sight_begin(&step->sight, camera);
    step->counts = prom_sight_counts(&step->sight);
    prom_guarantee_set_extra(guarantee, counting_ms(step));
    double allowed = prom_guarantee_allowed(guarantee);
    prom_switches switches = choose(step, camera, allowed);
    double selected = prom_clock_ms();
    prom_resolution_draw(&step->resolution, &step->sight, &step->cut, camera, &plain);
    double end = prom_clock_ms();

    prom_draw_stats stats = prom_renderer_take_stats(s->renderer);
    step->binds = (double)stats.calls;
    prom_frame_record record = {
        .start_ms = start_ms,
        .frame_ms = end - start_ms,
        .select_ms = selected - start_ms,
        .draw_ms = end - selected,
        .predicted_ms = prom_guarantee_expected(guarantee, step->cut.predicted_ms),
        .allowed_ms = allowed,
        .scale = guarantee->scale,
        .margin = guarantee->margin,
        .resolution = prom_resolution_scale(&step->resolution),
        .triangles = (double)stats.triangles,
        .draws = (double)stats.draws,
        .switches = switches,
        .feasible = step->cut.cmin_ms <= allowed,
        .fits = prom_guarantee_expected(guarantee, step->cut.cmin_ms) + guarantee->charge_ms <=
                guarantee->options.budget_ms * (1 - guarantee->device.margin),
    };
    describe(&step->cut, &record);
    return record;
}

void prom_frame_step_feed(prom_frame_step *step, const prom_frame_record *record)
{
    prom_guarantee_frame frame = {.draw_ms = record->draw_ms,
                                  .other_ms = record->select_ms + record->display_ms,
                                  .aside = record->aside};
    memcpy(frame.terms_ms, step->cut.terms_ms, sizeof frame.terms_ms);
    if (!step->session->frozen) learn_counting(step, record->draw_ms);
    prom_guarantee_feed(&step->guarantee, &frame);
    // A selector that reacts to times gets the expected ones where measured ones must not
    // count.
    step->measured_ms = step->session->frozen ? record->predicted_ms : record->frame_ms;
}

void prom_frame_step_warm(prom_frame_step *step, const prom_camera *camera)
{
    for (int i = 0; i < WARM_FRAMES; i++) {
        prom_frame_record record = prom_frame_step_draw(step, camera, prom_clock_ms());
        record.aside = true;
        if (i + 1 == WARM_FRAMES) prom_frame_step_feed(step, &record);
    }
}
