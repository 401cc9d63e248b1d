#include "app/noise_floor.h"

#include "app/cut_change.h"
#include "app/statistics.h"
#include "app/still.h"
#include "metaobj/base/clock.h"

#include <math.h>

#define TARGET 0.9 // of the budget; by taste: what a frame with room for noise takes
#define NEAR 0.05  // relative distance from the target that will do
#define DRAWS 5    // of which the median counts
#define TRIES 6    // in a view
#define VIEWS 3

static double draw_once(prom_session *session, const prom_cut *cut, const prom_camera *camera)
{
    double start = prom_clock_ms();
    prom_session_draw(session, cut, camera, &(prom_frame_options){0});
    return prom_clock_ms() - start;
}

static double median_draw(prom_session *session, const prom_cut *cut, const prom_camera *camera)
{
    double ms[DRAWS];
    for (int i = 0; i < DRAWS; i++) ms[i] = draw_once(session, cut, camera);
    return prom_spread_of(ms, DRAWS).p50;
}

static double distance(double ms, double target_ms)
{
    return fabs(ms / target_ms - 1);
}

static void keep(prom_noise_floor *floor, const prom_still *still, double ms)
{
    floor->camera = still->camera;
    floor->frame = still->frame;
    floor->chosen_ms = ms;
    prom_cut_copy(&still->cut, &floor->cut);
}

// Looks in one view; the time that a cut is allowed follows what the last one took. True when
// what is kept is near enough.
static bool find_in_view(prom_noise_floor *floor, prom_still *still, uint32_t view)
{
    double before_ms = -1;
    still->allowed_ms = floor->target_ms;
    for (int i = 0; i < TRIES; i++) {
        prom_still_look(still, view);
        if (still->cut.predicted_ms == before_ms) return false; // there is no other cut
        before_ms = still->cut.predicted_ms;
        double ms = median_draw(still->session, &still->cut, &still->camera);
        bool first = !(floor->chosen_ms > 0);
        if (first ||
            distance(ms, floor->target_ms) < distance(floor->chosen_ms, floor->target_ms))
            keep(floor, still, ms);
        if (distance(floor->chosen_ms, floor->target_ms) < NEAR) return true;
        still->allowed_ms *= fmin(fmax(floor->target_ms / ms, 0.5), 2);
    }
    return false;
}

prom_status prom_noise_floor_init(prom_noise_floor *floor, prom_session *session,
                                  double budget_ms, uint32_t path_frames, prom_error *error)
{
    static const uint32_t order[VIEWS] = {1, 0, 2}; // the middle first
    const prom_still_options options = {.selector = PROM_SELECTOR_DEFAULT,
                                        .budget_ms = budget_ms,
                                        .rule_scale = 1,
                                        .path_frames = path_frames,
                                        .views = VIEWS};
    *floor = (prom_noise_floor){.target_ms = TARGET * budget_ms};
    prom_still still;
    prom_status status = prom_still_init(&still, session, &options, error);
    if (status) return status;
    bool found = false;
    for (uint32_t i = 0; i < VIEWS && !found; i++)
        if (order[i] < still.count) found = find_in_view(floor, &still, order[i]);
    prom_still_finish(&still);
    prom_renderer_take_stats(session->renderer);
    return PROM_OK;
}

void prom_noise_floor_finish(prom_noise_floor *floor)
{
    prom_cut_finish(&floor->cut);
    prom_array_finish(&floor->ms);
}

void prom_noise_floor_draw(prom_noise_floor *floor, prom_session *session)
{
    prom_array_push(&floor->ms, draw_once(session, &floor->cut, &floor->camera));
    prom_renderer_take_stats(session->renderer);
}
