// LINK: prom_traverse prom_benefit prom_metaobj
// Culling, the evaluation and the selectors on random trees and cameras.
#include "random_model.h"
#include "traverse/evaluate.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

// ---- culling and appearance

// Independent of the planes: turns the point into the camera's frame by the quaternion.
static void to_camera(const prom_camera *camera, const double world[3], double out[3])
{
    double p[3], q[4], t[3];
    for (int k = 0; k < 3; k++) p[k] = world[k] - camera->eye[k];
    for (int k = 0; k < 4; k++) q[k] = k < 3 ? -camera->orientation[k] : camera->orientation[k];
    // p + 2 w (q x p) + 2 q x (q x p)
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        t[k] = 2.0 * (q[a] * p[b] - q[b] * p[a]);
    }
    for (int k = 0; k < 3; k++) {
        int a = (k + 1) % 3, b = (k + 2) % 3;
        out[k] = p[k] + q[3] * t[k] + q[a] * t[b] - q[b] * t[a];
    }
}

// How far inside the frustum a point is, in its own distance; negative outside.
static double depth_inside(const prom_camera *camera, const double world[3])
{
    double p[3], h = tan(0.5 * camera->fov_y), w = h * camera->width / camera->height;
    to_camera(camera, world, p);
    double inside = -p[2] - camera->z_near;
    inside = fmin(inside, w * -p[2] - fabs(p[0]));
    return fmin(inside, h * -p[2] - fabs(p[1]));
}

static void culling_is_conservative(void **state)
{
    (void)state;
    uint64_t seed = 1;
    const random_model_options o = {.leaves = 30, .max_children = 6, .extent = 40};
    uint32_t seen[3] = {0};
    for (int round = 0; round < 60; round++) {
        prom_model m;
        random_model(&m, (uint64_t)round, &o);
        prom_camera camera;
        prom_view view;
        random_camera(&m, &seed, &camera);
        prom_view_init(&view, &camera);
        for (uint32_t n = 0; n < m.tree_count; n++) {
            prom_cull cull = prom_view_cull(&view, m.center[n], m.half[n]);
            seen[cull]++;
            for (int i = 0; i < 60; i++) {
                double p[3];
                for (int k = 0; k < 3; k++)
                    p[k] =
                        m.center[n][k] + m.half[n][k] * (i < 8 ? (i >> k & 1 ? 1.0 : -1.0)
                                                               : random_between(&seed, -1, 1));
                double inside = depth_inside(&camera, p);
                if (cull == PROM_OUTSIDE) assert_true(inside < 0.0);
                if (cull == PROM_INSIDE) assert_true(inside > -1e-4);
            }
        }
        prom_model_finish(&m);
    }
    assert_true(seen[0] > 100 && seen[1] > 100 && seen[2] > 100);
}

static void appearance_is_in_range(void **state)
{
    (void)state;
    uint64_t seed = 2;
    const random_model_options o = {.leaves = 30, .max_children = 6, .extent = 20};
    uint32_t near_cases = 0, partial = 0;
    for (int round = 0; round < 60; round++) {
        prom_model m;
        random_model(&m, (uint64_t)round, &o);
        prom_camera camera;
        prom_view view;
        random_camera(&m, &seed, &camera);
        prom_view_init(&view, &camera);
        for (uint32_t n = 0; n < m.tree_count; n++) {
            prom_appearance a;
            prom_view_appearance(&view, &m, n, &a);
            bool holds_eye = true;
            for (int k = 0; k < 3; k++)
                holds_eye = holds_eye && fabs(camera.eye[k] - m.center[n][k]) < m.half[n][k];
            assert_true(a.in_view > 0.0f && a.in_view <= 1.0f);
            assert_true(a.nearest <= a.distance && a.dir < PROM_DIRS);
            if (holds_eye) assert_true(a.near_case && a.nearest == 0.0f);
            if (a.nearest > 2.5f * camera.z_near + 1e-3f && camera.fov_y < 1.0f &&
                camera.width < camera.height)
                assert_false(a.near_case);
            near_cases += a.near_case;
            partial += a.in_view < 1.0f && a.in_view > 0.01f;
        }
        prom_model_finish(&m);
    }
    assert_true(near_cases > 10 && partial > 100);
}

// The part of a box's rectangle in view, against points on a grid over the screen.
static void in_view_of_a_half_visible_box(void **state)
{
    (void)state;
    prom_model m;
    random_model(&m, 3, &(random_model_options){.leaves = 1, .max_children = 2});
    prom_camera camera = {.fov_y = 1.5707963f,
                          .z_near = 0.1f,
                          .width = 100,
                          .height = 100,
                          .orientation = {0, 0, 0, 1}};
    prom_view view;
    prom_appearance a;
    // A flat square at distance 10 from x = 5 to x = 15: the view ends at 10.
    for (int k = 0; k < 3; k++) {
        m.half[0][k] = k == 2 ? 0.0f : 5.0f;
        m.center[0][k] = k == 0 ? 10.0 : k == 1 ? 0.0 : -10.0;
    }
    prom_view_init(&view, &camera);
    prom_view_appearance(&view, &m, 0, &a);
    assert_float_equal(a.in_view, 0.5f, 1e-4f);
    m.center[0][1] = -10.0; // and cut below as well
    prom_view_appearance(&view, &m, 0, &a);
    assert_float_equal(a.in_view, 0.25f, 1e-4f);
    m.center[0][0] = m.center[0][1] = 0.0;
    prom_view_appearance(&view, &m, 0, &a);
    assert_float_equal(a.in_view, 1.0f, 0.0f);
    prom_model_finish(&m);
}

// ---- evaluation

// DESIGN: B(node) = sum of B(children | node) with accuracy 1, here on whole trees in views.
static void pixels_flow_without_loss(void **state)
{
    (void)state;
    uint64_t seed = 4;
    uint32_t compared = 0, near_nodes = 0;
    for (int round = 0; round < 150; round++) {
        const random_model_options o = {
            .leaves = 60, .max_children = 8, .extent = 60, .bare_clusters = 0.3f};
        prom_model m;
        random_model(&m, (uint64_t)round, &o);
        prom_cost_model cost = random_cost(&seed);
        prom_camera camera;
        prom_view view;
        random_camera(&m, &seed, &camera);
        prom_view_init(&view, &camera);
        const prom_selection selection = {.view = &view, .cost = &cost, .budget_ms = 10};
        prom_eval eval;
        prom_eval_init(&eval, &m);
        prom_eval_run(&eval, &selection, NULL, NULL);
        float screen = (float)camera.width * (float)camera.height;
        for (uint32_t i = 0; i < eval.visited_count; i++) {
            uint32_t node = eval.visited[i];
            const prom_eval_node *n = &eval.nodes[node];
            assert_true(n->px >= 0.0f && n->px <= screen * 1.0001f);
            near_nodes += n->near_case;
            if (!n->expanded || !n->in_flow) continue;
            double sum = 0.0;
            bool any = false;
            for (uint32_t c = 0; c < m.child_count[node]; c++) {
                sum += eval.nodes[m.first_child[node] + c].px;
                any = any || !eval.nodes[m.first_child[node] + c].culled;
            }
            if (!any) continue;
            assert_true(fabs(sum - n->px) <= 1e-5 * n->px);
            compared++;
        }
        prom_eval_finish(&eval);
        prom_model_finish(&m);
    }
    assert_true(compared > 500 && near_nodes > 50);
}

// Pixels that a solid box covers, by casting a ray through every cell of a grid over the
// screen.
static double cast_box(const prom_view *view, const double center[3], const float half[3])
{
    enum { GRID = 40 };
    const prom_camera *camera = &view->camera;
    uint32_t hits = 0;
    for (int cell = 0; cell < GRID * GRID; cell++) {
        double x = ((cell % GRID + 0.5) / GRID - 0.5) * camera->width / view->f_px;
        double y = ((cell / GRID + 0.5) / GRID - 0.5) * camera->height / view->f_px;
        double enter = camera->z_near, leave = INFINITY;
        for (int k = 0; k < 3; k++) {
            const float *axis = view->axes + 3 * k; // of the world, in the camera's frame
            double d = x * axis[0] + y * axis[1] - axis[2];
            double to = center[k] - camera->eye[k];
            double a = (to - half[k]) / d, b = (to + half[k]) / d;
            enter = fmax(enter, fmin(a, b));
            leave = fmin(leave, fmax(a, b));
        }
        hits += enter <= leave;
    }
    return (double)hits * camera->width * camera->height / (GRID * GRID);
}

// Solid boxes from all sides, from afar to near by and half out of the view: the estimate
// follows what rays hit.
static void pixels_of_solid_boxes(void **state)
{
    (void)state;
    uint64_t seed = 70;
    prom_model m;
    random_model(&m, 5, &(random_model_options){.leaves = 1, .max_children = 2});
    prom_cost_model cost = random_cost(&seed);
    prom_eval eval;
    prom_eval_init(&eval, &m);
    m.placement[0] = prom_placement_identity;
    uint32_t count = 0, close = 0;
    double sum = 0.0;
    while (count < 2000) {
        float radius2 = 0.0f;
        for (int k = 0; k < 3; k++) {
            m.half[0][k] = powf(10.0f, random_between(&seed, -1, 1.5f));
            radius2 += m.half[0][k] * m.half[0][k];
            m.center[0][k] = 0.0;
        }
        m.radius[0] = sqrtf(radius2);
        prom_camera camera = {.fov_y = 1.0f, .z_near = 0.01f, .width = 800, .height = 600};
        double far = powf(10.0f, random_between(&seed, -1, 1)), target[3];
        for (int k = 0; k < 3; k++) {
            camera.eye[k] = random_between(&seed, -1, 1) * (m.half[0][k] + far);
            target[k] = random_between(&seed, -1.5f, 1.5f) * m.half[0][k];
        }
        prom_camera_look_at(&camera, target);
        prom_view view;
        prom_view_init(&view, &camera);
        prom_appearance a;
        prom_view_appearance(&view, &m, 0, &a);
        double rays = cast_box(&view, m.center[0], m.half[0]);
        if (rays < 2000 || a.nearest == 0.0f) continue; // the eye is inside, or few rays hit
        float outline = 0.0f;
        for (int k = 0; k < 3; k++)
            outline += 4.0f * m.half[0][(k + 1) % 3] * m.half[0][(k + 2) % 3] *
                       fabsf((float)camera.eye[k]) / a.distance;
        m.coverage[m.prototype[0]][a.dir] =
            (uint16_t)(65535.0f * outline / (3.14159265f * radius2));
        const prom_selection selection = {.view = &view, .cost = &cost};
        prom_eval_run(&eval, &selection, NULL, NULL);
        double ratio = log2(eval.nodes[0].px / rays);
        sum += ratio;
        close += fabs(ratio) < 1.0;
        count++;
    }
    print_message("pixels of solid boxes: mean factor %.2f, within a factor of 2: %.1f %%\n",
                  exp2(sum / count), 100.0 * close / count);
    assert_true(fabs(sum / count) < 0.5 && close > 0.8 * count);
    prom_eval_finish(&eval);
    prom_model_finish(&m);
}

// ---- selectors

static bool same_cut(const prom_cut *a, const prom_cut *b)
{
    if (a->entries.count != b->entries.count || a->predicted_ms != b->predicted_ms)
        return false;
    for (size_t i = 0; i < a->entries.count; i++) {
        const prom_cut_entry *x = &a->entries.data[i], *y = &b->entries.data[i];
        if (x->node != y->node || x->rep != y->rep || x->depth != y->depth) return false;
    }
    return true;
}

static int by_node(const void *a, const void *b)
{
    const prom_cut_entry *x = a, *y = b;
    return x->node < y->node ? -1 : x->node > y->node;
}

// The same entries in any order.
static bool same_entries(prom_cut *a, prom_cut *b)
{
    if (a->entries.count != b->entries.count) return false;
    qsort(a->entries.data, a->entries.count, sizeof *a->entries.data, by_node);
    qsort(b->entries.data, b->entries.count, sizeof *b->entries.data, by_node);
    for (size_t i = 0; i < a->entries.count; i++)
        if (a->entries.data[i].node != b->entries.data[i].node ||
            a->entries.data[i].rep != b->entries.data[i].rep)
            return false;
    return true;
}

// Validity (DESIGN 5): boxes only from outside, not near, and up to their size.
static void check_validity(const prom_model *m, const prom_view *view, const prom_cut *cut)
{
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        prom_appearance a;
        prom_view_appearance(view, m, e->node, &a);
        if (m->reps[e->rep].kind != PROM_REP_MESH) {
            assert_false(a.near_case);
            assert_true(a.size_px <= m->reps[e->rep].max_size_px);
        }
        if (a.near_case) assert_int_equal(m->child_count[e->node], 0);
        assert_float_equal(e->fade, 1.0f, 0.0f);
        assert_int_equal(e->fade_from, PROM_NONE);
    }
}

typedef struct bench {
    prom_model model;
    prom_camera camera;
    prom_view view;
    prom_cost_model cost;
    prom_selection selection;
    prom_selector *selectors[8];
    prom_cut cuts[8];
} bench;

static void bench_init(bench *b, uint64_t seed, const random_model_options *o)
{
    memset(b, 0, sizeof *b);
    random_model(&b->model, seed, o);
    assert_null(prom_model_check(&b->model, NULL));
    b->cost = random_cost(&seed);
    for (size_t i = 0; i < prom_selector_count(); i++)
        b->selectors[i] = prom_selector_create(prom_selector_at(i)->name, &b->model, NULL);
    b->selection = (prom_selection){.view = &b->view, .cost = &b->cost};
}

static void bench_finish(bench *b)
{
    for (size_t i = 0; i < prom_selector_count(); i++) {
        prom_selector_destroy(b->selectors[i]);
        prom_cut_finish(&b->cuts[i]);
    }
    prom_model_finish(&b->model);
}

static void bench_look(bench *b, uint64_t *seed)
{
    random_camera(&b->model, seed, &b->camera);
    prom_view_init(&b->view, &b->camera);
}

static prom_cut *bench_run(bench *b, const char *name, double budget_ms)
{
    for (size_t i = 0; i < prom_selector_count(); i++) {
        if (strcmp(prom_selector_at(i)->name, name)) continue;
        b->selection.budget_ms = budget_ms;
        prom_selector_run(b->selectors[i], &b->selection, &b->cuts[i]);
        return &b->cuts[i];
    }
    fail_msg("no selector %s", name);
    return NULL;
}

static random_model_options options_of(uint64_t *seed)
{
    return (random_model_options){
        .leaves = 1 + random_below(seed, 200),
        .max_children = 2 + random_below(seed, 12),
        .extent = random_between(seed, 5, 300),
        .bare_clusters = random_unit(seed) * random_unit(seed),
    };
}

static void every_cut_covers_each_leaf_once(void **state)
{
    (void)state;
    uint64_t seed = 10;
    for (int round = 0; round < 80; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        for (int look = 0; look < 5; look++) {
            bench_look(&b, &seed);
            double low = bench_run(&b, "coarsest", 0)->predicted_ms;
            double high = bench_run(&b, "full", 0)->predicted_ms;
            double budget = low + (high - low) * random_between(&seed, -0.2f, 1.2f);
            for (size_t i = 0; i < prom_selector_count(); i++) {
                prom_cut *cut = bench_run(&b, prom_selector_at(i)->name, budget);
                const char *fault = prom_cut_check(&b.model, &b.view, cut);
                if (fault) fail_msg("%s: %s", prom_selector_at(i)->name, fault);
                check_validity(&b.model, &b.view, cut);
                assert_int_equal(cut->feasible, cut->predicted_ms <= budget);
                assert_true(cut->benefit >= 0.0 && cut->loss >= -1e-3 * cut->benefit);
            }
        }
        bench_finish(&b);
    }
}

static void the_check_finds_broken_cuts(void **state)
{
    (void)state;
    bench b;
    uint64_t seed = 11;
    bench_init(&b, 12, &(random_model_options){.leaves = 60, .max_children = 6, .extent = 30});
    do bench_look(&b, &seed);
    while (bench_run(&b, "full", 0)->entries.count < 5);
    prom_cut *cut = bench_run(&b, "full", 0);
    prom_cut_entry entry = cut->entries.data[cut->entries.count - 1];
    cut->entries.count--;
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    prom_array_push(&cut->entries, entry);
    assert_null(prom_cut_check(&b.model, &b.view, cut));
    prom_array_push(&cut->entries, entry);
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    cut->entries.data[cut->entries.count - 1].node = b.model.parent[entry.node];
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    cut->entries.count--;
    cut->entries.data[0].rep = b.model.rep_count;
    assert_non_null(prom_cut_check(&b.model, &b.view, cut));
    bench_finish(&b);
}

static void budgets_are_kept(void **state)
{
    (void)state;
    uint64_t seed = 20;
    uint32_t kept = 0, over = 0;
    for (int round = 0; round < 60; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        for (int look = 0; look < 6; look++) {
            bench_look(&b, &seed);
            double low = bench_run(&b, "coarsest", 0)->predicted_ms;
            double high = bench_run(&b, "full", 0)->predicted_ms;
            double budget = low + (high - low) * random_between(&seed, -0.3f, 0.8f);
            prom_cut *greedy = bench_run(&b, "greedy", budget);
            if (greedy->feasible)
                kept++;
            else
                assert_true(same_entries(greedy, bench_run(&b, "coarsest", budget)));
            assert_true(greedy->feasible || low > budget * (1.0 - 1e-8));
            assert_true(fabs(greedy->cmin_ms - low) <= 1e-9 * low);

            prom_cut *meta = bench_run(&b, "meta", budget);
            // Of all nodes in view; `coarsest` goes over fewer.
            double least = meta->cmin_ms;
            assert_true(least <= low * (1.0 + 1e-9));
            bool feasible = meta->feasible;
            double spent = meta->predicted_ms;
            over += !feasible;
            // A budget of nothing buys no improvement: that is the initial cut, the only one
            // that may be over a budget.
            double initial = bench_run(&b, "meta", 0.0)->predicted_ms;
            assert_true(initial >= least * (1.0 - 1e-9));
            assert_true(feasible || fabs(spent - initial) <= 1e-9 * initial);
            assert_true(feasible || initial > budget * (1.0 - 1e-8));
        }
        bench_finish(&b);
    }
    assert_true(kept > 100 && over > 30);
}

static void greedy_gains_with_budget(void **state)
{
    (void)state;
    uint64_t seed = 30;
    double lost = 0.0, total = 0.0;
    for (int round = 0; round < 40; round++) {
        bench b;
        random_model_options o = options_of(&seed);
        bench_init(&b, random_u64(&seed), &o);
        for (int look = 0; look < 4; look++) {
            bench_look(&b, &seed);
            prom_cut *coarsest = bench_run(&b, "coarsest", 0);
            double low = coarsest->predicted_ms, last = coarsest->benefit;
            prom_cut *full = bench_run(&b, "full", 0);
            double high = full->predicted_ms, most = full->benefit;
            for (int i = 0; i <= 24; i++) {
                double budget = low * (1.0 + 1e-6) + (high - low) * i / 20.0;
                double benefit = bench_run(&b, "greedy", budget)->benefit;
                assert_true(benefit >= last * (1.0 - 1e-6));
                last = benefit;
            }
            // With more than full detail costs, what is left closed shows less than its pixels:
            // a node of 2 px, or one that loses half a pixel.
            const prom_cut *greedy = bench_run(&b, "greedy", 1.2 * high);
            assert_true(most - greedy->benefit <= 3.2 * (double)greedy->entries.count);
            lost += most - greedy->benefit;
            total += most;
        }
        bench_finish(&b);
    }
    print_message("greedy with time enough misses %.4f %% of full detail\n",
                  100 * lost / total);
    assert_true(lost <= 0.01 * total);
}

static void equal_inputs_give_equal_cuts(void **state)
{
    (void)state;
    uint64_t seed = 40;
    for (int round = 0; round < 20; round++) {
        bench a, b;
        random_model_options o = options_of(&seed);
        uint64_t model_seed = random_u64(&seed);
        bench_init(&a, model_seed, &o);
        bench_init(&b, model_seed, &o);
        for (int look = 0; look < 6; look++) {
            uint64_t look_seed = random_u64(&seed), other = look_seed;
            bench_look(&a, &look_seed);
            bench_look(&b, &other);
            double budget = random_between(&seed, 0, 20);
            for (size_t i = 0; i < prom_selector_count(); i++) {
                const char *name = prom_selector_at(i)->name;
                assert_true(same_cut(bench_run(&a, name, budget), bench_run(&b, name, budget)));
            }
        }
        bench_finish(&a);
        bench_finish(&b);
    }
}

// A camera that trembles must not make `distance` change its mind.
static void distance_does_not_flicker(void **state)
{
    (void)state;
    uint64_t seed = 50;
    uint32_t changes = 0, moves = 0;
    for (int round = 0; round < 20; round++) {
        bench b;
        random_model_options o = {.leaves = 100, .max_children = 8, .extent = 100};
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
            if (i && cut->entries.count != first.entries.count) changes++;
            prom_array_reserve(&first.entries, cut->entries.count);
            first.entries.count = cut->entries.count;
            moves++;
        }
        prom_cut_finish(&first);
        bench_finish(&b);
    }
    // A border may be passed once, in the first move; not to and fro.
    assert_true(changes * 20 < moves);
}

static void unknown_selectors_are_refused(void **state)
{
    (void)state;
    prom_model m;
    prom_error error = {0};
    random_model(&m, 1, &(random_model_options){.leaves = 3, .max_children = 2, .extent = 9});
    assert_null(prom_selector_create("best", &m, &error));
    assert_int_equal(error.status, PROM_ERR_USAGE);
    assert_non_null(strstr(error.text, "'best'"));
    assert_non_null(strstr(error.text, "meta, greedy, distance, full, coarsest"));
    prom_model_finish(&m);
}

// ---- the optimum on small trees

typedef struct pareto {
    double cost, benefit;
} pareto;

typedef PROM_ARRAY(pareto) frontier;

static int by_cost(const void *a, const void *b)
{
    const pareto *x = a, *y = b;
    if (x->cost != y->cost) return x->cost < y->cost ? -1 : 1;
    return x->benefit > y->benefit ? -1 : x->benefit < y->benefit;
}

static void prune(frontier *f)
{
    size_t kept = 0;
    qsort(f->data, f->count, sizeof *f->data, by_cost);
    for (size_t i = 0; i < f->count; i++)
        if (!kept || f->data[i].benefit > f->data[kept - 1].benefit)
            f->data[kept++] = f->data[i];
    f->count = kept;
}

// All undominated (cost, benefit) pairs that cuts of a subtree can have: exact.
static void frontier_of(const prom_eval *eval, uint32_t node, frontier *out)
{
    const prom_model *m = eval->model;
    const prom_eval_node *n = &eval->nodes[node];
    if (n->expanded) {
        frontier sum = {0}, child = {0}, next = {0};
        prom_array_push(&sum, (pareto){0, 0});
        for (uint32_t c = 0; c < m->child_count[node]; c++) {
            uint32_t id = m->first_child[node] + c;
            if (eval->nodes[id].culled) continue;
            child.count = next.count = 0;
            frontier_of(eval, id, &child);
            for (size_t i = 0; i < sum.count; i++)
                for (size_t j = 0; j < child.count; j++)
                    prom_array_push(&next,
                                    (pareto){sum.data[i].cost + child.data[j].cost,
                                             sum.data[i].benefit + child.data[j].benefit});
            prune(&next);
            frontier swap = sum;
            sum = next;
            next = swap;
        }
        for (size_t i = 0; i < sum.count; i++) prom_array_push(out, sum.data[i]);
        prom_array_finish(&sum);
        prom_array_finish(&child);
        prom_array_finish(&next);
    }
    for (uint32_t i = 0; i < n->option_count; i++) {
        const prom_option *o = &eval->options[n->first_option + i];
        prom_array_push(out, (pareto){o->cost, o->benefit});
    }
    prune(out);
}

static void greedy_comes_near_the_optimum(void **state)
{
    (void)state;
    uint64_t seed = 60;
    double gaps = 0.0, meta_gaps = 0.0, worst = 0.0;
    uint32_t count = 0;
    for (int round = 0; round < 120; round++) {
        bench b;
        random_model_options o = {.leaves = 6 + random_below(&seed, 6),
                                  .max_children = 4,
                                  .extent = 30,
                                  .bare_clusters = 0.2f};
        bench_init(&b, random_u64(&seed), &o);
        bench_look(&b, &seed);
        double low = bench_run(&b, "coarsest", 0)->predicted_ms;
        double base = bench_run(&b, "coarsest", 0)->benefit;
        double high = bench_run(&b, "full", 0)->predicted_ms;
        prom_eval eval;
        prom_eval_init(&eval, &b.model);
        // What greedy goes over, with time in plenty and without. (A node that it does not go
        // below keeps pixels that may turn out to be outside the frustum, so neither tree's
        // optimum is above the other's.)
        frontier all = {0};
        for (int closer = 0; closer < 2; closer++) {
            eval.tolerance = closer ? 0.0625f : 1.0f;
            prom_eval_run(&eval, &b.selection, prom_eval_open_visible, &eval);
            if (!eval.nodes[0].culled) frontier_of(&eval, 0, &all);
        }
        for (int i = 1; i < 8 && all.count; i++) {
            double budget = (low + (high - low) * i / 8.0) * (1.0 + 1e-6), best = 0.0;
            for (size_t k = 0; k < all.count; k++)
                if (eval.fixed_ms + all.data[k].cost <= budget) best = all.data[k].benefit;
            double greedy = bench_run(&b, "greedy", budget)->benefit;
            assert_true(greedy <= best * (1.0 + 1e-6) + 1e-6);
            if (best - base < 1e-3 * best) continue;
            double gap = (best - greedy) / (best - base);
            gaps += gap;
            worst = fmax(worst, gap);
            prom_cut *meta = bench_run(&b, "meta", budget);
            meta_gaps +=
                meta->feasible ? fmax((best - meta->benefit) / (best - base), 0.0) : 1.0;
            count++;
        }
        prom_array_finish(&all);
        prom_eval_finish(&eval);
        bench_finish(&b);
    }
    print_message("gap to the exact optimum over %u cases: greedy %.2f %% mean, %.1f %% worst; "
                  "meta %.1f %% mean\n",
                  count, 100 * gaps / count, 100 * worst, 100 * meta_gaps / count);
    assert_true(count > 200);
    assert_true(gaps / count < 0.25);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(culling_is_conservative),
        cmocka_unit_test(appearance_is_in_range),
        cmocka_unit_test(in_view_of_a_half_visible_box),
        cmocka_unit_test(pixels_flow_without_loss),
        cmocka_unit_test(pixels_of_solid_boxes),
        cmocka_unit_test(every_cut_covers_each_leaf_once),
        cmocka_unit_test(the_check_finds_broken_cuts),
        cmocka_unit_test(budgets_are_kept),
        cmocka_unit_test(greedy_gains_with_budget),
        cmocka_unit_test(equal_inputs_give_equal_cuts),
        cmocka_unit_test(distance_does_not_flicker),
        cmocka_unit_test(unknown_selectors_are_refused),
        cmocka_unit_test(greedy_comes_near_the_optimum),
    };
    return cmocka_run_group_tests_name("traverse", tests, NULL, NULL);
}
