// LINK: prom_metaobj
// NEEDS: promenade
//
// The program from outside, where it needs neither a device nor a model: help, usage errors and
// files that are missing, damaged or cannot be written.
#include "tests/run_program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <sys/stat.h>

#include <cmocka.h>

static program_run run;

static void expect(const char *arguments, int code)
{
    run_program(&run, arguments);
    if (run.code != code) fprintf(stderr, "promenade %s: %s\n", arguments, run.err);
    assert_int_equal(run.code, code);
}

static const char *const commands[] = {
    "build",   "info",         "shot",       "walk",          "bench",      "calibrate",
    "compare", "compare-mesh", "scene city", "scene gallery", "scene tile", NULL};

static void help_goes_to_stdout(void **state)
{
    (void)state;
    for (int i = 0; commands[i]; i++) {
        char arguments[64];
        snprintf(arguments, sizeof arguments, "%s --help", commands[i]);
        expect(arguments, 0);
        assert_non_null(strstr(run.out, "Usage: promenade"));
        assert_non_null(strstr(run.out, commands[i]));
        assert_string_equal(run.err, "");
        snprintf(arguments, sizeof arguments, "%s --usage", commands[i]);
        expect(arguments, 0);
        snprintf(arguments, sizeof arguments, "%s --version", commands[i]);
        expect(arguments, 0);
        assert_string_equal(run.out, "promenade " PROM_VERSION "\n");
    }
}

static void help_lists_the_commands(void **state)
{
    (void)state;
    const char *const ways[] = {"--help", "help"};
    for (int w = 0; w < 2; w++) {
        expect(ways[w], 0);
        assert_string_equal(run.err, "");
        for (int i = 0; commands[i]; i++) {
            char word[32];
            snprintf(word, sizeof word, "%.*s", (int)strcspn(commands[i], " "), commands[i]);
            assert_non_null(strstr(run.out, word));
        }
    }
    expect("scene --help", 0);
    assert_non_null(strstr(run.out, "city"));
    expect("--version", 0);
    assert_string_equal(run.out, "promenade " PROM_VERSION "\n");
}

static void without_a_command_the_list_is_an_error(void **state)
{
    (void)state;
    expect("", 1);
    assert_string_equal(run.out, "");
    assert_non_null(strstr(run.err, "Usage: promenade"));
    assert_non_null(strstr(run.err, "bench"));
    expect("scene", 1);
    assert_string_equal(run.out, "");
    assert_non_null(strstr(run.err, "city"));
}

// Each wrong in one way; the second column must be in the message.
static const char *const wrong[][2] = {
    {"nonsense", "nonsense"},
    {"scene village", "village"},
    {"--nonsense", "--nonsense"},
    {"info", "missing"},
    {"info a.prom b.prom", "b.prom"},
    {"info a.prom --nonsense", "--nonsense"},
    {"build -o a.prom", "scene"},
    {"build a.glb", "--output"},
    {"build a.glb -o", "option requires an argument"},
    {"build a.glb -o a.prom --octree tight", "tight"},
    {"build a.glb -o a.prom --divisions 4,4,4", "strict"},
    {"build a.glb -o a.prom --octree strict --divisions 4,4", "4,4"},
    {"build a.glb -o a.prom --octree strict --divisions 4,0,4", "4,0,4"},
    {"build a.glb -o a.prom --octree strict --divisions 4,1.5,4", "4,1.5,4"},
    {"build a.glb -o a.prom --texture-mb -1", "--texture-mb"},
    {"build a.glb -o a.prom --texture-mb 1x", "1x"},
    {"build a.glb -o a.prom --max-object-triangles 99999999999999999999", "9999"},
    {"build a.glb -o a.prom --max-object-triangles 100 --min-object-triangles 101", "101"},
    {"build a.glb -o a.prom --chunk-size nan", "nan"},
    {"build a.glb -o a.prom --chunk-size inf", "inf"},
    {"shot a.prom", "--output"},
    {"shot a.prom -o a.png --eye 1,2,3", "--look-at"},
    {"shot a.prom -o a.png --eye 1,2,3 --look-at 1,2,3", "--look-at"},
    {"shot a.prom -o a.png --eye 1,2 --look-at 4,5,6", "1,2"},
    {"shot a.prom -o a.png --eye 1,2,3 --look-at 4,5,6 --path auto", "--path"},
    {"shot a.prom -o a.png --frame -1", "--frame"},
    {"bench a.prom --resolution 640", "640"},
    {"bench a.prom --resolution 640,360,3", "640,360,3"},
    {"bench a.prom --resolution 640,0", "640,0"},
    {"bench a.prom --resolution 640x360", "640x360"},
    {"bench a.prom --budget-ms fast", "fast"},
    {"bench a.prom --budget-ms 0", "--budget-ms"},
    {"bench a.prom --budget-ms -5", "--budget-ms"},
    {"bench a.prom --selector best", "greedy"},
    {"bench a.prom --frames 0", "--frames"},
    {"bench a.prom --quality-frames -1", "--quality-frames"},
    {"bench a.prom --ppd 0.5", "--ppd"},
    {"shot a.prom -o b.png --ppd 0", "--ppd"},
    {"walk a.prom --ppd far", "--ppd"},
    {"bench a.prom --visibility all", "cells or both"},
    {"bench a.prom --weights focus,beauty", "`beauty`"},
    {"shot a.prom -o b.png --weight statue", "`statue`"},
    {"shot a.prom -o b.png --weight =4", "pattern"},
    {"walk a.prom --weight statue=-1", "--weight"},
    {"build a.obj -o a.prom --weight statue=much", "--weight"},
    {"bench a.prom --benefit most", "pixels or sum"},
    {"bench a.prom --prior full-detail,", "few-pixels"},
    {"bench a.prom --hysteresis 2", "--hysteresis"},
    {"walk", "missing"},
    {"walk a.prom b.prom", "b.prom"},
    {"walk a.prom --frames 0", "--frames"},
    {"walk a.prom --budget-ms 0", "--budget-ms"},
    {"walk a.prom --selector best", "greedy"},
    {"compare a.png", "second picture"},
    {"compare a.png b.png c.png", "c.png"},
    {"compare a.png b.png --metric best", "edge-blur"},
    {"compare a.png b.png --metric all --map m.png", "one metric"},
    {"compare a.png b.png --ppd 0.5", "--ppd"},
    {"compare a.png b.png --threshold -1", "--threshold"},
    {"compare-mesh a.obj", "second mesh"},
    {"compare-mesh a.obj b.obj --views 0 --pictures x", "--views above 0"},
    {"compare-mesh a.obj b.obj --samples 0", "--samples"},
    {"calibrate --effort 4", "--effort"},
    {"calibrate here", "here"},
    {"scene city", "--output"},
    {"scene city -o a.glb --size 0", "--size"},
    {"scene gallery", "--output"},
    {"scene gallery -o a.glb --rooms 16", "--rooms"},
    {"scene gallery -o a.glb --rooms many", "many"},
    {"scene gallery -o a.glb --detail 5", "--detail"},
    {"scene gallery -o a.glb b.glb", "b.glb"},
    {"scene tile a.glb -o b.glb", "--grid"},
    {"scene tile a.glb -o b.glb --grid 5", "--grid"},
    {"scene tile a.glb -o b.glb --grid 5x-1", "--grid"},
    {"scene tile a.glb -o b.glb --grid 2.5x3", "--grid"},
};

static void usage_errors_exit_1_with_a_hint(void **state)
{
    (void)state;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        expect(wrong[i][0], 1);
        assert_string_equal(run.out, "");
        assert_true(count_lines(run.err) <= 3); // the hint may wrap
        assert_non_null(strstr(run.err, "--help"));
        if (!strstr(run.err, wrong[i][1])) fprintf(stderr, "%s: %s", wrong[i][0], run.err);
        assert_non_null(strstr(run.err, wrong[i][1]));
    }
    assert_int_equal(count_others(".", NULL), 0);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

// One line that names the file.
static void expect_error(const char *arguments, int code, const char *name)
{
    expect(arguments, code);
    assert_int_equal(count_lines(run.err), 1);
    assert_non_null(strstr(run.err, name));
}

static void unusable_inputs_exit_2_and_are_named(void **state)
{
    (void)state;
    write_text("text.prom", "this is no container\n");
    write_text("empty.prom", "");
    write_text("text.glb", "this is no scene\n");
    expect_error("info missing.prom", 2, "missing.prom");
    expect_error("info text.prom", 2, "text.prom");
    expect_error("info empty.prom", 2, "empty.prom");
    expect_error("info .", 2, ".");
    expect_error("bench missing.prom", 2, "missing.prom");
    expect_error("walk missing.prom", 2, "missing.prom");
    expect_error("shot text.prom -o a.png", 2, "text.prom");
    expect_error("build missing.glb -o a.prom", 2, "missing.glb");
    expect_error("build . -o a.prom", 2, ".");
    expect_error("build text.glb -o a.prom", 2, "text.glb");
    expect_error("scene tile missing.glb --grid 2x2 -o a.glb", 2, "missing.glb");
    expect_error("scene tile text.glb --grid 2x2 -o a.glb", 2, "text.glb");
    const char *const inputs[] = {"text.prom", "empty.prom", "text.glb", NULL};
    assert_int_equal(count_others(".", inputs), 0);
    for (int i = 0; inputs[i]; i++) unlink(inputs[i]);
}

static void unwritable_outputs_exit_4_and_are_named(void **state)
{
    (void)state;
    write_text("a.glb", "never read\n");
    write_text("file", "in the way\n");
    expect_error("build a.glb -o nowhere/a.prom", 4, "nowhere/a.prom");
    expect_error("build a.glb -o file/a.prom", 4, "file/a.prom");
    expect_error("build a.glb -o .", 4, ".");
    expect_error("shot missing.prom -o nowhere/a.png", 4, "nowhere/a.png");
    expect_error("bench missing.prom --report nowhere/r.json", 4, "nowhere/r.json");
    expect_error("bench missing.prom --csv nowhere/r.csv", 4, "nowhere/r.csv");
    expect_error("walk missing.prom --shot nowhere/a.png", 4, "nowhere/a.png");
    expect_error("calibrate -o nowhere/p.json", 4, "nowhere/p.json");
    expect_error("scene city -o nowhere/a.glb", 4, "nowhere/a.glb");
    expect_error("scene city -o b.glb --path nowhere/a.path", 4, "nowhere/a.path");
    expect_error("scene gallery -o nowhere/a.glb", 4, "nowhere/a.glb");
    expect_error("scene tile a.glb --grid 2x2 -o nowhere/b.glb", 4, "nowhere/b.glb");
    const char *const inputs[] = {"a.glb", "file", NULL};
    assert_int_equal(count_others(".", inputs), 0);
    for (int i = 0; inputs[i]; i++) unlink(inputs[i]);
}

static void inputs_and_outputs_are_different_files(void **state)
{
    (void)state;
    write_text("a.glb", "scene\n");
    assert_int_equal(symlink("a.glb", "link.glb"), 0);
    assert_int_equal(link("a.glb", "twin.glb"), 0);
    expect_error("build a.glb -o ./a.glb", 1, "a.glb");
    expect_error("build a.glb -o link.glb", 1, "link.glb");
    expect_error("build a.glb -o twin.glb", 1, "twin.glb");
    expect_error("build a.glb -o b.prom --profile b.prom", 1, "b.prom"); // not there yet
    expect_error("build missing.glb -o a.glb --profile a.glb", 2, "missing.glb");
    expect_error("shot a.glb -o a.glb", 1, "a.glb");
    expect_error("shot b.prom -o a.glb --path a.glb", 1, "a.glb");
    expect_error("bench a.glb --report a.glb", 1, "a.glb");
    expect_error("bench b.prom --profile a.glb --csv a.glb", 1, "a.glb");
    expect_error("bench b.prom --report r --csv ./r", 1, "r");
    expect_error("scene tile a.glb --grid 2x2 -o a.glb", 1, "a.glb");
    expect_error("scene city -o c.glb --path ./c.glb", 1, "c.glb");
    char text[16];
    slurp("a.glb", text, sizeof text);
    assert_string_equal(text, "scene\n");
    const char *const inputs[] = {"a.glb", "link.glb", "twin.glb", NULL};
    assert_int_equal(count_others(".", inputs), 0);
    for (int i = 0; inputs[i]; i++) unlink(inputs[i]);
}

static void outputs_are_regular_files(void **state)
{
    (void)state;
    assert_int_equal(mkfifo("pipe", 0600), 0);
    assert_int_equal(symlink("nowhere", "dangling"), 0);
    expect_error("scene city -o pipe", 4, "pipe");
    expect_error("scene city -o dangling", 4, "dangling");
    expect_error("bench b.prom --report /dev/null", 4, "/dev/null");
    const char *const kept[] = {"pipe", "dangling", NULL};
    assert_int_equal(count_others(".", kept), 0);
    for (int i = 0; kept[i]; i++) unlink(kept[i]);
}

static void a_link_to_an_output_stays_a_link(void **state)
{
    (void)state;
    write_text("real.glb", "old\n");
    assert_int_equal(symlink("real.glb", "link.glb"), 0);
    expect("scene city --size 1 --detail 1 -o link.glb", 0);
    struct stat st;
    assert_int_equal(lstat("link.glb", &st), 0);
    assert_true(S_ISLNK(st.st_mode));
    assert_int_equal(lstat("real.glb", &st), 0);
    assert_true(S_ISREG(st.st_mode) && st.st_size > 1000);
    const char *const kept[] = {"real.glb", "link.glb", NULL};
    assert_int_equal(count_others(".", kept), 0);
    for (int i = 0; kept[i]; i++) unlink(kept[i]);
}

static void a_bad_profile_stops_a_build_at_once(void **state)
{
    (void)state;
    write_text("a.glb", "never read\n");
    write_text("p.json", "{}\n");
    expect_error("build a.glb -o a.prom --profile p.json", 2, "p.json");
    expect_error("build a.glb -o a.prom --profile missing.json", 2, "missing.json");
    const char *const inputs[] = {"a.glb", "p.json", NULL};
    assert_int_equal(count_others(".", inputs), 0);
    for (int i = 0; inputs[i]; i++) unlink(inputs[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(help_goes_to_stdout),
        cmocka_unit_test(help_lists_the_commands),
        cmocka_unit_test(without_a_command_the_list_is_an_error),
        cmocka_unit_test(usage_errors_exit_1_with_a_hint),
        cmocka_unit_test(unusable_inputs_exit_2_and_are_named),
        cmocka_unit_test(unwritable_outputs_exit_4_and_are_named),
        cmocka_unit_test(inputs_and_outputs_are_different_files),
        cmocka_unit_test(outputs_are_regular_files),
        cmocka_unit_test(a_link_to_an_output_stays_a_link),
        cmocka_unit_test(a_bad_profile_stops_a_build_at_once),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    leave_scratch();
    return failed;
}
