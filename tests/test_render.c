// LINK: prom_render prom_metaobj
// Where things land, what hides what, and that many draws are the same as one after the other.
#include "tests/render_fixture.h"

#define SIZE 64u

static const uint8_t red[4] = {255, 0, 0, 255}, green[4] = {0, 255, 0, 255},
                     blue[4] = {0, 0, 255, 255};
static uint8_t rgba[4 * SIZE * SIZE];
static uint32_t ids[SIZE * SIZE];

static void read_all(prom_target *target)
{
    prom_target_read_rgba(target, 0, 0, SIZE, SIZE, rgba);
}

static void clear_is_read_back_exactly(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    for (int v = 0; v < 256; v++) {
        const uint8_t color[4] = {(uint8_t)v, (uint8_t)(255 - v), (uint8_t)(v ^ 85),
                                  (uint8_t)v};
        prom_target_clear(target, color);
        prom_target_read_rgba(target, SIZE / 2, 3, 1, 1, rgba);
        assert_near(rgba, color, 0);
    }
    prom_target_destroy(target);
}

static void impossible_targets_are_refused(void **state)
{
    NEEDS_GL(state);
    prom_error error = {0};
    assert_null(prom_target_create(0, 10, false, &error));
    assert_int_equal(error.status, PROM_ERR_USAGE);
    assert_null(prom_target_create(1u << 30, 10, true, &error));
    assert_non_null(strstr(error.text, "1073741824"));
}

// A camera turned and moved: a small square in front of pixel (x, y) shows there and nowhere
// else.
static void square_lands_at_its_pixel(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    uint32_t square = add_square(red, PROM_NONE);
    prom_camera camera = {.orientation = {0, 0, 0, 1},
                          .fov_y = 1.0f,
                          .z_near = 0.1f,
                          .width = SIZE,
                          .height = SIZE};
    prom_pass pass = {.width = SIZE, .height = SIZE, .output = PROM_OUTPUT_ALBEDO};
    prom_camera_projection(&camera, pass.projection);
    const uint32_t x = 50, y = 9; // from the top left
    float distance = 7, pixel_size = 2 * tanf(0.5f) * distance / SIZE;
    prom_draw_item item =
        item_at(square, ((float)x + 0.5f - SIZE / 2) * pixel_size,
                (SIZE / 2 - (float)y - 0.5f) * pixel_size, -distance, 0.5f * pixel_size);
    prom_draw_list_add(fix.list, &item);
    draw(target, &pass);
    read_all(target);
    for (uint32_t i = 0; i < SIZE * SIZE; i++)
        assert_near(rgba + 4 * i, i == y * SIZE + x ? red : clear_none, 0);
    prom_target_destroy(target);
}

static void camera_looks_where_it_is_turned(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    uint32_t square = add_square(red, PROM_NONE);
    prom_camera camera = {.fov_y = 1.0f, .z_near = 0.1f, .width = SIZE, .height = SIZE};
    const double at[3] = {-10, 0, 0};
    prom_camera_look_at(&camera, at); // along -x
    prom_pass pass = {.width = SIZE, .height = SIZE, .output = PROM_OUTPUT_ALBEDO};
    prom_camera_projection(&camera, pass.projection);
    // Turned to face +x, above the line of sight.
    prom_draw_item item = item_at(square, -10, 3, 0, 1);
    const float turn[9] = {0, 0, -1, 0, 1, 0, 1, 0, 0};
    memcpy(item.basis, turn, sizeof turn);
    prom_draw_list_add(fix.list, &item);
    draw(target, &pass);
    read_all(target);
    uint32_t row = (uint32_t)(SIZE / 2 - 0.3f / tanf(0.5f) * SIZE / 2);
    assert_near(pixel(rgba, SIZE, SIZE / 2, row), red, 0);
    assert_near(pixel(rgba, SIZE, SIZE / 2, SIZE - 1 - row), clear_none, 0);
    prom_target_destroy(target);
}

static void backs_are_not_drawn_unless_asked_for(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    const prom_material materials[2] = {
        {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE},
        {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE, .double_sided = 1}};
    prom_renderer_set_materials(fix.renderer, materials, 2);
    prom_pass pass = pass_parallel(SIZE);
    pass.output = PROM_OUTPUT_ALBEDO;
    for (int mirrored = 0; mirrored < 2; mirrored++)
        for (int turned = 0; turned < 2; turned++)
            for (uint32_t material = 0; material < 2; material++) {
                prom_draw_item item = item_at(add_square(red, material), 0, 0, 0, 1);
                // Mirroring in x keeps a face towards where it faces; turning about y does not.
                if (mirrored) item.basis[0] *= -1;
                if (turned) item.basis[0] *= -1, item.basis[8] *= -1;
                prom_draw_list_add(fix.list, &item);
                draw(target, &pass);
                read_all(target);
                assert_near(pixel(rgba, SIZE, SIZE / 2, SIZE / 2),
                            turned && !material ? clear_none : red, 0);
            }
    prom_target_destroy(target);
}

static void ids_stand_where_things_are(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, true);
    uint32_t square = add_square(red, PROM_NONE);
    prom_draw_item left = item_at(square, -0.5f, 0, 0, 0.25f);
    prom_draw_item right = item_at(square, 0.5f, 0, 0, 0.25f);
    left.id = 7;
    right.id = 0xfffffffe;
    prom_draw_list_add(fix.list, &left);
    prom_draw_list_add(fix.list, &right);
    prom_pass pass = pass_parallel(SIZE);
    draw(target, &pass);
    prom_target_read_ids(target, 0, 0, SIZE, SIZE, ids);
    uint32_t counts[3] = {0};
    for (uint32_t i = 0; i < SIZE * SIZE; i++) {
        assert_true(ids[i] == 7 || ids[i] == 0xfffffffe || ids[i] == PROM_NONE);
        counts[ids[i] == 7 ? 0 : ids[i] == 0xfffffffe ? 1 : 2]++;
    }
    assert_int_equal(counts[0], SIZE * SIZE / 16);
    assert_int_equal(counts[1], SIZE * SIZE / 16);
    assert_int_equal(ids[SIZE / 2 * SIZE + SIZE / 4], 7);
    prom_target_destroy(target);
}

// One part in ten thousand nearer is in front, at any distance and in any order of drawing.
static void nearer_hides_farther(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    uint32_t front = add_square(red, PROM_NONE), back = add_square(green, PROM_NONE);
    prom_camera camera = {.orientation = {0, 0, 0, 1},
                          .fov_y = 1.0f,
                          .z_near = 0.05f,
                          .width = SIZE,
                          .height = SIZE};
    prom_pass pass = {.width = SIZE, .height = SIZE, .output = PROM_OUTPUT_ALBEDO};
    prom_camera_projection(&camera, pass.projection);
    for (float z = 0.1f; z < 2e5f; z *= 3)
        for (int order = 0; order < 2; order++) {
            prom_draw_item a = item_at(front, 0, 0, -z, z);
            prom_draw_item b = item_at(back, 0, 0, -z * 1.0001f, z);
            a.depth = order ? 1 : 2; // right and wrong
            b.depth = order ? 2 : 1;
            prom_draw_list_add(fix.list, &a);
            prom_draw_list_add(fix.list, &b);
            draw(target, &pass);
            read_all(target);
            assert_near(pixel(rgba, SIZE, SIZE / 2, SIZE / 2), red, 0);
        }
    prom_target_destroy(target);
}

static void background_is_behind_and_leaves_no_trace(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, true);
    prom_pass pass = pass_parallel(SIZE);
    pass.output = PROM_OUTPUT_ALBEDO;
    prom_draw_item far = item_at(add_square(red, PROM_NONE), -0.5f, 0, -9, 0.5f);
    prom_draw_item near_hill = item_at(add_square(green, PROM_NONE), 0, 0, 9, 1);
    prom_draw_item far_hill = item_at(add_square(blue, PROM_NONE), 0, 0, 8, 1);
    near_hill.background = far_hill.background = true;
    near_hill.id = far_hill.id = 3;
    far.id = 5;
    prom_draw_list_add(fix.list, &near_hill);
    prom_draw_list_add(fix.list, &far_hill);
    prom_draw_list_add(fix.list, &far);
    draw(target, &pass);
    read_all(target);
    prom_target_read_ids(target, 0, 0, SIZE, SIZE, ids);
    const uint8_t green_without_alpha[4] = {0, 255, 0, 0};
    assert_near(pixel(rgba, SIZE, 5, SIZE / 2), red, 0);
    assert_near(pixel(rgba, SIZE, SIZE - 5, SIZE / 2), green_without_alpha, 0);
    assert_int_equal(ids[SIZE / 2 * SIZE + 5], 5);
    assert_int_equal(ids[SIZE / 2 * SIZE + SIZE - 5], PROM_NONE);
    prom_target_destroy(target);
}

static void see_through_layers_add_up(void **state)
{
    NEEDS_GL(state);
    const prom_material glass = {
        .base_color = {1, 1, 1, 0.5f}, .texture = PROM_NONE, .alpha_mode = PROM_ALPHA_BLEND};
    prom_renderer_set_materials(fix.renderer, &glass, 1);
    uint32_t panes[2] = {add_square(red, 0), add_square(green, 0)};
    uint32_t wall = add_square(blue, PROM_NONE);
    for (int with_ids = 0; with_ids < 2; with_ids++) {
        prom_target *target = make_target(SIZE, SIZE, with_ids);
        prom_pass pass = pass_parallel(SIZE);
        pass.output = PROM_OUTPUT_ALBEDO;
        // Red pane over green pane over a wall in the left half; added in the wrong order.
        prom_draw_item items[3] = {item_at(panes[0], 0, 0, 2, 1), item_at(panes[1], 0, 0, 1, 1),
                                   item_at(wall, -1, 0, 0, 1)};
        for (int i = 0; i < 3; i++) {
            items[i].id = (uint32_t)i;
            prom_draw_list_add(fix.list, &items[i]);
        }
        draw(target, &pass);
        read_all(target);
        // Half of each, on encoded colours as in most programs that paint.
        const uint8_t over_wall[4] = {128, 64, 64, 255};
        const uint8_t over_clear[4] = {over_wall[0], over_wall[1], 0, 255};
        assert_near(pixel(rgba, SIZE, 5, SIZE / 2), over_wall, 1);
        assert_near(pixel(rgba, SIZE, SIZE - 5, SIZE / 2), over_clear, 1);
        if (with_ids) {
            prom_target_read_ids(target, 0, 0, SIZE, SIZE, ids);
            assert_int_equal(ids[5], 0);
        }
        prom_target_destroy(target);
    }
}

static void truncating_keeps_what_was_before(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, false);
    uint32_t kept = add_square(red, PROM_NONE);
    uint64_t bytes = prom_renderer_bytes(fix.renderer);
    for (int round = 0; round < 3; round++) {
        for (int i = 0; i < 4000; i++) add_square(green, PROM_NONE);
        for (uint32_t size = 4; size < 300; size *= 2) {
            prom_texture texture;
            prom_texture_init(&texture, PROM_TEXTURE_IMPOSTOR_ALBEDO, size, size + 1);
            prom_renderer_add_texture(fix.renderer, &texture);
            prom_texture_finish(&texture);
        }
        assert_int_equal(prom_renderer_mesh_count(fix.renderer), 4001);
        assert_int_equal(prom_renderer_texture_count(fix.renderer), 7);
        assert_true(prom_renderer_bytes(fix.renderer) > bytes);
        prom_renderer_truncate(fix.renderer, 1, 0);
    }
    uint32_t next = add_square(blue, PROM_NONE);
    assert_int_equal(next, 1);
    prom_draw_item a = item_at(kept, -0.5f, 0, 0, 0.4f), b = item_at(next, 0.5f, 0, 0, 0.4f);
    prom_draw_list_add(fix.list, &a);
    prom_draw_list_add(fix.list, &b);
    prom_pass pass = pass_parallel(SIZE);
    pass.output = PROM_OUTPUT_ALBEDO;
    draw(target, &pass);
    read_all(target);
    assert_near(pixel(rgba, SIZE, SIZE / 4, SIZE / 2), red, 0);
    assert_near(pixel(rgba, SIZE, 3 * SIZE / 4, SIZE / 2), blue, 0);
    prom_target_destroy(target);
}

static float unit(uint32_t *seed)
{
    *seed = *seed * 1664525u + 1013904223u;
    return (float)(*seed >> 8) / 16777216.0f;
}

// Squares of several states, turned about and mirrored, in a box of space.
static prom_draw_item random_item(const uint32_t meshes[4], uint32_t i, uint32_t *seed)
{
    prom_draw_item item =
        item_at(meshes[i % 4], 2 * unit(seed) - 1, 2 * unit(seed) - 1, 16 * unit(seed) - 8, 1);
    item.id = i;
    for (int k = 0; k < 9; k++) item.basis[k] = 0.3f * (unit(seed) - 0.5f);
    return item;
}

static void many_draws_equal_single_ones(void **state)
{
    NEEDS_GL(state);
    static uint8_t single[4 * SIZE * SIZE];
    static uint32_t single_ids[SIZE * SIZE];
    enum { COUNT = 1000 };
    prom_material materials[2] = {
        {.base_color = {1, 0.5f, 0.2f, 1}, .texture = PROM_NONE, .double_sided = 1},
        {.base_color = {1, 1, 1, 1}, .texture = PROM_NONE, .alpha_mode = PROM_ALPHA_MASK}};
    prom_renderer_set_materials(fix.renderer, materials, 2);
    uint32_t meshes[4] = {add_square(red, PROM_NONE), add_square(green, PROM_NONE),
                          add_square(blue, 0), add_square(green, 1)};
    prom_target *target = make_target(SIZE, SIZE, true);
    prom_pass pass = pass_parallel(SIZE);
    uint32_t seed = 1;
    prom_target_clear(target, clear_none);
    for (uint32_t i = 0; i < COUNT; i++) {
        prom_draw_item item = random_item(meshes, i, &seed);
        prom_draw_list_add(fix.list, &item);
        draw_over(target, &pass);
    }
    prom_target_read_rgba(target, 0, 0, SIZE, SIZE, single);
    prom_target_read_ids(target, 0, 0, SIZE, SIZE, single_ids);
    prom_draw_stats stats = prom_renderer_take_stats(fix.renderer);
    assert_int_equal(stats.draws, COUNT);
    assert_int_equal(stats.calls, COUNT);

    seed = 1;
    for (uint32_t i = 0; i < COUNT; i++) {
        prom_draw_item item = random_item(meshes, i, &seed);
        prom_draw_list_add(fix.list, &item);
    }
    draw(target, &pass);
    read_all(target);
    prom_target_read_ids(target, 0, 0, SIZE, SIZE, ids);
    assert_memory_equal(rgba, single, sizeof rgba);
    assert_memory_equal(ids, single_ids, sizeof ids);
    stats = prom_renderer_take_stats(fix.renderer);
    assert_int_equal(stats.draws, COUNT);
    assert_int_equal(stats.vertices, 4 * COUNT);
    assert_int_equal(stats.triangles, 2 * COUNT);
    assert_true(stats.calls < 8 * 8);
    prom_target_destroy(target);
}

// Views side by side in one target, as bakes are drawn: nothing leaks out of its own.
static void passes_stay_in_their_rectangle(void **state)
{
    NEEDS_GL(state);
    prom_target *target = make_target(SIZE, SIZE, true);
    prom_draw_item item = item_at(add_square(red, PROM_NONE), 0.3f, -0.2f, 0, 5);
    item.id = 1;
    prom_draw_list_add(fix.list, &item);
    prom_draw_list_prepare(fix.list);
    prom_target_clear(target, clear_none);
    prom_pass pass = pass_parallel(0);
    pass.x = 16, pass.y = 8, pass.width = 24, pass.height = 32;
    prom_draw_list_submit(fix.list, target, &pass);
    prom_target_read_ids(target, 0, 0, SIZE, SIZE, ids);
    for (uint32_t y = 0; y < SIZE; y++)
        for (uint32_t x = 0; x < SIZE; x++) {
            uint32_t up = SIZE - 1 - y;
            bool inside = x >= 16 && x < 40 && up >= 8 && up < 40;
            assert_int_equal(ids[y * SIZE + x], inside ? 1 : PROM_NONE);
        }
    // Reading a part counts from the bottom left as well.
    uint32_t corner[2];
    prom_target_read_ids(target, 15, 8, 2, 1, corner);
    assert_int_equal(corner[0], PROM_NONE);
    assert_int_equal(corner[1], 1);
    prom_target_destroy(target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(clear_is_read_back_exactly),
        cmocka_unit_test(impossible_targets_are_refused),
        cmocka_unit_test(square_lands_at_its_pixel),
        cmocka_unit_test(camera_looks_where_it_is_turned),
        cmocka_unit_test(backs_are_not_drawn_unless_asked_for),
        cmocka_unit_test(ids_stand_where_things_are),
        cmocka_unit_test(nearer_hides_farther),
        cmocka_unit_test(background_is_behind_and_leaves_no_trace),
        cmocka_unit_test(see_through_layers_add_up),
        cmocka_unit_test(truncating_keeps_what_was_before),
        cmocka_unit_test(many_draws_equal_single_ones),
        cmocka_unit_test(passes_stay_in_their_rectangle),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
