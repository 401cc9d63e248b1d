// LINK: prom_builder prom_render prom_traverse prom_benefit prom_metaobj
// The tables of a real object: finer meshes and smaller pictures are more accurate.
#include "benefit/accuracy.h"
#include "builder/pipeline.h"
#include "metaobj/base/log.h"
#include "metaobj/base/math.h"
#include "metaobj/container.h"
#include "render/context.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include <cmocka.h>

static char *scene;

// The bunny as one object, and the tree's root above it, with meshes of both. The second metric
// is measured in the pictures of the first.
static void build(const char *metric, prom_model *model)
{
    prom_build_options options = {.objects = {.max_triangles = 200000},
                                  .measure = {.metric = metric},
                                  .keep_views = true};
    prom_error error = {0};
    if (prom_build(scene, "tables.prom", &options, NULL, &error)) fail_msg("%s", error.text);
    prom_container *c = prom_container_open("tables.prom", &error);
    assert_non_null(c);
    assert_int_equal(prom_container_load_model(c, model, &error), PROM_OK);
    prom_container_close(c);
    assert_string_equal(model->measured.metric, metric);
}

static bool are_levels(const prom_model *m, uint32_t finer, uint32_t coarser)
{
    for (uint32_t p = 0; p < m->prototype_count; p++) {
        uint32_t first = m->prototypes[p].first_rep, end = first + m->prototypes[p].rep_count;
        if (finer >= first && coarser < end)
            return m->reps[finer].kind == PROM_REP_MESH &&
                   m->reps[coarser].kind == PROM_REP_MESH;
    }
    return false;
}

#define SIZES (PROM_SIZES + PROM_SIZES_LARGE)
#define STEP 0.01f // accuracies are stored in steps, rounded down

// In a view bin, of those that are measured; beyond PROM_SIZES along the axes only.
static float accuracy_in(const prom_model *m, uint32_t rep, uint32_t dir, uint32_t size)
{
    float direction[3], uv[2];
    prom_accuracy_place place;
    prom_direction_of_bin(dir, direction);
    prom_octahedral_encode(direction, uv);
    prom_accuracy_place_init(&place, uv, prom_size_of_bin(size));
    return prom_accuracy(m, rep, &place, 1.0f);
}

// How far the accuracies of a row are at most above those of another.
static float most_above(const prom_model *m, uint32_t rep, uint32_t other)
{
    float most = 0.0f;
    for (uint32_t s = 0; s < SIZES; s++)
        for (uint32_t d = 0; d < (s < PROM_SIZES ? PROM_DIRS : PROM_DIRS_LARGE); d++)
            most = fmaxf(most, accuracy_in(m, rep, d, s) - accuracy_in(m, other, d, s));
    return most;
}

static float most_above_smaller(const prom_model *m, uint32_t rep)
{
    float most = 0.0f;
    for (uint32_t s = 1; s < SIZES; s++)
        for (uint32_t d = 0; d < (s < PROM_SIZES ? PROM_DIRS : PROM_DIRS_LARGE); d++)
            most = fmaxf(most, accuracy_in(m, rep, d, s) - accuracy_in(m, rep, d, s - 1));
    return most;
}

static void check_growth(const char *metric, float slack)
{
    prom_model m = {0};
    uint32_t pairs = 0, meshes = 0;
    build(metric, &m);
    for (uint32_t r = 0; r < m.rep_count; r++) {
        if (m.reps[r].kind != PROM_REP_MESH) continue;
        assert_true(most_above_smaller(&m, r) <= slack);
        meshes++;
        if (r + 1 == m.rep_count || !are_levels(&m, r, r + 1)) continue;
        assert_true(most_above(&m, r + 1, r) <= slack);
        pairs++;
    }
    assert_true(meshes >= 8 && pairs >= 6);
    prom_model_finish(&m);
}

static void rmse_grows_with_level_and_distance(void **state)
{
    (void)state;
    check_growth("rmse", STEP);
}

// It filters as eyes do, which see some spatial frequencies best.
static void flip_grows_with_level_and_distance(void **state)
{
    (void)state;
    check_growth("flip", 0.08f);
}

int main(void)
{
    const char *shared = getenv("PROM_SHARED");
    prom_error error;
    prom_log_set_level(PROM_LOG_WARNING);
    scene = prom_format("%s/scenes/bunny/stanford-bunny.obj", shared ? shared : "");
    prom_context *context = prom_context_create_headless(&error);
    if (access(scene, R_OK) != 0 || !context) {
        print_message("skipped: no %s\n", context ? scene : error.text);
        prom_context_destroy(context);
        prom_free(scene);
        return 0;
    }
    prom_context_destroy(context);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rmse_grows_with_level_and_distance),
        cmocka_unit_test(flip_grows_with_level_and_distance),
    };
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    prom_free(scene);
    return failed;
}
