// LINK: prom_render prom_metaobj
// The timer and the calibration: what they report, not how fast this machine is.
#include "tests/render_fixture.h"

#include "render/calibrate.h"
#include "render/timer.h"

static void timer_measures_time(void **state)
{
    NEEDS_GL(state);
    prom_timer *timer = prom_timer_create(fix.renderer);
    prom_target *target = make_target(256, 256, false);
    prom_timer_begin(timer);
    prom_target_clear(target, clear_none);
    double ms = prom_timer_end(timer);
    assert_true(ms >= 0 && ms < 60e3);
    assert_int_equal(prom_renderer_mesh_count(fix.renderer), 0);
    // Known from measurement: the queries of Mesa's rasteriser on the CPU report too little.
    if (strstr(prom_context_renderer(fix.context), "llvmpipe"))
        assert_false(prom_timer_uses_queries(timer));
    prom_target_destroy(target);
    prom_timer_destroy(timer);
}

static void calibration_covers_all_features(void **state)
{
    NEEDS_GL(state);
    static const uint8_t color[4] = {10, 200, 30, 255};
    const prom_material material = {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE};
    prom_renderer_set_materials(fix.renderer, &material, 1);
    uint32_t kept = add_square(color, 0);
    prom_timer *timer = prom_timer_create(fix.renderer);
    prom_cost_samples samples = {0};
    double noise = -1;
    prom_error error = {0};
    assert_int_equal(
        prom_calibrate_run(fix.renderer, timer, 320, 180, 1, &samples, &noise, &error),
        PROM_OK);
    assert_true(samples.count >= 60);
    assert_true(noise >= 0 && isfinite(noise));
    prom_cost_features most = {0};
    for (size_t i = 0; i < samples.count; i++) {
        const prom_cost_features *f = &samples.data[i].features;
        assert_true(samples.data[i].ms > 0 && f->fixed == 1);
        assert_true(f->draws <= 2000 && f->triangles <= 400000);
        most.draws = fmax(most.draws, f->draws);
        most.vertices = fmax(most.vertices, f->vertices);
        most.triangles = fmax(most.triangles, f->triangles);
        int shadings = 0;
        most.hidden = fmax(most.hidden, f->hidden);
        most.edges = fmax(most.edges, f->edges);
        most.binds = fmax(most.binds, f->binds);
        most.upload_bytes = fmax(most.upload_bytes, f->upload_bytes);
        assert_true(f->binds <= f->draws && (f->draws > 0) == (f->binds > 0));
        // Uploads come alone, and changes of state with little else.
        assert_true(!(f->upload_bytes > 0 && f->draws > 0));
        assert_true(f->binds <= 1 || (f->draws <= 512 && f->triangles <= 512 * 12));
        for (int s = 0; s < PROM_COST_KINDS; s++) {
            most.pixels[s] = fmax(most.pixels[s], f->pixels[s]);
            shadings += f->pixels[s] > 0 && (s == PROM_SHADE_PLAIN ? f->binds <= 1 : true);
            // Impostors stand side by side; of the others up to six layers are drawn front to
            // back, and only within a layer one may be shaded over another.
            bool impostor = s == PROM_SHADE_IMPOSTOR || s == PROM_COST_IMPOSTOR_LIT;
            assert_true(!impostor || f->pixels[s] <= 320 * 180);
            bool hides = s == PROM_SHADE_PLAIN || s == PROM_SHADE_TEXTURED;
            assert_true(!hides || f->pixels[s] < 2 * 320 * 180);
            assert_true(s != PROM_SHADE_BLENDED || f->pixels[s] == 0 || f->hidden == 0);
        }
        assert_true(shadings <= 1);
    }
    assert_true(most.draws >= 500 && most.triangles >= 100000 && most.vertices >= 50000);
    // Behind up to five layers.
    assert_true(most.hidden > 1.5 * 320 * 180 && most.hidden < 5.0 * 320 * 180);
    assert_true(most.edges > 320 * 180 && isfinite(most.edges));
    assert_true(most.binds > 50);
    assert_true(most.upload_bytes > 2e6 && most.upload_bytes <= 8e6);
    for (int s = 0; s < PROM_COST_KINDS; s++) assert_true(most.pixels[s] > 0.25 * 320 * 180);
    assert_true(most.pixels[PROM_SHADE_BLENDED] > 320 * 180 * 0.7);

    // What stood before stands still.
    assert_int_equal(prom_renderer_mesh_count(fix.renderer), 1);
    assert_int_equal(prom_renderer_texture_count(fix.renderer), 0);
    prom_target *target = make_target(8, 8, false);
    prom_draw_item item = item_at(kept, 0, 0, 0, 1);
    prom_draw_list_add(fix.list, &item);
    prom_pass pass = pass_parallel(8);
    pass.output = PROM_OUTPUT_ALBEDO;
    draw(target, &pass);
    uint8_t rgba[4];
    prom_target_read_rgba(target, 4, 4, 1, 1, rgba);
    assert_near(rgba, color, 1);
    assert_int_equal(
        prom_calibrate_run(fix.renderer, timer, 320, 180, 9, &samples, &noise, &error),
        PROM_ERR_USAGE);
    prom_target_destroy(target);
    prom_timer_destroy(timer);
    prom_array_finish(&samples);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(timer_measures_time),
        cmocka_unit_test(calibration_covers_all_features),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
