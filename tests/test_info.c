// LINK: prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
//
// What `promenade info` says of a model's view cells. No GL.
#include "container_fixture.h"
#include "run_program.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>
#include <jansson.h>

static program_run run;

static void write_model(fixture *f)
{
    prom_error error = {0};
    assert_int_equal(fixture_write(f, "x.prom", 1, &error), PROM_OK);
}

static void expect_line(const char *expected)
{
    run_program(&run, "info x.prom");
    assert_int_equal(run.code, 0);
    if (!strstr(run.out, expected)) print_error("no '%s' in\n%s", expected, run.out);
    assert_non_null(strstr(run.out, expected));
}

// The value of view_cells.KEY.
static double cells_number(const char *key)
{
    run_program(&run, "info x.prom --json");
    assert_int_equal(run.code, 0);
    json_t *info = json_loads(run.out, 0, NULL);
    json_t *value = json_object_get(json_object_get(info, "view_cells"), key);
    assert_true(json_is_number(value));
    double number = json_number_value(value);
    json_decref(info);
    return number;
}

static void cells_are_told(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 5, 8);
    write_model(&f);
    double shown = f.cells.entry_count / (12.0 * 40.0);
    char text[64];
    snprintf(text, sizeof text, "one shows %.0f %% of 40 leaves on average", 100 * shown);
    expect_line("view cells       12 of size 2.5, ");
    expect_line(text);
    assert_true(cells_number("count") == 12);
    assert_true(cells_number("size") == 2.5);
    assert_true(cells_number("bytes") > 0);
    assert_true(cells_number("bytes") <= 5.0 * f.cells.entry_count);
    assert_true(fabs(cells_number("mean_shown") - shown) < 1e-5);
    fixture_finish(&f);
}

static void no_cells_are_told(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 5, 8);
    prom_view_cells_finish(&f.cells);
    write_model(&f);
    expect_line("view cells       none\n");
    static const char *const keys[] = {"count", "size", "bytes", "mean_shown"};
    for (size_t i = 0; i < sizeof keys / sizeof *keys; i++)
        assert_true(cells_number(keys[i]) == 0);
    fixture_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_are_told),
        cmocka_unit_test(no_cells_are_told),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    leave_scratch();
    return failed;
}
