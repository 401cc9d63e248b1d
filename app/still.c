#include "app/still.h"

#define SETTLE_FRAMES 8 // until what frames show of each other has settled

prom_status prom_still_init(prom_still *still, prom_session *session,
                            const prom_still_options *options, prom_error *error)
{
    uint32_t count = options->views;
    if (count > options->path_frames) count = options->path_frames;
    *still = (prom_still){.session = session, .options = options, .count = count};
    still->allowed_ms = prom_session_allowed_ms(session, options->budget_ms);
    prom_status status = prom_sight_init(&still->sight, session, error);
    if (status) return status;
    still->selector = prom_selector_create(options->selector, &session->model, error);
    if (!still->selector) {
        prom_sight_finish(&still->sight);
        return error->status;
    }
    prom_eval_init(&still->eval, &session->model);
    still->eval.any_mesh_hides = true; // as the selectors have it
    return PROM_OK;
}

void prom_still_finish(prom_still *still)
{
    prom_selector_destroy(still->selector);
    prom_sight_finish(&still->sight);
    prom_eval_finish(&still->eval);
    prom_cut_finish(&still->cut);
}

static void settle(prom_still *s)
{
    const prom_frame_options plain = {0};
    for (int i = 0;; i++) {
        prom_sight_begin(&s->sight, &s->camera);
        s->selection = prom_session_selection(s->session, &s->view, s->sight.visibility,
                                              s->allowed_ms, s->options->rule_scale);
        prom_selector_run(s->selector, &s->selection, &s->cut);
        if (i == SETTLE_FRAMES || !s->sight.counter) return;
        prom_sight_draw(&s->sight, &s->cut, &s->camera, &plain);
    }
}

void prom_still_look(prom_still *still, uint32_t i)
{
    prom_still *s = still;
    s->frame = (uint32_t)((2 * (uint64_t)i + 1) * s->options->path_frames / (2 * s->count));
    s->camera = s->session->camera;
    prom_path_pose(&s->session->path, s->frame, &s->camera);
    prom_view_init(&s->view, &s->camera);
    settle(s);
    prom_eval_run(&s->eval, &s->selection, NULL, NULL);
}
