// For tests of the program on a device: what it must exit with, and a cost profile for a small
// picture. Include it after cmocka's header.
#ifndef PROM_TESTS_PROGRAM_FIXTURE_H
#define PROM_TESTS_PROGRAM_FIXTURE_H

#include "tests/run_program.h"

static program_run run;
static bool no_device;

static inline void expect(const char *arguments, int code)
{
    run_program(&run, arguments);
    if (run.code != code) fprintf(stderr, "promenade %s: %s\n", arguments, run.err);
    assert_int_equal(run.code, code);
}

// Writes p.json; false where there is no GL, and no test can run.
static inline bool calibrate_small(void)
{
    run_program(&run, "calibrate --effort 1 --resolution 160,90 -o p.json --quiet");
    no_device = run.code == 3;
    if (no_device)
        fprintf(stderr, "skipped: %s", run.err);
    else
        assert_int_equal(run.code, 0);
    return !no_device;
}

#define NEED_DEVICE()                                                                          \
    if (no_device) skip()

#endif
