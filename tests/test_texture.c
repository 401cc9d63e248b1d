// LINK: prom_metaobj
// Textures: sizes, stored mips, dilation.
#include "container_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

static double share_above(const prom_texture *t, uint32_t level, int cutoff)
{
    uint32_t w = t->width >> level, h = t->height >> level;
    size_t n = (size_t)(w ? w : 1) * (h ? h : 1), above = 0;
    const uint8_t *p = t->pixels + prom_texture_offset(t, level, 0);
    for (size_t i = 0; i < n; i++) above += p[4 * i + 3] >= cutoff;
    return (double)above / (double)n;
}

static void mips_keep_coverage(void **state)
{
    (void)state;
    uint32_t seed = 4;
    prom_texture t;
    prom_texture_init(&t, PROM_TEXTURE_COLOR, 256, 128);
    for (size_t i = 0; i < 256 * 128; i++) { // foliage: 30 % of the texels, scattered
        memset(t.pixels + 4 * i, 200, 3);
        t.pixels[4 * i + 3] = fixture_random(&seed) % 10 < 3 ? 255 : 0;
    }
    prom_texture_make_mips(&t, 0.5f);
    double share = share_above(&t, 0, 128);
    for (uint32_t level = 1; level < 6; level++)
        assert_float_equal(share_above(&t, level, 128), share, 0.08);
    prom_texture_make_mips(&t, 0);
    assert_true(share_above(&t, 3, 128) < 0.01); // without it they thin out
    prom_texture_finish(&t);
}

static void mips_average_light(void **state)
{
    (void)state;
    prom_texture t;
    prom_texture_init(&t, PROM_TEXTURE_COLOR, 7, 5); // odd sizes shrink without a shift
    assert_int_equal(t.levels, 3);
    for (int y = 0; y < 5; y++)
        for (int x = 0; x < 7; x++) {
            uint8_t *p = t.pixels + 4 * (y * 7 + x);
            p[0] = p[1] = p[2] = (x + y) % 2 ? 255 : 0;
            p[3] = 255;
        }
    prom_texture_make_mips(&t, 0.5f);
    const uint8_t *last = t.pixels + prom_texture_offset(&t, 2, 0);
    assert_float_equal(prom_srgb8_to_linear(last[0]), (17.0f / 35), 0.05f);
    assert_int_equal(last[3], 255);
    prom_texture_finish(&t);
    // Colour of uncovered texels does not come through.
    prom_texture_init(&t, PROM_TEXTURE_COLOR, 2, 2);
    memcpy(t.pixels,
           (uint8_t[]){10, 20, 30, 255, 255, 0, 255, 0, 255, 0, 255, 0, 10, 20, 30, 255}, 16);
    prom_texture_make_mips(&t, 0);
    assert_memory_equal(t.pixels + 16, ((uint8_t[]){10, 20, 30, 128}), 4);
    prom_texture_finish(&t);
}

static void mips_of_normals(void **state)
{
    (void)state;
    prom_texture t;
    prom_texture_init(&t, PROM_TEXTURE_IMPOSTOR_ALBEDO, 2, 2);
    uint8_t *p = t.pixels + prom_texture_offset(&t, 0, 7);
    for (int i = 0; i < 4; i++) // half +x, half +z
        memcpy(p + 4 * i,
               i % 2 ? (uint8_t[]){255, 128, 128, 255} : (uint8_t[]){128, 128, 255, 255}, 4);
    prom_texture_make_mips(&t, 0);
    const uint8_t *q = t.pixels + prom_texture_offset(&t, 1, 7);
    assert_true(abs(q[0] - 218) <= 1 && abs(q[1] - 128) <= 1 && abs(q[2] - 218) <= 1);
    assert_int_equal(q[3], 255);
    prom_texture_finish(&t);
}

static void texture_sizes(void **state)
{
    (void)state;
    prom_texture t;
    prom_texture_init(&t, PROM_TEXTURE_IMPOSTOR_LIT, 5, 3);
    assert_int_equal(t.levels, 3);
    assert_int_equal(prom_texture_bytes(&t), 6 * 4 * (15 + 2 + 1));
    assert_int_equal(prom_texture_offset(&t, 1, 2), 4 * (6 * 15 + 2 * 2));
    prom_texture wrong = t;
    wrong.layers = 5;
    assert_int_equal(prom_texture_bytes(&wrong), 0);
    wrong = t;
    wrong.levels = 4;
    assert_int_equal(prom_texture_bytes(&wrong), 0);
    wrong = t;
    wrong.width = PROM_TEXTURE_MAX + 1;
    assert_int_equal(prom_texture_bytes(&wrong), 0);
    wrong = t;
    wrong.kind = PROM_TEXTURE_KIND_COUNT;
    assert_int_equal(prom_texture_bytes(&wrong), 0);
    prom_texture_finish(&t);
}

static void dilation(void **state)
{
    (void)state;
    prom_texture t;
    prom_texture_init(&t, PROM_TEXTURE_COLOR, 16, 16);
    for (int i = 0; i < 256; i++) memcpy(t.pixels + 4 * i, (uint8_t[]){255, 0, 255, 0}, 4);
    uint8_t *left = t.pixels + 4 * (8 * 16 + 2), *right = t.pixels + 4 * (8 * 16 + 13);
    memcpy(left, (uint8_t[]){100, 0, 0, 255}, 4);
    memcpy(right, (uint8_t[]){0, 100, 0, 255}, 4);
    prom_texture_dilate(&t, 2);
    for (int i = 0; i < 256; i++) {
        const uint8_t *p = t.pixels + 4 * i;
        int x = i % 16, y = i / 16, dl = abs(x - 2), dr = abs(x - 13), dy = abs(y - 8);
        bool covered = dy == 0 && (dl == 0 || dr == 0);
        assert_int_equal(p[3], covered ? 255 : 0); // alpha stays
        if (dl <= 2 && dy <= 2)
            assert_memory_equal(p, ((uint8_t[]){100, 0, 0}), 3);
        else if (dr <= 2 && dy <= 2)
            assert_memory_equal(p, ((uint8_t[]){0, 100, 0}), 3);
        else // the mean, in linear light
            assert_true(p[0] == p[1] && p[0] > 60 && p[0] < 80 && p[2] == 0);
    }
    prom_texture_finish(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(mips_keep_coverage), cmocka_unit_test(mips_average_light),
        cmocka_unit_test(mips_of_normals),    cmocka_unit_test(texture_sizes),
        cmocka_unit_test(dilation),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
