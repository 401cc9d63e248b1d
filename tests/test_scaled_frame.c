// LINK: prom_app
// NEEDS: promenade
//
// Frames drawn smaller and scaled up, on a street of boxes: the picture stays where it was,
// what is counted of it too, and a cut that does not fit otherwise does. Skips without GL.
#include "app/frame_step.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "tests/obj_street.h"
#include "tests/program_fixture.h"

#define WIDTH 320
#define HEIGHT 180
#define PIXELS (WIDTH * HEIGHT)

static prom_session session;
static prom_camera camera;

static int make_model(void **state)
{
    (void)state;
    if (!calibrate_small()) return 0;
    write_street("street.obj", 40, 0, 0);
    expect("build street.obj -o street.prom --quiet", 0);
    return 0;
}

// Costs of a device that fills slowly: the screen takes `fill_ms`, of which the
// street covers a fifth.
static prom_frame_step open_step(double min_scale, double fill_ms, double budget_ms)
{
    prom_error error = {0};
    prom_view_options view = prom_view_options_default;
    view.selector = "greedy";
    view.profile = "p.json";
    view.budget_ms = budget_ms;
    view.min_scale = min_scale;
    view.size_px[0] = WIDTH;
    view.size_px[1] = HEIGHT;
    if (prom_session_open(&session, "street.prom", &view, true, 20, &error))
        fail_msg("%s", error.text);
    session.cost = (prom_cost_model){.fixed_ms = 0.1, .sample_count = 1};
    for (int i = 0; i < PROM_COST_KINDS; i++) session.cost.pixel_ms[i] = fill_ms / PIXELS;
    session.cost.pixel_ms[PROM_SHADE_TEXTURED] /= 20; // scaling up
    camera = session.camera;
    const double above[3] = {36, 30, 50}, middle[3] = {36, 0, 12};
    memcpy(camera.eye, above, sizeof above);
    prom_camera_look_at(&camera, middle);
    prom_frame_step step;
    if (prom_frame_step_init(&step, &session, "greedy", budget_ms, 1, &error))
        fail_msg("%s", error.text);
    return step;
}

static void close_step(prom_frame_step *step)
{
    prom_frame_step_finish(step);
    prom_session_close(&session);
}

static prom_frame_record draw(prom_frame_step *step, int frames, uint8_t *rgba)
{
    prom_frame_record record = {0};
    for (int i = 0; i < frames; i++) record = prom_frame_step_draw(step, &camera, 0);
    prom_target_read_rgba(session.target, 0, 0, WIDTH, HEIGHT, rgba);
    return record;
}

// Of 255.
static double mean_difference(const uint8_t *a, const uint8_t *b)
{
    double sum = 0;
    for (size_t i = 0; i < 4 * PIXELS; i++) sum += abs(a[i] - b[i]);
    return sum / (4 * PIXELS);
}

static double visible_px(const prom_frame_step *step)
{
    double sum = 0;
    for (size_t i = 0; i < step->cut.entries.count; i++)
        sum += (double)step->cut.entries.data[i].visible_px;
    return sum;
}

static void what_does_not_fit_fits_when_it_is_smaller(void **state)
{
    (void)state;
    NEED_DEVICE();
    static uint8_t whole[4 * PIXELS], scaled[4 * PIXELS];
    prom_frame_step native = open_step(1, 20, 3);
    prom_frame_record before = draw(&native, 24, whole);
    double px = visible_px(&native);
    assert_true(before.resolution == 1 && !before.feasible);
    close_step(&native);
    prom_frame_step smaller = open_step(0.5, 20, 3);
    prom_frame_record after = draw(&smaller, 24, scaled);
    assert_true(after.resolution < 1 && after.feasible);
    assert_true(after.predicted_ms < before.predicted_ms);
    // Counted in pixels of the whole picture.
    assert_true(fabs(visible_px(&smaller) / px - 1) < 0.2);
    // Turned, mirrored or in a corner of the target, it would be another picture.
    double difference = mean_difference(whole, scaled);
    assert_true(difference > 0 && difference < 8);
    for (unsigned i = 1; i < PROM_SCALES; i++)
        assert_true(smaller.resolution.scaling.scales[i].loss > 0);
    close_step(&smaller);
}

static void what_fits_stays_as_it_is(void **state)
{
    (void)state;
    NEED_DEVICE();
    static uint8_t whole[4 * PIXELS], allowed[4 * PIXELS];
    prom_frame_step native = open_step(1, 1, 100);
    draw(&native, 3, whole);
    close_step(&native);
    prom_frame_step may = open_step(0.5, 1, 100);
    assert_true(draw(&may, 50, allowed).resolution == 1);
    assert_memory_equal(whole, allowed, sizeof whole);
    close_step(&may);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_does_not_fit_fits_when_it_is_smaller),
        cmocka_unit_test(what_fits_stays_as_it_is),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, make_model, NULL);
    leave_scratch();
    return failed;
}
