// LINK: prom_builder prom_benefit prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
// `promenade compare-mesh` from outside: what it says of meshes that are known, and the views
// behind it. What needs GL is skipped without it.
#include "builder/mesh_pictures.h"
#include "metaobj/base/alloc.h"
#include "picture_bytes.h"
#include "run_program.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <jansson.h>

static program_run run;
static bool has_gl;

static void expect(const char *arguments, int code)
{
    run_program(&run, arguments);
    if (run.code != code) fail_msg("promenade %s: %d: %s", arguments, run.code, run.err);
}

// A box of outward faces from `low` to `high` along each axis, some faces left out at the end,
// with a material where `library` is not NULL.
static void write_box(const char *name, const float low[3], const float high[3], int faces,
                      const char *library)
{
    static const int order[6][4] = {{1, 3, 7, 5}, {0, 4, 6, 2}, {2, 6, 7, 3},
                                    {0, 1, 5, 4}, {4, 5, 7, 6}, {0, 2, 3, 1}};
    FILE *out = fopen(name, "w");
    assert_non_null(out);
    if (library) fprintf(out, "mtllib %s\nusemtl paint\n", library);
    for (int i = 0; i < 8; i++)
        fprintf(out, "v %.7g %.7g %.7g\n", (double)(i & 1 ? high[0] : low[0]),
                (double)(i & 2 ? high[1] : low[1]), (double)(i & 4 ? high[2] : low[2]));
    fputs("vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n", out);
    for (int f = 0; f < faces; f++)
        fprintf(out, "f %d/1 %d/2 %d/3 %d/4\n", order[f][0] + 1, order[f][1] + 1,
                order[f][2] + 1, order[f][3] + 1);
    assert_int_equal(fclose(out), 0);
}

static void write_text(const char *name, const char *text)
{
    FILE *out = fopen(name, "w");
    assert_non_null(out);
    fputs(text, out);
    assert_int_equal(fclose(out), 0);
}

static void write_texture(const char *name, uint8_t red, uint8_t green, uint8_t blue)
{
    static picture_bytes png;
    uint8_t rgb[8 * 8 * 3];
    for (int i = 0; i < 64; i++) memcpy(rgb + 3 * i, (uint8_t[3]){red, green, blue}, 3);
    png_form form = {.width = 8, .height = 8, .depth = 8, .type = 2};
    make_png(&png, &form, rgb, 8 * 3);
    FILE *out = fopen(name, "wb");
    assert_non_null(out);
    assert_int_equal(fwrite(png.data, 1, png.count, out), png.count);
    assert_int_equal(fclose(out), 0);
}

static void write_boxes(void)
{
    static const float low[3] = {-1, -1, -1}, high[3] = {1, 1, 1}, tall[3] = {1, 1.5f, 1},
                       moved_low[3] = {99, 199, -301}, moved_high[3] = {101, 201, -299};
    write_box("cube.obj", low, high, 6, NULL);
    write_box("tall.obj", low, tall, 6, NULL);
    write_box("open.obj", low, high, 5, NULL);
    write_box("far.obj", moved_low, moved_high, 6, NULL);
    write_box("red.obj", low, high, 6, "red.mtl");
    write_box("blue.obj", low, high, 6, "blue.mtl");
    write_text("red.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd red.png\n");
    write_text("blue.mtl", "newmtl paint\nKd 1 1 1\nmap_Kd blue.png\n");
    write_texture("red.png", 220, 30, 30);
    write_texture("blue.png", 30, 30, 220);
}

static json_t *result(const char *arguments)
{
    char line[512];
    snprintf(line, sizeof line, "compare-mesh %s --json --samples 50000", arguments);
    expect(line, 0);
    json_t *json = json_loads(run.out, 0, NULL);
    assert_non_null(json);
    return json;
}

// The number at a path of keys with dots between.
static double number(const json_t *json, const char *path)
{
    char keys[128];
    snprintf(keys, sizeof keys, "%s", path);
    for (char *key = strtok(keys, "."); key; key = strtok(NULL, "."))
        json = json_object_get(json, key);
    if (!json_is_number(json)) fail_msg("%s is no number", path);
    return json_number_value(json);
}

static double looks(const json_t *json, int metric, const char *key)
{
    const json_t *look = json_array_get(json_object_get(json, "looks"), (size_t)metric);
    assert_string_equal(json_string_value(json_object_get(look, "metric")),
                        prom_look_metrics[metric]);
    return number(look, key);
}

static void assert_close(double got, double want, double tolerance)
{
    if (!(fabs(got - want) <= tolerance)) fail_msg("%.9g, not %.9g", got, want);
}

// ---- distances

static void a_grown_box_has_grown_by_that(void **state)
{
    (void)state;
    json_t *json = result("cube.obj tall.obj --views 0");
    assert_close(number(json, "a.diagonal_units"), sqrt(12), 1e-6);
    assert_close(number(json, "hausdorff_units"), 0.5, 1e-6);
    assert_close(number(json, "hausdorff_percent"), 100 * 0.5 / sqrt(12), 1e-4);
    assert_close(number(json, "a.volume_cubic_units"), 8, 1e-6);
    assert_close(number(json, "b.volume_cubic_units"), 10, 1e-6);
    assert_close(number(json, "volume_difference_percent"), 25, 1e-5);
    assert_close(number(json, "a.area_square_units"), 24, 1e-6);
    assert_close(number(json, "b_to_a.samples"), 50000, 0);
    // From the taller one: its top is off by 0.5, its sides above by 0 to 0.5.
    double squares = 4 * 0.25 + 4 * 2 * 0.125 / 3, area = 2 * 4 + 4 * 2 * 2.5;
    assert_close(number(json, "b_to_a.rms_units"), sqrt(squares / area), 1e-4);
    assert_true(number(json, "rms_units") >= number(json, "a_to_b.rms_units"));
    json_decref(json);
}

static void ways_change_places(void **state)
{
    (void)state;
    json_t *json = result("cube.obj tall.obj --views 0");
    json_t *swapped = result("tall.obj cube.obj --views 0");
    assert_close(number(json, "hausdorff_units"), number(swapped, "hausdorff_units"), 1e-6);
    assert_close(number(json, "a_to_b.rms_units"), number(swapped, "b_to_a.rms_units"), 1e-5);
    assert_close(number(json, "b_to_a.rms_units"), number(swapped, "a_to_b.rms_units"), 1e-5);
    json_decref(json);
    json_decref(swapped);
}

// What floats would lose so far from the origin is not lost.
static void far_from_the_origin_nothing_is_lost(void **state)
{
    (void)state;
    json_t *json = result("far.obj far.obj --views 0");
    assert_close(number(json, "hausdorff_units"), 0, 0);
    assert_close(number(json, "a.volume_cubic_units"), 8, 1e-4);
    json_decref(json);
    json = result("cube.obj far.obj --views 0");
    double away = sqrt(100.0 * 100 + 200.0 * 200 + 300.0 * 300);
    assert_true(number(json, "a_to_b.max_units") > away - 4);
    json_decref(json);
}

static void an_open_box_has_no_volume(void **state)
{
    (void)state;
    json_t *json = result("cube.obj open.obj --views 0");
    assert_true(json_is_null(json_object_get(json, "volume_difference_percent")));
    assert_true(json_is_false(json_object_get(json_object_get(json, "b"), "closed")));
    assert_close(number(json, "b_to_a.max_units"), 0, 0);
    // The middle of the missing face is 1 from all others; samples are close to it.
    assert_close(number(json, "a_to_b.max_units"), 1, 0.02);
    json_decref(json);
    expect("compare-mesh cube.obj open.obj --views 0 --samples 100", 0);
    assert_non_null(strstr(run.out, "area 20, open"));
}

// ---- looks

static void equal_meshes_look_equal(void **state)
{
    (void)state;
    if (!has_gl) skip();
    json_t *json = result("red.obj red.obj --size-px 64");
    assert_close(number(json, "hausdorff_units"), 0, 0);
    assert_close(number(json, "rms_units"), 0, 0);
    assert_close(number(json, "volume_difference_percent"), 0, 0);
    assert_close(number(json, "views"), PROM_CUBE_VIEWS, 0);
    for (int m = 0; m < PROM_LOOK_METRICS; m++) {
        assert_close(looks(json, m, "mean"), 0, 0);
        assert_close(looks(json, m, "worst"), 0, 0);
    }
    json_decref(json);
}

static void another_texture_shows_though_nothing_moved(void **state)
{
    (void)state;
    if (!has_gl) skip();
    json_t *json = result("red.obj blue.obj --size-px 64 --ppd 20");
    assert_close(number(json, "hausdorff_units"), 0, 0);
    assert_true(looks(json, PROM_LOOK_FLIP, "object_mean") > 0.3);
    assert_true(looks(json, PROM_LOOK_RMSE, "object_mean") > 0.05); // of luminance
    for (int m = 0; m < PROM_LOOK_METRICS; m++) {
        assert_true(looks(json, m, "mean") < looks(json, m, "object_mean"));
        assert_true(looks(json, m, "worst") >= looks(json, m, "mean"));
    }
    json_decref(json);
}

// A grown top shows from the sides and, without perspective, hardly from above: least from the
// two faces along it.
static void views_see_what_is_on_their_side(void **state)
{
    (void)state;
    if (!has_gl) skip();
    json_t *json = result("cube.obj tall.obj --size-px 96");
    const json_t *look = json_array_get(json_object_get(json, "looks"), PROM_LOOK_FLIP);
    const json_t *views = json_object_get(look, "views");
    assert_int_equal(json_array_size(views), PROM_CUBE_VIEWS);
    for (size_t side = 0; side < 6; side++) {
        double flip = json_number_value(json_array_get(views, side));
        if (side == 2 || side == 3)
            assert_true(flip < 1e-6);
        else
            assert_true(flip > 0.01);
    }
    json_decref(json);
}

static void the_sheet_is_written(void **state)
{
    (void)state;
    if (!has_gl) skip();
    expect("compare-mesh red.obj tall.obj --samples 100 --size-px 64 --pictures sheets/red "
           "--report report.json",
           0);
    char png[32];
    slurp("sheets/red/worst_views.png", png, sizeof png);
    assert_memory_equal(png, "\x89PNG", 4);
    json_t *json = json_load_file("report.json", 0, NULL);
    assert_close(number(json, "views"), PROM_CUBE_VIEWS, 0);
    json_decref(json);
}

static void views_are_all_around(void **state)
{
    (void)state;
    float sum[3] = {0, 0, 0};
    for (uint32_t v = 0; v < PROM_CUBE_VIEWS; v++) {
        float d[3], other[3];
        prom_cube_view_direction(v, d);
        assert_close((double)glm_vec3_norm(d), 1, 1e-6);
        glm_vec3_add(sum, d, sum);
        for (uint32_t w = 0; w < v; w++) {
            prom_cube_view_direction(w, other);
            assert_true(glm_vec3_dot(d, other) < 0.9f);
        }
    }
    assert_close((double)glm_vec3_norm(sum), 0, 1e-5);
}

// ---- answers

static void thresholds_end_with_5(void **state)
{
    (void)state;
    const char *rest = "compare-mesh cube.obj tall.obj --views 0 --samples 1000";
    char line[256];
    snprintf(line, sizeof line, "%s --max-hausdorff-percent 15", rest);
    expect(line, 0);
    snprintf(line, sizeof line, "%s --max-hausdorff-percent 14", rest);
    expect(line, 5);
    assert_non_null(strstr(run.err, "--max-hausdorff-percent 14"));
    assert_non_null(strstr(run.out, "A to B")); // told all the same
    snprintf(line, sizeof line, "%s --max-rms-percent 0.01", rest);
    expect(line, 5);
}

static void wrong_calls_are_told(void **state)
{
    (void)state;
    expect("compare-mesh --help", 0);
    expect("compare-mesh cube.obj", 1);
    expect("compare-mesh cube.obj tall.obj open.obj", 1);
    expect("compare-mesh cube.obj tall.obj --views 27", 1);
    expect("compare-mesh cube.obj tall.obj --views 0 --max-flip 0.1", 1);
    expect("compare-mesh cube.obj tall.obj --report cube.obj", 1);
    expect("compare-mesh cube.obj tall.obj --report nowhere/r.json", 4);
    expect("compare-mesh cube.obj missing.obj", 2);
    assert_non_null(strstr(run.err, "missing.obj"));
    expect("compare-mesh red.png cube.obj", 2);
    assert_non_null(strstr(run.err, "red.png"));
}

static int setup(void **state)
{
    (void)state;
    enter_scratch();
    write_boxes();
    run_program(&run, "compare-mesh cube.obj cube.obj --samples 1 --views 1 --size-px 16");
    has_gl = run.code != 3;
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    leave_scratch();
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_grown_box_has_grown_by_that),
        cmocka_unit_test(ways_change_places),
        cmocka_unit_test(far_from_the_origin_nothing_is_lost),
        cmocka_unit_test(an_open_box_has_no_volume),
        cmocka_unit_test(equal_meshes_look_equal),
        cmocka_unit_test(another_texture_shows_though_nothing_moved),
        cmocka_unit_test(views_see_what_is_on_their_side),
        cmocka_unit_test(the_sheet_is_written),
        cmocka_unit_test(views_are_all_around),
        cmocka_unit_test(thresholds_end_with_5),
        cmocka_unit_test(wrong_calls_are_told),
    };
    return cmocka_run_group_tests_name("compare_mesh", tests, setup, teardown);
}
