// LINK: prom_traverse prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
//
// With a profile the same path has the same cuts in every run, however long its frames take;
// and what a bench says of how it kept to the budget. Skips where there is no GL.
#include "tests/obj_street.h"

#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <jansson.h>

#include "tests/program_fixture.h"
#include "traverse/cost.h"

#define FRAMES 40

// Of no device, so that the cuts do not depend on the one at hand: draws are dear, and of the
// 40 houses some can be drawn by themselves.
static void write_profile(void)
{
    prom_cost_model cost = {.fixed_ms = 1,
                            .draw_ms = 0.02,
                            .triangle_ms = 0.001,
                            .margin = 0.1,
                            .sample_count = 100,
                            .width = 160,
                            .height = 90,
                            .renderer = "none"};
    prom_error error = {0};
    for (int i = 0; i < PROM_COST_KINDS; i++) cost.pixel_ms[i] = 1e-5;
    if (prom_cost_save(&cost, "p.json", &error)) fail_msg("%s", error.text);
}

static int make_model(void **state)
{
    (void)state;
    write_profile();
    write_street("street.obj", 40, 0, 0);
    run_program(&run, "build street.obj -o street.prom --quiet --metric constant");
    no_device = run.code == 3;
    if (no_device)
        fprintf(stderr, "skipped: %s", run.err);
    else
        assert_int_equal(run.code, 0);
    return 0;
}

static json_t *bench(const char *selector, const char *budget_ms, const char *more)
{
    char arguments[512];
    snprintf(arguments, sizeof arguments,
             "bench street.prom --frames %d --warmup 5 --quality-frames 0 --visibility frame "
             "--resolution 160,90 --quiet --report r.json --csv r.csv --selector %s "
             "--budget-ms %s %s",
             FRAMES, selector, budget_ms, more);
    expect(arguments, 0);
    json_t *report = json_load_file("r.json", 0, NULL);
    json_t *one = json_incref(json_array_get(json_object_get(report, "runs"), 0));
    json_decref(report);
    assert_non_null(one);
    return one;
}

static double number(json_t *object, const char *key)
{
    json_t *value = json_object_get(object, key);
    if (!json_is_number(value)) fail_msg("%s is no number", key);
    return json_number_value(value);
}

// What the frames chose: a run's hash, and the columns of its table that say what was chosen.
typedef struct choices {
    char run[17], frames[FRAMES][256];
} choices;

static const char *const chosen[] = {"predicted_ms", "triangles",  "cut_nodes", "switches",
                                     "benefit_px",   "loss_px",    "feasible",  "limited",
                                     "gap",          "allowed_ms", "cut_hash",  NULL};

static bool is_chosen(const char *column, size_t length)
{
    for (int i = 0; chosen[i]; i++)
        if (strlen(chosen[i]) == length && !strncmp(chosen[i], column, length)) return true;
    return false;
}

static void read_row(const char *header, const char *row, char text[256])
{
    size_t used = 0, found = 0;
    while (*header) {
        size_t name = strcspn(header, ",\n"), value = strcspn(row, ",\n");
        if (is_chosen(header, name)) {
            used += (size_t)snprintf(text + used, 256 - used, "%.*s,", (int)value, row);
            found++;
        }
        header += name + (header[name] != 0);
        row += value + (row[value] != 0);
    }
    assert_true(found + 1 == sizeof chosen / sizeof *chosen && used < 256);
}

static choices choices_of(const char *selector, const char *budget_ms, const char *more)
{
    static char text[65536];
    choices c = {0};
    json_t *one = bench(selector, budget_ms, more);
    snprintf(c.run, sizeof c.run, "%s", json_string_value(json_object_get(one, "cuts_hash")));
    json_decref(one);
    slurp("r.csv", text, sizeof text);
    char *header = strtok(text, "\n");
    for (int i = 0; i < FRAMES; i++) read_row(header, strtok(NULL, "\n"), c.frames[i]);
    assert_int_equal(strlen(c.run), 16);
    return c;
}

static pid_t start_load(void)
{
    fflush(NULL);
    pid_t child = fork();
    if (child == 0)
        for (volatile unsigned i = 0;; i++) {
        }
    return child;
}

static void stop_load(pid_t child)
{
    kill(child, SIGKILL);
    waitpid(child, NULL, 0);
}

static void the_same_path_has_the_same_cuts(void **state)
{
    (void)state;
    NEED_DEVICE();
    const char *const selectors[] = {"greedy", "meta", "lagrange", "incremental", "feedback"};
    for (size_t s = 0; s < sizeof selectors / sizeof *selectors; s++) {
        choices first = choices_of(selectors[s], "1.6", "--profile p.json");
        // Slower, and with other work between the frames.
        pid_t load = start_load();
        choices again =
            choices_of(selectors[s], "1.6", "--profile p.json --noise-floor 7 --check-holes 3");
        stop_load(load);
        assert_string_equal(first.run, again.run);
        for (int i = 0; i < FRAMES; i++) assert_string_equal(first.frames[i], again.frames[i]);
        // The walk sees other things from elsewhere, and with more time it chooses others.
        assert_string_not_equal(first.frames[0], first.frames[FRAMES / 2]);
        choices other = choices_of(selectors[s], "2.5", "--profile p.json");
        assert_string_not_equal(first.run, other.run);
    }
}

static void a_bench_says_how_it_kept_to_its_budget(void **state)
{
    (void)state;
    NEED_DEVICE();
    json_t *one = bench("greedy", "1000", "--miss-rate 0.05 --noise-floor 25 --profile p.json");
    assert_true(number(one, "miss_rate_wanted") == 0.05);
    assert_true(json_is_true(json_object_get(json_object_get(one, "guarantee"), "frozen")));
    assert_true(number(json_object_get(one, "guarantee"), "margin") == 0.1);
    json_t *misses = json_object_get(one, "misses");
    assert_true(number(misses, "rate_low") <= number(one, "miss_rate"));
    assert_true(number(misses, "rate_high") >= number(one, "miss_rate"));
    assert_int_equal(json_array_size(json_object_get(misses, "quarters")), 4);
    json_t *cold = json_object_get(one, "cold_start");
    assert_true(number(cold, "frames") == 30); // 5 of the warm-up
    assert_true(number(json_object_get(one, "after_turn"), "turns") == 0);
    json_t *floor = json_object_get(one, "noise_floor");
    assert_true(number(floor, "draws") == 25);
    assert_true(number(floor, "target_ms") == 900);
    assert_true(number(floor, "p50") > 0 && number(floor, "p50") <= number(floor, "p99"));
    assert_true(number(floor, "mean_of_p99") <= 1 && number(floor, "frame") < FRAMES);
    json_decref(one);
    one = bench("distance", "1000", "--profile p.json");
    assert_true(json_is_null(json_object_get(one, "noise_floor")));
    assert_true(json_is_null(json_object_get(one, "use_of_floor")));
    json_decref(one);
}

static void a_spinning_camera_turns(void **state)
{
    (void)state;
    NEED_DEVICE();
    // Steps of 20, then of 40 degrees, then a leap without a turn.
    FILE *path = fopen("spin.path", "w");
    assert_non_null(path);
    double angle = 0;
    for (int i = 0; i < 12; i++) {
        fprintf(path, "%g %d 5 30 0 %.9g 0 %.9g\n", i / 30.0, i < 11 ? 30 : 90, sin(angle / 2),
                cos(angle / 2));
        if (i < 10) angle += (i < 5 ? 20 : 40) * M_PI / 180;
    }
    assert_int_equal(fclose(path), 0);
    json_t *one = bench("greedy", "1000", "--path spin.path --frames 12 --profile p.json");
    json_t *turns = json_object_get(one, "after_turn");
    assert_true(number(turns, "turns") == 5 + 1);
    assert_true(number(turns, "most_misses") == 0);
    json_decref(one);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_same_path_has_the_same_cuts),
        cmocka_unit_test(a_bench_says_how_it_kept_to_its_budget),
        cmocka_unit_test(a_spinning_camera_turns),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, make_model, NULL);
    leave_scratch();
    return failed;
}
