// LINK: prom_benefit prom_metaobj
//
// FLIP, with the loops for each kind of processor. The cases and the expected values of
// `vectors` come from an independent implementation in double precision that reproduces the
// authors' published values; their pictures are not all made of 8-bit values, so they enter as
// linear floats.
#include "benefit/flip.c"

#include "benefit/flip.h"
#include "metaobj/model.h"

#include "flip_reference.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

enum { SIDE = 64, PIXELS = SIDE * SIDE, WIDTH = 61, HEIGHT = 37 };

#define FOR_EACH_LOOPS(l) for (size_t l = 0; prom_flip_loops_at(l); l++)

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

// ---- running

// The mean; the map, if wanted.
static double flip_of(prom_picture a, prom_picture b, double ppd, size_t loops, float *map)
{
    static float own[PIXELS], both[2][PIXELS * PROM_FLIP_PLANES];
    const uint32_t side = a.width > a.height ? a.width : a.height;
    const size_t pixels = (size_t)a.width * a.height;
    map = map ? map : own;
    flip *f = prom_metric_flip.create(ppd, side, pixels, 1);
    f->loops = prom_flip_loops_at(loops);
    prom_metric_flip.features(f, &a, both[0]);
    prom_metric_flip.features(f, &b, both[1]);
    prom_metric_flip.compare(f, both[0], both[1], a.width, a.height, map);
    prom_metric_flip.destroy(f);
    double sum = 0;
    for (size_t i = 0; i < pixels; i++) sum += map[i];
    return sum / (double)pixels;
}

// ---- known values

static prom_picture painted(painter *paint, int picture)
{
    static float pixels[2][PIXELS][3];
    for (int i = 0; i < PIXELS; i++) {
        float *rgb = pixels[picture][i];
        paint(i % SIDE, i / SIDE, picture, rgb);
        for (int c = 0; c < 3; c++) rgb[c] = prom_srgb_to_linear(rgb[c]);
    }
    return (prom_picture){SIDE, SIDE, 3, .floats = true, .pixels = pixels[picture]};
}

static void expect_vector(const struct vector *v, size_t loops)
{
    const double close = 1e-4; // what two implementations agree to in the mean
    static float map[PIXELS];
    double mean = flip_of(painted(v->paint, 0), painted(v->paint, 1), v->ppd, loops, map);
    double max = 0, min = 1, center = map[32 * SIDE + 32];
    for (int k = 0; k < PIXELS; k++) {
        max = fmax(max, (double)map[k]);
        min = fmin(min, (double)map[k]);
    }
    if (fabs(mean - v->mean) > close || fabs(max - v->max) > close ||
        fabs(min - v->min) > close || fabs(center - v->center) > close)
        fail_msg("%s: mean %.7f, max %.7f, min %.7f, center %.7f", v->name, mean, max, min,
                 center);
}

static void known_values_are_met(void **state)
{
    (void)state;
    FOR_EACH_LOOPS(l)
    for (size_t i = 0; i < sizeof vectors / sizeof *vectors; i++) expect_vector(&vectors[i], l);
}

// ---- properties

// Noise in blocks, so that there are edges, points and flat parts.
static void random_picture(uint8_t *rgba, uint32_t seed)
{
    for (uint32_t i = 0; i < WIDTH * HEIGHT; i++)
        for (uint32_t c = 0; c < 4; c++) {
            uint32_t patch = i % WIDTH / 5 + i / WIDTH / 4 * WIDTH;
            uint32_t hash = (patch * 4 + (c < 3 ? c : i) + 1) * 2654435761u ^ seed * 40503u;
            rgba[i * 4 + c] = (uint8_t)((hash * 2246822519u) >> 24);
        }
}

typedef struct pair {
    uint8_t pixels[2][WIDTH * HEIGHT * 4];
    prom_picture a, b;
    float map[WIDTH * HEIGHT], other[WIDTH * HEIGHT];
} pair;

static int open_pair(void **state)
{
    static pair p;
    for (uint32_t i = 0; i < 2; i++) {
        random_picture(p.pixels[i], i + 1);
        *(i ? &p.b : &p.a) = (prom_picture){WIDTH, HEIGHT, 4, .pixels = p.pixels[i]};
    }
    *state = &p;
    return 0;
}

static void turn(uint8_t *rgba)
{
    for (int i = 0, j = WIDTH * HEIGHT - 1; i < j; i++, j--) {
        uint8_t pixel[4];
        memcpy(pixel, rgba + 4 * i, 4);
        memcpy(rgba + 4 * i, rgba + 4 * j, 4);
        memcpy(rgba + 4 * j, pixel, 4);
    }
}

// As far from the change as the radius says nothing is different, and turning both pictures
// turns the errors.
static void errors_stay_near_the_change_and_turn_with_it(void **state)
{
    pair *p = *state;
    enum { X = 20, Y = 9, REACH = 4 };
    flip *f = prom_metric_flip.create(PAIR_PPD, WIDTH, WIDTH * HEIGHT, 1);
    assert_int_equal(prom_metric_flip.radius(f), REACH);
    prom_metric_flip.destroy(f);
    memcpy(p->pixels[1], p->pixels[0], sizeof p->pixels[0]);
    for (int c = 0; c < 3; c++) p->pixels[1][(Y * WIDTH + X) * 4 + c] ^= 0x80;
    FOR_EACH_LOOPS(l)
    {
        flip_of(p->a, p->b, PAIR_PPD, l, p->map);
        assert_true(p->map[Y * WIDTH + X] > 0.1f);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            if (abs(i % WIDTH - X) > REACH || abs(i / WIDTH - Y) > REACH)
                assert_true(p->map[i] == 0);
        for (int i = 0; i < 2; i++) turn(p->pixels[i]);
        flip_of(p->a, p->b, PAIR_PPD, l, p->other);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            assert_float_equal(p->map[i], p->other[WIDTH * HEIGHT - 1 - i], 1e-3);
        for (int i = 0; i < 2; i++) turn(p->pixels[i]);
    }
}

// The known values say little of colours that change from pixel to pixel. From fewer pixels per
// degree than a filter has room for to filters half as wide as the picture.
static void coloured_pictures_follow_the_recipe(void **state)
{
    pair *p = *state;
    static flip_reference r = {.width = WIDTH, .height = HEIGHT};
    const double ppds[] = {PROM_PPD_MIN, 8.25, PAIR_PPD, PPD, 140};
    flip_reference_set(&r, 0, p->pixels[0]);
    flip_reference_set(&r, 1, p->pixels[1]);
    FOR_EACH_LOOPS(l)
    for (size_t k = 0; k < sizeof ppds / sizeof *ppds; k++) {
        r.ppd = ppds[k];
        flip_of(p->a, p->b, r.ppd, l, p->map);
        const int step = r.ppd < 30 ? 1 : 23; // the reference is slow
        for (int i = 0; i < WIDTH * HEIGHT; i += step)
            assert_float_equal(p->map[i], flip_reference_error(&r, i % WIDTH, i / WIDTH), 5e-5);
    }
}

static void processors_agree(void **state)
{
    pair *p = *state;
    double first = flip_of(p->a, p->b, PAIR_PPD, 0, p->map);
    FOR_EACH_LOOPS(l)
    {
        assert_float_equal(flip_of(p->a, p->b, PAIR_PPD, l, p->other), first, 1e-6);
        for (int i = 0; i < WIDTH * HEIGHT; i++)
            assert_float_equal(p->other[i], p->map[i], 1e-5);
    }
}

// The ends of what a filter is made for, and pictures smaller than it.
static void extreme_sizes_work(void **state)
{
    (void)state;
    const double ppds[] = {PROM_PPD_MIN, PROM_FLIP_PPD, PROM_PPD_MAX};
    const uint8_t black[7] = {0}, white[7] = {255, 255, 255, 255, 255, 255, 255};
    float map[7];
    FOR_EACH_LOOPS(l)
    for (int i = 0; i < 3; i++)
        for (int tall = 0; tall < 2; tall++) {
            prom_picture a = {tall ? 1 : 7, tall ? 7 : 1, 1, .pixels = black}, b = a;
            b.pixels = white;
            assert_float_equal(flip_of(a, b, ppds[i], l, map), 0.9673798, 1e-4);
        }
}

// ---- forms of pictures

static void bytes_and_linear_floats_mean_the_same(void **state)
{
    pair *p = *state;
    static float pixels[2][WIDTH * HEIGHT * 4];
    prom_picture floats[2];
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < WIDTH * HEIGHT * 4; k++)
            pixels[i][k] = prom_srgb8_to_linear(p->pixels[i][k]);
        floats[i] = (prom_picture){WIDTH, HEIGHT, 4, .floats = true, .pixels = pixels[i]};
    }
    flip_of(p->a, p->b, PAIR_PPD, 0, p->map);
    flip_of(floats[0], floats[1], PAIR_PPD, 0, p->other);
    assert_memory_equal(p->map, p->other, sizeof p->map);
}

static void what_no_screen_shows_is_clamped(void **state)
{
    (void)state;
    const float over[] = {7, -3, 1e30f}, within[] = {1, 0, 1};
    prom_picture a = {1, 1, 3, .floats = true, .pixels = over}, b = a;
    b.pixels = within;
    assert_true(flip_of(a, b, PPD, 0, NULL) == 0);
}

static void greys_are_colours_of_three_equal_channels(void **state)
{
    pair *p = *state;
    static uint8_t rgb[2][WIDTH * HEIGHT * 3];
    prom_picture greys[2], colours[2];
    for (int i = 0; i < 2; i++) {
        for (int k = 0; k < WIDTH * HEIGHT * 3; k++) rgb[i][k] = p->pixels[i][k / 3];
        greys[i] = (prom_picture){WIDTH, HEIGHT, 1, .pixels = p->pixels[i]};
        colours[i] = (prom_picture){WIDTH, HEIGHT, 3, .pixels = rgb[i]};
    }
    assert_true(flip_of(greys[0], greys[1], PAIR_PPD, 0, p->map) > 0.1);
    flip_of(colours[0], colours[1], PAIR_PPD, 0, p->other);
    assert_memory_equal(p->map, p->other, sizeof p->map);
}

#define WITH_PAIR(test) cmocka_unit_test_setup(test, open_pair)

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(known_values_are_met),
        WITH_PAIR(errors_stay_near_the_change_and_turn_with_it),
        WITH_PAIR(coloured_pictures_follow_the_recipe),
        WITH_PAIR(processors_agree),
        cmocka_unit_test(extreme_sizes_work),
        WITH_PAIR(bytes_and_linear_floats_mean_the_same),
        cmocka_unit_test(what_no_screen_shows_is_clamped),
        WITH_PAIR(greys_are_colours_of_three_equal_channels),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
