// LINK: prom_builder prom_benefit prom_metaobj
// Pictures from foreign files: the values of good ones stay as they are, broken ones are
// errors.
#include "picture_bytes.h"
#include "picture_samples.h"
#include "scene_files.h"

#include "builder/picture_file.h"
#include "builder/picture_parts.h"
#include "metaobj/base/math.h"

#include <signal.h>
#include <sys/stat.h>

static picture_bytes file;

static prom_picture_file read_bytes(const char *name)
{
    prom_picture_file picture;
    prom_error error = {0};
    const char *path = scene_write_bytes(name, file.data, file.count);
    if (prom_picture_file_read(path, &picture, &error)) fail_msg("%s", error.text);
    return picture;
}

static void expect_bytes(const char *name, uint32_t channels, const uint8_t *values,
                         size_t count)
{
    prom_picture_file p = read_bytes(name);
    assert_false(p.picture.floats);
    assert_int_equal(p.picture.channels, channels);
    assert_int_equal((size_t)p.picture.width * p.picture.height * channels, count);
    assert_ptr_equal(p.picture.pixels, p.pixels);
    assert_memory_equal(p.pixels, values, count);
    prom_picture_file_finish(&p);
}

static void expect_floats(const char *name, uint32_t channels, const float *values,
                          size_t count)
{
    prom_picture_file p = read_bytes(name);
    assert_true(p.picture.floats);
    assert_int_equal(p.picture.channels, channels);
    assert_int_equal((size_t)p.picture.width * p.picture.height * channels, count);
    assert_memory_equal(p.pixels, values, count * sizeof *values);
    prom_picture_file_finish(&p);
}

// ---- what is in the file is what comes out

static void bytes_stay_as_they_are(void **state)
{
    (void)state;
    uint8_t rgb[5 * 3 * 3];
    for (size_t i = 0; i < sizeof rgb; i++) rgb[i] = (uint8_t)(i * 37);
    png_form form = {.width = 5, .height = 3, .depth = 8, .type = 2};
    make_png(&file, &form, rgb, 15);
    expect_bytes("rgb.png", 3, rgb, sizeof rgb);
    // What the file says of its gamma or place changes nothing.
    form.extra = "gAMA";
    form.extra_data = "\0\1\x86\xa0"; // 1.0
    form.extra_bytes = 4;
    make_png(&file, &form, rgb, 15);
    expect_bytes("gamma.png", 3, rgb, sizeof rgb);
    form.extra = "oFFs";
    form.extra_data = "\0\0\0\3\0\0\0\2";
    form.extra_bytes = 9;
    make_png(&file, &form, rgb, 15);
    expect_bytes("offset.png", 3, rgb, sizeof rgb);
    form = (png_form){.width = 15, .height = 3, .depth = 8, .type = 0};
    make_png(&file, &form, rgb, 15);
    expect_bytes("grey.png", 1, rgb, sizeof rgb);
}

static void palettes_and_few_bits_are_expanded(void **state)
{
    (void)state;
    static const uint8_t palette[] = {1, 2, 3, 250, 120, 7};
    static const uint8_t shown[] = {250, 120, 7, 1, 2, 3, 1, 2, 3, 250, 120, 7};
    png_form form = {.width = 4, .height = 1, .depth = 8, .type = 3};
    form.extra = "PLTE";
    form.extra_data = palette;
    form.extra_bytes = sizeof palette;
    make_png(&file, &form, (uint8_t[]){1, 0, 0, 1}, 4);
    expect_bytes("palette.png", 3, shown, sizeof shown);
    form.depth = 1;
    make_png(&file, &form, (uint8_t[]){0x90}, 1);
    expect_bytes("palette1.png", 3, shown, sizeof shown);
    form = (png_form){.width = 4, .height = 1, .depth = 2, .type = 0};
    make_png(&file, &form, (uint8_t[]){0x1b}, 1);
    expect_bytes("grey2.png", 1, (uint8_t[]){0, 85, 170, 255}, 4);
}

static void colours_are_not_multiplied_by_alpha(void **state)
{
    (void)state;
    static const uint8_t rgba[] = {200, 100, 50, 255, 200, 100, 50, 128, 9, 8, 7, 0};
    static const uint8_t rgb[] = {200, 100, 50, 200, 100, 50, 9, 8, 7};
    png_form form = {.width = 3, .height = 1, .depth = 8, .type = 6};
    make_png(&file, &form, rgba, sizeof rgba);
    expect_bytes("rgba.png", 3, rgb, sizeof rgb);
    prom_picture_file p = read_bytes("rgba.png");
    assert_true(p.transparent);
    assert_int_equal(p.left_out, 0);
    prom_picture_file_finish(&p);
    form.width = 1;
    make_png(&file, &form, rgba, 4);
    p = read_bytes("opaque.png");
    assert_false(p.transparent);
    prom_picture_file_finish(&p);
    form = (png_form){.width = 2, .height = 1, .depth = 8, .type = 4};
    make_png(&file, &form, (uint8_t[]){77, 255, 78, 10}, 4);
    expect_bytes("grey-alpha.png", 1, (uint8_t[]){77, 78}, 2);
}

static void wide_integers_become_linear_floats(void **state)
{
    (void)state;
    static const uint16_t values[] = {0, 1, 257, 1000, 32768, 65535};
    uint8_t big[12];
    float linear[6];
    for (int i = 0; i < 6; i++) {
        big[2 * i] = (uint8_t)(values[i] >> 8);
        big[2 * i + 1] = (uint8_t)values[i];
        linear[i] = prom_srgb_to_linear((float)values[i] / 65535.0f);
    }
    png_form form = {.width = 3, .height = 2, .depth = 16, .type = 0};
    make_png(&file, &form, big, 6);
    expect_floats("grey16.png", 1, linear, 6);
    assert_true(linear[1] > 0); // more than 8 bits are kept
}

static void floats_stay_as_they_are(void **state)
{
    (void)state;
    static const float grey[] = {0, -1.5f, 1e30f, 0.1f, 65504, 1e-30f};
    make_plain_exr(&file, 3, 2, "Y", grey);
    expect_floats("grey.exr", 1, grey, 6);
    // Alphabetic in the file, R, G, B here; depth and alpha are left out.
    static const float abgrz[] = {1, 0.3f, 0.2f, 0.1f, 99, 0.5f, 6, 5, 4, 98};
    make_plain_exr(&file, 2, 1, "ABGRZ", abgrz);
    expect_floats("rgb.exr", 3, (float[]){0.1f, 0.2f, 0.3f, 4, 5, 6}, 6);
    make_plain_exr(&file, 2, 1, "AYZ", (float[]){1, 0.3f, 99, 0.5f, 6, 98});
    expect_floats("grey-alpha.exr", 1, (float[]){0.3f, 6}, 2);
    make_plain_exr(&file, 2, 1, "Z", (float[]){1, 0.3f});
    expect_floats("depth.exr", 1, (float[]){1, 0.3f}, 2);
    make_plain_exr(&file, 2, 1, "ABGRZ", abgrz);
    prom_picture_file p = read_bytes("rgb.exr");
    assert_true(p.transparent);
    assert_int_equal(p.left_out, 1);
    prom_picture_file_finish(&p);
}

static void an_exr_fills_its_display_window(void **state)
{
    (void)state;
    static const float six[] = {1, 2, 3, 4, 5, 6}; // 3x2 pixels from (-1, 1) on
    static const float shown[] = {0, 0, 0, 2, 3, 0, 5, 6, 0};
    make_exr(&file, (int32_t[]){-1, 1, 1, 2}, (int32_t[]){0, 0, 2, 2}, "Y", six);
    expect_floats("window.exr", 1, shown, 9);
    make_exr(&file, (int32_t[]){-1, 1, 1, 2}, (int32_t[]){5, 5, 6, 6}, "Y", six);
    expect_floats("elsewhere.exr", 1, (float[4]){0}, 4);
}

static void other_formats_are_read(void **state)
{
    (void)state;
    file.count = 0;
    put_text(&file, "P6 2 1 255\n\1\2\3\xfd\xfe\xff");
    expect_bytes("a.ppm", 3, (uint8_t[]){1, 2, 3, 253, 254, 255}, 6);
    file.count = 0;
    put_text(&file, "Pf\n2 1\n-1.0\n");
    put_bytes(&file, (float[]){0.25f, 7}, 8);
    expect_floats("a.pfm", 1, (float[]){0.25f, 7}, 2);
    static const uint8_t tga[] = {0, 0, 2, 0,  0,    0, 0, 0, 0,   0, 0, 0, 2,
                                  0, 1, 0, 32, 0x28, 3, 2, 1, 128, 6, 5, 4, 128};
    file.count = 0;
    put_bytes(&file, tga, sizeof tga);
    expect_bytes("a.tga", 3, (uint8_t[]){1, 2, 3, 4, 5, 6}, 6);
}

// ---- one form for two

static void pictures_are_brought_to_one_form(void **state)
{
    (void)state;
    uint8_t grey[] = {0, 128, 255, 9};
    float rgb[12];
    for (int i = 0; i < 12; i++) rgb[i] = prom_srgb8_to_linear(grey[i / 3]);
    png_form form = {.width = 2, .height = 2, .depth = 8, .type = 0};
    make_png(&file, &form, grey, 2);
    prom_picture_file a = read_bytes("a.png"), c = read_bytes("c.png");
    make_plain_exr(&file, 2, 2, "BGR", rgb);
    prom_picture_file b = read_bytes("b.exr");
    prom_picture_files_match(&a, &c);
    assert_int_equal(a.picture.channels, 1);
    assert_false(a.picture.floats);
    prom_picture_files_match(&a, &b);
    assert_int_equal(a.picture.channels, 3);
    assert_true(a.picture.floats);
    assert_memory_equal(a.pixels, rgb, sizeof rgb);
    assert_memory_equal(b.pixels, rgb, sizeof rgb);
    prom_picture_file_finish(&a);
    prom_picture_file_finish(&b);
    prom_picture_file_finish(&c);
}

static void sixteen_bits_of_the_same_value_are_the_same(void **state)
{
    (void)state;
    uint8_t narrow[256], wide[512];
    for (int i = 0; i < 256; i++) narrow[i] = wide[2 * i] = wide[2 * i + 1] = (uint8_t)i;
    png_form form = {.width = 256, .height = 1, .depth = 8, .type = 0};
    make_png(&file, &form, narrow, 256);
    prom_picture_file a = read_bytes("a.png");
    form.depth = 16;
    make_png(&file, &form, wide, 512);
    prom_picture_file b = read_bytes("b.png");
    prom_picture_files_match(&a, &b);
    assert_memory_equal(a.pixels, b.pixels, 256 * sizeof(float));
    prom_picture_file_finish(&a);
    prom_picture_file_finish(&b);
}

// ---- what cannot be read

// The error's text; the message always names the file.
static const char *refused(const char *path)
{
    static prom_error error;
    prom_picture_file picture;
    error = (prom_error){0};
    if (prom_picture_file_read(path, &picture, &error) != PROM_ERR_INPUT)
        fail_msg("%s: is read", path);
    prom_picture_file_finish(&picture);
    if (!strstr(error.text, path)) fail_msg("`%s` names no %s", error.text, path);
    return error.text;
}

static void expect_refused(const char *path, const char *words)
{
    const char *text = refused(path);
    if (!strstr(text, words)) fail_msg("`%s` lacks `%s`", text, words);
}

static void what_is_no_picture_is_refused(void **state)
{
    (void)state;
    expect_refused(scene_path("missing.png"), "No such file");
    expect_refused(scene_folder, "folder");
    expect_refused(scene_write("text.png", "this is no picture\n"), "no known picture format");
    expect_refused(scene_write("empty.png", ""), "no known picture format");
    assert_int_equal(mkfifo(scene_path("pipe.png"), 0600), 0);
    expect_refused(scene_path("pipe.png"), "no regular file");
}

static void values_that_are_not_finite_are_refused(void **state)
{
    (void)state;
    float values[12] = {0};
    values[3 * 2 + 1] = INFINITY; // G at 0,1 of two columns
    for (int i = 0; i < 2; i++, values[7] = NAN) {
        make_plain_exr(&file, 2, 2, "BGR", values);
        const char *path = scene_write_bytes("wild.exr", file.data, file.count);
        expect_refused(path, "channel 1 at pixel 0,1");
        expect_refused(path, i ? "nan" : "inf");
    }
    values[7] = 0;
    make_plain_exr(&file, 2, 2, "BGR", values);
    prom_picture_file p = read_bytes("tame.exr");
    prom_picture_file_finish(&p);
}

static void what_a_reader_would_change_is_refused(void **state)
{
    (void)state;
    expect_refused(scene_write_bytes("half.webp", sample_webp, sizeof sample_webp),
                   "multiplies");
}

static void a_jpeg(picture_bytes *to)
{
    to->count = 0;
    put_bytes(to, sample_jpeg, sizeof sample_jpeg);
}

static void a_png(picture_bytes *to)
{
    uint8_t rows[9 * 9];
    for (size_t i = 0; i < sizeof rows; i++) rows[i] = (uint8_t)(i * 11);
    png_form form = {.width = 9, .height = 9, .depth = 8, .type = 0};
    make_png(to, &form, rows, 9);
}

static void an_exr(picture_bytes *to)
{
    static float values[5 * 4 * 4];
    for (int i = 0; i < 5 * 4 * 4; i++) values[i] = (float)i;
    make_plain_exr(to, 5, 4, "ABGR", values);
}

static const struct {
    void (*make)(picture_bytes *to);
    size_t tail; // bytes at the end that no value depends on
    const char *name;
} kinds[] = {{a_png, 20, "a.png"}, {an_exr, 0, "a.exr"}, {a_jpeg, 2, "a.jpg"}};

static void no_part_of_a_picture_is_a_picture(void **state)
{
    (void)state;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
        kinds[k].make(&file);
        prom_picture_file whole = read_bytes(kinds[k].name);
        prom_picture_file_finish(&whole);
        for (size_t cut = 0; cut < file.count - kinds[k].tail; cut += 3)
            refused(scene_write_bytes(kinds[k].name, file.data, cut));
    }
}

static void spoiled_pictures_are_read_or_refused(void **state)
{
    (void)state;
    uint32_t seed = 1;
    unsigned read = 0;
    for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++)
        for (int turn = 0; turn < 60; turn++) {
            kinds[k].make(&file);
            for (int i = 0; i < 2; i++) {
                seed = seed * 1664525u + 1013904223u;
                file.data[(seed >> 8) % file.count] = (uint8_t)seed;
            }
            const char *path = scene_write_bytes(kinds[k].name, file.data, file.count);
            prom_picture_file p;
            prom_error error = {0};
            prom_status status = prom_picture_file_read(path, &p, &error);
            assert_true(status == PROM_OK || status == PROM_ERR_INPUT);
            if (status) assert_non_null(strstr(error.text, path));
            read += !status;
            prom_picture_file_finish(&p);
        }
    assert_true(read > 0); // some bytes are only values
}

static void claims_beyond_reason_are_refused(void **state)
{
    (void)state;
    static const uint32_t sizes[][2] = {
        {65536, 65536},           {16385, 1}, {1, 16385}, {16384, 16384},
        {0x7fffffff, 0x7fffffff}, {0, 1}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        png_form form = {.width = sizes[i][0], .height = sizes[i][1], .depth = 8, .type = 2};
        png_start(&file, &form);
        png_data(&file, (const uint8_t *)"", 0);
        png_chunk(&file, "IEND", "", 0);
        refused(scene_write_bytes("huge.png", file.data, file.count));
    }
    // A display of more pixels than there are data.
    static const int32_t far = 2000000000;
    make_exr(&file, (int32_t[4]){0}, (int32_t[]){-far, -far, far, far}, "Y", (float[]){1});
    refused(scene_write_bytes("far.exr", file.data, file.count));
    make_exr(&file, (int32_t[4]){0}, (int32_t[]){0, 0, 20000, 20000}, "Y", (float[]){1});
    expect_refused(scene_write_bytes("wide.exr", file.data, file.count), "too large");
    // Data that end before their header says so.
    an_exr(&file);
    static const int32_t claimed[4] = {0, 0, 8191, 8191};
    for (size_t i = 0; i + 16 < file.count; i++)
        if (!memcmp(file.data + i, (int32_t[]){0, 0, 4, 3}, 16))
            memcpy(file.data + i, claimed, 16);
    refused(scene_write_bytes("claim.exr", file.data, file.count));
}

static void die(void)
{
    raise(SIGSEGV);
}

static void a_crash_of_the_decoder_names_the_file(void **state)
{
    (void)state;
    a_png(&file);
    const char *path = scene_write_bytes("a.png", file.data, file.count);
    prom_picture_child_hook = die;
    expect_refused(path, "the decoder crashed (signal 11");
    prom_picture_child_hook = NULL;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bytes_stay_as_they_are),
        cmocka_unit_test(palettes_and_few_bits_are_expanded),
        cmocka_unit_test(colours_are_not_multiplied_by_alpha),
        cmocka_unit_test(wide_integers_become_linear_floats),
        cmocka_unit_test(floats_stay_as_they_are),
        cmocka_unit_test(an_exr_fills_its_display_window),
        cmocka_unit_test(other_formats_are_read),
        cmocka_unit_test(pictures_are_brought_to_one_form),
        cmocka_unit_test(sixteen_bits_of_the_same_value_are_the_same),
        cmocka_unit_test(what_is_no_picture_is_refused),
        cmocka_unit_test(values_that_are_not_finite_are_refused),
        cmocka_unit_test(what_a_reader_would_change_is_refused),
        cmocka_unit_test(no_part_of_a_picture_is_a_picture),
        cmocka_unit_test(spoiled_pictures_are_read_or_refused),
        cmocka_unit_test(claims_beyond_reason_are_refused),
        cmocka_unit_test(a_crash_of_the_decoder_names_the_file),
    };
    return cmocka_run_group_tests(tests, scene_folder_make, scene_folder_remove);
}
