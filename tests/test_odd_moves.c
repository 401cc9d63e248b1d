// LINK: prom_traverse prom_benefit prom_metaobj
//
// Cameras that do what no walk does: teleports, a spin, a zoom, nothing in view, the eye inside
// an object, a model of one object; every selector, under the guarantee and with what was seen.
#include "selector_fixture.h"
#include "traverse/bound.h"
#include "traverse/guarantee.h"

#define FRAMES 60
#define BUDGET_MS 8.0

typedef struct world {
    bench b;
    prom_visibility *visibility;
    prom_guarantee guarantee;
    prom_last_cut last;
    PROM_ARRAY(prom_visible_count) counts;
    uint64_t seed;
} world;

typedef void moves(world *w, int frame, prom_camera *camera);

static prom_camera outside(world *w)
{
    uint64_t seed = 11;
    prom_camera camera;
    random_camera_outside(&w->b.model, &seed, &camera);
    return camera;
}

static void teleport(world *w, int frame, prom_camera *camera)
{
    (void)frame;
    random_camera(&w->b.model, &w->seed, camera);
}

// Half way round in three frames, from the middle of the model.
static void spin(world *w, int frame, prom_camera *camera)
{
    *camera = outside(w);
    double target[3];
    for (int k = 0; k < 3; k++) camera->eye[k] = target[k] = w->b.model.center[0][k];
    target[0] += cos(frame * M_PI / 3);
    target[2] += sin(frame * M_PI / 3);
    prom_camera_look_at(camera, target);
}

// From a fish's eye to a telescope and back.
static void zoom(world *w, int frame, prom_camera *camera)
{
    *camera = outside(w);
    camera->fov_y = (float)(1.5 * pow(0.8, frame < FRAMES / 2 ? frame : FRAMES - frame));
}

static void look_away(world *w, int frame, prom_camera *camera)
{
    (void)frame;
    *camera = outside(w);
    double target[3];
    for (int k = 0; k < 3; k++) target[k] = 2 * camera->eye[k] - w->b.model.center[0][k];
    prom_camera_look_at(camera, target);
}

// In the middle of one leaf after another.
static void go_inside(world *w, int frame, prom_camera *camera)
{
    const prom_model *m = &w->b.model;
    uint32_t leaf = m->tree_count - 1 - (uint32_t)frame % m->tree_count;
    *camera = outside(w);
    double target[3];
    for (int k = 0; k < 3; k++) camera->eye[k] = m->center[leaf][k], target[k] = camera->eye[k];
    target[0] += 1;
    prom_camera_look_at(camera, target);
}

// What shows is half of what the selector thought.
static void feed_back(world *w, const prom_cut *cut)
{
    w->counts.count = 0;
    for (size_t i = 0; i < cut->entries.count; i++)
        prom_array_push(&w->counts,
                        (prom_visible_count){cut->entries.data[i],
                                             0.5f * cut->entries.data[i].footprint_px});
    prom_visibility_feed(w->visibility, &w->b.camera, w->counts.data, w->counts.count);
    prom_guarantee_frame frame = {.draw_ms = 1.2 * cut->predicted_ms + 0.01, .other_ms = 0.2};
    memcpy(frame.terms_ms, cut->terms_ms, sizeof frame.terms_ms);
    prom_guarantee_feed(&w->guarantee, &frame);
    prom_last_cut_note(&w->last, cut);
}

static void check_cut(const world *w, const prom_selector_class *class, const prom_cut *cut,
                      double allowed)
{
    assert_null(prom_cut_check(&w->b.model, &w->b.view, cut));
    assert_true(isfinite(cut->predicted_ms) && cut->predicted_ms >= 0);
    assert_true(isfinite(cut->benefit) && isfinite(cut->loss));
    if (class->budgeted && class->uses_cost && cut->feasible)
        assert_true(cut->predicted_ms <= allowed);
    double gap = prom_cut_gap(cut);
    assert_true(isnan(gap) || (gap >= 0 && gap <= 1));
    if (cut->feasible && class->uses_cost)
        assert_true(cut->benefit <= cut->bound * (1 + 1e-9) + 1e-6);
    assert_true(prom_guarantee_allowed(&w->guarantee) >= 0);
    assert_true(w->guarantee.scale > 0 && isfinite(w->guarantee.scale));
}

static void begin(world *w)
{
    const prom_guarantee_options options = {.budget_ms = BUDGET_MS, .miss_rate = 0.01};
    prom_guarantee_init(&w->guarantee, &w->b.cost, &options);
    w->visibility = prom_visibility_create(&w->b.model, NULL);
    prom_last_cut_init(&w->last, &w->b.model);
    w->seed = 5;
}

static void end(world *w)
{
    prom_visibility_destroy(w->visibility);
    prom_last_cut_finish(&w->last);
    prom_array_finish(&w->counts);
}

static void move(world *w, moves *how, const char *name, bool empty)
{
    begin(w);
    for (int f = 0; f < FRAMES; f++) {
        how(w, f, &w->b.camera);
        prom_view_init(&w->b.view, &w->b.camera);
        prom_visibility_begin(w->visibility, &w->b.camera);
        double allowed = prom_guarantee_allowed(&w->guarantee);
        w->b.selection = (prom_selection){.view = &w->b.view,
                                          .cost = prom_guarantee_cost(&w->guarantee),
                                          .visibility = w->visibility,
                                          .last = &w->last,
                                          .hysteresis = 0.05f,
                                          .max_switches = f % 2 ? 3 : 0,
                                          .certify = true};
        const prom_cut *cut = bench_run(&w->b, name, allowed);
        check_cut(w, prom_selector_class_named(name), cut, allowed);
        if (empty) assert_int_equal(cut->entries.count, 0);
        feed_back(w, cut);
    }
    end(w);
}

static void move_with_all(moves *how, bool empty)
{
    const random_model_options shapes[] = {
        {.leaves = 60, .max_children = 6, .extent = 60, .bare_clusters = 0.1f},
        {.leaves = 1, .max_children = 2, .extent = 5}};
    for (size_t s = 0; s < 2; s++) {
        world w = {0};
        bench_init(&w.b, 21 + s, &shapes[s]);
        for (size_t i = 0; i < prom_selector_count(); i++)
            move(&w, how, prom_selector_at(i)->name, empty);
        bench_finish(&w.b);
    }
}

static void teleports(void **state)
{
    (void)state;
    move_with_all(teleport, false);
}

static void a_spin(void **state)
{
    (void)state;
    move_with_all(spin, false);
}

static void a_zoom(void **state)
{
    (void)state;
    move_with_all(zoom, false);
}

static void nothing_in_view(void **state)
{
    (void)state;
    move_with_all(look_away, true);
}

static void the_eye_inside(void **state)
{
    (void)state;
    move_with_all(go_inside, false);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(teleports),      cmocka_unit_test(a_spin),
        cmocka_unit_test(a_zoom),         cmocka_unit_test(nothing_in_view),
        cmocka_unit_test(the_eye_inside),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
