// LINK: prom_metaobj
// The model: bounds from prototypes, and the check that refuses what cannot be walked.
#include "container_fixture.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static float random_unit(uint32_t *seed)
{
    return (float)fixture_random(seed) / 8388608.0f - 1; // [-1,1)
}

static void bounds_hold_children(void **state)
{
    (void)state;
    fixture f;
    fixture_init(&f, 6, 9);
    prom_model *m = &f.model;
    uint32_t seed = 8;
    for (uint32_t n = 0; n < m->node_count; n++)
        for (int i = 0; i < 12; i++) {
            if (i < 9)
                m->placement[n].basis[i] = random_unit(&seed) * 3;
            else
                m->placement[n].origin[i - 9] = 1e5 + random_unit(&seed) * 500;
        }
    prom_model_update_bounds(m);
    uint64_t row;
    assert_null(prom_model_check(m, &row));
    for (uint32_t n = 1; n < m->tree_count; n++) {
        uint32_t p = m->parent[n];
        for (int a = 0; a < 3; a++) {
            double d = fabs(m->center[n][a] - m->center[p][a]);
            assert_true(d + m->half[n][a] <= m->half[p][a] + 1e-9);
        }
        double diagonal = 0;
        for (int a = 0; a < 3; a++) diagonal += (double)m->half[p][a] * m->half[p][a];
        assert_true(m->radius[p] <= sqrt(diagonal) * 1.000001);
    }
    fixture_finish(&f);
}

// Applies one change to a good model and wants it refused.
#define assert_refused(change)                                                                 \
    do {                                                                                       \
        fixture f;                                                                             \
        fixture_init(&f, 3, 4);                                                                \
        prom_model *m = &f.model;                                                              \
        uint64_t row = 0;                                                                      \
        assert_null(prom_model_check(m, &row));                                                \
        change;                                                                                \
        assert_non_null(prom_model_check(m, &row));                                            \
        fixture_finish(&f);                                                                    \
    } while (0)

static void model_check(void **state)
{
    (void)state;
    static const prom_texture_info lit_pictures = {PROM_TEXTURE_IMPOSTOR_LIT, 4, 4, 6, 3};
    assert_refused(m->tree_count = 0);
    assert_refused(m->tree_count = m->node_count + 1);
    assert_refused(m->tree_count = m->node_count);     // the backdrop is nobody's child
    assert_refused(m->tree_count = m->node_count - 2); // a child in the background
    assert_refused(m->parent[0] = 0);
    assert_refused(m->parent[6] = 2);
    assert_refused(m->parent[6] = 6);
    assert_refused(m->parent[6] = PROM_NONE);
    assert_refused(m->parent[m->node_count - 1] = 0);
    assert_refused(m->first_child[1] = 1);
    assert_refused(m->first_child[1] = PROM_NONE);
    assert_refused(m->first_child[5] = 6);
    assert_refused(m->child_count[1] = UINT32_MAX);
    assert_refused(m->child_count[3] = 5);
    assert_refused(m->prototype[5] = 4);
    assert_refused(m->prototype[5] = 1); // a cluster's
    assert_refused(m->prototype[1] = 2); // three children, not four
    assert_refused(m->name[2] = m->names_bytes);
    assert_refused(m->names[m->names_bytes - 1] = 'x');
    assert_refused(m->names[0] = 'x');
    assert_refused(m->placement[4].origin[1] = NAN);
    assert_refused(m->placement[4].basis[8] = INFINITY);
    assert_refused(m->center[4][0] = NAN);
    assert_refused(m->half[4][0] = -1);
    assert_refused(m->radius[4] = NAN);
    assert_refused(m->prototypes[0].rep_count = 4);
    assert_refused(m->prototypes[0].rep_count = 2);
    assert_refused(m->prototypes[3].first_rep = UINT32_MAX);
    assert_refused(m->prototypes[1].first_share = PROM_NONE);
    assert_refused(m->prototypes[1].first_share = 4);
    assert_refused(m->prototypes[0].first_share = 0);
    assert_refused(m->prototypes[0].flags = PROM_PROTO_CLUSTER);
    assert_refused(m->prototypes[0].radius = -1);
    assert_refused(m->prototypes[0].center[2] = NAN);
    assert_refused(m->reps[5].kind = PROM_REP_AVERAGE_BOX); // a leaf without a mesh
    assert_refused(m->reps[0].kind = PROM_REP_KIND_COUNT);
    assert_refused(m->reps[0].mesh = m->mesh_count);
    assert_refused(m->reps[0].texture = m->texture_count);
    assert_refused(m->reps[0].texture = 1); // pictures on a mesh
    assert_refused(m->reps[1].texture = 1); // on an average-colour box
    assert_refused(m->reps[2].texture = PROM_NONE);
    assert_refused(m->reps[2].texture = 0);
    assert_refused(m->reps[2].flags ^= PROM_REP_UNLIT);
    assert_refused(m->textures[1] = lit_pictures);
    assert_refused(m->reps[0].shading = PROM_SHADE_COUNT);
    assert_refused(m->reps[0].error = -1);
    assert_refused(m->reps[0].error = INFINITY);
    assert_refused(m->reps[0].max_size_px = 0);
    assert_refused(m->reps[0].max_size_px = NAN);
    assert_refused(m->reps[0].near_k = -0.5f);
    assert_refused(m->materials[0].texture = 1);
    assert_refused(m->materials[0].texture = 2);
    assert_refused(m->materials[0].alpha_mode = 3);
    assert_refused(m->materials[0].base_color[1] = NAN);
    assert_refused(m->meshes[0].index_count++);
    assert_refused(m->textures[0].levels--);
    assert_refused(m->textures[0].width = 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bounds_hold_children),
        cmocka_unit_test(model_check),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
