// LINK: prom_builder prom_render prom_benefit prom_metaobj
// What accuracy tables are made of: views, their resampling, and the comparison itself.
#include "builder/measure.h"

#include "benefit/accuracy.h"
#include "benefit/metric.h"
#include "builder/measure_picture.h"
#include "metaobj/base/threads.h"
#include "view_pictures.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

// ---- pictures to compare

typedef struct disc {
    float radius; // 1: the bounding sphere's
    uint8_t grey;
    float wedge; // beyond this x it is cut off; 0: whole
} disc;

static bool paint_disc(const void *user, uint32_t view, float x, float y, uint8_t rgb[3])
{
    const disc *d = user;
    (void)view;
    memset(rgb, d->grey, 3);
    return x * x + y * y < d->radius * d->radius && !(d->wedge > 0 && x > d->wedge);
}

// A ball of stripes, nothing of which is seen along the +x axis (bin 4).
static bool paint_plate(const void *user, uint32_t view, float x, float y, uint8_t rgb[3])
{
    const int shift = *(const int *)user;
    uint32_t dir = view < PROM_DIRS ? view : view - PROM_DIRS;
    memset(rgb, ((int)floorf(x * 8) + shift) & 1 ? 200 : 60, 3);
    return dir != 4 && x * x + y * y < 0.64f;
}

static void measure_all(const prom_measure_options *options, const prom_views *truth,
                        prom_comparison *const *others, size_t count)
{
    prom_measure *m = prom_measure_create(options, 0.2f);
    prom_measuring measuring;
    prom_measuring_init(&measuring, truth, others, count);
    for (size_t s = 0; s < PROM_MEASURE_STEPS; s++) prom_measure_step(m, 0, &measuring, s);
    prom_measure_end(&measuring);
    prom_measure_destroy(m);
}

// ---- views

static void views_keep_what_is_covered(void **state)
{
    (void)state;
    prom_views views = {0}, again = {0};
    const disc small = {0.5f, 100, 0};
    paint_views(&views, true, paint_disc, &small);
    assert_int_equal(views.count, PROM_VIEWS);
    assert_int_equal(views.at[3].part.x, 32);
    assert_int_equal(views.at[3].part.width, 64);
    assert_int_equal(views.at[PROM_DIRS].part.y, 128);
    assert_int_equal(views.at[PROM_DIRS].part.height, 256);
    assert_true(fabs(prom_views_coverage(&views, 3) / 65535.0 - 0.25) < 0.01);

    prom_pack pack = {0};
    prom_views_pack(&views, &pack);
    prom_unpack in = {.at = pack.data, .left = pack.count};
    prom_views_unpack(&in, &again);
    assert_true(prom_unpack_end(&in));
    assert_memory_equal(views.at, again.at, sizeof views.at);
    assert_memory_equal(views.pixels.data, again.pixels.data, views.pixels.count * 4);
    for (size_t cut = 0; cut < pack.count; cut += cut < 2000 ? 1 : 9973) {
        in = (prom_unpack){.at = pack.data, .left = cut};
        prom_views_unpack(&in, &again);
        assert_true(in.failed);
    }
    // No view may reach out of its picture or of the pixels.
    for (size_t word = 1; word < 13; word++) {
        uint32_t *at = (uint32_t *)(void *)pack.data + word, kept = *at;
        for (uint32_t shift = 0; shift < 32; shift += 10) {
            *at = kept + (7919u << shift);
            in = (prom_unpack){.at = pack.data, .left = pack.count};
            prom_views_unpack(&in, &again);
            if (in.failed) continue;
            const prom_cutout *v = again.at;
            assert_in_range(v->part.x + v->part.width, 0, PROM_VIEW_PX);
            assert_in_range(v->part.y + v->part.height, 0, PROM_VIEW_PX);
        }
        *at = kept;
    }
    prom_array_finish(&pack);
    prom_views_finish(&views);
    prom_views_finish(&again);
}

static void shares_count_pixels(void **state)
{
    (void)state;
    uint32_t ids[PROM_VIEW_PIXELS];
    uint16_t shares[3][PROM_DIRS];
    for (uint32_t i = 0; i < PROM_VIEW_PIXELS; i++)
        ids[i] = i % PROM_VIEW_PX < 32 ? 0 : i % PROM_VIEW_PX < 64 ? 2 : UINT32_MAX;
    prom_view_shares(ids, PROM_VIEW_PX, 7, 3, shares);
    assert_in_range(shares[0][7], 32767, 32768);
    assert_int_equal(shares[1][7], 0);
    assert_in_range(shares[2][7], 32767, 32768);
}

// ---- resampling

// Whatever the step and wherever the part begins, light is neither lost nor made, and a pixel
// does not depend on how much around it was taken.
static void reduction_keeps_light(void **state)
{
    (void)state;
    prom_views views = {0};
    const disc d = {0.7f, 160, 0.4f};
    paint_views(&views, false, paint_disc, &d);
    prom_patch patch = {.pixels = prom_alloc(PROM_VIEW_PIXELS, 16)};
    prom_patch tight = {.pixels = prom_alloc(PROM_VIEW_PIXELS, 16)};
    prom_patch reduced[2];
    for (int k = 0; k < 2; k++) reduced[k].pixels = prom_alloc(PROM_VIEW_PIXELS, 16);
    float(*between)[4] = prom_alloc(PROM_VIEW_PIXELS, 16);
    prom_patch_take(&views, 5, (prom_part){0, 0, PROM_VIEW_PX, PROM_VIEW_PX}, &patch);
    prom_patch_take(&views, 5, views.at[5].part, &tight);
    for (uint32_t s = 0; s < PROM_SIZES; s++) {
        const float step = PROM_VIEW_PX / prom_size_of_bin(s);
        prom_patch_reduce(&patch, step, between, &reduced[0]);
        prom_patch_reduce(&tight, step, between, &reduced[1]);
        const prom_part part = reduced[1].part;
        double sum[4] = {0};
        for (uint32_t y = 0; y < part.height; y++)
            for (uint32_t x = 0; x < part.width; x++)
                for (int c = 0; c < 4; c++) {
                    size_t i = (size_t)(y + part.y) * reduced[0].part.width + x + part.x;
                    float value = reduced[1].pixels[(size_t)y * part.width + x][c];
                    assert_float_equal(value, reduced[0].pixels[i][c], 1e-5);
                    sum[c] += value * step * step;
                }
        double covered = views.at[5].covered;
        assert_true(fabs(sum[3] / covered - 1) < 1e-4);
        assert_true(fabs(sum[1] / covered - (double)prom_srgb8_to_linear(160)) < 1e-4);
    }
    prom_free(patch.pixels);
    prom_free(tight.pixels);
    for (int k = 0; k < 2; k++) prom_free(reduced[k].pixels);
    prom_free(between);
    prom_views_finish(&views);
}

// ---- comparing

static void accuracy_is_one_for_equal_and_falls_with_difference(void **state)
{
    (void)state;
    static const disc discs[4] = {
        {0.62f, 188, 0}, {0.60f, 178, 0}, {0.45f, 140, 0}, {0.31f, 90, 0}};
    prom_views views[4] = {0};
    static prom_comparison result[4];
    prom_comparison *others[4];
    for (int i = 0; i < 4; i++) {
        paint_views(&views[i], true, paint_disc, &discs[i]);
        result[i].views = &views[i];
        others[i] = &result[i];
    }
    for (size_t k = 0; k < prom_metric_count(); k++) {
        const prom_measure_options options = {.metric = prom_metric_at(k)->name};
        measure_all(&options, &views[0], others, 4);
        for (uint32_t d = 0; d < PROM_DIRS; d++) {
            for (uint32_t s = 0; s < PROM_SIZES; s++) {
                assert_int_equal(result[0].accuracy.bins[d][s], 255);
                for (int i = 1; i < 4; i++) {
                    uint8_t better = result[i - 1].accuracy.bins[d][s];
                    uint8_t worse = result[i].accuracy.bins[d][s];
                    assert_true(worse < better || better == 0);
                }
            }
            assert_int_equal(result[0].gaps[d], 0);
            assert_true(result[3].gaps[d] > 100);
        }
        for (uint32_t d = 0; d < PROM_DIRS_LARGE; d++)
            for (uint32_t s = 0; s < PROM_SIZES_LARGE; s++) {
                assert_int_equal(result[0].accuracy.large[d][s], 255);
                assert_true(result[1].accuracy.large[d][s] < 255);
            }
    }
    for (int i = 0; i < 4; i++) prom_views_finish(&views[i]);
}

// A third of the object is missing: from the veto's size on that is no representation of it.
static void what_lacks_a_part_is_vetoed(void **state)
{
    (void)state;
    static const disc discs[2] = {{0.6f, 250, 0}, {0.6f, 250, 0.2f}};
    prom_views truth = {0}, views = {0};
    static prom_comparison result;
    prom_comparison *other = &result;
    paint_views(&truth, true, paint_disc, &discs[0]);
    paint_views(&views, true, paint_disc, &discs[1]);
    result.views = &views;
    prom_measure_options options = {0};
    measure_all(&options, &truth, &other, 1);
    assert_true(result.accuracy.bins[0][PROM_SIZES - 1] > 0); // unless it is asked for
    options.veto = true;
    measure_all(&options, &truth, &other, 1);
    for (uint32_t d = 0; d < PROM_DIRS; d++)
        for (uint32_t s = 0; s < PROM_SIZES; s++) {
            uint8_t accuracy = result.accuracy.bins[d][s];
            if (prom_size_of_bin(s) >= 32)
                assert_int_equal(accuracy, 0);
            else
                assert_in_range(accuracy, 1, 254);
        }
    assert_int_equal(result.accuracy.large[0][1], 0);
    prom_views_finish(&truth);
    prom_views_finish(&views);
}

// What is the same in all directions is measured in the coarse ones, and the same as when it is
// measured in all; a representation's row does not depend on its company or on threads.
static void rows_depend_on_nothing_else(void **state)
{
    (void)state;
    static const disc discs[3] = {{0.6f, 188, 0}, {0.59f, 180, 0}, {0.8f, 90, 0}};
    prom_views views[3] = {0};
    static prom_comparison result[3], alone, everywhere;
    prom_comparison *others[2] = {&result[1], &result[2]}, *one = &alone, *all = &everywhere;
    for (int i = 0; i < 3; i++) {
        paint_views(&views[i], true, paint_disc, &discs[i]);
        result[i].views = &views[i];
    }
    alone.views = everywhere.views = &views[1];
    prom_measure_options options = {0};
    measure_all(&options, &views[0], others, 2);
    measure_all(&options, &views[0], &one, 1);
    options.everywhere = true;
    measure_all(&options, &views[0], &all, 1);
    assert_memory_equal(&alone.accuracy, &result[1].accuracy, sizeof alone.accuracy);
    assert_memory_equal(&alone.accuracy, &everywhere.accuracy, sizeof alone.accuracy);
    for (uint32_t d = 0; d < PROM_DIRS; d++) {
        assert_int_equal(alone.compared[d], d < PROM_DIRS_COARSE);
        assert_true(everywhere.compared[d]);
    }
    for (int i = 0; i < 3; i++) prom_views_finish(&views[i]);
}

typedef struct parallel {
    prom_measure *measure;
    prom_measuring measuring;
} parallel;

static void step_of(void *user, size_t i, unsigned thread)
{
    parallel *p = user;
    prom_measure_step(p->measure, thread, &p->measuring, i);
}

static void threads_change_nothing(void **state)
{
    (void)state;
    static const int shifts[2] = {0, 1};
    prom_views truth = {0}, views = {0};
    static prom_comparison single, several;
    prom_comparison *one = &single, *two = &several;
    paint_views(&truth, true, paint_plate, &shifts[0]);
    paint_views(&views, true, paint_plate, &shifts[1]);
    single.views = several.views = &views;
    const prom_measure_options options = {.metric = "rmse"};
    measure_all(&options, &truth, &one, 1);
    parallel p = {.measure = prom_measure_create(&options, 0.2f)};
    prom_measuring_init(&p.measuring, &truth, &two, 1);
    prom_pool *pool = prom_pool_create();
    prom_loop loop = {.body = step_of, .user = &p, .count = PROM_MEASURE_STEPS};
    prom_pool_start(pool, &loop);
    prom_pool_wait(pool, &loop);
    prom_pool_destroy(pool);
    prom_measure_end(&p.measuring);
    prom_measure_destroy(p.measure);
    assert_memory_equal(&single.accuracy, &several.accuracy, sizeof single.accuracy);
    assert_memory_equal(single.compared, several.compared, sizeof single.compared);
    prom_views_finish(&truth);
    prom_views_finish(&views);
}

// Along an axis from which nothing is seen, large sizes keep what they keep along the others.
static void an_unseen_axis_follows_the_others(void **state)
{
    (void)state;
    static const int shifts[2] = {0, 1};
    prom_views truth = {0}, views = {0};
    static prom_comparison result;
    prom_comparison *other = &result;
    paint_views(&truth, true, paint_plate, &shifts[0]);
    paint_views(&views, true, paint_plate, &shifts[1]);
    result.views = &views;
    const prom_measure_options options = {.metric = "rmse"};
    measure_all(&options, &truth, &other, 1);
    const prom_accuracy_row *row = &result.accuracy;
    assert_int_equal(row->bins[4][PROM_SIZES - 1], 255); // nothing beside nothing
    for (uint32_t s = 0; s < PROM_SIZES_LARGE; s++) {
        double there = (double)row->large[0][s] / row->bins[0][PROM_SIZES - 1];
        double ratio = (double)row->large[4][s] / row->bins[4][PROM_SIZES - 1];
        assert_true(there > 0 && fabs(ratio - fmin(there, 1)) < 0.02);
    }
    prom_views_finish(&truth);
    prom_views_finish(&views);
}

static void constant_compares_nothing(void **state)
{
    (void)state;
    static const disc discs[2] = {{0.6f, 188, 0}, {0.3f, 20, 0}};
    prom_views truth = {0}, views = {0};
    static prom_comparison result;
    prom_comparison *other = &result;
    paint_views(&truth, true, paint_disc, &discs[0]);
    paint_views(&views, true, paint_disc, &discs[1]);
    result.views = &views;
    const prom_measure_options options = {.metric = PROM_METRIC_CONSTANT};
    measure_all(&options, &truth, &other, 1);
    for (uint32_t d = 0; d < PROM_DIRS; d++) {
        for (uint32_t s = 0; s < PROM_SIZES; s++)
            assert_int_equal(result.accuracy.bins[d][s], prom_byte_of_accuracy(0.5));
        assert_true(result.gaps[d] > 100);
    }
    assert_int_equal(result.accuracy.large[2][1], prom_byte_of_accuracy(0.5));
    prom_views_finish(&truth);
    prom_views_finish(&views);
}

// What the results depend on, and nothing else, makes another key.
static void keys_tell_settings_apart(void **state)
{
    (void)state;
    const prom_measure_options options[] = {{.metric = "ssim"},
                                            {.metric = "ssim", .ppd = 40},
                                            {.metric = "rmse"},
                                            {.metric = "ssim", .everywhere = true}};
    uint64_t keys[4];
    for (int i = 0; i < 4; i++) {
        prom_measure *m = prom_measure_create(&options[i], 0.2f);
        keys[i] = prom_measure_key(m);
        prom_measure_destroy(m);
    }
    prom_measure *lighter = prom_measure_create(&options[0], 0.4f);
    assert_true(keys[0] == keys[1]); // it does not use the pixels per degree
    assert_true(keys[0] != keys[2] && keys[0] != keys[3]);
    assert_true(keys[0] != prom_measure_key(lighter));
    prom_measure_destroy(lighter);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(views_keep_what_is_covered),
        cmocka_unit_test(shares_count_pixels),
        cmocka_unit_test(reduction_keeps_light),
        cmocka_unit_test(accuracy_is_one_for_equal_and_falls_with_difference),
        cmocka_unit_test(what_lacks_a_part_is_vetoed),
        cmocka_unit_test(rows_depend_on_nothing_else),
        cmocka_unit_test(threads_change_nothing),
        cmocka_unit_test(an_unseen_axis_follows_the_others),
        cmocka_unit_test(constant_compares_nothing),
        cmocka_unit_test(keys_tell_settings_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
