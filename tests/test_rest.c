// LINK: prom_app
// NEEDS: promenade
//
// Refinement at rest on a street of boxes: it ends at the pixels of full detail, whatever a
// step may take, and leaves what the walk has learnt as it was. Skips without GL.
#include "app/rest.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/obj_street.h"
#include "tests/program_fixture.h"

#define WIDTH 320
#define HEIGHT 180
#define BYTES (WIDTH * HEIGHT * 4)
#define BUDGET_MS 1.5
#define MOST_STEPS 10000

static prom_session session;
static prom_frame_step step;
static prom_camera camera;
static uint8_t full[BYTES], shown[BYTES];

static int make_model(void **state)
{
    (void)state;
    if (!calibrate_small()) return 0;
    write_street("street.obj", 80, 0, 0);
    expect("build street.obj -o street.prom --quiet", 0);
    return 0;
}

// Costs at which the whole street takes many times the budget: its 960 triangles 9.6 ms.
static void set_costs(prom_cost_model *cost)
{
    *cost = (prom_cost_model){.fixed_ms = 0.1, .triangle_ms = 0.01, .sample_count = 1};
}

static int open_walk(void **state)
{
    (void)state;
    if (no_device) return 0;
    prom_error error = {0};
    prom_view_options view = prom_view_options_default;
    view.selector = "greedy";
    view.profile = "p.json";
    view.budget_ms = BUDGET_MS;
    view.size_px[0] = WIDTH;
    view.size_px[1] = HEIGHT;
    if (prom_session_open(&session, "street.prom", &view, true, 20, &error))
        fail_msg("%s", error.text);
    set_costs(&session.cost);
    camera = session.camera;
    const double from_above[3] = {36, 40, 80}, middle[3] = {36, 0, 24};
    memcpy(camera.eye, from_above, sizeof from_above);
    prom_camera_look_at(&camera, middle);
    if (prom_frame_step_init(&step, &session, "greedy", BUDGET_MS, 1, &error))
        fail_msg("%s", error.text);
    return 0;
}

static int close_walk(void **state)
{
    (void)state;
    if (no_device) return 0;
    prom_frame_step_finish(&step);
    prom_session_close(&session);
    return 0;
}

static void read_shown(uint8_t *rgba)
{
    prom_target_read_rgba(session.target, 0, 0, WIDTH, HEIGHT, rgba);
}

static prom_frame_record walk_frame(void)
{
    prom_frame_record record = prom_frame_step_draw(&step, &camera, 0);
    read_shown(shown);
    return record;
}

static void draw_full(void)
{
    prom_error error = {0};
    prom_cut cut = {0};
    prom_selector *selector = prom_selector_create("full", &session.model, &error);
    assert_non_null(selector);
    prom_session_select(&session, selector, NULL, &camera, INFINITY, 1, &cut);
    prom_session_draw(&session, &cut, &camera, &(prom_frame_options){0});
    read_shown(full);
    prom_cut_finish(&cut);
    prom_selector_destroy(selector);
}

static prom_rest new_rest(const char *selector, double budget_ms)
{
    prom_error error = {0};
    prom_rest rest;
    if (prom_rest_init(&rest, &step, selector, budget_ms, &error)) fail_msg("%s", error.text);
    return rest;
}

// Steps to the end; returns how many there were, and in `pictures` how many that showed
// something new.
static unsigned refine(prom_rest *rest, unsigned *pictures)
{
    unsigned steps = 0;
    *pictures = 0;
    for (; !prom_rest_is_done(rest) && steps < MOST_STEPS; steps++)
        *pictures += prom_rest_step(rest, &camera);
    assert_true(steps < MOST_STEPS);
    read_shown(shown);
    return steps;
}

static void it_ends_at_full_detail(void **state)
{
    (void)state;
    NEED_DEVICE();
    draw_full();
    walk_frame();
    assert_memory_not_equal(shown, full, BYTES);
    const double budgets[] = {0.5, 3, 5, 1000};
    unsigned last_steps = UINT32_MAX, pictures;
    for (int i = 0; i < 4; i++) {
        walk_frame();
        prom_rest rest = new_rest("greedy", budgets[i]);
        unsigned steps = refine(&rest, &pictures);
        assert_true(prom_rest_shows_all(&rest));
        assert_memory_equal(shown, full, BYTES);
        assert_true(steps <= last_steps); // more time a step, fewer of them
        assert_true(pictures >= 1);
        last_steps = steps;
        prom_rest_finish(&rest);
    }
}

// While full detail comes in parts, what is shown stays.
static void parts_are_not_shown(void **state)
{
    (void)state;
    NEED_DEVICE();
    static uint8_t before[BYTES];
    walk_frame();
    memcpy(before, shown, BYTES);
    prom_rest rest = new_rest("greedy", 0.5); // less than the budget: no frames between
    unsigned parts = 0;
    while (!prom_rest_is_done(&rest)) {
        read_shown(shown);
        assert_memory_equal(shown, before, BYTES);
        parts += rest.phase == PROM_REST_PARTS;
        prom_rest_step(&rest, &camera);
    }
    assert_true(parts > 5);
    prom_rest_finish(&rest);
}

// Whenever the camera moves, the next frame is the one that would have been without the rest.
static void a_movement_finds_everything_as_it_was(void **state)
{
    (void)state;
    NEED_DEVICE();
    session.visibility = PROM_SEE_NONE; // what is seen at rest may be used
    prom_frame_step_finish(&step);
    prom_error error = {0};
    assert_int_equal(prom_frame_step_init(&step, &session, "greedy", BUDGET_MS, 1, &error),
                     PROM_OK);
    uint64_t usual = walk_frame().cut_hash;
    prom_guarantee before = step.guarantee;
    for (unsigned steps = 0; steps < 12; steps++) {
        prom_rest rest = new_rest("greedy", 4);
        for (unsigned i = 0; i < steps; i++) prom_rest_step(&rest, &camera);
        prom_rest_end(&rest);
        prom_frame_record record = walk_frame();
        assert_true(record.cut_hash == usual);
        assert_int_equal(record.switches.count, 0);
        assert_memory_equal(&step.guarantee, &before, sizeof before);
        prom_rest_finish(&rest);
    }
}

static void it_can_be_off(void **state)
{
    (void)state;
    NEED_DEVICE();
    prom_rest off = new_rest("greedy", 0), coarse = new_rest("coarsest", 100);
    assert_true(prom_rest_is_done(&off) && !prom_rest_shows_all(&off));
    assert_true(prom_rest_is_done(&coarse) && !prom_rest_shows_all(&coarse));
    prom_rest_finish(&off);
    prom_rest_finish(&coarse);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(it_ends_at_full_detail, open_walk, close_walk),
        cmocka_unit_test_setup_teardown(parts_are_not_shown, open_walk, close_walk),
        cmocka_unit_test_setup_teardown(a_movement_finds_everything_as_it_was, open_walk,
                                        close_walk),
        cmocka_unit_test_setup_teardown(it_can_be_off, open_walk, close_walk),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, make_model, NULL);
    leave_scratch();
    return failed;
}
