// LINK: prom_builder prom_render prom_benefit prom_metaobj
// Subjects that are measured several at a time, without a device: they are written in order,
// and a failure anywhere ends the run with nothing left under way.
#include "builder/subject.h"

#include "metaobj/base/stop.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <unistd.h>

#include <cmocka.h>

#define MODEL "subjects.prom"
#define SUBJECTS 9

static struct {
    prom_build_options options;
    prom_build_state build;
    prom_prototype prototypes[SUBJECTS];
    uint16_t coverage[SUBJECTS][PROM_DIRS];
    prom_mesh mesh;
    uint32_t fails_at_begin, fails_at_draw, fails_at_amend, stops_at_draw, drawn;
    uint32_t settled[SUBJECTS], settled_count;
} run;

static prom_status begin(prom_subject *s, uint32_t index, prom_error *error)
{
    if (index == run.fails_at_begin) return prom_fail(error, PROM_ERR_UNSUPPORTED, "begin");
    const prom_representation rep = {
        .kind = PROM_REP_MESH, .texture = PROM_NONE, .switch_distance = INFINITY};
    s->prototype = index;
    s->key = index + 1;
    prom_subject_add(s, &run.mesh, &rep, PROM_ADMIT_TRUTH);
    return PROM_OK;
}

// Less the device: nothing is seen.
static prom_status draw(prom_subject *s, uint32_t index, prom_error *error)
{
    prom_rgba *nothing = prom_calloc(PROM_VIEW_PIXELS, sizeof *nothing);
    for (uint32_t d = 0; d < PROM_DIRS; d++)
        prom_views_add(&s->truth, (const prom_rgba *)nothing, PROM_VIEW_PX);
    prom_free(nothing);
    run.drawn++;
    if (index == run.stops_at_draw) prom_stop_request();
    return index == run.fails_at_draw ? prom_fail(error, PROM_ERR_UNSUPPORTED, "draw")
                                      : PROM_OK;
}

static prom_status amend(prom_subject *s, uint32_t index, prom_error *error)
{
    (void)s;
    return index == run.fails_at_amend ? prom_fail(error, PROM_ERR_UNSUPPORTED, "amend")
                                       : PROM_OK;
}

static void settled(prom_subject *s, uint32_t index)
{
    (void)s;
    run.settled[run.settled_count++] = index;
}

static int start(void **state)
{
    (void)state;
    const float center[3] = {0, 0, 0}, half[3] = {1, 1, 1};
    const prom_measure_options options = {0};
    prom_error error = {0};
    memset(&run, 0, sizeof run);
    run.fails_at_begin = run.fails_at_draw = run.fails_at_amend = run.stops_at_draw = PROM_NONE;
    prom_mesh_init_box(&run.mesh, center, half, NULL);
    for (int i = 0; i < SUBJECTS; i++) run.prototypes[i].radius = 2;
    unlink(MODEL ".work");
    run.build = (prom_build_state){.options = &run.options,
                                   .prototypes = run.prototypes,
                                   .coverage = run.coverage,
                                   .lock = PTHREAD_MUTEX_INITIALIZER,
                                   .writer = prom_writer_create(MODEL, &error),
                                   .store = prom_store_open(MODEL, PROM_UNIT_COUNT, &error),
                                   .measure = prom_measure_create(&options, 0.2f),
                                   .pool = prom_pool_create()};
    return !run.build.writer || !run.build.store;
}

static int finish(void **state)
{
    (void)state;
    prom_build_state *b = &run.build;
    prom_pool_destroy(b->pool);
    prom_measure_destroy(b->measure);
    prom_store_close(b->store);
    prom_writer_destroy(b->writer);
    prom_array_finish(&b->reps);
    prom_array_finish(&b->accuracy);
    prom_array_finish(&b->mesh_infos);
    prom_mesh_finish(&run.mesh);
    return 0;
}

static prom_status run_subjects(prom_error *error)
{
    static const prom_subject_class class = {
        PROM_UNIT_LEAF, PROM_UNIT_LEAF_VIEWS, begin, draw, amend, settled};
    prom_progress progress;
    prom_progress_begin(&progress, "subjects", SUBJECTS);
    return prom_subjects_run(&run.build, &class, NULL, SUBJECTS, &progress, error);
}

static void assert_settled(uint32_t count)
{
    assert_int_equal(run.settled_count, count);
    assert_int_equal(run.build.reps.count, count);
    for (uint32_t i = 0; i < count; i++) assert_int_equal(run.settled[i], i);
}

static void all_are_settled_in_order(void **state)
{
    (void)state;
    prom_error error = {0};
    assert_int_equal(run_subjects(&error), PROM_OK);
    assert_settled(SUBJECTS);
    assert_int_equal(run.drawn, SUBJECTS);
    run.settled_count = 0;
    run.build.reps.count = 0;
    assert_int_equal(run_subjects(&error), PROM_OK);
    assert_settled(SUBJECTS);
    assert_int_equal(run.drawn, SUBJECTS); // known by now
}

static void any_failure_ends_the_run(void **state)
{
    uint32_t *const failures[] = {&run.fails_at_begin, &run.fails_at_draw, &run.fails_at_amend};
    for (int f = 0; f < 3; f++)
        for (uint32_t at = 0; at < SUBJECTS; at += 2) {
            finish(state);
            assert_int_equal(start(state), 0);
            *failures[f] = at;
            prom_error error = {0};
            assert_int_equal(run_subjects(&error), PROM_ERR_UNSUPPORTED);
            assert_int_equal(error.status, PROM_ERR_UNSUPPORTED);
            assert_in_range(run.settled_count, 0, at);
            assert_settled(run.settled_count);
        }
}

// The last test: a request cannot be taken back.
static void a_request_to_stop_ends_the_run(void **state)
{
    (void)state;
    prom_error error = {0};
    run.stops_at_draw = 4;
    assert_int_equal(run_subjects(&error), PROM_ERR_STOPPED);
    assert_in_range(run.settled_count, 0, 4);
    assert_settled(run.settled_count);
    assert_int_equal(run.drawn, 5);
}

int main(void)
{
    prom_log_set_level(PROM_LOG_WARNING);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(all_are_settled_in_order, start, finish),
        cmocka_unit_test_setup_teardown(any_failure_ends_the_run, start, finish),
        cmocka_unit_test_setup_teardown(a_request_to_stop_ends_the_run, start, finish),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
