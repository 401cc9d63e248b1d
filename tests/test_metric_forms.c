// LINK: prom_benefit prom_metaobj
// All metrics of the registry: what form a picture has, and who works on it, does not matter.
#include "metaobj/base/threads.h"
#include "metric_fixture.h"

// FLIP takes floats as linear light, the metrics on luma take what is stored.
static float value_of(const char *metric, uint8_t byte)
{
    return !strcmp(metric, "flip") ? prom_srgb8_to_linear(byte) : (float)byte / 255.0f;
}

static void assert_same_map(const char *name, prom_picture a, prom_picture b,
                            const float *expected, float tolerance)
{
    static float map[PIXELS];
    compare(name, a, b, map);
    for (uint32_t i = 0; i < a.width * a.height; i++)
        assert_float_equal(map[i], expected[i], tolerance);
}

static void floats_are_as_good_as_bytes(void **state)
{
    (void)state;
    static float map[PIXELS];
    uint64_t seed = 4;
    FOR_EACH_METRIC(name)
    for (uint32_t channels = 1; channels <= 4; channels += channels == 1 ? 2 : 1) {
        for (int k = 0; k < 2; k++) {
            random_picture(&seed, memory.bytes[k], W, H);
            for (int i = 0; i < W * H * 4; i++)
                memory.floats[k][i] = value_of(name, memory.bytes[k][i]);
        }
        compare(name, byte_picture(memory.bytes[0], W, H, channels),
                byte_picture(memory.bytes[1], W, H, channels), map);
        assert_same_map(name, float_picture(memory.floats[0], W, H, channels),
                        float_picture(memory.floats[1], W, H, channels), map, 1e-5f);
    }
}

// Of rgba bytes, what `channels` of them hold.
static void take_channels(const uint8_t *rgba, uint32_t channels, uint8_t *out)
{
    for (uint32_t p = 0; p < W * H; p++)
        for (uint32_t c = 0; c < channels; c++) out[p * channels + c] = rgba[p * 4 + c];
}

static void the_fourth_channel_is_not_looked_at(void **state)
{
    (void)state;
    static float map[PIXELS];
    static uint8_t rgb[2][W * H * 3];
    uint64_t seed = 5;
    for (int k = 0; k < 2; k++) {
        random_picture(&seed, memory.bytes[k], W, H);
        take_channels(memory.bytes[k], 3, rgb[k]);
    }
    FOR_EACH_METRIC(name)
    {
        compare(name, byte_picture(memory.bytes[0], W, H, 4),
                byte_picture(memory.bytes[1], W, H, 4), map);
        assert_same_map(name, byte_picture(rgb[0], W, H, 3), byte_picture(rgb[1], W, H, 3), map,
                        0);
    }
}

static void a_grey_is_three_equal_channels(void **state)
{
    (void)state;
    static float map[PIXELS];
    static uint8_t grey[2][W * H];
    uint64_t seed = 6;
    for (int k = 0; k < 2; k++) {
        random_picture(&seed, memory.bytes[k], W, H);
        take_channels(memory.bytes[k], 1, grey[k]);
        for (int i = 0; i < W * H * 3; i++) memory.bytes[k][i] = grey[k][i / 3];
    }
    FOR_EACH_METRIC(name)
    {
        compare(name, byte_picture(memory.bytes[0], W, H, 3),
                byte_picture(memory.bytes[1], W, H, 3), map);
        assert_same_map(name, byte_picture(grey[0], W, H, 1), byte_picture(grey[1], W, H, 1),
                        map, 1e-5f);
    }
}

// A part of a larger picture is compared in its place.
static void rows_may_stand_apart(void **state)
{
    (void)state;
    static float map[PIXELS];
    static uint8_t close[2][PIXELS * 4];
    enum { X = 5, Y = 3, PART_W = 40, PART_H = 29 };
    uint64_t seed = 7;
    prom_picture part[2], copy[2];
    for (int k = 0; k < 2; k++) {
        random_picture(&seed, memory.bytes[k], W, H);
        for (int y = 0; y < PART_H; y++)
            memcpy(close[k] + y * PART_W * 4, memory.bytes[k] + ((y + Y) * W + X) * 4,
                   PART_W * 4);
        copy[k] = byte_picture(close[k], PART_W, PART_H, 4);
        part[k] = byte_picture(memory.bytes[k] + (Y * W + X) * 4, PART_W, PART_H, 4);
        part[k].row_bytes = W * 4;
    }
    FOR_EACH_METRIC(name)
    {
        compare(name, copy[0], copy[1], map);
        assert_same_map(name, part[0], part[1], map, 0);
    }
}

static void threads_change_nothing(void **state)
{
    (void)state;
    static float one[PIXELS], all[PIXELS];
    uint64_t seed = 8;
    for (int k = 0; k < 2; k++) random_picture(&seed, memory.bytes[k], W, TALL);
    const prom_picture a = byte_picture(memory.bytes[0], W, TALL, 4);
    const prom_picture b = byte_picture(memory.bytes[1], W, TALL, 4);
    assert_true(prom_thread_count() > 1);
    FOR_EACH_METRIC(name)
    {
        compare_on(1, name, a, b, one);
        compare_on(0, name, a, b, all);
        assert_memory_equal(one, all, sizeof(float) * W * TALL);
    }
}

static void one_metric_serves_all_sizes(void **state)
{
    (void)state;
    static float map[PIXELS], expected[PIXELS];
    uint64_t seed = 9;
    FOR_EACH_METRIC(name)
    {
        prom_metric *metric = prom_metric_create(name, PPD, TALL, W * TALL, 1);
        for (size_t i = 0; i < sizeof odd_sizes / sizeof *odd_sizes; i++) {
            const uint32_t w = odd_sizes[i][0], h = odd_sizes[i][1];
            random_picture(&seed, memory.bytes[0], w, h);
            random_picture(&seed, memory.bytes[1], w, h);
            const prom_picture a = byte_picture(memory.bytes[0], w, h, 4);
            const prom_picture b = byte_picture(memory.bytes[1], w, h, 4);
            compare(name, a, b, expected);
            run(metric, &a, &b, map);
            assert_memory_equal(map, expected, w * h * sizeof *map);
        }
        prom_metric_destroy(metric);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(floats_are_as_good_as_bytes),
        cmocka_unit_test(the_fourth_channel_is_not_looked_at),
        cmocka_unit_test(a_grey_is_three_equal_channels),
        cmocka_unit_test(rows_may_stand_apart),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(one_metric_serves_all_sizes),
    };
    prom_thread_set_count(3);
    return cmocka_run_group_tests_name("metric forms", tests, NULL, NULL);
}
