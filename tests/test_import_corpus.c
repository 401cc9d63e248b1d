// LINK: prom_builder prom_metaobj
// LABEL: slow
// Import against files that others made: broken ones, and real scenes. Skipped without them.
#include "builder/source.h"
#include "metaobj/base/clock.h"
#include "metaobj/base/log.h"

#include <ftw.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static struct {
    unsigned good, refused;
    double slowest_ms;
} outcome;

static const char *shared(const char *name)
{
    static char path[4096];
    const char *base = getenv("PROM_SHARED");
    snprintf(path, sizeof path, "%s/%s", base ? base : "../shared", name);
    if (!access(path, R_OK)) return path;
    print_message("skipped: %s is not there\n", path);
    skip();
    return NULL;
}

static int visit(const char *path, const struct stat *info, int kind, struct FTW *where)
{
    (void)info;
    (void)where;
    if (kind != FTW_F) return 0;
    prom_import_options options = {.time_s = 20, .memory_bytes = (uint64_t)2 << 30};
    prom_source source;
    prom_error error = {0};
    double start = prom_clock_ms();
    prom_status status = prom_source_import(path, &options, &source, &error);
    double took = prom_clock_ms() - start;
    if (took > outcome.slowest_ms) outcome.slowest_ms = took;
    if (status) {
        assert_int_equal(status, PROM_ERR_INPUT);
        assert_true(error.text[0] != 0);
        outcome.refused++;
        return 0;
    }
    outcome.good++;
    for (size_t m = 0; m < source.meshes.count; m++)
        assert_null(prom_mesh_check(&source.meshes.data[m], (uint32_t)source.materials.count));
    prom_source_finish(&source);
    return 0;
}

static void broken_files_never_end_the_program(void **state)
{
    (void)state;
    assert_int_equal(nftw(shared("malformed"), visit, 16, FTW_PHYS), 0);
    print_message("%u imported, %u refused, the slowest took %.2f s\n", outcome.good,
                  outcome.refused, outcome.slowest_ms / 1000);
    assert_true(outcome.refused > outcome.good);
}

// Triangles as placed, and those of them that have two equal corners (counted in the files).
static void real_scenes_arrive_whole(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        uint64_t triangles, degenerate;
    } scenes[] = {{"scenes/sponza/sponza.obj", 262267, 267},
                  {"scenes/candela_city/candela_city.gltf", 431630, 0},
                  {"scenes/black_forest/black_forest.gltf", 1105608, 7},
                  {"scenes/forza/forza.gltf", 71775, 0},
                  {"scenes/bunny/stanford-bunny.obj", 69451, 0},
                  {"scenes/dragon/dragon_vrip_res3.ply", 47794, 0}};
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        prom_source s;
        prom_error error = {0};
        if (prom_source_import(shared(scenes[i].name), NULL, &s, &error))
            fail_msg("%s", error.text);
        uint64_t placed = 0;
        for (size_t r = 0; r < s.mesh_refs.count; r++)
            placed += s.meshes.data[s.mesh_refs.data[r]].index_count / 3;
        assert_int_equal(placed, scenes[i].triangles - scenes[i].degenerate);
        for (size_t k = 0; k < s.images.count; k++) assert_false(s.images.data[k].missing);
        prom_source_finish(&s);
    }
}

int main(void)
{
    prom_log_set_level(PROM_LOG_ERROR);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(broken_files_never_end_the_program),
        cmocka_unit_test(real_scenes_arrive_whole),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
