// Builds that are killed and started again. BUILD_KILLS: at how many moments.
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

#define HOUSES 24
static const char command[] = "build street.obj -o x.prom --quiet --min-object-triangles 12";

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

static void build(void)
{
    program_run run;
    run_program(&run, command);
    if (run.code) fail_msg("exit code %d: %s", run.code, run.err);
}

// Starts a build and kills it after ms; true if it was still running.
static bool build_and_kill(double ms)
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
        execv(argv[0], argv);
        _exit(127);
    }
    long ns = (long)(ms * 1e6);
    nanosleep(&(struct timespec){ns / 1000000000, ns % 1000000000}, NULL);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    return WIFSIGNALED(status);
}

static void remove_outputs(void)
{
    static const char *const names[] = {"x.prom", "x.prom.part", "x.prom.part-journal",
                                        "x.prom.work", "x.prom.work-journal"};
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) unlink(names[i]);
}

static int enter(void **state)
{
    (void)state;
    enter_scratch();
    write_street("street.obj", HOUSES, -1, 0);
    return 0;
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

static void assert_none_or_whole(uint64_t wanted)
{
    if (access("x.prom", F_OK) == 0) assert_true(content() == wanted);
}

// At moments spread evenly over the build: killed, there is the old model or none; resumed, it
// ends as if never killed.
static void a_killed_build_goes_on(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    double start = prom_clock_ms();
    build();
    double ms = prom_clock_ms() - start;
    const uint64_t wanted = content();
    unsigned killed = 0;
    for (int i = 0; i < BUILD_KILLS; i++) {
        remove_outputs();
        killed += build_and_kill(ms * (i + 0.5) / BUILD_KILLS);
        assert_none_or_whole(wanted);
        build();
        assert_true(content() == wanted);
        assert_int_not_equal(access("x.prom.part", F_OK), 0);
        assert_int_not_equal(access("x.prom.work-journal", F_OK), 0);
    }
    print_message("killed %u of %d\n", killed, BUILD_KILLS);
    assert_true(killed > 0);
}

// Killed again and again it comes to an end: each start takes what the ones before have done.
static void a_build_killed_again_and_again_ends(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    remove_outputs();
    double start = prom_clock_ms();
    build();
    double whole = prom_clock_ms() - start;
    const uint64_t wanted = content();
    start = prom_clock_ms();
    build();
    double taken = prom_clock_ms() - start; // when nothing has to be done
    remove_outputs();
    unsigned kills = 0;
    while (build_and_kill(taken + (whole - taken) / 4)) {
        kills++;
        assert_none_or_whole(wanted);
        assert_in_range(kills, 0, 60);
    }
    print_message("ended after %u kills\n", kills);
    assert_true(content() == wanted);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(a_killed_build_goes_on),
                                       cmocka_unit_test(a_build_killed_again_and_again_ends)};
    return cmocka_run_group_tests(tests, enter, leave);
}
