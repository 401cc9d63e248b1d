// Builds that are killed, or stopped, and started again. BUILD_KILLS: at how many moments.
#include "run_program.h"

#include "builder/store.h"
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

#define HOUSES 16
static const char command[] = "build street.obj -o x.prom --quiet --min-object-triangles 12";

// Of a build that was let be: its content, how long it takes, and how long when nothing has to
// be done.
static uint64_t wanted;
static double whole_ms, taken_ms;

static uint64_t content(void)
{
    prom_error error = {0};
    uint64_t hash = 0;
    prom_container *c = prom_container_open("x.prom", &error);
    if (!c) fail_msg("%s", error.text);
    assert_int_equal(prom_container_content_hash(c, &hash, &error), PROM_OK);
    prom_container_close(c);
    return hash;
}

static double build(void)
{
    program_run run;
    double start = prom_clock_ms();
    run_program(&run, command);
    if (run.code) fail_msg("exit code %d: %s", run.code, run.err);
    return prom_clock_ms() - start;
}

// Starts a build and sends it a signal after ms; true if it ended by that.
static bool build_and_end(double ms, int signal_number)
{
    char text[256], *argv[16];
    int argc = 0;
    snprintf(text, sizeof text, "%s", command);
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
    if (WIFSIGNALED(status)) assert_int_equal(WTERMSIG(status), signal_number);
    return WIFSIGNALED(status);
}

static void remove_outputs(void)
{
    static const char *const names[] = {"x.prom", "x.prom.part", "x.prom.part-journal",
                                        "x.prom.work", "x.prom.work-journal"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) unlink(names[i]);
}

static int leave(void **state)
{
    (void)state;
    leave_scratch();
    return 0;
}

static bool have_gl(void)
{
    prom_error error;
    prom_context *context = prom_context_create_headless(&error);
    if (!context) print_message("skipped: %s\n", error.text);
    prom_context_destroy(context);
    return context != NULL;
}

static int enter(void **state)
{
    (void)state;
    enter_scratch();
    write_street("street.obj", HOUSES, -1, 0);
    if (!have_gl()) return 0;
    whole_ms = build();
    wanted = content();
    taken_ms = build();
    return 0;
}

static void assert_none_or_whole(void)
{
    if (access("x.prom", F_OK) == 0) assert_true(content() == wanted);
}

static void assert_no_part(void)
{
    assert_int_not_equal(access("x.prom.part", F_OK), 0);
    assert_int_not_equal(access("x.prom.part-journal", F_OK), 0);
    assert_int_not_equal(access("x.prom.work-journal", F_OK), 0);
}

// Asked to end, it keeps its work, leaves nothing else, and says so in one line (unless the
// signal came before it had begun).
static void assert_stopped_well(void)
{
    char text[1024];
    slurp("stderr", text, sizeof text);
    assert_no_part();
    if (access("x.prom.work", F_OK)) return;
    assert_int_equal(count_lines(text), 1);
    assert_non_null(strstr(text, "x.prom.work"));
}

// At moments spread evenly over the build, whatever the signal: there is the old model or none;
// resumed, it ends as if never cut off.
static void a_build_cut_off_goes_on(void **state)
{
    static const int signals[] = {SIGKILL, SIGINT, SIGTERM, SIGHUP};
    (void)state;
    if (!wanted) skip();
    unsigned ended = 0;
    for (int i = 0; i < BUILD_KILLS; i++) {
        int signal_number = signals[i % 4];
        // The first part of it is the system's, which loads the program.
        double ms = whole_ms * (0.25 + 0.75 * (i + 0.5) / BUILD_KILLS);
        bool hit = false;
        for (int tries = 0; tries < 4 && !hit; tries++, ms *= 0.7) { // it may be quicker now
            remove_outputs();
            hit = build_and_end(ms, signal_number);
        }
        ended += hit;
        assert_none_or_whole();
        if (hit && signal_number != SIGKILL) assert_stopped_well();
        build();
        assert_true(content() == wanted);
        assert_no_part();
    }
    print_message("ended %u of %d\n", ended, BUILD_KILLS);
    assert_true(ended > 0);
}

// Killed again and again it comes to an end: each start takes what the ones before have done.
static void a_build_killed_again_and_again_ends(void **state)
{
    (void)state;
    if (!wanted) skip();
    remove_outputs();
    unsigned kills = 0;
    while (build_and_end(taken_ms + (whole_ms - taken_ms) / 4, SIGKILL)) {
        kills++;
        assert_none_or_whole();
        assert_in_range(kills, 0, 60);
    }
    print_message("ended after %u kills\n", kills);
    assert_true(content() == wanted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_build_cut_off_goes_on),
                                       cmocka_unit_test(a_build_killed_again_and_again_ends)};
    return cmocka_run_group_tests(tests, enter, leave);
}
