// LINK: prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
//
// The swap test and the oracle on a street of boxes: finite numbers, the same on every run, in
// the report, the table and the plot. Skips where there is no GL.
#include "tests/obj_street.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include <jansson.h>

#include "tests/program_fixture.h"

#define VIEWS 6
#define SWAPS 5
#define BENCH                                                                                  \
    "bench street.prom --frames 120 --warmup 0 --quality-frames 0 "                            \
    "--budget-ms 1.5 --selector greedy --resolution 160,90 --profile p.json --quiet "

static int make_model(void **state)
{
    (void)state;
    if (!calibrate_small()) return 0;
    write_street("street.obj", 40, 0, 0);
    expect("build street.obj -o street.prom --quiet", 0);
    return 0;
}

static json_t *found(json_t *report, const char *key)
{
    json_t *runs = json_object_get(report, "runs");
    return json_object_get(json_array_get(runs, 0), key);
}

static double number(json_t *object, const char *key)
{
    json_t *value = json_object_get(object, key);
    assert_true(json_is_number(value));
    return json_number_value(value);
}

// Every swap is of one kind, and of a leaf or a cluster.
static void check_groups(json_t *groups, double swaps)
{
    const char *name;
    json_t *group;
    double sum = 0;
    json_object_foreach(groups, name, group) sum += number(group, "swaps");
    assert_true(sum == swaps);
}

static double check_report(void)
{
    json_t *report = json_load_file("r.json", 0, NULL), *swap = found(report, "swap");
    double swaps = number(swap, "swaps");
    assert_true(number(swap, "frames") == VIEWS);
    assert_true(swaps > VIEWS && swaps <= VIEWS * SWAPS);
    assert_true(fabs(number(swap, "spearman")) <= 1);
    assert_true(fabs(number(swap, "spearman_selector")) <= 1);
    assert_true(isfinite(number(swap, "slope")));
    check_groups(json_object_get(swap, "kinds"), swaps);
    check_groups(json_object_get(swap, "nodes"), swaps);
    assert_non_null(json_object_get(json_object_get(swap, "kinds"), "open"));
    json_decref(report);
    return swaps;
}

// Rows with all columns and pixels to compare; at least one change is seen.
static void check_table(char *text, double swaps)
{
    assert_true(count_lines(text) == swaps + 1);
    assert_int_equal(strncmp(text, "frame,node,name,cluster,kind_from,kind_to,", 42), 0);
    double changed = 0;
    strtok(text, "\n");
    for (char *line; (line = strtok(NULL, "\n"));) {
        double px, predicted, believed, measured;
        char *last = line;
        for (int i = 0; i < 9; i++) last = strchr(last, ',') + 1; // the name has no comma
        assert_int_equal(sscanf(last, "%lf,%lf,%lf,%lf", &px, &predicted, &believed, &measured),
                         4);
        assert_true(px >= 16 && px <= 160 * 90);
        assert_true(isfinite(predicted) && isfinite(believed) && isfinite(measured));
        assert_true(fabs(predicted) <= px && fabs(measured) <= 160 * 90);
        changed += fabs(measured);
    }
    assert_true(changed > 1);
}

static void swaps_are_the_same_on_every_run(void **state)
{
    (void)state;
    NEED_DEVICE();
    static char tables[2][65536], plots[2][65536];
    for (int i = 0; i < 2; i++) {
        expect(BENCH "--swap-test 6 --swaps 5 --swap-csv s.csv --swap-plot s.svg "
                     "--report r.json",
               0);
        assert_non_null(strstr(run.out, "\nswap "));
        slurp("s.csv", tables[i], sizeof tables[i]);
        slurp("s.svg", plots[i], sizeof plots[i]);
    }
    double swaps = check_report();
    assert_string_equal(tables[0], tables[1]);
    assert_string_equal(plots[0], plots[1]);
    check_table(tables[0], swaps);
    assert_int_equal(strncmp(plots[0], "<svg ", 5), 0);
    assert_non_null(strstr(plots[0], "Spearman"));
    assert_non_null(strstr(plots[0], "</svg>\n"));
}

static void files_need_the_test(void **state)
{
    (void)state;
    NEED_DEVICE();
    expect("bench street.prom --swap-csv s.csv", 1);
    assert_non_null(strstr(run.err, "--swap-test"));
}

// The cheapest cut leaves it time to do better with.
static void the_oracle_is_no_worse(void **state)
{
    (void)state;
    NEED_DEVICE();
    json_t *reports[2], *oracle = NULL, *frame;
    for (int i = 0; i < 2; i++) {
        expect(BENCH "--selector coarsest --budget-ms 50 --oracle 60 --oracle-frames 3 "
                     "--report r.json",
               0);
        assert_non_null(strstr(run.out, "\noracle "));
        reports[i] = json_load_file("r.json", 0, NULL);
        assert_true(json_is_null(found(reports[i], "swap")));
    }
    oracle = found(reports[0], "oracle");
    assert_true(json_equal(oracle, found(reports[1], "oracle")));
    assert_true(number(oracle, "frames") == 3 && number(oracle, "tries") == 60);
    size_t index;
    json_array_foreach(json_object_get(oracle, "per_frame"), index, frame)
    {
        assert_true(number(frame, "best_flip") >= 0);
        assert_true(number(frame, "best_flip") <= number(frame, "flip"));
        assert_true(number(frame, "best_ms") <= 50);
    }
    assert_int_equal(index, 3);
    assert_true(number(oracle, "best_flip") < number(oracle, "flip")); // something was found
    for (int i = 0; i < 2; i++) json_decref(reports[i]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(swaps_are_the_same_on_every_run),
        cmocka_unit_test(files_need_the_test),
        cmocka_unit_test(the_oracle_is_no_worse),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, make_model, NULL);
    leave_scratch();
    return failed;
}
