// LINK: prom_traverse prom_benefit prom_metaobj
// Culling, how nodes appear, and the pixels that an evaluation gives them.
#include "random_model.h"
#include "traverse/evaluate.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(culling_is_conservative),
        cmocka_unit_test(appearance_is_in_range),
        cmocka_unit_test(in_view_of_a_half_visible_box),
        cmocka_unit_test(pixels_flow_without_loss),
        cmocka_unit_test(pixels_of_solid_boxes),
    };
    return cmocka_run_group_tests_name("view", tests, NULL, NULL);
}
