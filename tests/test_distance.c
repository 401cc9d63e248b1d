// LINK: prom_traverse prom_benefit prom_metaobj
// The selector `distance`: hysteresis, and levels by artists with their switching distances.
#include "selector_fixture.h"
#include "traverse/evaluate.h"

// ---- one object with levels by its artist

// Its representations, in the prototype's order.
enum { ITSELF, OWN_1, ARTIST_1, OWN_2, ARTIST_2, BOX, REPS };

static const float until[REPS] = {[ITSELF] = 40, [ARTIST_1] = 100, [ARTIST_2] = 300};

static void set_artist_level(prom_model *m, uint32_t rep)
{
    m->reps[rep].switch_distance = until[rep];
    if (rep != ITSELF) m->reps[rep].flags |= PROM_REP_ARTIST;
}

// ARTIST_1 has more triangles than the level before it.
static void object_reps(prom_model *m, uint64_t *seed)
{
    static const uint32_t triangles[REPS] = {1000, 300, 500, 100, 50, 12};
    m->rep_count = 0;
    for (uint32_t r = 0; r < REPS; r++)
        random_add_rep(m, seed, r == BOX ? PROM_REP_AVERAGE_BOX : PROM_REP_MESH, r,
                       0.1f * (float)r, triangles[r], 1.0f - 0.1f * (float)r);
    for (uint32_t r = 0; r < REPS; r++) m->reps[r].layers = 1.0f; // triangles alone decide
    set_artist_level(m, ITSELF);
    set_artist_level(m, ARTIST_1);
    set_artist_level(m, ARTIST_2);
    m->mesh_count = m->rep_count;
    m->prototypes[0].first_rep = 0;
    m->prototypes[0].rep_count = REPS;
}

static void object_init(bench *b, float scale)
{
    memset(b, 0, sizeof *b);
    uint64_t seed = 1;
    random_model(&b->model, 1, &(random_model_options){.leaves = 1, .max_children = 2});
    assert_int_equal(b->model.tree_count, 1);
    object_reps(&b->model, &seed);
    b->model.placement[0] = prom_placement_identity;
    for (int k = 0; k < 3; k++) b->model.placement[0].basis[4 * k] = scale;
    prom_model_update_bounds(&b->model);
    b->cost = random_cost(&seed);
    b->camera = (prom_camera){.fov_y = 1, .z_near = 0.1f, .width = 600, .height = 600};
    b->selection = (prom_selection){.view = &b->view, .cost = &b->cost};
}

static void object_start(bench *b)
{
    assert_null(prom_model_check(&b->model, NULL));
    for (size_t i = 0; i < prom_selector_count(); i++) {
        prom_selector_destroy(b->selectors[i]);
        b->selectors[i] = prom_selector_create(prom_selector_at(i)->name, &b->model, NULL);
    }
}

static uint32_t object_at(bench *b, double distance)
{
    for (int k = 0; k < 3; k++)
        b->camera.eye[k] = b->model.center[0][k] + (k == 2 ? distance : 0.0);
    prom_camera_look_at(&b->camera, b->model.center[0]);
    prom_view_init(&b->view, &b->camera);
    prom_cut *cut = bench_run(b, "distance", 0);
    assert_int_equal(cut->entries.count, 1);
    assert_null(prom_cut_check(&b->model, &b->view, cut));
    return cut->entries.data[0].rep;
}

// The same without memory of earlier frames.
static uint32_t object_first_at(bench *b, double distance)
{
    object_start(b);
    return object_at(b, distance);
}

static void artists_levels_switch_at_their_distances(void **state)
{
    (void)state;
    const float scales[] = {0.25f, 1, 6}; // which do not matter
    for (int i = 0; i < 3; i++) {
        bench b;
        object_init(&b, scales[i]);
        assert_int_equal(object_first_at(&b, 12), ITSELF);
        assert_int_equal(object_first_at(&b, 39.9), ITSELF);
        assert_int_equal(object_first_at(&b, 40.1), ARTIST_1);
        assert_int_equal(object_first_at(&b, 99.9), ARTIST_1);
        assert_int_equal(object_first_at(&b, 100.1), ARTIST_2);
        assert_int_equal(object_first_at(&b, 299), ARTIST_2);
        // Where the artist's engine drops it, and where all others take a box.
        assert_int_equal(object_first_at(&b, 301), ARTIST_2);
        assert_int_equal(object_first_at(&b, 1e5), ARTIST_2);
        b.selection.rule_scale = 3;
        assert_int_equal(object_first_at(&b, 119), ITSELF);
        assert_int_equal(object_first_at(&b, 121), ARTIST_1);
        assert_int_equal(object_first_at(&b, 301), ARTIST_2);
        bench_finish(&b);
    }
}

static void artists_levels_have_hysteresis(void **state)
{
    (void)state;
    bench b;
    object_init(&b, 1);
    assert_int_equal(object_first_at(&b, 39), ITSELF);
    assert_int_equal(object_at(&b, 43), ITSELF);
    assert_int_equal(object_at(&b, 46), ARTIST_1);
    assert_int_equal(object_at(&b, 37), ARTIST_1);
    assert_int_equal(object_at(&b, 35), ITSELF);
    assert_int_equal(object_at(&b, 200), ARTIST_2); // a jump over a level
    assert_int_equal(object_at(&b, 95), ARTIST_2);
    assert_int_equal(object_at(&b, 60), ARTIST_1);
    bench_finish(&b);
}

// The box around the eye, and a level that the builder would not show so near: what the artist
// says is done. The budgeted selectors keep to what was measured.
static void artists_know_better_than_gaps(void **state)
{
    (void)state;
    bench b;
    object_init(&b, 1);
    b.model.reps[ARTIST_1].max_size_px = 1;
    assert_int_equal(object_first_at(&b, 0.01), ITSELF);
    assert_int_equal(object_first_at(&b, 60), ARTIST_1);
    assert_true(bench_run(&b, "distance", 0)->loss > 0.0);
    for (double budget = 0.01; budget < 100; budget *= 1.3) {
        assert_int_not_equal(bench_run(&b, "greedy", budget)->entries.data[0].rep, ARTIST_1);
        assert_int_not_equal(bench_run(&b, "meta", budget)->entries.data[0].rep, ARTIST_1);
    }
    bench_finish(&b);
}

// A prototype orders its levels by what they cost, which need not be the order of distances.
static void artists_levels_in_any_order(void **state)
{
    (void)state;
    bench b;
    object_init(&b, 1);
    b.model.reps[ARTIST_1].switch_distance = 300;
    b.model.reps[ARTIST_2].switch_distance = 100;
    assert_int_equal(object_first_at(&b, 39), ITSELF);
    assert_int_equal(object_first_at(&b, 60), ARTIST_2);
    assert_int_equal(object_first_at(&b, 200), ARTIST_1);
    assert_int_equal(object_first_at(&b, 2000), ARTIST_1);
    // An object that is itself at any distance.
    b.model.reps[ITSELF].switch_distance = INFINITY;
    assert_int_equal(object_first_at(&b, 2000), ITSELF);
    // A last level for everything beyond.
    b.model.reps[ITSELF].switch_distance = 40;
    b.model.reps[ARTIST_2].switch_distance = INFINITY;
    assert_int_equal(object_first_at(&b, 299), ARTIST_1);
    assert_int_equal(object_first_at(&b, 301), ARTIST_2);
    bench_finish(&b);
}

// Levels without any distance (a scene need not give them) are levels like all others.
static void levels_without_distances_follow_the_radius(void **state)
{
    (void)state;
    bench b;
    object_init(&b, 1);
    for (uint32_t r = 0; r < REPS; r++) b.model.reps[r].switch_distance = INFINITY;
    b.model.reps[ARTIST_1].max_size_px = 1;
    float radius = b.model.radius[0];
    assert_int_equal(object_first_at(&b, 7.9 * radius), ITSELF);
    assert_int_equal(object_first_at(&b, 8.1 * radius), OWN_1);
    assert_int_equal(object_first_at(&b, 16.1 * radius), OWN_1); // ARTIST_1 is for afar only
    assert_int_equal(object_first_at(&b, 32.1 * radius), OWN_2);
    assert_int_equal(object_first_at(&b, 1e5), BOX);
    bench_finish(&b);
}

// Greedy and meta take whatever gives most for the time, whoever made it.
static void artists_levels_are_levels_for_the_others(void **state)
{
    (void)state;
    const char *const names[] = {"greedy", "meta"};
    for (int i = 0; i < 2; i++) {
        bench b;
        object_init(&b, 1);
        // Each pays, the next one always a little less than the one before.
        b.cost.edge_ms = 0.0;
        for (uint32_t r = 0; r < REPS; r++) {
            static const uint8_t accuracy[REPS] = {236, 162, 176, 149, 145, 141};
            memset(&b.model.accuracy[r], accuracy[r], sizeof *b.model.accuracy);
            b.model.reps[r].shading = PROM_SHADE_PLAIN;
            b.model.reps[r].draws = 1;
        }
        object_first_at(&b, 60);
        bool seen[REPS] = {false};
        uint32_t last = 0;
        for (double budget = 0.001; budget < 100; budget *= 1.01) {
            const prom_cut *cut = bench_run(&b, names[i], budget);
            const prom_representation *r = &b.model.reps[cut->entries.data[0].rep];
            seen[cut->entries.data[0].rep] = true;
            assert_true(r->triangles >= last);
            last = r->triangles;
        }
        assert_true(seen[ITSELF] && seen[ARTIST_1] && seen[ARTIST_2]);
        bench_finish(&b);
    }
}

// ---- whole models

// What a leaf without a past is drawn by.
static bool is_artists_choice(const prom_model *m, uint32_t node, uint32_t rep, float distance)
{
    const prom_prototype *p = &m->prototypes[m->prototype[node]];
    const prom_representation *chosen = &m->reps[rep];
    if (rep != p->first_rep && !(chosen->flags & PROM_REP_ARTIST)) return false;
    bool reaches = distance <= chosen->switch_distance;
    for (uint32_t r = p->first_rep; r < p->first_rep + p->rep_count; r++) {
        if (r == rep || (r != p->first_rep && !(m->reps[r].flags & PROM_REP_ARTIST))) continue;
        float other = m->reps[r].switch_distance;
        if (distance <= other && (!reaches || other < chosen->switch_distance)) return false;
        if (!reaches && other > chosen->switch_distance) return false;
    }
    return true;
}

// Artists decide about their objects and about nothing else.
static void artists_decide_for_their_objects_alone(void **state)
{
    (void)state;
    uint64_t seed = 70;
    uint32_t theirs = 0, coarse = 0, others = 0, clusters = 0;
    for (int round = 0; round < 60; round++) {
        bench with, without;
        random_model_options o = options_of(&seed);
        o.artists = 0.5f;
        uint64_t model_seed = random_u64(&seed), look_seed = random_u64(&seed);
        bench_init(&with, model_seed, &o);
        bench_init(&without, model_seed, &o);
        bench_look(&with, &look_seed);
        without.camera = with.camera, without.view = with.view;
        for (uint32_t r = 0; r < without.model.rep_count; r++)
            without.model.reps[r].switch_distance = INFINITY;
        const prom_cut *a = bench_run(&with, "distance", 0);
        const prom_cut *b = bench_run(&without, "distance", 0);
        assert_int_equal(a->entries.count, b->entries.count);
        for (size_t i = 0; i < a->entries.count; i++) {
            const prom_cut_entry *e = &a->entries.data[i];
            const prom_model *m = &with.model;
            const prom_prototype *p = &m->prototypes[m->prototype[e->node]];
            assert_int_equal(e->node, b->entries.data[i].node);
            if (isfinite(m->reps[p->first_rep].switch_distance)) {
                prom_appearance seen;
                prom_view_appearance(&with.view, m, e->node, &seen);
                assert_true(is_artists_choice(m, e->node, e->rep, seen.distance));
                theirs++, coarse += e->rep != p->first_rep;
            } else {
                assert_int_equal(e->rep, b->entries.data[i].rep);
                others++, clusters += m->child_count[e->node] > 0;
            }
        }
        bench_finish(&with);
        bench_finish(&without);
    }
    assert_true(theirs > 200 && coarse > 50 && others > 200 && clusters > 50);
}

static uint32_t count_changes(const prom_cut *a, const prom_cut *b)
{
    uint32_t changes = 0;
    if (a->entries.count != b->entries.count) return (uint32_t)a->entries.count;
    for (size_t i = 0; i < a->entries.count; i++)
        changes += a->entries.data[i].node != b->entries.data[i].node ||
                   a->entries.data[i].rep != b->entries.data[i].rep;
    return changes;
}

static void copy_entries(const prom_cut *from, prom_cut *to)
{
    to->entries.count = 0;
    for (size_t i = 0; i < from->entries.count; i++)
        prom_array_push(&to->entries, from->entries.data[i]);
}

// A camera that trembles must not make `distance` change its mind.
static void distance_does_not_flicker(void **state)
{
    (void)state;
    uint64_t seed = 50;
    uint32_t shown = 0;
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = {
            .leaves = 100, .max_children = 8, .extent = 100, .artists = 0.5f};
        bench_init(&b, random_u64(&seed), &o);
        random_camera(&b.model, &seed, &b.camera);
        // From far off, where a small move neither culls nor enters anything.
        for (int k = 0; k < 3; k++)
            b.camera.eye[k] = b.model.center[0][k] + (k == 2 ? 4.0 * b.model.radius[0] : 0.0);
        prom_camera_look_at(&b.camera, b.model.center[0]);
        b.camera.fov_y = 1.0f;
        b.camera.width = b.camera.height = 600;
        prom_cut first = {0};
        double z = b.camera.eye[2];
        for (int i = 0; i < 20; i++) {
            b.camera.eye[2] = z * (1.0 + 0.02 * (i % 2 ? 1 : -1) * random_unit(&seed));
            prom_view_init(&b.view, &b.camera);
            prom_cut *cut = bench_run(&b, "distance", 0);
            if (i) assert_int_equal(count_changes(cut, &first), 0);
            if (!i) copy_entries(cut, &first);
        }
        shown += (uint32_t)first.entries.count;
        prom_cut_finish(&first);
        bench_finish(&b);
    }
    assert_true(shown > 200);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(artists_levels_switch_at_their_distances),
        cmocka_unit_test(artists_levels_have_hysteresis),
        cmocka_unit_test(artists_know_better_than_gaps),
        cmocka_unit_test(artists_levels_in_any_order),
        cmocka_unit_test(levels_without_distances_follow_the_radius),
        cmocka_unit_test(artists_levels_are_levels_for_the_others),
        cmocka_unit_test(artists_decide_for_their_objects_alone),
        cmocka_unit_test(distance_does_not_flicker),
    };
    return cmocka_run_group_tests_name("distance", tests, NULL, NULL);
}
