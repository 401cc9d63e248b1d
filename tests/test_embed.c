// LINK: prom_metaobj
// NEEDS: embed
//
// The example of docs/embed.c, run with a small model.
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "tests/container_fixture.h"
#include "tests/run_program.h"

enum { CLUSTERS = 3, LEAVES = 5, SKY = 1 + CLUSTERS * (1 + LEAVES), FRAMES = 12 };

static program_run run;

static int write_model(void **state)
{
    (void)state;
    setenv("PROM_PROGRAM", getenv("PROM_EMBED"), 1);
    enter_scratch();
    fixture f;
    prom_error error = {0};
    fixture_init(&f, CLUSTERS, LEAVES);
    prom_status status = fixture_write(&f, "small.prom", 1, &error);
    fixture_finish(&f);
    return status;
}

static int leave(void **state)
{
    (void)state;
    leave_scratch();
    return 0;
}

// What its lines say of a run.
typedef struct told {
    unsigned frames, entries, draws, leaves, skies, fitting;
    bool uploaded[FIXTURE_MESHES];
    double predicted_ms, allowed_ms; // of the last frame
} told;

static void read_frame(told *t, const char *line)
{
    unsigned frame, entries;
    double gap;
    char fits[32];
    int n = sscanf(line, "frame %u: %u entries, %lf of %lf ms, %31[^,], gap at most %lf %%",
                   &frame, &entries, &t->predicted_ms, &t->allowed_ms, fits, &gap);
    assert_int_equal(n, 6);
    assert_int_equal(frame, t->frames++);
    assert_int_equal(t->draws, t->entries); // of the frames before
    assert_int_equal(t->skies, frame);
    assert_true(gap >= 0 && gap <= 100);
    t->fitting += !strcmp(fits, "fits");
    t->entries += entries;
}

// Nothing is drawn that was not sent to the device, and nothing is sent twice.
static void read_line(told *t, const char *line)
{
    unsigned node, mesh;
    if (!strncmp(line, "frame", 5)) {
        read_frame(t, line);
    } else if (sscanf(line, "  upload mesh %u", &mesh) == 1) {
        assert_true(mesh < FIXTURE_MESHES && !t->uploaded[mesh]);
        t->uploaded[mesh] = true;
    } else if (sscanf(line, "  draw node %u %*[^,], mesh %u", &node, &mesh) == 2) {
        assert_true(node <= SKY && mesh < FIXTURE_MESHES && t->uploaded[mesh]);
        t->skies += node == SKY;
        t->draws += node < SKY;
        t->leaves += node > CLUSTERS && node < SKY;
    }
}

static told run_example(const char *arguments)
{
    told t = {0};
    run_program(&run, arguments);
    assert_string_equal(run.err, "");
    assert_int_equal(run.code, 0);
    for (char *line = strtok(run.out, "\n"); line; line = strtok(NULL, "\n"))
        read_line(&t, line);
    assert_int_equal(t.frames, FRAMES);
    assert_int_equal(t.draws, t.entries);
    assert_int_equal(t.skies, FRAMES);
    assert_true(t.draws >= FRAMES);
    return t;
}

static void all_that_is_drawn_was_uploaded(void **state)
{
    (void)state;
    told t = run_example("small.prom 100");
    assert_int_equal(t.fitting, FRAMES);
    assert_true(t.leaves > 0);
    assert_true(t.predicted_ms <= t.allowed_ms);
    // The device is a third slower than its cost model says, and a margin is kept.
    assert_true(t.allowed_ms < 100 / 1.2);
}

static void what_does_not_fit_is_said(void **state)
{
    (void)state;
    told t = run_example("small.prom 0.01");
    assert_int_equal(t.fitting, 0);
    assert_true(t.predicted_ms > t.allowed_ms);
}

static void wrong_calls_and_files_are_refused(void **state)
{
    (void)state;
    const struct {
        const char *arguments;
        int code;
    } calls[] = {{"", 1},
                 {"small.prom", 1},
                 {"small.prom nothing", 1},
                 {"small.prom -3", 1},
                 {"none.prom 10", PROM_ERR_INPUT},
                 {"small.prom 10 none.json", PROM_ERR_INPUT},
                 {"small.prom 10 small.prom", PROM_ERR_INPUT}};
    for (size_t i = 0; i < sizeof calls / sizeof *calls; i++) {
        run_program(&run, calls[i].arguments);
        assert_int_equal(run.code, calls[i].code);
        assert_int_equal(count_lines(run.err), 1);
        assert_string_equal(run.out, "");
    }
}

static void no_graphics_library_is_linked(void **state)
{
    (void)state;
    char *command = prom_format("ldd '%s'", getenv("PROM_EMBED"));
    FILE *ldd = popen(command, "r");
    char libraries[16384] = "";
    size_t n = ldd ? fread(libraries, 1, sizeof libraries - 1, ldd) : 0;
    libraries[n] = 0;
    bool works = ldd && pclose(ldd) == 0;
    prom_free(command);
    if (!works) skip();
    assert_non_null(strstr(libraries, "libsqlite3"));
    const char *const graphics[] = {"libGL",     "libEGL", "libepoxy",      "libglfw",
                                    "libassimp", "libX11", "libOpenImageIO"};
    for (size_t i = 0; i < sizeof graphics / sizeof *graphics; i++)
        assert_null(strstr(libraries, graphics[i]));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_that_is_drawn_was_uploaded),
        cmocka_unit_test(what_does_not_fit_is_said),
        cmocka_unit_test(wrong_calls_and_files_are_refused),
        cmocka_unit_test(no_graphics_library_is_linked),
    };
    return cmocka_run_group_tests_name("embed", tests, write_model, leave);
}
