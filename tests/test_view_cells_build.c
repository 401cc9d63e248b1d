// LINK: prom_builder prom_render prom_metaobj
// NEEDS: promenade
// `build --view-cells`: the same on any number of cores, killed or not; what is wrong is said
// before the work.
#include "run_program.h"

#include "metaobj/base/clock.h"
#include "metaobj/container.h"
#include "obj_street.h"
#include "render/context.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stdint.h>
#include <time.h>

#include <cmocka.h>

#define BUILD "build street.obj -o x.prom --min-object-triangles 12 --metric constant "
#define CELLS BUILD "--view-cells a.path,b.path --view-cell-px 128 "

static bool have_gl;

static void write_path(const char *name, double z)
{
    FILE *f = fopen(name, "w");
    assert_non_null(f);
    for (int i = 0; i < 60; i++)
        fprintf(f, "%.4f %.3f 1.7 %.3f 0 0 0 1\n", i / 30.0, 1.3 * i, z);
    fclose(f);
}

static int enter(void **state)
{
    (void)state;
    enter_scratch();
    write_street("street.obj", 20, -1, 0);
    write_path("a.path", 5.5);
    write_path("b.path", 12.5);
    prom_error error = {0};
    prom_context *context = prom_context_create_headless(&error);
    have_gl = context != NULL;
    if (!have_gl) print_message("skipped: %s\n", error.text);
    prom_context_destroy(context);
    return 0;
}

static int leave(void **state)
{
    (void)state;
    leave_scratch();
    return 0;
}

static void build(const char *arguments, program_run *run)
{
    run_program(run, arguments);
    if (run->code) fail_msg("exit code %d: %s", run->code, run->err);
}

// The model's content; *cells: how many view cells it has.
static uint64_t content(uint32_t *cells)
{
    prom_error error = {0};
    uint64_t hash = 0;
    prom_model model;
    prom_view_cells view_cells;
    prom_container *c = prom_container_open("x.prom", &error);
    if (!c) fail_msg("%s", error.text);
    assert_int_equal(prom_container_content_hash(c, &hash, &error), PROM_OK);
    assert_int_equal(prom_container_load_model(c, &model, &error), PROM_OK);
    assert_int_equal(prom_container_read_view_cells(c, &model, &view_cells, &error), PROM_OK);
    *cells = view_cells.cell_count;
    prom_view_cells_finish(&view_cells);
    prom_model_finish(&model);
    prom_container_close(c);
    return hash;
}

static void any_number_of_cores_gives_the_same(void **state)
{
    (void)state;
    if (!have_gl) skip();
    static program_run run;
    uint32_t cells[3];
    build(CELLS "-j 1", &run);
    assert_non_null(strstr(run.out, "view cells"));
    uint64_t one = content(&cells[0]);
    assert_true(cells[0] > 20);
    build(CELLS "-j 2 --force", &run);
    assert_true(content(&cells[1]) == one);
    build(CELLS "-j 3 --from view-cells --drop-work", &run);
    assert_true(content(&cells[2]) == one);
    assert_int_not_equal(access("x.prom.work", F_OK), 0);
    build(BUILD, &run);
    assert_true(content(&cells[0]) != one);
    assert_int_equal(cells[0], 0);
    assert_null(strstr(run.out, "view cells"));
}

// Starts a build and sends it a signal after ms; true if it ended by that.
static bool build_and_end(const char *arguments, double ms, int signal_number)
{
    char text[256], *argv[24];
    int argc = 0;
    snprintf(text, sizeof text, "%s", arguments);
    argv[argc++] = getenv("PROM_PROGRAM");
    for (char *word = strtok(text, " "); word; word = strtok(NULL, " ")) argv[argc++] = word;
    argv[argc] = NULL;
    fflush(NULL);
    pid_t child = fork();
    if (child == 0) {
        redirect(1, "stdout");
        redirect(2, "stderr");
        execv(argv[0], argv);
        _exit(127);
    }
    long ns = (long)(ms * 1e6);
    nanosleep(&(struct timespec){ns / 1000000000, ns % 1000000000}, NULL);
    kill(child, signal_number);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
}

// While the cells are made, a whole model is in place, with its old cells or none; the next
// build goes on and ends as if never cut off.
static void a_build_of_cells_cut_off_goes_on(void **state)
{
    (void)state;
    if (!have_gl) skip();
    enum { KILLS = 10 };
    static const int signals[] = {SIGKILL, SIGINT, SIGTERM, SIGKILL};
    static program_run run;
    uint32_t cells, all;
    unsigned ended = 0, without = 0;
    build(CELLS, &run);
    const uint64_t wanted = content(&all);
    build(BUILD, &run);
    const uint64_t bare = content(&cells);
    double start = prom_clock_ms();
    build(CELLS "--from view-cells", &run);
    double whole_ms = prom_clock_ms() - start;
    for (int i = 0; i < KILLS; i++) {
        double ms = whole_ms * (0.3 + 0.65 * i / KILLS);
        bool hit = build_and_end(CELLS "--from view-cells", ms, signals[i % 4]);
        ended += hit;
        uint64_t now = content(&cells);
        assert_true(now == wanted || now == bare);
        without += now == bare;
        if (hit && signals[i % 4] != SIGKILL)
            assert_int_not_equal(access("x.prom.part", F_OK), 0);
        build(CELLS, &run);
        assert_true(content(&cells) == wanted);
        assert_int_equal(cells, all);
        assert_int_not_equal(access("x.prom.part", F_OK), 0);
    }
    print_message("ended %u of %d, %u without cells\n", ended, KILLS, without);
    assert_true(ended > 0);
}

// A second build takes every cell from the first.
static void cells_done_are_not_done_again(void **state)
{
    (void)state;
    if (!have_gl) skip();
    static program_run run;
    uint32_t cells;
    build(CELLS, &run);
    build(CELLS, &run); // all is known
    char wanted[64];
    content(&cells);
    snprintf(wanted, sizeof wanted, "view cells: %u in", cells);
    const char *line = strstr(run.err, wanted);
    assert_non_null(line);
    snprintf(wanted, sizeof wanted, "%u of them from the last build", cells);
    assert_non_null(strstr(line, wanted));
}

static void wrong_places_are_said_before_the_work(void **state)
{
    (void)state;
    static const struct {
        const char *arguments, *says;
        int code;
    } cases[] = {
        {"--view-cells none.path", "none.path", 2},
        {"--view-cells a.path,none.path", "none.path", 2},
        {"--view-cells street.obj", "street.obj", 2},
        {"--view-cells a.path,", "empty name", 1},
        {"--view-cells 0,0,0:1,-1,1", "along y", 1},
        {"--view-cells 0,0:1,1,1", "--view-cells", 1},
        {"--view-cells a.path --view-cell-size 0", "--view-cell-size", 1},
        {"--view-cell-size 2", "are for --view-cells", 1},
        {"--view-cells a.path --view-cell-px 10", "--view-cell-px", 1},
        {"--view-cells x.prom", "x.prom", 1},
    };
    static program_run run;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        char text[256];
        unlink("x.prom");
        unlink("x.prom.work");
        snprintf(text, sizeof text, BUILD "%s", cases[i].arguments);
        if (strstr(text, "--view-cells x.prom")) write_path("x.prom", 0);
        run_program(&run, text);
        if (run.code != cases[i].code || !strstr(run.err, cases[i].says))
            fail_msg("%s: exit code %d, %s", cases[i].arguments, run.code, run.err);
        assert_int_not_equal(access("x.prom.work", F_OK), 0);
    }
    unlink("x.prom");
}

// A box over the street, and the automatic walk.
static void boxes_and_the_automatic_walk_have_eyes(void **state)
{
    (void)state;
    if (!have_gl) skip();
    static program_run run;
    uint32_t cells;
    // The roofs are the only floors.
    build(BUILD "--view-cell-px 64 --view-cells 0,0,0:80,9,20", &run);
    content(&cells);
    assert_in_range(cells, 15, 400);
    build(BUILD "--view-cell-px 64 --view-cells auto", &run);
    content(&cells);
    assert_in_range(cells, 10, 400);
    run_program(&run, BUILD "--view-cells 0,50,0:80,60,20");
    assert_int_equal(run.code, 2);
    assert_non_null(strstr(run.err, "no floor"));
    assert_non_null(strstr(run.err, "x.prom is there, without view cells"));
    content(&cells);
    assert_int_equal(cells, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(wrong_places_are_said_before_the_work),
        cmocka_unit_test(any_number_of_cores_gives_the_same),
        cmocka_unit_test(a_build_of_cells_cut_off_goes_on),
        cmocka_unit_test(cells_done_are_not_done_again),
        cmocka_unit_test(boxes_and_the_automatic_walk_have_eyes),
    };
    return cmocka_run_group_tests(tests, enter, leave);
}
