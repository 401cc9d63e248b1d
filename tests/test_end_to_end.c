// LINK: prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
//
// The whole way through the program with a tiny city: scene, build, info, shot, bench, and what
// goes wrong with a real model at hand. Skips where there is no GL.

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include <jansson.h>

#include "tests/program_fixture.h"

#define SMALL " --resolution 160,90 --profile p.json --quiet"
// Comparing every view takes minutes under the sanitizers; the metrics have tests of their own.
#ifdef PROM_SANITIZE
#define QUICK " --quiet --metric constant"
#else
#define QUICK " --quiet"
#endif

static off_t size_of(const char *path)
{
    struct stat st;
    return stat(path, &st) == 0 ? st.st_size : -1;
}

static int make_model(void **state)
{
    (void)state;
    if (!calibrate_small()) return 0;
    expect("scene city --seed 7 --size 1 --detail 1 --styles 2 -o city.glb --path city.path",
           0);
    expect("build city.glb -o city.prom" QUICK, 0);
    return 0;
}

static json_t *at(json_t *json, const char *path)
{
    char text[128];
    snprintf(text, sizeof text, "%s", path);
    for (char *key = strtok(text, "."); key && json; key = strtok(NULL, "."))
        json = json_object_get(json, key);
    if (!json) fprintf(stderr, "no key %s\n", path);
    return json;
}

static double number(json_t *json, const char *path)
{
    json_t *value = at(json, path);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void the_build_leaves_the_model_and_its_work(void **state)
{
    (void)state;
    NEED_DEVICE();
    const char *const made[] = {"city.glb",       "city.path", "city.prom",
                                "city.prom.work", "p.json",    NULL};
    assert_int_equal(count_others(".", made), 0);
    assert_true(size_of("city.prom") > 0);
}

static void info_tells_what_was_built(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("info city.prom", 0);
    assert_non_null(strstr(run.out, "textured-box"));
    expect("info city.prom --json", 0);
    json_t *info = json_loads(run.out, 0, NULL);
    assert_non_null(info);
    double leaves = number(info, "nodes.leaves"), nodes = 0;
    assert_true(leaves > 1);
    assert_true(leaves == number(info, "nodes.objects") + number(info, "nodes.chunks") +
                              number(info, "nodes.blended"));
    size_t level;
    json_t *count;
    json_array_foreach(at(info, "nodes.by_level"), level, count) nodes +=
        (double)json_integer_value(count);
    assert_true(nodes == leaves + number(info, "nodes.clusters"));
    assert_true(number(info, "tables.node.rows") == nodes + number(info, "nodes.backdrops"));
    assert_true(number(info, "triangles") > 0);
    assert_true(number(info, "file_bytes") == (double)size_of("city.prom"));
    assert_true(json_array_size(at(info, "stages")) > 0);
    char patches[64];
    snprintf(patches, sizeof patches, ", %.0f patches", number(info, "repair.patches"));
    json_decref(info);
    expect("info city.prom", 0);
    const char *repair = strstr(run.out, "\nrepair  ");
    assert_non_null(repair);
    assert_non_null(strstr(repair, patches));
}

static void shots_are_written(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("shot city.prom --path city.path --frame 10 -o a.png" SMALL, 0);
    assert_true(size_of("a.png") > 200);
    expect("shot city.prom --eye 10,20,60 --look-at 0,0,0 --budget-ms 5 --selector meta "
           "--false-colours -o b.png" SMALL,
           0);
    assert_true(size_of("b.png") > 200);
    expect("shot city.prom --wireframe -o c.png" SMALL, 0);
    assert_true(size_of("c.png") > 200);
    const char *const made[] = {"city.glb",       "city.path", "city.prom",
                                "city.prom.work", "p.json",    "a.png",
                                "b.png",          "c.png",     NULL};
    assert_int_equal(count_others(".", made), 0);
}

// What it is drawn as has no part in what is chosen.
static void a_wireframe_is_that_of_the_picture(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("shot city.prom --path city.path --frame 10 --budget-ms 1 -o a.png" SMALL, 0);
    char *plain = strdup(run.out);
    expect(
        "shot city.prom --path city.path --frame 10 --budget-ms 1 --wireframe -o a.png" SMALL,
        0);
    assert_string_equal(run.out, plain);
    free(plain);
}

static void shots_end_with_the_path(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("shot city.prom --path city.path --frame 599 -o a.png" SMALL, 0);
    expect("shot city.prom --path city.path --frame 600 -o a.png" SMALL, 1);
    assert_non_null(strstr(run.err, "600 frames"));
}

// Full detail needs no cost model, so nothing is measured or kept for it; a budget needs one.
static void shots_measure_the_device_only_if_needed(void **state)
{
    (void)state;
    NEED_DEVICE();
    char here[1024], cache[1100];
    assert_non_null(getcwd(here, sizeof here));
    snprintf(cache, sizeof cache, "%s/cache", here);
    assert_int_equal(setenv("XDG_CACHE_HOME", cache, 1), 0);
    expect("shot city.prom --path city.path --resolution 160,90 -o a.png", 0);
    assert_null(strstr(run.err, "measuring"));
    assert_null(strstr(run.out, "predicted"));
    assert_int_equal(count_others("cache/promenade", NULL), 0);
    expect("shot city.prom --path city.path --resolution 160,90 --budget-ms 50 -o a.png", 0);
    assert_non_null(strstr(run.err, "measuring"));
    expect("shot city.prom --path city.path --resolution 160,90 -o a.png", 0);
    assert_non_null(strstr(run.out, "predicted"));
    expect("shot city.prom --resolution 96,96 --profile p.json -o a.png", 0);
    assert_non_null(strstr(run.err, "160x90"));
    unsetenv("XDG_CACHE_HOME");
    remove_tree("cache");
}

// The keys of a report.
static const char *const keys[] = {
    "scene",
    "path",
    "frames",
    "budget_ms",
    "selector",
    "frame_ms.mean",
    "frame_ms.p50",
    "frame_ms.p95",
    "frame_ms.p99",
    "frame_ms.max",
    "frame_ms.std",
    "miss_rate",
    "use_of_budget",
    "select_ms.mean",
    "select_ms.p99",
    "triangles.mean",
    "cut_nodes.mean",
    "start_s",
    "memory_mb.start",
    "memory_mb.end",
    "predict.mape",
    "predict.worst_under",
    "loss.mean",
    "holes.mean",
    "holes.max",
    "accuracy.mean",
    "accuracy.min",
    "accuracy.predicted",
    "device.renderer",
    "resolution",
    "quality.metric",
    "quality.ppd",
    "switches.mean",
    "weights",
    "frame_ms.p999",
    "change_ms.p99",
    "misses.quarters",
    "misses.rate_high",
    "contested.std_ms",
    "cold_start.misses.count",
    "guarantee.scale",
    "guarantee.margin",
    "gap",
    "cuts_hash",
};

static void check_run(json_t *one, const char *selector)
{
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++) assert_non_null(at(one, keys[i]));
    assert_string_equal(json_string_value(at(one, "selector")), selector);
    assert_true(number(one, "frames") == 12);
    assert_true(number(one, "budget_ms") == 20);
    double mean = number(one, "frame_ms.mean"), p50 = number(one, "frame_ms.p50");
    double p95 = number(one, "frame_ms.p95"), max = number(one, "frame_ms.max");
    assert_true(p50 > 0 && p50 <= p95 && p95 <= max && mean <= max);
    assert_true(fabs(number(one, "use_of_budget") - mean / 20) < 1e-6);
    double rate = number(one, "miss_rate");
    assert_true(rate >= 0 && rate <= 1);
    double holes = number(one, "holes.mean");
    assert_true(holes >= 0 && holes <= number(one, "holes.max"));
    double accuracy = number(one, "accuracy.mean"), least = number(one, "accuracy.min");
    assert_true(number(one, "accuracy.frames") == 3);
    assert_true(least > 0 && least <= accuracy && accuracy <= 1);
    assert_string_equal(json_string_value(at(one, "quality.metric")), "flip");
    assert_true(fabs(number(one, "quality.ppd") - 67.0206 * 160 / 3840) < 1e-9);
    assert_true(number(one, "quality.frames") == 3);
    double flip = number(one, "quality.mean"), worst = number(one, "quality.p95");
    assert_true(flip >= 0 && flip <= worst && worst < 1);
    // Of a pixel, more can be lost than it has (benefit/accuracy.h).
    assert_true(number(one, "quality.loss") >= 0 && number(one, "quality.loss") <= 4);
    const char *const shares[] = {"quality.hidden_cost", "quality.hidden_nodes"};
    for (int i = 0; i < 2; i++)
        assert_true(number(one, shares[i]) >= 0 && number(one, shares[i]) < 1);
    assert_true(number(one, "cut_nodes.mean") >= 1);
    assert_true(number(one, "memory_mb.end") > 0);
}

static void check_csv(const char *path)
{
    static char text[65536];
    slurp(path, text, sizeof text);
    assert_int_equal(count_lines(text), 13); // the header and 12 frames
    assert_int_equal(strncmp(text, "frame,t_s,budget_ms,frame_ms,select_ms,", 39), 0);
    // Every row has all fields; those of the comparison, the last ones, are empty where none
    // was made.
    int compared = 0, fields = 0;
    for (char *line = strtok(text, "\n"); line; line = strtok(NULL, "\n")) {
        int commas = 0;
        for (const char *c = line; *c; c++) commas += *c == ',';
        fields = fields ? fields : commas;
        assert_int_equal(commas, fields); // the header's
        compared += line[strlen(line) - 1] != ',';
    }
    assert_int_equal(compared, 1 + 3);
}

static void bench_reports_every_selector(void **state)
{
    (void)state;
    NEED_DEVICE();
    const char *const selectors[] = {"meta", "greedy", "distance", "full", "coarsest"};
    for (int i = 0; i < 5; i++) {
        char arguments[512];
        snprintf(
            arguments, sizeof arguments,
            "bench city.prom --path city.path --selector %s --budget-ms 20 --frames 12 "
            "--warmup 2 --check-holes 3 --check-accuracy 3 --quality-frames 3 --report r.json "
            "--csv r.csv --keep-frames kept --every 6 --false-colours" SMALL,
            selectors[i]);
        expect(arguments, 0);
        json_t *report = json_load_file("r.json", 0, NULL);
        assert_int_equal(json_array_size(at(report, "runs")), 1);
        check_run(json_array_get(at(report, "runs"), 0), selectors[i]);
        json_decref(report);
        check_csv("r.csv");
        const char *const pictures[] = {"frame-00000.png", "frame-00006.png",
                                        "frame-00000-colours.png", "frame-00006-colours.png",
                                        NULL};
        assert_int_equal(count_others("kept", pictures), 0);
        assert_true(size_of("kept/frame-00006.png") > 200);
    }
}

// Full detail is itself, pixel for pixel; the cheapest cut is not.
static void full_detail_is_accurate(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("bench city.prom --selector full --path city.path --frames 4 --warmup 0 "
           "--check-holes 4 --check-accuracy 4 --quality-frames 4 --report r.json" SMALL,
           0);
    json_t *report = json_load_file("r.json", 0, NULL);
    json_t *one = json_array_get(at(report, "runs"), 0);
    assert_true(number(one, "holes.max") == 0);
    assert_true(number(one, "accuracy.min") == 1 && number(one, "accuracy.predicted") == 1);
    assert_true(number(one, "quality.p95") == 0 && number(one, "quality.loss") == 0);
    // In a street most houses stand behind others, and some are seen.
    double hidden = number(one, "quality.hidden_nodes");
    assert_true(hidden > 0 && hidden < 1 && number(one, "quality.hidden_cost") > 0);
    json_decref(report);
    expect("bench city.prom --selector coarsest --path city.path --frames 4 --warmup 0 "
           "--check-accuracy 2 --quality-frames 3 --ppd 20 --report r.json" SMALL,
           0);
    assert_non_null(strstr(run.out, "\naccuracy "));
    assert_non_null(strstr(run.out, "\nquality "));
    report = json_load_file("r.json", 0, NULL);
    one = json_array_get(at(report, "runs"), 0);
    assert_true(json_is_null(at(one, "holes")));
    assert_true(number(one, "accuracy.frames") == 2 && number(one, "accuracy.mean") < 1);
    assert_true(number(one, "accuracy.predicted") < 1);
    assert_true(number(one, "quality.ppd") == 20 && number(one, "quality.frames") == 3);
    assert_true(number(one, "quality.mean") > 0 && number(one, "quality.loss") > 0);
    json_decref(report);
}

static void full_draws_at_least_what_coarsest_draws(void **state)
{
    (void)state;
    NEED_DEVICE();
    double triangles[2];
    const char *const selectors[] = {"full", "coarsest"};
    for (int i = 0; i < 2; i++) {
        char arguments[256];
        snprintf(arguments, sizeof arguments,
                 "bench city.prom --selector %s --path city.path --frames 3 --warmup 0 "
                 "--quality-frames 0 --report r.json" SMALL,
                 selectors[i]);
        expect(arguments, 0);
        json_t *report = json_load_file("r.json", 0, NULL);
        json_t *one = json_array_get(at(report, "runs"), 0);
        triangles[i] = number(one, "triangles.mean");
        assert_true(json_is_null(at(one, "quality")));
        json_decref(report);
    }
    assert_true(triangles[0] > triangles[1]);
}

// A budget below the cheapest cut is met with a warning that names one that would do.
static void an_impossible_budget_is_named(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("bench city.prom --path city.path --budget-ms 0.01 --frames 3 --warmup 0" SMALL, 0);
    assert_non_null(strstr(run.err, "would do"));
    assert_int_equal(count_lines(run.err), 1);
}

static void copy_head(const char *from, const char *to, long bytes)
{
    FILE *in = fopen(from, "rb"), *out = fopen(to, "wb");
    assert_non_null(in);
    assert_non_null(out);
    for (int c; bytes-- > 0 && (c = fgetc(in)) != EOF;) fputc(c, out);
    fclose(in);
    fclose(out);
}

static void expect_error(const char *arguments, int code, const char *name)
{
    expect(arguments, code);
    assert_int_equal(count_lines(run.err), 1);
    assert_non_null(strstr(run.err, name));
}

static void damaged_files_are_named(void **state)
{
    (void)state;
    NEED_DEVICE();
    FILE *file = fopen("bad.path", "w");
    assert_non_null(file);
    fputs("# a path\n0 0 0 0 0 0 0 1\n0.1 0 nonsense\n", file);
    fclose(file);
    expect_error("bench city.prom --path bad.path" SMALL, 2, "bad.path");
    expect_error("bench city.prom --path none.path" SMALL, 2, "none.path");
    expect_error("shot city.prom -o d.png --profile city.path --resolution 160,90", 2,
                 "city.path");
    long bytes = (long)size_of("city.prom");
    for (int i = 1; i < 4; i++) {
        copy_head("city.prom", "cut.prom", bytes * i / 4);
        expect_error("bench cut.prom --frames 1" SMALL, 2, "cut.prom");
    }
    copy_head("city.glb", "cut.glb", (long)size_of("city.glb") / 2);
    expect_error("build cut.glb -o d.prom --quiet", 2, "cut.glb");
    assert_int_equal(size_of("d.prom"), -1);
    assert_int_equal(size_of("d.prom.part"), -1);
    assert_int_equal(size_of("d.png"), -1);
}

// Bowls of several sizes on a grid: quick to build, with levels and clusters.
static void write_bowls(const char *path)
{
    enum { SIDE = 4, RINGS = 6, AROUND = 12 };
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    int vertices = 0;
    for (int i = 0; i < SIDE * SIDE; i++) {
        double size = 1 + i % 3;
        fprintf(file, "o bowl-%d\n", i);
        for (int k = 0; k < RINGS * AROUND; k++) {
            double radius = size * (1 + k / AROUND) / RINGS, turn = 2 * M_PI * k / AROUND;
            fprintf(file, "v %f %f %f\n", 10 * (i % SIDE) + radius * cos(turn),
                    radius * radius / size, 10 * (i / SIDE) + radius * sin(turn));
        }
        for (int k = 0; k < (RINGS - 1) * AROUND; k++) {
            int a = vertices + 1 + k, b = k % AROUND == AROUND - 1 ? a + 1 - AROUND : a + 1;
            fprintf(file, "f %d %d %d %d\n", a, b, b + AROUND, a + AROUND);
        }
        vertices += RINGS * AROUND;
    }
    assert_int_equal(fclose(file), 0);
}

static void the_same_build_has_the_same_content(void **state)
{
    (void)state;
    NEED_DEVICE();
    char first[17] = "";
    write_bowls("bowls.obj");
    for (int i = 0; i < 2; i++) {
        expect(i ? "build bowls.obj -o again.prom" QUICK : "build bowls.obj -o b.prom" QUICK,
               0);
        expect(i ? "info again.prom --json" : "info b.prom --json", 0);
        json_t *info = json_loads(run.out, 0, NULL);
        const char *content = json_string_value(at(info, "content"));
        assert_int_equal(strlen(content), 16);
        if (i) assert_string_equal(first, content);
        snprintf(first, sizeof first, "%s", content);
        assert_true(number(info, "nodes.clusters") > 0);
        json_decref(info);
    }
}

static void the_strict_octree_builds(void **state)
{
    (void)state;
    NEED_DEVICE();
    write_bowls("bowls.obj");
    expect("build bowls.obj -o strict.prom --octree strict --divisions 4,1,4" QUICK, 0);
    expect("bench strict.prom --frames 3 --warmup 0 --selector meta" SMALL, 0);
}

static void every_visibility_shows_everything(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("bench city.prom --path city.path --frames 3 --warmup 0 --budget-ms 1000 "
           "--visibility cells" SMALL,
           0);
    assert_non_null(strstr(run.err, "no view cells"));
    expect("build city.glb -o city.prom" QUICK " --view-cells city.path --view-cell-px 64", 0);
    const char *const modes[] = {"none", "frame", "cells", "both"};
    for (int i = 0; i < 4; i++) {
        char arguments[256];
        snprintf(arguments, sizeof arguments,
                 "bench city.prom --path city.path --frames 6 --warmup 0 --budget-ms 1000 "
                 "--quality-frames 0 --check-holes 6 --report r.json --visibility %s" SMALL,
                 modes[i]);
        expect(arguments, 0);
        assert_string_equal(run.err, "");
        json_t *report = json_load_file("r.json", 0, NULL);
        json_t *one = json_array_get(at(report, "runs"), 0);
        assert_string_equal(json_string_value(at(one, "visibility")), modes[i]);
        assert_true(number(one, "holes.max") < 0.01);
        json_decref(report);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_build_leaves_the_model_and_its_work),
        cmocka_unit_test(info_tells_what_was_built),
        cmocka_unit_test(shots_are_written),
        cmocka_unit_test(a_wireframe_is_that_of_the_picture),
        cmocka_unit_test(shots_end_with_the_path),
        cmocka_unit_test(shots_measure_the_device_only_if_needed),
        cmocka_unit_test(bench_reports_every_selector),
        cmocka_unit_test(full_detail_is_accurate),
        cmocka_unit_test(full_draws_at_least_what_coarsest_draws),
        cmocka_unit_test(an_impossible_budget_is_named),
        cmocka_unit_test(damaged_files_are_named),
        cmocka_unit_test(the_same_build_has_the_same_content),
        cmocka_unit_test(the_strict_octree_builds),
        cmocka_unit_test(every_visibility_shows_everything),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, make_model, NULL);
    leave_scratch();
    return failed;
}
