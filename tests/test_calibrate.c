// LINK: prom_traverse prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
//
// promenade calibrate: its profile, report, table and plot say the same. Skips where there is
// no GL.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include <jansson.h>

#include "traverse/cost.h"

#include "tests/program_fixture.h"

static int calibrate(void **state)
{
    (void)state;
    if (!calibrate_small()) return 0;
    expect("calibrate --effort 1 --resolution 160,90 -o q.json --residuals q.csv --plot q.svg "
           "--report r.json --quiet",
           0);
    return 0;
}

static double number(const json_t *json, const char *key)
{
    const json_t *value = json_object_get(json, key);
    if (!json_is_number(value)) fprintf(stderr, "no number %s\n", key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

static void the_text_names_all_that_is_fitted(void **state)
{
    (void)state;
    NEED_DEVICE();
    static const char *const lines[] = {"device ",
                                        "clock ",
                                        "form ",
                                        "frame ",
                                        "bind ",
                                        "upload ",
                                        "triangle ",
                                        "edge ",
                                        "hidden pixel",
                                        "lit impostor",
                                        "worst under",
                                        "margin ",
                                        "profile      q.json"};
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++)
        if (!strstr(run.out, lines[i])) fail_msg("no line `%s`", lines[i]);
}

// The errors of the report are those of the table, whose rows are the samples of the profile.
static void report_and_table_agree(void **state)
{
    (void)state;
    NEED_DEVICE();
    prom_cost_model model;
    assert_int_equal(prom_cost_load("q.json", &model, NULL), PROM_OK);
    json_t *report = json_load_file("r.json", 0, NULL);
    assert_non_null(report);
    assert_true(number(report, "samples") == model.sample_count);
    assert_true(model.width == 160 && model.height == 90);

    FILE *file = fopen("q.csv", "r");
    assert_non_null(file);
    char line[1024];
    assert_non_null(fgets(line, sizeof line, file));
    assert_non_null(strstr(line, "binds,upload_bytes"));
    double sum = 0, worst = 0;
    unsigned rows = 0;
    for (; fgets(line, sizeof line, file); rows++) {
        char *comma = strrchr(line, ',');
        double held_out = atof(comma + 1), measured, predicted;
        *comma = 0;
        comma = strrchr(line, ',');
        predicted = atof(comma + 1);
        *comma = 0;
        measured = atof(strrchr(line, ',') + 1);
        assert_true(measured > 0 && predicted > 0 && held_out >= 0);
        sum += fabs(held_out / measured - 1);
        if (held_out > 0) worst = fmax(worst, measured / held_out - 1);
    }
    fclose(file);
    assert_int_equal(rows, model.sample_count);
    assert_true(fabs(sum / rows - model.mean_error) <= 1e-3);
    assert_true(fabs(worst - model.worst_under) <= 1e-2 * (1 + worst));
    assert_true(fabs(number(report, "mean_error") - model.mean_error) <= 1e-6);
    const json_t *forms = json_object_get(report, "form_mean_error");
    const char *form = json_string_value(json_object_get(report, "form"));
    assert_true(fabs(number(forms, form) - model.mean_error) <= 1e-6);
    // By what is drawn, they make up the whole.
    const json_t *group;
    const char *name;
    double samples = 0, weighted = 0;
    json_object_foreach(json_object_get(report, "errors"), name, group)
    {
        samples += number(group, "samples");
        weighted += number(group, "samples") * number(group, "mean_error");
    }
    assert_true(samples == rows);
    assert_true(fabs(weighted / samples - model.mean_error) <= 1e-6);
    const json_t *values = json_object_get(report, "coefficients");
    assert_true(fabs(number(values, "bind_us") - 1e3 * model.bind_ms) <= 1e-6);
    assert_true(fabs(number(values, "upload_us_MB") - 1e9 * model.upload_ms) <= 1e-3);
    json_decref(report);
}

static void the_plot_shows_each_sample(void **state)
{
    (void)state;
    NEED_DEVICE();
    static char plot[262144];
    prom_cost_model model;
    assert_int_equal(prom_cost_load("q.json", &model, NULL), PROM_OK);
    slurp("q.svg", plot, sizeof plot);
    assert_int_equal(strncmp(plot, "<svg ", 5), 0);
    assert_non_null(strstr(plot, "</svg>\n"));
    unsigned marks = 0;
    for (const char *at = plot; (at = strstr(at, "<use ")); at++) marks++;
    assert_int_equal(marks, model.sample_count + 9); // and the legend
}

static void what_cannot_be_written_is_said_at_once(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("calibrate -o q.json --plot q.json", 1);
    expect("calibrate --residuals nowhere/q.csv", 4);
    assert_non_null(strstr(run.err, "nowhere/q.csv"));
    expect("calibrate --report nowhere/r.json", 4);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_text_names_all_that_is_fitted),
        cmocka_unit_test(report_and_table_agree),
        cmocka_unit_test(the_plot_shows_each_sample),
        cmocka_unit_test(what_cannot_be_written_is_said_at_once),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests_name("calibrate", tests, calibrate, NULL);
    leave_scratch();
    return failed;
}
