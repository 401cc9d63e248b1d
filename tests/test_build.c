// LINK: prom_builder prom_render prom_traverse prom_benefit prom_metaobj
#include "builder/pipeline.h"

#include "metaobj/base/log.h"
#include "metaobj/container.h"
#include "obj_street.h"
#include "render/context.h"
#include "traverse/selector.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

static bool have_gl(void)
{
    prom_error error;
    prom_context *context = prom_context_create_headless(&error);
    if (!context) print_message("skipped: %s\n", error.text);
    prom_context_destroy(context);
    return context != NULL;
}

// Where it does not matter how pictures are compared.
static const prom_measure_options quick = {.metric = PROM_METRIC_CONSTANT};

static void same_input_gives_same_content(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    write_street("build_scene.obj", 30, -1, 0);
    prom_build_options options = {.objects = {.min_triangles = 24}, .measure = quick};
    uint64_t hashes[2];
    prom_error error = {0};
    for (int i = 0; i < 2; i++) {
        unlink("build_scene.prom.work");
        prom_build_report report;
        prom_status status =
            prom_build("build_scene.obj", "build_scene.prom", &options, &report, &error);
        if (status) fail_msg("%s", error.text);
        assert_int_equal(report.source_triangles, 30 * 12);
        assert_true(report.nodes > report.objects);
        assert_true(report.max_children <= 16);
        prom_container *c = prom_container_open("build_scene.prom", &error);
        assert_non_null(c);
        assert_int_equal(prom_container_content_hash(c, &hashes[i], &error), PROM_OK);
        prom_container_close(c);
    }
    assert_int_equal(hashes[0], hashes[1]);
    assert_int_not_equal(access("build_scene.prom.part", F_OK), 0);
}

// The tables of a built model: full detail is exact, shares sum to one, nothing is accurate
// that shows nothing.
static void tables_of_a_built_model_hold(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    write_street("tables_scene.obj", 40, -1, 0);
    prom_build_options options = {.objects = {.min_triangles = 12}};
    prom_error error = {0};
    assert_int_equal(
        prom_build("tables_scene.obj", "tables_scene.prom", &options, NULL, &error), PROM_OK);
    prom_container *c = prom_container_open("tables_scene.prom", &error);
    assert_non_null(c);
    prom_model m = {0};
    assert_int_equal(prom_container_load_model(c, &m, &error), PROM_OK);
    uint32_t clusters = 0;
    for (uint32_t p = 0; p < m.prototype_count; p++) {
        const prom_prototype *proto = &m.prototypes[p];
        for (uint32_t d = 0; d < PROM_DIRS; d++) {
            assert_true(m.coverage[p][d] > 0);
            if (!(proto->flags & PROM_PROTO_CLUSTER)) {
                for (uint32_t s = 0; s < PROM_SIZES; s++)
                    assert_int_equal(m.accuracy[proto->first_rep].bins[d][s], 255);
                continue;
            }
            uint32_t sum = 0;
            for (uint32_t k = 0; k < proto->child_count; k++)
                sum += m.shares[proto->first_share + k][d];
            assert_in_range(sum, 65535 - proto->child_count, 65535 + proto->child_count);
        }
        clusters += (proto->flags & PROM_PROTO_CLUSTER) != 0;
        for (uint32_t r = proto->first_rep; r < proto->first_rep + proto->rep_count; r++)
            if (m.reps[r].kind != PROM_REP_MESH)
                assert_float_equal(m.reps[r].max_size_px, PROM_SIZE_MAX_PX, 0);
    }
    assert_true(clusters >= 4);
    prom_model_finish(&m);
    prom_container_close(c);
}

static uint64_t content_of(const char *path)
{
    prom_error error = {0};
    uint64_t hash = 0;
    prom_container *c = prom_container_open(path, &error);
    if (!c) fail_msg("%s", error.text);
    assert_int_equal(prom_container_content_hash(c, &hash, &error), PROM_OK);
    prom_container_close(c);
    return hash;
}

static prom_build_report build_street(const prom_build_options *options)
{
    prom_build_report report = {0};
    prom_error error = {0};
    if (prom_build("units_scene.obj", "units.prom", options, &report, &error))
        fail_msg("%s", error.text);
    return report;
}

// A build takes from the last one what its changes left right, and ends as if made anew.
static void only_what_depends_on_a_change_is_done_again(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    prom_build_options options = {.objects = {.min_triangles = 12}, .measure = quick};
    unlink("units.prom.work");
    write_street("units_scene.obj", 30, -1, 0);
    prom_build_report first = build_street(&options);
    assert_int_equal(first.units_taken, 0);
    uint64_t content = content_of("units.prom");

    prom_build_report again = build_street(&options);
    assert_int_equal(again.units, first.units);
    assert_int_equal(again.units_taken, again.units);
    assert_true(content_of("units.prom") == content);

    // Another tree: the leaves stay.
    options.tree.max_children = 5;
    prom_build_report tree = build_street(&options);
    assert_true(tree.units_taken >= 2 * tree.objects);
    assert_true(tree.units_taken < tree.units);
    options.tree.max_children = 0;

    // Another house: its own units and the clusters above it.
    build_street(&options);
    write_street("units_scene.obj", 30, 17, 0.5);
    prom_build_report house = build_street(&options);
    assert_true(house.units_taken >= 2 * (house.objects - 1));
    assert_true(house.units_taken < house.units - 2);
    uint64_t changed = content_of("units.prom");
    assert_true(changed != content);
    options.from = PROM_BUILD_FROM_START;
    assert_int_equal(build_street(&options).units_taken, 0);
    assert_true(content_of("units.prom") == changed);

    // From a stage on.
    options.from = PROM_BUILD_FROM_CLUSTERS;
    prom_build_report from = build_street(&options);
    assert_int_equal(from.units_taken, 2 * from.objects);
    options.from = PROM_BUILD_FROM_NOWHERE;
    options.drop_work = true;
    assert_int_equal(build_street(&options).units_taken, first.units);
    assert_int_not_equal(access("units.prom.work", F_OK), 0);
    assert_true(content_of("units.prom") == changed);
}

// Views that were kept serve other metrics, and change nothing in what comes of them.
static void kept_views_serve_other_metrics(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    prom_build_options options = {.objects = {.min_triangles = 12}};
    unlink("units.prom.work");
    write_street("units_scene.obj", 12, -1, 0);
    build_street(&options);
    const uint64_t content = content_of("units.prom");
    options.measure.metric = "rmse";
    prom_build_report drawn = build_street(&options);
    const uint64_t rmse = content_of("units.prom");
    assert_int_equal(drawn.views_taken, 0);
    assert_true(rmse != content);

    options.measure.metric = NULL;
    options.keep_views = true;
    options.from = PROM_BUILD_FROM_LEAVES;
    prom_build_report kept = build_street(&options);
    assert_int_equal(kept.views_taken, 0);
    assert_true(kept.work_bytes > drawn.work_bytes);
    assert_true(content_of("units.prom") == content);

    options.from = PROM_BUILD_FROM_NOWHERE;
    options.measure.metric = "rmse";
    prom_build_report taken = build_street(&options);
    assert_int_equal(taken.views_taken, taken.prototypes);
    assert_true(content_of("units.prom") == rmse);
    // It does not use the pixels per degree: nothing is measured again, the views stay.
    options.measure.ppd = 60;
    prom_build_report known = build_street(&options);
    assert_int_equal(known.units_taken, known.units);
    options.measure.metric = "flip";
    assert_int_equal(build_street(&options).views_taken, taken.prototypes);
    // A build that neither looks at them nor is to keep them drops them.
    options.keep_views = false;
    assert_int_equal(build_street(&options).units_taken, known.units);
    options.measure.metric = "edge-blur";
    assert_int_equal(build_street(&options).views_taken, 0);
}

static void bad_input_leaves_nothing(void **state)
{
    (void)state;
    static const char *const scenes[] = {"no_such_scene.obj", "garbage.glb"};
    FILE *f = fopen("garbage.glb", "w");
    assert_non_null(f);
    fputs("glTF is not this", f);
    fclose(f);
    for (size_t i = 0; i < 2; i++) {
        prom_build_options options = {0};
        prom_error error = {0};
        assert_int_equal(prom_build(scenes[i], "bad.prom", &options, NULL, &error),
                         PROM_ERR_INPUT);
        assert_non_null(strstr(error.text, scenes[i]));
        assert_int_not_equal(access("bad.prom", F_OK), 0);
        assert_int_not_equal(access("bad.prom.part", F_OK), 0);
        assert_int_not_equal(access("bad.prom.work", F_OK), 0);
    }
}

// What was mended is part of the model, also where it was mended by an earlier build.
static void repair_is_recorded(void **state)
{
    (void)state;
    if (!have_gl()) skip();
    write_street("repair_scene.obj", 10, -1, 0);
    FILE *f = fopen("repair_scene.obj", "a");
    fputs("f 73 75 76 74\nf 73 75 76 74\n", f); // a wall of the last house, thrice in all
    fclose(f);
    unlink("repair.prom.work");
    prom_build_options options = {.objects = {.min_triangles = 12}, .measure = quick};
    prom_error error = {0};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(prom_build("repair_scene.obj", "repair.prom", &options, NULL, &error),
                         PROM_OK);
        prom_container *c = prom_container_open("repair.prom", &error);
        assert_non_null(c);
        const char *repair = prom_container_meta(c, "repair");
        assert_non_null(repair);
        assert_non_null(strstr(repair, "\"duplicate\": 4, \"turned\": 0, \"faces\": 120,"));
        assert_non_null(strstr(repair, "\"patches\": 10, \"closed_patches\": 10}"));
        prom_container_close(c);
    }
}

int main(void)
{
    prom_log_set_level(PROM_LOG_WARNING);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_input_gives_same_content),
        cmocka_unit_test(only_what_depends_on_a_change_is_done_again),
        cmocka_unit_test(kept_views_serve_other_metrics),
        cmocka_unit_test(tables_of_a_built_model_hold),
        cmocka_unit_test(bad_input_leaves_nothing),
        cmocka_unit_test(repair_is_recorded),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
