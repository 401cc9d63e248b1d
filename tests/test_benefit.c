// LINK: prom_benefit prom_metaobj
// Accuracy and footprints.
#include "benefit/accuracy.h"
#include "random_model.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const random_model_options small_model = {.leaves = 40, .max_children = 7, .extent = 50};

// ---- accuracy

static void bytes_never_promise_more(void **state)
{
    (void)state;
    for (int byte = 0; byte < 256; byte++)
        assert_int_equal(prom_byte_of_accuracy(prom_accuracy_of_byte((uint8_t)byte)), byte);
    for (double accuracy = -5.0; accuracy <= 1.0; accuracy += 1e-4) {
        double kept = (double)prom_accuracy_of_byte(prom_byte_of_accuracy(accuracy));
        assert_true(kept <= fmax(accuracy, 1.0 - (double)PROM_ERROR_MAX) + 1e-4);
        assert_true(kept > accuracy - 0.04);
        if (accuracy > 0.9) assert_true(kept > accuracy - 0.006);
    }
    assert_int_equal(prom_byte_of_accuracy(1.5), 255);
    assert_int_equal(prom_byte_of_accuracy(-9), 0);
}

static prom_accuracy_place place_of(uint32_t dir, float size_px)
{
    float direction[3], uv[2];
    prom_direction_of_bin(dir, direction);
    prom_octahedral_encode(direction, uv);
    prom_accuracy_place place;
    prom_accuracy_place_init(&place, uv, size_px);
    return place;
}

static prom_accuracy_place any_place(uint64_t *seed, float size_px)
{
    const float uv[2] = {random_between(seed, 0, 1), random_between(seed, 0, 1)};
    prom_accuracy_place place;
    prom_accuracy_place_init(&place, uv, size_px);
    return place;
}

static float accuracy_at(const prom_model *m, uint32_t rep, uint32_t dir, float size_px,
                         float radius)
{
    prom_accuracy_place place = place_of(dir, size_px);
    return prom_accuracy(m, rep, &place, radius);
}

static void accuracy_of_full_geometry_is_1(void **state)
{
    (void)state;
    prom_model m;
    random_model(&m, 1, &small_model);
    uint64_t seed = 2;
    for (uint32_t p = 0; p < m.prototype_count; p++) {
        if (m.prototypes[p].child_count) continue;
        for (int i = 0; i < 50; i++) {
            float size = powf(10.0f, random_between(&seed, -1, 6));
            prom_accuracy_place place = any_place(&seed, size);
            float a =
                prom_accuracy(&m, m.prototypes[p].first_rep, &place, m.prototypes[p].radius);
            assert_float_equal(a, 1.0f, 1e-6f);
        }
    }
    prom_model_finish(&m);
}

static void accuracy_meets_its_table_and_is_continuous(void **state)
{
    (void)state;
    prom_model m;
    random_model(&m, 3, &small_model);
    for (uint32_t p = 0; p < m.prototype_count; p++) {
        const prom_prototype *proto = &m.prototypes[p];
        for (uint32_t r = proto->first_rep; r < proto->first_rep + proto->rep_count; r++) {
            for (uint32_t s = 0; s < PROM_SIZES; s++)
                assert_float_equal(
                    accuracy_at(&m, r, r % PROM_DIRS, prom_size_of_bin(s), proto->radius),
                    prom_accuracy_of_byte(m.accuracy[r].bins[r % PROM_DIRS][s]), 1e-4f);
            float last = accuracy_at(&m, r, 0, 2.0f, proto->radius);
            for (float size = 2.0f; size < 3000.0f; size *= 1.002f) {
                float a = accuracy_at(&m, r, 0, size, proto->radius);
                assert_true(a >= 1.0f - PROM_ERROR_MAX && a <= 1.0f);
                // Half an octave at full swing is 1; a step here is a 173th of that.
                assert_true(fabsf(a - last) < 0.008f);
                last = a;
            }
        }
    }
    prom_model_finish(&m);
}

static void accuracy_falls_beyond_the_measured_sizes(void **state)
{
    (void)state;
    prom_model m;
    random_model(&m, 4, &small_model);
    for (uint32_t p = 0; p < m.prototype_count; p++) {
        const prom_prototype *proto = &m.prototypes[p];
        for (uint32_t r = proto->first_rep; r < proto->first_rep + proto->rep_count; r++) {
            float first = accuracy_at(&m, r, 5, PROM_SIZE_MAX_PX, proto->radius), last = first;
            for (float size = PROM_SIZE_MAX_PX; size < 1e5f; size *= 1.3f) {
                float a = accuracy_at(&m, r, 5, size, proto->radius);
                assert_true(a <= last + 1e-6f);
                last = a;
            }
            if (m.reps[r].kind == PROM_REP_MESH && m.reps[r].error > 0.0f && first > 0.0f)
                assert_true(last < first);
        }
    }
    prom_model_finish(&m);
}

static void near_fit_recovers_its_parameter(void **state)
{
    (void)state;
    uint64_t seed = 5;
    for (int i = 0; i < 100; i++) {
        float k = powf(10.0f, random_between(&seed, -2, 2)), e[12], a[12];
        float from = i % 2 ? 1.0f : random_between(&seed, 0.3f, 1.0f);
        for (int j = 0; j < 12; j++) {
            e[j] = random_between(&seed, 0, 20);
            a[j] = from / (1.0f + k * e[j]);
        }
        float fitted = prom_accuracy_fit_near(e, a, 12);
        assert_true(fabsf(fitted / k - 1.0f) < 1e-3f);
    }
    const float e[3] = {1, 2, 4}, perfect[3] = {1, 1, 1}, nothing[3] = {0, 0, 0};
    const float odd[3] = {NAN, 0.5f, INFINITY}, level[3] = {0.7f, 0.7f, 0.7f};
    const float rising[3] = {0.6f, 0.7f, 0.75f}, falling[3] = {0.8f, 0.7f, 0.4f};
    assert_float_equal(prom_accuracy_fit_near(e, perfect, 3), 0.0f, 0.0f);
    assert_float_equal(prom_accuracy_fit_near(e, level, 3), 0.0f, 0.0f);
    assert_float_equal(prom_accuracy_fit_near(e, rising, 3), 0.0f, 0.0f);
    assert_true(prom_accuracy_fit_near(e, falling, 3) > 0.1f);
    assert_float_equal(prom_accuracy_fit_near(e, nothing, 3), 0.0f, 0.0f);
    assert_float_equal(prom_accuracy_fit_near(nothing, perfect, 3), 0.0f, 0.0f);
    assert_float_equal(prom_accuracy_fit_near(NULL, NULL, 0), 0.0f, 0.0f);
    assert_float_equal(prom_accuracy_fit_near(e, odd, 3), 0.0f, 0.0f); // one row tells nothing
}

// ---- pixels

static void footprint_of_a_full_disc(void **state)
{
    (void)state;
    prom_model m;
    random_model(&m, 6, &small_model);
    m.coverage[0][7] = 65535;
    assert_float_equal(prom_footprint_px(&m, 0, 7, 100.0f), 7853.98f, 0.1f);
    m.coverage[0][7] = 0;
    assert_float_equal(prom_footprint_px(&m, 0, 7, 100.0f), 0.0f, 0.0f);
    prom_model_finish(&m);
}

// DESIGN: with accuracy 1 everywhere, B(node) = sum of B(children | node).
static void split_keeps_the_pixels_of_a_cluster(void **state)
{
    (void)state;
    uint64_t seed = 7;
    float in_view[16], px[16];
    for (int round = 0; round < 40; round++) {
        prom_model m;
        random_model(&m, 100 + (uint64_t)round, &small_model);
        for (uint32_t p = 0; p < m.prototype_count; p++) {
            uint32_t count = m.prototypes[p].child_count;
            if (!count) continue;
            bool any = false;
            for (uint32_t c = 0; c < count; c++) {
                in_view[c] = random_below(&seed, 3) ? random_unit(&seed) : 0.0f;
                any = any || in_view[c] > 0.0f;
            }
            float pixels = powf(10.0f, random_between(&seed, -2, 6));
            uint32_t dir = random_below(&seed, PROM_DIRS);
            if (random_below(&seed, 5) == 0) // nothing was visible when it was baked
                for (uint32_t c = 0; c < count; c++)
                    m.shares[m.prototypes[p].first_share + c][dir] = 0;
            prom_split_pixels(&m, p, dir, pixels, in_view, px);
            double sum = 0.0;
            for (uint32_t c = 0; c < count; c++) {
                assert_true(px[c] >= 0.0f);
                if (!(in_view[c] > 0.0f)) assert_float_equal(px[c], 0.0f, 0.0f);
                sum += px[c];
            }
            assert_true(fabs(sum / pixels - (any ? 1.0 : 0.0)) < 1e-5);
        }
        prom_model_finish(&m);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_never_promise_more),
        cmocka_unit_test(accuracy_of_full_geometry_is_1),
        cmocka_unit_test(accuracy_meets_its_table_and_is_continuous),
        cmocka_unit_test(accuracy_falls_beyond_the_measured_sizes),
        cmocka_unit_test(near_fit_recovers_its_parameter),
        cmocka_unit_test(footprint_of_a_full_disc),
        cmocka_unit_test(split_keeps_the_pixels_of_a_cluster),
    };
    return cmocka_run_group_tests_name("benefit", tests, NULL, NULL);
}
