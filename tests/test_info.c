// LINK: prom_builder prom_benefit prom_metaobj PkgConfig::JANSSON
// NEEDS: promenade
//
// What `promenade info` says of a model: its view cells, how it was measured, its tables, and
// the sheet of an object (which is skipped where there is no GL).
#include "benefit/accuracy.h"
#include "benefit/colour_map.h"
#include "builder/image_io.h"
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

static void how_it_was_measured_is_told(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 2, 2);
    write_model(&f);
    expect_line("accuracy         by flip, 22.34 pixels per degree, over luminances of 0.2 and "
                "0.8\n");
    expect_line("0 where the error's 95 % quantile is above 0.9\n");
    run_program(&run, "info x.prom --json");
    json_t *info = json_loads(run.out, 0, NULL);
    const char *metric;
    double ppd, backgrounds[2], percentile, veto;
    assert_int_equal(json_unpack(info, "{s:{s:s,s:F,s:[F,F],s:F,s:F}}", "measured", "metric",
                                 &metric, "ppd", &ppd, "backgrounds", &backgrounds[0],
                                 &backgrounds[1], "veto_percentile", &percentile, "veto_error",
                                 &veto),
                     0);
    assert_string_equal(metric, "flip");
    assert_true(fabs(ppd - 22.34) < 1e-5 && fabs(percentile - 0.95) < 1e-6);
    assert_true(fabs(backgrounds[0] - 0.2) < 1e-6 && fabs(backgrounds[1] - 0.8) < 1e-6);
    assert_true(fabs(veto - 0.9) < 1e-6);
    json_decref(info);
    fixture_finish(&f);
}

// ---- tables

typedef struct row {
    unsigned prototype, rep, level, triangles, dir;
    char name[32], of[16], kind[16];
    float direction[3], size_px, accuracy, coverage;
} row;

static bool read_row(FILE *file, row *r)
{
    return fscanf(file, "%u,\"%31[^\"]\",%u,%15[^,],%15[^,],%u,%u,%u,%f,%f,%f,%f,%f,%f\n",
                  &r->prototype, r->name, &r->rep, r->of, r->kind, &r->level, &r->triangles,
                  &r->dir, &r->direction[0], &r->direction[1], &r->direction[2], &r->size_px,
                  &r->accuracy, &r->coverage) == 14;
}

// Notes which bin a row is of, and checks it against the model.
static void check_row(const prom_model *m, const row *r,
                      bool seen[6][PROM_DIRS][PROM_SIZES + PROM_SIZES_LARGE])
{
    static const char *const names[] = {"leaf", "cluster", "root", "sky"};
    const prom_representation *rep = &m->reps[r->rep];
    const prom_prototype *proto = &m->prototypes[r->prototype];
    assert_in_range(r->rep, proto->first_rep, proto->first_rep + proto->rep_count - 1);
    assert_string_equal(r->name, names[r->prototype]);
    assert_string_equal(r->of, r->prototype == 1 ? "cluster" : "object");
    assert_string_equal(r->kind, prom_rep_kind_name(rep->kind));
    assert_int_equal(r->level, rep->level);
    assert_int_equal(r->triangles, rep->triangles);
    uint32_t s = (uint32_t)lroundf(prom_bin_of_size(r->size_px));
    assert_true(r->dir < PROM_DIRS && s < PROM_SIZES + PROM_SIZES_LARGE);
    assert_false(seen[r->rep][r->dir][s]);
    seen[r->rep][r->dir][s] = true;
    assert_true(fabsf(r->size_px / prom_size_of_bin(s) - 1) < 1e-3f);
    assert_int_equal(prom_bin_of_direction(r->direction), r->dir);
    uint8_t accuracy = s < PROM_SIZES ? m->accuracy[r->rep].bins[r->dir][s]
                                      : m->accuracy[r->rep].large[r->dir][s - PROM_SIZES];
    assert_true(fabsf(r->accuracy - prom_accuracy_of_byte(accuracy)) < 1e-4f);
    assert_true(fabsf(r->coverage - m->coverage[r->prototype][r->dir] / 65535.0f) < 1e-4f);
}

static unsigned count_rows(const fixture *f)
{
    bool seen[6][PROM_DIRS][PROM_SIZES + PROM_SIZES_LARGE] = {0};
    char header[256];
    row r;
    unsigned rows = 0;
    FILE *file = fopen("t.csv", "r");
    assert_non_null(fgets(header, sizeof header, file));
    assert_memory_equal(header, "prototype,object,", 17);
    for (; read_row(file, &r); rows++) check_row(&f->model, &r, seen);
    assert_true(feof(file));
    fclose(file);
    return rows;
}

#define BINS (PROM_DIRS * PROM_SIZES)
#define LARGE_BINS (PROM_DIRS_LARGE * PROM_SIZES_LARGE)

static void tables_hold_what_the_model_does(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 2, 2);
    for (uint32_t r = 0; r < 6; r++)
        for (uint32_t i = 0; i < LARGE_BINS && f.model.reps[r].kind == PROM_REP_MESH; i++)
            f.model.accuracy[r].large[i / 2][i % 2] = (uint8_t)(17 * i + 11 * r);
    write_model(&f);
    run_program(&run, "info x.prom --tables t.csv");
    assert_int_equal(run.code, 0);
    assert_string_equal(run.err, "");
    assert_int_equal(count_rows(&f), 6 * BINS + 4 * LARGE_BINS);
    run_program(&run, "info x.prom --tables t.csv --object cl*r");
    assert_int_equal(run.code, 0);
    assert_int_equal(count_rows(&f), 2 * BINS + LARGE_BINS);
    run_program(&run, "info x.prom --tables t.csv --object #0");
    assert_int_equal(run.code, 0);
    assert_int_equal(count_rows(&f), 3 * BINS + 2 * LARGE_BINS);
    fixture_finish(&f);
}

static void expect_error(const char *arguments, int code, const char *words)
{
    run_program(&run, arguments);
    assert_int_equal(run.code, code);
    if (!strstr(run.err, words)) print_error("no '%s' in\n%s", words, run.err);
    assert_non_null(strstr(run.err, words));
}

static void what_cannot_be_is_said(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 2, 2);
    write_model(&f);
    expect_error("info x.prom --tables t2.csv --object clutser", 2, "near it: `cluster`");
    expect_error("info x.prom --tables t2.csv --object zzz*", 2, "#0 to #3");
    expect_error("info x.prom --tables t2.csv --object #4", 2, "#0 to #3");
    expect_error("info x.prom --tables t2.csv --object #", 2, "#0 to #3");
    expect_error("info x.prom --sheet s2.png --object chair", 2, "chair");
    expect_error("info x.prom --tables no/t2.csv", 4, "no/t2.csv");
    expect_error("info x.prom --tables x.prom", 1, "x.prom");
    expect_error("info x.prom --tables t2.csv --sheet t2.csv --object leaf", 1, "t2.csv");
    expect_error("info x.prom --sheet s2.png", 1, "--object");
    expect_error("info x.prom --object leaf", 1, "--sheet");
    expect_error("info x.prom --sheet s2.png --object leaf --directions 67", 1, "--directions");
    expect_error("info x.prom --sheet s2.png --object leaf --size-px 7", 1, "--size-px");
    assert_true(access("t2.csv", F_OK) != 0 && access("s2.png", F_OK) != 0);
    fixture_finish(&f);
}

// ---- sheets

#define VIEW 128 // pixels along a side of a picture
#define DIRECTIONS 4

typedef struct picture {
    uint32_t width, height;
    uint8_t *rgba;
} picture;

// The sheet of an object; false where there is no device.
static bool take_sheet(const char *object, const char *more, picture *p)
{
    char arguments[256];
    prom_error error = {0};
    snprintf(arguments, sizeof arguments, "info x.prom --quiet --sheet s.png --object %s %s",
             object, more);
    run_program(&run, arguments);
    if (run.code == 3) return false;
    assert_string_equal(run.err, "");
    assert_int_equal(run.code, 0);
    assert_int_equal(prom_image_read("s.png", 16384, &p->width, &p->height, &p->rgba, &error),
                     PROM_OK);
    return true;
}

static unsigned count_color(const picture *p, const uint8_t rgb[3])
{
    unsigned count = 0;
    for (size_t i = 0; i < (size_t)p->width * p->height; i++)
        count += !memcmp(p->rgba + 4 * i, rgb, 3);
    return count;
}

// Pixels of a sheet that say: no error.
static unsigned count_right(const picture *p)
{
    uint8_t colours[256][3];
    prom_colour_map(colours);
    return count_color(p, colours[0]);
}

static void sheets_grow_by_rows_and_columns(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 2, 2);
    write_model(&f);
    picture all[5];
    static const char *const more[] = {"--directions 5", "--directions 6", "--directions 7",
                                       "--directions 5", "--directions 5 --size-px 20"};
    for (int i = 0; i < 5; i++)
        if (!take_sheet(i == 3 ? "cluster" : "leaf", more[i], &all[i])) skip();
    // Columns of a picture and its map, rows of a picture and a line of text.
    assert_int_equal(all[2].width - all[1].width, all[1].width - all[0].width);
    assert_in_range(all[1].width - all[0].width, 2 * VIEW, 3 * VIEW);
    assert_int_equal(all[2].height, all[0].height);
    // A leaf has three representations here, a cluster two.
    assert_in_range(all[0].height - all[3].height, VIEW, 2 * VIEW);
    // Small pictures are enlarged, by whole numbers: 20 px is 23 (16 * 2^0.5) six times.
    assert_int_equal(all[4].width - all[0].width, 5 * 2 * (6 * 23 - VIEW));
    // Large ones are not, and there are those along the axes: 250 px is 256.
    picture large;
    assert_true(take_sheet("leaf", "--size-px 250", &large));
    assert_int_equal(large.width - all[1].width, 6 * 2 * (256 - VIEW));
    prom_free(large.rgba);
    for (int i = 0; i < 5; i++) prom_free(all[i].rgba);
    fixture_finish(&f);
}

// A single mesh is the object itself: no pixel of it errs. Where the model says so too, there
// is nothing to add.
static void sheets_show_what_errs(void **state)
{
    (void)state;
    static const uint8_t amber[3] = {255, 190, 80};
    fixture f;
    fixture_init(&f, 2, 2);
    snprintf(f.model.measured.metric, sizeof f.model.measured.metric, "edge-blur");
    memset(f.model.accuracy[5].bins, 255, sizeof f.model.accuracy[5].bins);
    memset(f.model.accuracy[0].bins, 255, sizeof f.model.accuracy[0].bins);
    write_model(&f);
    picture right, leaf, wrong;
    if (!take_sheet("sky", "--directions 4", &right)) skip();
    unsigned zero = count_right(&right) - DIRECTIONS * VIEW * VIEW;
    assert_in_range(zero, 1, 1000); // the end of the colour scale
    assert_int_equal(count_color(&right, amber), 0);
    // Of the pictures, the true one and the mesh's, a part is the first background.
    uint8_t level = prom_linear_to_srgb8(f.model.measured.background[0]);
    uint8_t background[3] = {level, level, level};
    assert_in_range(count_color(&right, background), 1000, 2 * DIRECTIONS * VIEW * VIEW - 1000);
    // The coarser mesh and the box differ from the leaf, and not as the model has it.
    assert_true(take_sheet("leaf", "--directions 4", &leaf));
    unsigned leaf_right = count_right(&leaf) - zero;
    assert_in_range(leaf_right, DIRECTIONS * VIEW * VIEW, 3 * DIRECTIONS * VIEW * VIEW - 1000);
    assert_in_range(count_color(&leaf, amber), 100, 100000);
    // The same picture with a model that is wrong.
    memset(f.model.accuracy[5].bins, 100, sizeof f.model.accuracy[5].bins);
    write_model(&f);
    assert_true(take_sheet("sky", "--directions 4", &wrong));
    assert_int_equal(count_right(&wrong), count_right(&right));
    assert_true(count_color(&wrong, amber) > 100);
    prom_free(right.rgba);
    prom_free(leaf.rgba);
    prom_free(wrong.rgba);
    fixture_finish(&f);
}

static void other_meanings_are_told(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 2, 2);
    write_model(&f);
    picture p;
    if (!take_sheet("*", "--directions 1", &p)) skip();
    prom_free(p.rgba);
    assert_string_equal(run.out,
                        "s.png: root (#2)\nthe name also means cluster (#1), leaf (#0), "
                        "sky (#3)\n");
    if (take_sheet("leaf", "--directions 1", &p)) prom_free(p.rgba);
    assert_string_equal(run.out, "s.png: leaf (#0)\n");
    fixture_finish(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cells_are_told),
        cmocka_unit_test(no_cells_are_told),
        cmocka_unit_test(how_it_was_measured_is_told),
        cmocka_unit_test(tables_hold_what_the_model_does),
        cmocka_unit_test(what_cannot_be_is_said),
        cmocka_unit_test(sheets_grow_by_rows_and_columns),
        cmocka_unit_test(sheets_show_what_errs),
        cmocka_unit_test(other_meanings_are_told),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    leave_scratch();
    return failed;
}
