// Builds of a small scene on a disk that fails at one call of SQLite after the other.
// BUILD_FAILURES_STEP: every how many calls one is let fail.
#include "builder/pipeline.h"
#include "failing_vfs.h"
#include "metaobj/base/log.h"
#include "metaobj/container.h"
#include "obj_street.h"
#include "render/context.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#define SCENE "failures_scene.obj"
#define MODEL "failures.prom"
#define OLD "a model of old"

static void write_old_model(void)
{
    FILE *f = fopen(MODEL, "w");
    assert_non_null(f);
    fputs(OLD, f);
    fclose(f);
}

static void assert_old_model(void)
{
    char text[64] = "";
    FILE *f = fopen(MODEL, "r");
    assert_non_null(f);
    assert_non_null(fgets(text, sizeof text, f));
    fclose(f);
    assert_string_equal(text, OLD);
    assert_int_not_equal(access(MODEL ".part", F_OK), 0);
    assert_int_not_equal(access(MODEL ".part-journal", F_OK), 0);
}

static prom_status build(prom_error *error)
{
    prom_build_options options = {.objects = {.min_triangles = 12}};
    return prom_build(SCENE, MODEL, &options, NULL, error);
}

static uint64_t content(void)
{
    prom_error error = {0};
    uint64_t hash = 0;
    prom_container *c = prom_container_open(MODEL, &error);
    if (!c) fail_msg("%s", error.text);
    assert_int_equal(prom_container_content_hash(c, &hash, &error), PROM_OK);
    prom_container_close(c);
    return hash;
}

// The n-th call fails, for n over the whole build: one clear line, the old model as it was.
// What was stored until then serves the next build, which is equal to one that never failed.
static void failing_calls_leave_the_old_model(void **state)
{
    (void)state;
    prom_error error = {0};
    prom_context *context = prom_context_create_headless(&error);
    if (!context) {
        print_message("skipped: %s\n", error.text);
        skip();
    }
    prom_context_destroy(context);
    write_street(SCENE, 3, -1, 0);
    unlink(MODEL ".work");
    failing_vfs_arm(FAILING_ANY, SQLITE_FULL, 0, false);
    if (build(&error)) fail_msg("%s", error.text);
    const long calls = failing_vfs_calls();
    const uint64_t wanted = content();
    assert_true(calls > 50);
    long tried = 0, failed = 0;
    for (long n = 1; n <= calls; n += BUILD_FAILURES_STEP, tried++) {
        bool full = tried % 2 == 0; // a disk that is full, or one that errs once
        unlink(MODEL ".work");
        write_old_model();
        error = (prom_error){0};
        failing_vfs_arm(FAILING_ANY, full ? SQLITE_FULL : SQLITE_IOERR, n, full);
        prom_status status = build(&error);
        bool hit = failing_vfs_failed() > 0;
        failing_vfs_arm(0, 0, 0, false);
        if (!status) { // a call whose failure may be passed over, such as deleting a journal
            assert_true(content() == wanted);
            continue;
        }
        assert_true(hit);
        failed++;
        assert_int_equal(status, PROM_ERR_OUTPUT);
        assert_non_null(strstr(error.text, MODEL));
        assert_null(strchr(error.text, '\n'));
        assert_old_model();
        if (tried % 4) continue;
        if (build(&error)) fail_msg("after call %ld failed: %s", n, error.text);
        assert_true(content() == wanted);
    }
    print_message("%ld calls, %ld of them let fail, %ld builds failed\n", calls, tried, failed);
    assert_true(failed > tried / 2);
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    failing_vfs_install();
    const struct CMUnitTest tests[] = {cmocka_unit_test(failing_calls_leave_the_old_model)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
