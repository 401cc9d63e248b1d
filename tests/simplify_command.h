// For tests of `promenade simplify`: what it must exit with, and meshes with materials in a
// folder of their own. Include it after cmocka's header.
#ifndef PROM_TESTS_SIMPLIFY_COMMAND_H
#define PROM_TESTS_SIMPLIFY_COMMAND_H

#include "picture_bytes.h"
#include "run_program.h"

#include <jansson.h>
#include <math.h>
#include <sys/stat.h>

#define SIDE 24 // quads along a sheet

static program_run run;
static bool has_gl;

static inline void expect(int code, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static inline void expect(int code, const char *format, ...)
{
    char arguments[1024];
    va_list list;
    va_start(list, format);
    vsnprintf(arguments, sizeof arguments, format, list);
    va_end(list);
    run_program(&run, arguments);
    if (run.code != code) fail_msg("promenade %s: %d: %s", arguments, run.code, run.err);
}

static inline FILE *create(const char *name)
{
    FILE *out = fopen(name, "w");
    assert_non_null(out);
    return out;
}

static inline void write_text(const char *name, const char *text)
{
    FILE *out = create(name);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

// A picture whose texels all differ a little.
static inline void write_picture(const char *name, uint8_t red, int channels)
{
    static picture_bytes png;
    uint8_t pixels[16 * 16 * 4];
    for (int i = 0; i < 256; i++) {
        const uint8_t texel[4] = {red, (uint8_t)i, (uint8_t)(255 - i),
                                  (uint8_t)(i % 16 < 5 ? 0 : 255)};
        memcpy(pixels + channels * i, texel, (size_t)channels);
    }
    png_form form = {.width = 16, .height = 16, .depth = 8, .type = channels == 4 ? 6 : 2};
    make_png(&png, &form, pixels, (size_t)(16 * channels));
    FILE *out = create(name);
    assert_int_equal(fwrite(png.data, 1, png.count, out), png.count);
    assert_int_equal(fclose(out), 0);
}

static inline double height(int i, int j)
{
    return 0.2 * sin(0.4 * i) * cos(0.3 * j);
}

// A waved square, its left half of material `left`, its right half of `right`.
static inline void write_sheet(const char *name, const char *library, double x,
                               const char *left, const char *right)
{
    FILE *out = create(name);
    fprintf(out, "mtllib %s\n", library);
    for (int i = 0; i <= SIDE; i++)
        for (int j = 0; j <= SIDE; j++)
            fprintf(out, "v %.9g %.9g %.9g\nvt %.9g %.9g\n", x + 2.0 * i / SIDE, height(i, j),
                    2.0 * j / SIDE, 1.5 * i / SIDE, 1.0 * j / SIDE);
    for (int i = 0; i < SIDE; i++) {
        if (i == 0) fprintf(out, "usemtl %s\n", left);
        if (i == SIDE / 2) fprintf(out, "usemtl %s\n", right);
        for (int j = 0; j < SIDE; j++) {
            const int a = i * (SIDE + 1) + j + 1, b = a + SIDE + 1;
            fprintf(out, "f %d/%d %d/%d %d/%d %d/%d\n", a, a, a + 1, a + 1, b + 1, b + 1, b, b);
        }
    }
    assert_int_equal(fclose(out), 0);
}

static inline void write_colored(const char *name)
{
    FILE *out = create(name);
    fprintf(out,
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
            "property float z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\n"
            "element face 4\nproperty list uchar int vertex_indices\nend_header\n"
            "0 0 0 255 10 20\n1 0.1 0.3 30 255 40\n0.2 1 0.1 50 60 255\n0.1 0.2 1 128 128 0\n"
            "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    assert_int_equal(fclose(out), 0);
}

static inline void write_inputs(void)
{
    write_text("sheet.mtl", "newmtl red\nKd 1 1 1\nmap_Kd red.png\n"
                            "newmtl grate\nKd 0.5 0.8 0.9\nmap_Kd grate.png\n"
                            "newmtl masked\nKd 1 1 1\nmap_Kd red.png\nmap_d mask.png\n"
                            "newmtl plain\nKd 0.2 0.5 0.7\n"
                            "newmtl glass\nKd 0.3 0.6 0.2\nd 0.4\n");
    write_picture("red.png", 200, 3);
    write_picture("grate.png", 90, 4);
    write_picture("mask.png", 30, 3);
    write_sheet("two.obj", "sheet.mtl", 0, "red", "grate");
    write_sheet("one.obj", "sheet.mtl", 0, "grate", "grate");
    write_sheet("masked.obj", "sheet.mtl", 0, "masked", "plain");
    write_sheet("glass.obj", "sheet.mtl", 0, "glass", "red");
    write_sheet("far.obj", "sheet.mtl", -5000, "plain", "red");
    write_colored("colored.ply");
    assert_int_equal(mkdir("below", 0777), 0);
    assert_int_equal(mkdir("alone", 0777), 0);
}

static inline double number(const json_t *json, const char *path)
{
    char keys[128];
    snprintf(keys, sizeof keys, "%s", path);
    for (char *key = strtok(keys, "."); key; key = strtok(NULL, "."))
        json = json_object_get(json, key);
    if (!json_is_number(json)) fail_msg("%s is no number", path);
    return json_number_value(json);
}

static inline bool exists(const char *path)
{
    return access(path, F_OK) == 0;
}

static inline bool text_has(const char *path, const char *part)
{
    char text[4096];
    slurp(path, text, sizeof text);
    return strstr(text, part) != NULL;
}

static inline int setup(void **state)
{
    (void)state;
    enter_scratch();
    write_inputs();
    run_program(&run, "compare-mesh one.obj one.obj --samples 1 --views 1 --size-px 16");
    has_gl = run.code != 3;
    return 0;
}

static inline int teardown(void **state)
{
    (void)state;
    leave_scratch();
    return 0;
}

#endif
