// LINK: prom_metaobj
//
// FLIP. The cases and the expected values of `vectors` come from an independent implementation
// in double precision that reproduces the authors' published values; their pictures are not
// all made of 8-bit values, so they enter behind the decoding.
#include "benefit/flip.c"
#include "flip_reference.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { SIDE = 64, PIXELS = SIDE * SIDE, WIDTH = 61, HEIGHT = 37 };

// The authors' default, unrounded.
#define PPD (0.7 * 3840 / 0.7 * M_PI / 180)
#define PAIR_PPD 22.34

// ---- known values

// Encoded sRGB of a pixel of a case's first or second picture.
typedef void painter(int x, int y, int picture, float rgb[3]);

static void set(float rgb[3], double r, double g, double b)
{
    rgb[0] = (float)r, rgb[1] = (float)g, rgb[2] = (float)b;
}

static void grey(float rgb[3], double value)
{
    set(rgb, value, value, value);
}

static void black_white(int x, int y, int picture, float rgb[3])
{
    (void)x, (void)y;
    grey(rgb, picture);
}

static void green_blue(int x, int y, int picture, float rgb[3])
{
    (void)x, (void)y;
    set(rgb, 0, !picture, picture);
}

static void red_cyan(int x, int y, int picture, float rgb[3])
{
    (void)x, (void)y;
    set(rgb, !picture, picture, picture);
}

static void neighbouring_greys(int x, int y, int picture, float rgb[3])
{
    (void)x, (void)y;
    grey(rgb, (128 + picture) / 255.0);
}

static void equal_greys(int x, int y, int picture, float rgb[3])
{
    (void)x, (void)y, (void)picture;
    grey(rgb, 0.5);
}

static void white_pixel(int x, int y, int picture, float rgb[3])
{
    grey(rgb, picture && x == 32 && y == 32);
}

static void shifted_edge(int x, int y, int picture, float rgb[3])
{
    (void)y;
    grey(rgb, x < 32 + picture ? 0.2 : 0.8);
}

static void checker_grey(int x, int y, int picture, float rgb[3])
{
    grey(rgb, picture ? 0.5 : (x + y) % 2);
}

static void checker_mean(int x, int y, int picture, float rgb[3])
{
    grey(rgb, picture ? 0.735357 : (x + y) % 2); // as bright as the checker from afar
}

static void ramps(int x, int y, int picture, float rgb[3])
{
    (void)y;
    set(rgb, picture ? 1 - x / 63.0 : x / 63.0, 0.25, 0.25);
}

static const struct vector {
    const char *name;
    painter *paint;
    double ppd, mean, max, min, center; // center: at (32, 32)
} vectors[] = {
    {"black and white", black_white, PPD, 0.9673798, 0.9673798, 0.9673798, 0.9673798},
    {"green and blue", green_blue, PPD, 1, 1, 1, 1},
    {"red and cyan", red_cyan, PPD, 0.9799065, 0.9799065, 0.9799065, 0.9799065},
    {"greys 128 and 129", neighbouring_greys, PPD, 0.0298552, 0.0298552, 0.0298552, 0.0298552},
    {"equal greys", equal_greys, PPD, 0, 0, 0, 0},
    {"one white pixel", white_pixel, PPD, 0.003494, 0.8649065, 0, 0.8649065},
    {"one white pixel, 1920", white_pixel, PPD / 2, 0.0015747, 0.9764668, 0, 0.9764668},
    {"shifted edge", shifted_edge, PPD, 0.0354978, 0.6061746, 0, 0.4466766},
    {"checker and grey", checker_grey, PPD, 0.5181887, 0.7914641, 0.5118946, 0.5118946},
    {"checker and its mean", checker_mean, PPD, 0.0042024, 0.5157402, 0.0010368, 0.0010368},
    {"ramps", ramps, PPD, 0.7400589, 0.9667689, 0.0806024, 0.0806024},
};

static void paint_planes(prom_flip *f, painter *paint)
{
    for (int picture = 0; picture < 2; picture++)
        for (int i = 0; i < PIXELS; i++) {
            float rgb[3], opponent[CHANNELS];
            paint(i % SIDE, i / SIDE, picture, rgb);
            for (int c = 0; c < 3; c++) rgb[c] = prom_srgb_to_linear(rgb[c]);
            opponent_of_rgb(f, rgb, opponent);
            for (int c = 0; c < CHANNELS; c++)
                f->opponent[picture][c * PIXELS + i] = opponent[c];
        }
}

static void known_values_are_met(void **state)
{
    (void)state;
    const double close = 1e-4; // what two implementations agree to in the mean
    static float map[PIXELS];
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) {
        const struct vector *v = &vectors[i];
        prom_flip *f = prom_flip_create(SIDE, SIDE, v->ppd);
        paint_planes(f, v->paint);
        double mean = compare_planes(f, map), max = 0, min = 1;
        for (int k = 0; k < PIXELS; k++) {
            max = fmax(max, (double)map[k]);
            min = fmin(min, (double)map[k]);
        }
        double center = map[32 * SIDE + 32];
        if (fabs(mean - v->mean) > close || fabs(max - v->max) > close ||
            fabs(min - v->min) > close || fabs(center - v->center) > close)
            fail_msg("%s: mean %.7f, max %.7f, min %.7f, center %.7f", v->name, mean, max, min,
                     center);
        prom_flip_destroy(f);
    }
}

static void the_greatest_difference_is_that_of_the_recipe(void **state)
{
    (void)state;
    prom_flip *f = prom_flip_create(1, 1, PPD);
    assert_float_equal(f->greatest, 41.27610, 1e-4);
    prom_flip_destroy(f);
}

// ---- properties

// Noise in blocks, so that there are edges, points and flat parts.
static void random_picture(uint8_t *pixels, uint32_t stride, uint32_t seed)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        for (uint32_t c = 0; c < stride; c++) {
            uint32_t block = i % WIDTH / 5 + i / WIDTH / 4 * WIDTH;
            uint32_t hash = (block * 4 + (c < 3 ? c : i) + 1) * 2654435761u ^ seed * 40503u;
            pixels[i * stride + c] = (uint8_t)((hash * 2246822519u) >> 24);
        }
}

typedef struct pair {
    prom_flip *flip;
    uint8_t a[WIDTH * HEIGHT * 4], b[WIDTH * HEIGHT * 4];
    float map[WIDTH * HEIGHT], other[WIDTH * HEIGHT];
} pair;

static int open_pair(void **state)
{
    static pair p;
    p.flip = prom_flip_create(WIDTH, HEIGHT, PAIR_PPD);
    random_picture(p.a, 4, 1);
    random_picture(p.b, 4, 2);
    *state = &p;
    return 0;
}

static int close_pair(void **state)
{
    pair *p = *state;
    prom_flip_destroy(p->flip);
    return 0;
}

static void errors_are_in_range_and_their_mean_is_returned(void **state)
{
    pair *p = *state;
    double mean = prom_flip_run(p->flip, p->a, p->b, 4, p->map), sum = 0;
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        assert_true(p->map[i] >= 0 && p->map[i] <= 1);
        sum += p->map[i];
    }
    assert_float_equal(mean, sum / (WIDTH * HEIGHT), 1e-9);
    assert_true(mean > 0.1);
}

static void it_is_symmetric(void **state)
{
    pair *p = *state;
    double ab = prom_flip_run(p->flip, p->a, p->b, 4, p->map);
    double ba = prom_flip_run(p->flip, p->b, p->a, 4, p->other);
    assert_true(ab == ba);
    assert_memory_equal(p->map, p->other, sizeof p->map);
}

static void equal_pictures_have_no_error(void **state)
{
    pair *p = *state;
    assert_true(prom_flip_run(p->flip, p->a, p->a, 4, p->map) == 0);
    memcpy(p->b, p->a, sizeof p->b);
    for (int i = 0; i < WIDTH * HEIGHT; i++) p->b[4 * i + 3] ^= 0x5a; // alpha is not looked at
    assert_true(prom_flip_run(p->flip, p->a, p->b, 4, p->map) == 0);
}

static void strides_are_heeded(void **state)
{
    pair *p = *state;
    static uint8_t a[WIDTH * HEIGHT * 3], b[WIDTH * HEIGHT * 3];
    for (int i = 0; i < WIDTH * HEIGHT; i++) {
        memcpy(a + 3 * i, p->a + 4 * i, 3);
        memcpy(b + 3 * i, p->b + 4 * i, 3);
    }
    double four = prom_flip_run(p->flip, p->a, p->b, 4, p->map);
    double three = prom_flip_run(p->flip, a, b, 3, p->other);
    assert_true(three == four && three > 0);
    assert_memory_equal(p->map, p->other, sizeof p->map);
}

// Far from the change nothing is different, and turning both pictures turns the errors.
static void errors_stay_near_the_change_and_turn_with_it(void **state)
{
    pair *p = *state;
    enum { X = 20, Y = 9, REACH = 4 + 4 }; // more than the filters' radius
    memcpy(p->b, p->a, sizeof p->b);
    for (int c = 0; c < 3; c++) p->b[(Y * WIDTH + X) * 4 + c] ^= 0x80;
    prom_flip_run(p->flip, p->a, p->b, 4, p->map);
    assert_true(p->map[Y * WIDTH + X] > 0.1f);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        if (abs(i % WIDTH - X) > REACH || abs(i / WIDTH - Y) > REACH)
            assert_true(p->map[i] == 0);
    for (int i = 0, j = WIDTH * HEIGHT - 1; i < j; i++, j--)
        for (int k = 0; k < 2; k++) {
            uint8_t *picture = k ? p->b : p->a, pixel[4];
            memcpy(pixel, picture + 4 * i, 4);
            memcpy(picture + 4 * i, picture + 4 * j, 4);
            memcpy(picture + 4 * j, pixel, 4);
        }
    prom_flip_run(p->flip, p->a, p->b, 4, p->other);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_float_equal(p->map[i], p->other[WIDTH * HEIGHT - 1 - i], 1e-3);
}

// The known values say little of colours that change from pixel to pixel.
static void coloured_pictures_follow_the_recipe(void **state)
{
    pair *p = *state;
    static flip_reference r = {.width = WIDTH, .height = HEIGHT, .ppd = PAIR_PPD};
    flip_reference_set(&r, 0, p->a);
    flip_reference_set(&r, 1, p->b);
    prom_flip_run(p->flip, p->a, p->b, 4, p->map);
    for (int i = 0; i < WIDTH * HEIGHT; i++)
        assert_float_equal(p->map[i], flip_reference_error(&r, i % WIDTH, i / WIDTH), 1e-4);
}

// The ends of what a filter is made for, and pictures smaller than it.
static void extreme_sizes_work(void **state)
{
    (void)state;
    const double ppds[] = {PROM_PPD_MIN, PROM_FLIP_PPD, PROM_PPD_MAX};
    const uint8_t black[] = {0, 0, 0}, white[] = {255, 255, 255};
    float map[1];
    for (int i = 0; i < 3; i++) {
        prom_flip *f = prom_flip_create(1, 1, ppds[i]);
        assert_float_equal(prom_flip_run(f, black, white, 3, map), 0.9673798, 1e-4);
        prom_flip_destroy(f);
    }
}

#define WITH_PAIR(test) cmocka_unit_test_setup_teardown(test, open_pair, close_pair)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_values_are_met),
        cmocka_unit_test(the_greatest_difference_is_that_of_the_recipe),
        WITH_PAIR(errors_are_in_range_and_their_mean_is_returned),
        WITH_PAIR(it_is_symmetric),
        WITH_PAIR(equal_pictures_have_no_error),
        WITH_PAIR(strides_are_heeded),
        WITH_PAIR(errors_stay_near_the_change_and_turn_with_it),
        WITH_PAIR(coloured_pictures_follow_the_recipe),
        cmocka_unit_test(extreme_sizes_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
