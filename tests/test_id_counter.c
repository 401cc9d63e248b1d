// LINK: prom_render prom_metaobj
// Counting ids: what is counted is what a target shows; whose ids it gets; the ring; hidden
// items.
#include "tests/random_model.h"
#include "tests/render_fixture.h"

#include "render/id_counter.h"

#define IDS 40u
#define WALL 11u
#define PANE 22u
#define SIZE 64u
#define PHASES (PROM_ID_STEP * PROM_ID_STEP)

static const uint8_t grey[4] = {120, 120, 120, 255};

static prom_id_counter *make_counter(uint32_t id_count)
{
    prom_error error = {0};
    prom_id_counter *counter = prom_id_counter_create(id_count, &error);
    if (!counter) fail_msg("%s", error.text);
    return counter;
}

// Squares of any size and place, a few ids for many of them, over and behind each other; one
// id is past the counter's.
static void draw_squares(prom_target *target, uint32_t width, uint32_t height, uint64_t seed)
{
    uint32_t square = add_square(grey, PROM_NONE);
    for (uint32_t i = 0; i <= IDS; i++) {
        prom_draw_item item =
            item_at(square, random_between(&seed, -1, 1), random_between(&seed, -1, 1),
                    random_between(&seed, -9, 9), random_between(&seed, 0.02f, 0.4f));
        item.id = i;
        prom_draw_list_add(fix.list, &item);
    }
    prom_pass pass = pass_parallel(SIZE);
    pass.width = width, pass.height = height;
    draw(target, &pass);
}

// True counts of ids below IDS; returns their sum.
static double count_all(prom_target *target, uint32_t width, uint32_t height, double px[IDS])
{
    uint32_t *ids = prom_alloc((size_t)width * height, sizeof *ids);
    double sum = 0;
    for (uint32_t i = 0; i < IDS; i++) px[i] = 0;
    prom_target_read_ids(target, 0, 0, width, height, ids);
    for (size_t i = 0; i < (size_t)width * height; i++)
        if (ids[i] < IDS) px[ids[i]]++, sum++;
    prom_free(ids);
    return sum;
}

static void rounds_of_calls_count_exactly(void **state)
{
    NEEDS_GL(state);
    static const uint32_t sizes[][2] = {{64, 64}, {1, 1}, {3, 50}, {257, 131}, {1280, 721}};
    prom_id_counter *counter = make_counter(IDS);
    for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
        uint32_t width = sizes[s][0], height = sizes[s][1];
        prom_target *target = make_target(width, height, true);
        draw_squares(target, width, height, s);
        double want[IDS], got[IDS] = {0}, sum = 0;
        double covered = count_all(target, width, height, want);
        if (width >= SIZE) assert_true(covered > 0.2 * width * height);
        for (uint64_t i = 0; i < PHASES; i++) {
            prom_id_counts counts;
            assert_true(prom_id_counter_start(counter, target, i));
            assert_true(prom_id_counter_take(counter, true, &counts));
            assert_int_equal(counts.frame, i);
            double once = 0;
            for (size_t k = 0; k < counts.count; k++) {
                assert_true(counts.counts[k].px > 0);
                assert_true(counts.counts[k].id < IDS);
                got[counts.counts[k].id] += (double)counts.counts[k].px / PHASES;
                once += (double)counts.counts[k].px;
            }
            // One call alone is near: 1 of 16 pixels of pieces that are larger than blocks.
            if (width >= 200) assert_true(fabs(once - covered) < 0.05 * covered);
            sum += once / PHASES;
        }
        for (uint32_t i = 0; i < IDS; i++) assert_true(got[i] == want[i]);
        assert_true(sum == covered);
        prom_target_destroy(target);
    }
    prom_id_counter_destroy(counter);
}

static void an_id_is_given_once(void **state)
{
    NEEDS_GL(state);
    prom_id_counter *counter = make_counter(IDS);
    prom_target *target = make_target(SIZE, SIZE, true);
    draw_squares(target, SIZE, SIZE, 5);
    prom_id_counts counts;
    prom_id_counter_start(counter, target, 0);
    assert_true(prom_id_counter_take(counter, true, &counts));
    bool given[IDS] = {0};
    assert_true(counts.count > 5);
    for (size_t i = 0; i < counts.count; i++) {
        assert_false(given[counts.counts[i].id]);
        given[counts.counts[i].id] = true;
    }
    prom_target_destroy(target);
    prom_id_counter_destroy(counter);
}

// Each frame is a square of its own size and id, in a target of its own size.
static void start_frame(prom_id_counter *counter, uint64_t frame, bool expected)
{
    uint32_t size = SIZE + 8 * (uint32_t)(frame % 3);
    prom_target *target = make_target(size, size, true);
    prom_draw_item item = item_at(add_square(grey, PROM_NONE), 0, 0, 0, 1);
    item.id = (uint32_t)frame % IDS;
    prom_pass pass = pass_parallel(size);
    prom_draw_list_add(fix.list, &item);
    draw(target, &pass);
    assert_int_equal(prom_id_counter_start(counter, target, frame), expected);
    prom_target_destroy(target); // what was started is not lost with it
}

static void take_frame(prom_id_counter *counter, uint64_t frame)
{
    prom_id_counts counts;
    double size = SIZE + 8 * (double)(frame % 3);
    assert_true(prom_id_counter_take(counter, true, &counts));
    assert_int_equal(counts.frame, frame);
    assert_int_equal(counts.count, 1);
    assert_int_equal(counts.counts[0].id, frame % IDS);
    assert_true(counts.counts[0].px == size * size);
}

static void frames_come_in_order(void **state)
{
    NEEDS_GL(state);
    prom_id_counter *counter = make_counter(IDS);
    prom_id_counts counts;
    assert_false(prom_id_counter_take(counter, true, &counts));
    for (uint64_t first = 0; first < 30; first += PROM_ID_RING) {
        for (uint64_t i = 0; i < PROM_ID_RING; i++) start_frame(counter, first + i, true);
        start_frame(counter, 1000, false); // full
        for (uint64_t i = 0; i < PROM_ID_RING; i++) take_frame(counter, first + i);
        assert_false(prom_id_counter_take(counter, false, &counts));
    }
    // The ring turns while it is neither full nor empty.
    start_frame(counter, 100, true);
    for (uint64_t i = 101; i < 120; i++) {
        start_frame(counter, i, true);
        take_frame(counter, i - 1);
    }
    take_frame(counter, 119);
    assert_false(prom_id_counter_take(counter, true, &counts));
    start_frame(counter, 8, true); // and destroyed under way
    prom_id_counter_destroy(counter);
}

static void polling_gets_there(void **state)
{
    NEEDS_GL(state);
    prom_id_counter *counter = make_counter(IDS);
    prom_id_counts counts = {0};
    start_frame(counter, 3, true);
    prom_renderer_finish(fix.renderer);
    assert_true(prom_id_counter_take(counter, false, &counts));
    assert_int_equal(counts.frame, 3);
    prom_id_counter_destroy(counter);
}

// ---- whose ids

// A wall fills the left half; a pane reaches over all of the upper half before it and another
// stands behind it.
static void add_room(void)
{
    const prom_material glass = {
        .base_color = {1, 1, 1, 0.5f}, .texture = PROM_NONE, .alpha_mode = PROM_ALPHA_BLEND};
    prom_renderer_set_materials(fix.renderer, &glass, 1);
    uint32_t pane = add_square(grey, 0);
    prom_draw_item wall = item_at(add_square(grey, PROM_NONE), -1, 0, 0, 1);
    prom_draw_item before = item_at(pane, 0, 1, 2, 1), behind = item_at(pane, 0, 0, -2, 1);
    wall.id = WALL;
    before.id = PANE;
    behind.id = PANE + 1;
    prom_draw_list_add(fix.list, &wall);
    prom_draw_list_add(fix.list, &before);
    prom_draw_list_add(fix.list, &behind);
}

static void targets_get_the_ids_asked_for(void **state)
{
    NEEDS_GL(state);
    // Of the quarters: top left, top right, bottom left, bottom right.
    static const uint32_t want[][4] = {
        [PROM_IDS_ALL] = {PANE, PANE, WALL, PANE + 1},
        [PROM_IDS_OPAQUE] = {WALL, PROM_NONE, WALL, PROM_NONE},
        [PROM_IDS_BLENDED] = {PANE, PANE, PROM_NONE, PANE + 1},
        [PROM_IDS_NONE] = {PROM_NONE, PROM_NONE, PROM_NONE, PROM_NONE},
    };
    static uint32_t ids[SIZE * SIZE];
    static uint8_t rgba[4 * SIZE * SIZE], first[4 * SIZE * SIZE];
    prom_target *target = make_target(SIZE, SIZE, true);
    for (prom_output output = 0; output < PROM_OUTPUT_COUNT; output++)
        for (prom_ids which = PROM_IDS_ALL; which <= PROM_IDS_NONE; which++) {
            prom_pass pass = pass_parallel(SIZE);
            pass.output = output;
            pass.ids = which;
            add_room();
            draw(target, &pass);
            prom_target_read_ids(target, 0, 0, SIZE, SIZE, ids);
            for (uint32_t i = 0; i < SIZE * SIZE; i++) {
                uint32_t x = i % SIZE, y = i / SIZE;
                assert_int_equal(ids[i], want[which][2 * (y / (SIZE / 2)) + x / (SIZE / 2)]);
            }
            // The picture does not depend on them.
            prom_target_read_rgba(target, 0, 0, SIZE, SIZE, rgba);
            if (which == PROM_IDS_ALL) memcpy(first, rgba, sizeof first);
            assert_memory_equal(rgba, first, sizeof first);
        }
    prom_target_destroy(target);
}

static void lists_know_what_is_blended(void **state)
{
    NEEDS_GL(state);
    prom_draw_list_prepare(fix.list);
    assert_false(prom_draw_list_has_blended(fix.list));
    prom_draw_list_reset(fix.list);
    add_room();
    prom_draw_list_prepare(fix.list);
    assert_true(prom_draw_list_has_blended(fix.list));
    prom_draw_list_reset(fix.list);
    prom_draw_item item = item_at(add_square(grey, 0), 0, 0, 0, 1);
    item.background = true;
    prom_draw_list_add(fix.list, &item);
    item.mesh = add_square(grey, PROM_NONE);
    item.background = false;
    prom_draw_list_add(fix.list, &item);
    prom_draw_list_prepare(fix.list);
    assert_false(prom_draw_list_has_blended(fix.list));
}

// ---- hidden items

// What is said to be hidden and is not shows all the same; the picture depends on depth alone.
static void hidden_items_show_the_same(void **state)
{
    NEEDS_GL(state);
    static uint8_t want[4 * SIZE * SIZE], got[4 * SIZE * SIZE];
    prom_target *target = make_target(SIZE, SIZE, false);
    prom_pass pass = pass_parallel(SIZE);
    for (int round = 0; round < 8; round++)
        for (int hidden = 0; hidden < 2; hidden++) {
            uint64_t seed = (uint64_t)round;
            for (uint32_t i = 0; i < 60; i++) {
                uint8_t color[4] = {(uint8_t)(4 * i), (uint8_t)(7 * i), (uint8_t)(11 * i), 255};
                prom_draw_item item =
                    item_at(add_square(color, PROM_NONE), random_between(&seed, -1, 1),
                            random_between(&seed, -1, 1), random_between(&seed, -9, 9), 0.3f);
                bool marked = random_u64(&seed) & 1 || round == 7; // all of them once
                item.hidden = hidden && marked;
                prom_draw_list_add(fix.list, &item);
            }
            draw(target, &pass);
            prom_target_read_rgba(target, 0, 0, SIZE, SIZE, hidden ? got : want);
            if (hidden) assert_memory_equal(got, want, sizeof want);
        }
    prom_target_destroy(target);
}

// Of two at one depth the first that is drawn stays: a hidden one comes after all others.
static void hidden_items_come_last(void **state)
{
    NEEDS_GL(state);
    uint32_t id;
    prom_target *target = make_target(SIZE, SIZE, true);
    prom_draw_item items[2] = {item_at(add_square(grey, PROM_NONE), 0, 0, 0, 1)};
    items[1] = items[0];
    items[0].id = 1, items[0].depth = 0.01f;
    items[1].id = 2, items[1].depth = 1000;
    for (int hidden = 0; hidden < 2; hidden++) {
        items[0].hidden = hidden;
        for (int i = 0; i < 2; i++) prom_draw_list_add(fix.list, &items[i]);
        prom_pass pass = pass_parallel(SIZE);
        draw(target, &pass);
        prom_target_read_ids(target, SIZE / 2, SIZE / 2, 1, 1, &id);
        assert_int_equal(id, hidden ? 2 : 1);
    }
    prom_target_destroy(target);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rounds_of_calls_count_exactly),
        cmocka_unit_test(an_id_is_given_once),
        cmocka_unit_test(frames_come_in_order),
        cmocka_unit_test(polling_gets_there),
        cmocka_unit_test(targets_get_the_ids_asked_for),
        cmocka_unit_test(lists_know_what_is_blended),
        cmocka_unit_test(hidden_items_show_the_same),
        cmocka_unit_test(hidden_items_come_last),
    };
    return cmocka_run_group_tests(tests, fixture_setup, fixture_teardown);
}
