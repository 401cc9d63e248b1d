// LINK: prom_builder prom_benefit prom_metaobj
// NEEDS: promenade
// `promenade compare` from outside: what it prints, draws and answers.
#include "picture_bytes.h"
#include "run_program.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>

#include <cmocka.h>

#include "benefit/colour_map.h"
#include "builder/picture_file.h"
#include "metaobj/base/alloc.h"

#define W 48
#define H 32

static program_run run;

static void expect(const char *arguments, int code)
{
    run_program(&run, arguments);
    if (run.code != code) fail_msg("promenade %s: %d: %s", arguments, run.code, run.err);
}

static void write_bytes(const char *name, const void *data, size_t count)
{
    FILE *out = fopen(name, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(data, 1, count, out), count);
    assert_int_equal(fclose(out), 0);
}

static void write_png(const char *name, uint32_t width, uint32_t height, const uint8_t *rgb)
{
    static picture_bytes png;
    png_form form = {.width = width, .height = height, .depth = 8, .type = 2};
    make_png(&png, &form, rgb, (size_t)width * 3);
    write_bytes(name, png.data, png.count);
}

static void write_grey_exr(const char *name, const float values[W * H])
{
    static picture_bytes exr;
    make_plain_exr(&exr, W, H, "Y", values);
    write_bytes(name, exr.data, exr.count);
}

// A number of the JSON that was printed.
static double found(const char *key)
{
    char name[64];
    snprintf(name, sizeof name, "\"%s\":", key);
    const char *at = strstr(run.out, name);
    if (!at) fail_msg("no %s in %s", key, run.out);
    return at ? strtod(at + strlen(name), NULL) : 0;
}

static uint8_t left[W * H * 3], right[W * H * 3];

static int make_pictures(void **state)
{
    (void)state;
    enter_scratch();
    for (size_t i = 0; i < sizeof left; i++) left[i] = right[i] = (uint8_t)(i * 7 % 251);
    for (int y = 8; y < 16; y++) // a quarter of the height, a third of the width
        memset(right + 3 * (y * W + 16), 255, 16 * 3);
    write_png("a.png", W, H, left);
    write_png("b.png", W, H, right);
    write_png("small.png", W - 1, H, left);
    return 0;
}

static int remove_pictures(void **state)
{
    (void)state;
    leave_scratch();
    return 0;
}

static void equal_pictures_have_no_error(void **state)
{
    (void)state;
    expect("compare a.png a.png --metric all --json", 0);
    unsigned metrics = 0;
    for (char *at = run.out; (at = strstr(at, "\"metric\"")); at++, metrics++) {
        memmove(run.out, at, strlen(at) + 1);
        at = run.out;
        static const char *const keys[] = {
            "mean", "weighted_median", "p50",           "p75", "p95", "p99",
            "max",  "differing",       "differing_mean"};
        for (size_t k = 0; k < sizeof keys / sizeof *keys; k++)
            assert_true(found(keys[k]) == 0); // -0 too
    }
    assert_int_equal(metrics, prom_metric_count());
    expect("compare a.png a.png --metric all --threshold 0", 0);
}

static void a_difference_shows_in_every_metric(void **state)
{
    (void)state;
    for (size_t i = 0; i < prom_metric_count(); i++) {
        char arguments[128];
        snprintf(arguments, sizeof arguments, "compare a.png b.png --metric %s --json",
                 prom_metric_at(i)->name);
        expect(arguments, 0);
        assert_non_null(strstr(run.out, "\"a\": \"a.png\""));
        assert_non_null(strstr(run.out, prom_metric_at(i)->name));
        assert_true(found("width") == W && found("height") == H);
        double mean = found("mean"), most = found("max");
        assert_true(mean > 0 && mean < found("differing_mean"));
        assert_true(found("differing_mean") <= most && most <= 1);
        assert_true(found("p50") <= found("p75") && found("p75") <= found("p95"));
        assert_true(found("p95") <= found("p99") && found("p99") <= most);
        assert_true(fabs(found("differing") - 128.0 / (W * H)) < 1e-6);
    }
}

// The text is for people: it names what was compared, the pixels per degree, and every metric.
static void the_text_names_all(void **state)
{
    (void)state;
    expect("compare a.png b.png --metric all --ppd 33.5", 0);
    assert_non_null(strstr(run.out, "a.png, b.png: 48x32 pixels, 33.50 per degree"));
    for (size_t i = 0; i < prom_metric_count(); i++)
        assert_non_null(strstr(run.out, prom_metric_at(i)->name));
    assert_string_equal(run.err, "");
}

static void the_default_is_flip_on_a_full_screen(void **state)
{
    (void)state;
    static uint8_t wide[960 * 3];
    write_png("wide.png", 960, 1, wide);
    expect("compare wide.png wide.png --json", 0);
    assert_true(fabs(found("ppd") - 67.0206 / 4) < 1e-4);
    assert_non_null(strstr(run.out, "\"flip\""));
    expect("compare a.png a.png --json", 0); // narrower than filters are made for
    assert_true(found("ppd") == 1);
}

// Greys as floats: their luminance is the value itself.
static void rmse_is_the_root_of_the_mean_square(void **state)
{
    (void)state;
    static float a[W * H], b[W * H];
    double sum = 0, differing = 0;
    for (int i = 0; i < W * H; i++) {
        a[i] = (float)(i % 97) / 97;
        b[i] = i % 3 ? a[i] : a[i] * 0.75f;
        double d = (double)a[i] - (double)b[i];
        sum += d * d;
        differing += a[i] != b[i];
    }
    write_grey_exr("a.exr", a);
    write_grey_exr("b.exr", b);
    expect("compare a.exr b.exr --metric rmse --json", 0);
    assert_true(fabs(found("mean") - sqrt(sum / (W * H))) < 1e-6);
    assert_true(fabs(found("differing") - differing / (W * H)) < 1e-6);
    assert_true(fabs(found("differing_mean") - sqrt(sum / differing)) < 1e-6);
}

static void a_mean_above_the_threshold_exits_5(void **state)
{
    (void)state;
    expect("compare a.png b.png --metric rmse --json", 0);
    char arguments[128];
    double mean = found("mean");
    snprintf(arguments, sizeof arguments, "compare a.png b.png --metric rmse --threshold %.9g",
             mean * 1.001);
    expect(arguments, 0);
    snprintf(arguments, sizeof arguments, "compare a.png b.png --metric rmse --threshold %.9g",
             mean * 0.999);
    expect(arguments, 5);
    assert_int_equal(count_lines(run.err), 1);
    assert_non_null(strstr(run.err, "rmse"));
    assert_true(count_lines(run.out) >= 2); // the result is printed all the same
    expect("compare a.png b.png --metric all --threshold 0", 5);
}

// Where nothing differs nearby the map has the colour of 0, and inside the difference another.
static void the_map_shows_where(void **state)
{
    (void)state;
    uint8_t colours[256][3];
    prom_colour_map(colours);
    expect("compare a.png b.png --metric rmse --map map.png", 0);
    prom_picture_file map;
    assert_int_equal(prom_picture_file_read("map.png", &map, NULL), 0);
    assert_true(map.picture.width == W && map.picture.height == H);
    assert_int_equal(map.picture.channels, 3);
    const uint8_t *rgb = map.pixels;
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            bool inside = y >= 8 && y < 16 && x >= 16 && x < 32;
            bool shown = memcmp(rgb + 3 * (y * W + x), colours[0], 3) != 0;
            if (inside != shown) fail_msg("%d,%d: %d, %d", x, y, inside, shown);
        }
    prom_picture_file_finish(&map);
    unlink("map.png");
}

static void black_and_white_are_the_ends_of_the_map(void **state)
{
    (void)state;
    static float zero[W * H], one[W * H];
    uint8_t colours[256][3];
    prom_colour_map(colours);
    for (int i = 0; i < W * H; i++) one[i] = 1;
    write_grey_exr("zero.exr", zero);
    write_grey_exr("one.exr", one);
    expect("compare zero.exr one.exr --metric rmse --map ends.png", 0);
    prom_picture_file map;
    assert_int_equal(prom_picture_file_read("ends.png", &map, NULL), 0);
    assert_memory_equal(map.pixels, colours[255], 3);
    prom_picture_file_finish(&map);
    unlink("ends.png");
}

// One line that names the file, and nothing else printed or written.
static void refused(const char *arguments, int code, const char *name)
{
    expect(arguments, code);
    assert_string_equal(run.out, "");
    assert_int_equal(count_lines(run.err), 1);
    if (!strstr(run.err, name)) fail_msg("`%s` names no %s", run.err, name);
}

static void unusable_pictures_exit_2(void **state)
{
    (void)state;
    static picture_bytes png;
    png_form form = {.width = W, .height = H, .depth = 8, .type = 2};
    make_png(&png, &form, left, W * 3);
    write_bytes("cut.png", png.data, png.count / 2);
    write_bytes("text.png", "no picture\n", 11);
    refused("compare a.png small.png", 2, "48x32");
    refused("compare a.png small.png", 2, "47x32");
    refused("compare a.png missing.png", 2, "missing.png");
    refused("compare missing.png a.png", 2, "missing.png");
    refused("compare a.png cut.png --map m.png", 2, "cut.png");
    refused("compare text.png a.png", 2, "text.png");
    refused("compare a.png .", 2, ".");
    static float wild[W * H] = {[5] = NAN};
    write_grey_exr("wild.exr", wild);
    refused("compare wild.exr a.png", 2, "wild.exr");
    assert_int_equal(access("m.png", F_OK), -1);
}

static void a_map_that_cannot_be_written_exits_4(void **state)
{
    (void)state;
    refused("compare a.png b.png --map nowhere/m.png", 4, "nowhere/m.png");
    refused("compare a.png b.png --map .", 4, ".");
    refused("compare a.png b.png --map ./a.png", 1, "a.png");
    prom_picture_file kept; // the input stands
    assert_int_equal(prom_picture_file_read("a.png", &kept, NULL), 0);
    assert_memory_equal(kept.pixels, left, sizeof left);
    prom_picture_file_finish(&kept);
}

static void what_is_left_out_is_said(void **state)
{
    (void)state;
    static picture_bytes png;
    static uint8_t rgba[W * H * 4];
    png_form form = {.width = W, .height = H, .depth = 8, .type = 6};
    make_png(&png, &form, rgba, W * 4);
    write_bytes("clear.png", png.data, png.count);
    expect("compare clear.png a.png --metric rmse", 0);
    assert_int_equal(count_lines(run.err), 1);
    assert_non_null(strstr(run.err, "clear.png"));
    assert_non_null(strstr(run.err, "alpha"));
}

static void a_map_is_of_one_metric(void **state)
{
    (void)state;
    expect("compare a.png b.png --metric all --map m.png", 1);
    assert_non_null(strstr(run.err, "one metric"));
    assert_int_equal(access("m.png", F_OK), -1);
}

// ---- the colours of the map

// OKLab of an sRGB colour, by the forward matrices (Ottosson 2020).
static void to_oklab(const uint8_t rgb[3], double lab[3])
{
    double linear[3];
    for (int c = 0; c < 3; c++) {
        double v = rgb[c] / 255.0;
        linear[c] = v <= 0.04045 ? v / 12.92 : pow((v + 0.055) / 1.055, 2.4);
    }
    static const double lms[3][3] = {{0.4122214708, 0.5363325363, 0.0514459929},
                                     {0.2119034982, 0.6806995451, 0.1073969566},
                                     {0.0883024619, 0.2817188376, 0.6299787005}};
    static const double to_lab[3][3] = {{0.2104542553, 0.7936177850, -0.0040720468},
                                        {1.9779984951, -2.4285922050, 0.4505937099},
                                        {0.0259040371, 0.7827717662, -0.8086757660}};
    double roots[3];
    for (int i = 0; i < 3; i++)
        roots[i] = cbrt(lms[i][0] * linear[0] + lms[i][1] * linear[1] + lms[i][2] * linear[2]);
    for (int i = 0; i < 3; i++)
        lab[i] = to_lab[i][0] * roots[0] + to_lab[i][1] * roots[1] + to_lab[i][2] * roots[2];
}

static void equal_steps_of_error_look_equal(void **state)
{
    (void)state;
    enum { STEP = 15 }; // of 255: colours of 8 bits are too coarse for less
    uint8_t colours[256][3];
    double lab[256][3], least = INFINITY, most = 0;
    prom_colour_map(colours);
    for (int i = 0; i < 256; i++) to_oklab(colours[i], lab[i]);
    assert_true(lab[0][0] < 0.16 && lab[255][0] > 0.97);
    for (int i = STEP; i < 256; i += STEP) {
        double d = 0;
        for (int c = 0; c < 3; c++) d += pow(lab[i][c] - lab[i - STEP][c], 2);
        least = fmin(least, sqrt(d));
        most = fmax(most, sqrt(d));
    }
    if (most > 1.1 * least) fail_msg("steps from %g to %g", least, most);
    for (int i = 3; i < 256; i++) assert_true(lab[i][0] > lab[i - 3][0]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equal_pictures_have_no_error),
        cmocka_unit_test(a_difference_shows_in_every_metric),
        cmocka_unit_test(the_text_names_all),
        cmocka_unit_test(the_default_is_flip_on_a_full_screen),
        cmocka_unit_test(rmse_is_the_root_of_the_mean_square),
        cmocka_unit_test(a_mean_above_the_threshold_exits_5),
        cmocka_unit_test(the_map_shows_where),
        cmocka_unit_test(black_and_white_are_the_ends_of_the_map),
        cmocka_unit_test(unusable_pictures_exit_2),
        cmocka_unit_test(a_map_that_cannot_be_written_exits_4),
        cmocka_unit_test(what_is_left_out_is_said),
        cmocka_unit_test(a_map_is_of_one_metric),
        cmocka_unit_test(equal_steps_of_error_look_equal),
    };
    return cmocka_run_group_tests(tests, make_pictures, remove_pictures);
}
