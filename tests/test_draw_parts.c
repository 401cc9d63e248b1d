// LINK: prom_render prom_metaobj
//
// A draw list drawn in parts: the same pixels as in one go, and parts that cost what was asked.
// Skips without GL.
#include "tests/render_fixture.h"

#define SIZE 64
#define SQUARES 24
#define BYTES (SIZE * SIZE * 4)

static const prom_material materials[] = {
    {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE},
    {.base_color = {1, 1, 1, 0.4f}, .texture = PROM_NONE, .alpha_mode = PROM_ALPHA_BLEND},
};

// Squares that cover each other, some in one plane, some see-through, one far behind: order
// decides what is seen of them.
static void fill_list(void)
{
    prom_renderer_set_materials(fix.renderer, materials, 2);
    for (uint32_t i = 0; i < SQUARES; i++) {
        const uint8_t color[4] = {(uint8_t)(40 + 9 * i), (uint8_t)(i * 53), (uint8_t)(i * 97),
                                  255};
        uint32_t mesh = add_square(color, i % 3 == 2);
        float x = (float)(i % 5) * 0.3f - 0.6f, y = (float)(i % 7) * 0.2f - 0.6f;
        prom_draw_item item = item_at(mesh, x, y, (float)(i / 4), 0.4f);
        item.id = i;
        item.cost_ms = 1;
        item.background = i == SQUARES - 1;
        item.hidden = i % 6 == 1;
        prom_draw_list_add(fix.list, &item);
    }
    prom_draw_list_prepare(fix.list);
}

static void draw_in_parts(prom_target *target, double cost_ms, uint8_t *rgba)
{
    prom_pass pass = pass_parallel(SIZE);
    size_t length = prom_draw_list_length(fix.list);
    prom_target_clear(target, clear_none);
    for (size_t first = 0; first < length; first = pass.end) {
        pass.first = first;
        pass.end = prom_draw_list_part(fix.list, first, cost_ms);
        assert_true(pass.end > first && pass.end <= length);
        assert_true((double)(pass.end - first) <= fmax(cost_ms, 1));
        prom_draw_list_submit(fix.list, target, &pass);
        prom_renderer_finish(fix.renderer);
    }
    prom_target_read_rgba(target, 0, 0, SIZE, SIZE, rgba);
}

static void parts_have_the_pixels_of_the_whole(void **state)
{
    NEEDS_GL(state);
    static uint8_t whole[BYTES], parts[BYTES];
    prom_target *target = make_target(SIZE, SIZE, true);
    fill_list();
    draw_in_parts(target, INFINITY, whole);
    prom_draw_stats once = prom_renderer_take_stats(fix.renderer);
    assert_int_equal(once.triangles, 2 * SQUARES);
    const double costs[] = {0, 1, 2.5, 7};
    for (size_t i = 0; i < sizeof costs / sizeof *costs; i++) {
        draw_in_parts(target, costs[i], parts);
        assert_memory_equal(parts, whole, BYTES);
        prom_draw_stats stats = prom_renderer_take_stats(fix.renderer);
        assert_int_equal(stats.triangles, once.triangles);
        assert_int_equal(stats.draws, once.draws);
        assert_int_equal(stats.vertices, once.vertices);
    }
    prom_target_destroy(target);
}

static void colours_are_copied_and_scaled(void **state)
{
    NEEDS_GL(state);
    static uint8_t from[BYTES], to[BYTES];
    prom_target *a = make_target(SIZE, SIZE, true), *b = make_target(SIZE, SIZE, false);
    prom_target *half = make_target(SIZE / 2, SIZE / 2, true);
    fill_list();
    draw_in_parts(a, INFINITY, from);
    prom_target_copy_colors(b, a);
    prom_target_read_rgba(b, 0, 0, SIZE, SIZE, to);
    assert_memory_equal(to, from, BYTES);
    const uint8_t red[4] = {200, 10, 30, 255};
    prom_target_clear(half, red);
    prom_target_copy_colors(b, half);
    prom_target_read_rgba(b, 0, 0, SIZE, SIZE, to);
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) assert_near(pixel(to, SIZE, x, y), red, 1);
    prom_target_destroy(a);
    prom_target_destroy(b);
    prom_target_destroy(half);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(parts_have_the_pixels_of_the_whole),
        cmocka_unit_test(colours_are_copied_and_scaled),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
