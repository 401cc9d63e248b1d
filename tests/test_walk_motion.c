// LINK: prom_scenes prom_metaobj
//
// The walker's motion without a window: speed, directions, bounds, the way home, a model's
// size, paths in real time, and the title.
#include "app/walk_motion.c"
#include "app/walk_path.c"
#include "app/walk_size.c"
#include "app/walk_title.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#define SIZE 40.0 // a walk of 1 unit a second
#define NEAR(a, b, most) assert_true(fabs((double)(a) - (double)(b)) <= (most))

static prom_walk_motion motion;
static prom_camera camera;

static void start_at(const double eye[3], const double target[3])
{
    camera = (prom_camera){.orientation = {0, 0, 0, 1}, .width = 16, .height = 9};
    memcpy(camera.eye, eye, sizeof camera.eye);
    prom_camera_look_at(&camera, target);
    prom_walk_init(&motion, &camera, SIZE);
}

static void start_plain(void)
{
    start_at((double[]){1, 2, 3}, (double[]){1, 2, -7}); // along -z
}

static void walk_for(const prom_walk_input *input, double seconds, double dt)
{
    for (double t = 0; t < seconds - dt / 2; t += dt) prom_walk_step(&motion, input, dt);
}

static double way_from(double x, double y, double z)
{
    return sqrt((motion.eye[0] - x) * (motion.eye[0] - x) +
                (motion.eye[1] - y) * (motion.eye[1] - y) +
                (motion.eye[2] - z) * (motion.eye[2] - z));
}

static void forward_vector(const prom_camera *c, vec3 forward)
{
    versor q;
    memcpy(q, c->orientation, sizeof q);
    glm_quat_rotatev(q, (vec3){0, 0, -1}, forward);
}

static void keys_lead_where_they_say(void **state)
{
    (void)state;
    const struct {
        prom_walk_input input;
        double way[3];
    } cases[] = {
        {{.forward = 1}, {0, 0, -1}}, {{.forward = -1}, {0, 0, 1}}, {{.right = 1}, {1, 0, 0}},
        {{.right = -1}, {-1, 0, 0}},  {{.up = 1}, {0, 1, 0}},       {{.up = -1}, {0, -1, 0}},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        start_plain();
        walk_for(&cases[i].input, 1, 0.02);
        for (int k = 0; k < 3; k++) NEAR(motion.eye[k], camera.eye[k] + cases[i].way[k], 1e-9);
    }
}

static void the_speed_is_the_same_at_any_frame_rate(void **state)
{
    (void)state;
    for (double dt = 0.001; dt < 0.1; dt *= 2) {
        start_plain();
        prom_walk_input input = {.forward = 1};
        walk_for(&input, 2, dt);
        NEAR(way_from(1, 2, 3), 2, dt + 1e-9);
        double slow = way_from(1, 2, 3);
        start_plain();
        input.fast = true;
        walk_for(&input, 2, dt);
        NEAR(way_from(1, 2, 3), FAST * slow, 1e-9);
    }
}

static void a_diagonal_is_no_faster(void **state)
{
    (void)state;
    for (int f = -1; f <= 1; f++)
        for (int r = -1; r <= 1; r++)
            for (int u = -1; u <= 1; u++) {
                start_at((double[]){5, 5, 5}, (double[]){8, 4, 1});
                prom_walk_input input = {.forward = f, .right = r, .up = u};
                prom_walk_step(&motion, &input, 0.05);
                NEAR(way_from(5, 5, 5), f || r || u ? 0.05 : 0, 1e-12);
            }
}

static void walking_keeps_the_height_and_follows_the_heading(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++) {
        double angle = i * 0.7;
        start_at((double[]){0, 9, 0}, (double[]){sin(angle), 9 - 0.1 * (i % 20), cos(angle)});
        prom_walk_step(&motion, &(prom_walk_input){.forward = 1}, 0.1);
        NEAR(motion.eye[1], 9, 0);
        NEAR(motion.eye[0], 0.1 * sin(angle), 1e-6);
        NEAR(motion.eye[2], 0.1 * cos(angle), 1e-6);
    }
}

static void the_pose_taken_is_the_pose_given(void **state)
{
    (void)state;
    srand(5);
    for (int i = 0; i < 1000; i++) {
        double target[3];
        for (int k = 0; k < 3; k++) target[k] = rand() / (double)RAND_MAX - 0.5;
        target[1] *= 0.8;
        start_at((double[]){0, 0, 0}, target);
        if (fabs(motion.pitch) >= PROM_WALK_PITCH_MAX) continue;
        prom_camera now = camera;
        prom_walk_camera(&motion, &now);
        double dot = 0;
        for (int k = 0; k < 4; k++) dot += (double)(now.orientation[k] * camera.orientation[k]);
        NEAR(fabs(dot), 1, 1e-5);
    }
}

static void straight_down_the_heading_is_the_top_of_the_picture(void **state)
{
    (void)state;
    for (int sign = -1; sign <= 1; sign += 2) {
        // Tilted by a right angle about +x, turned to the left by half a right angle.
        versor turn, tilt, q;
        glm_quatv(turn, (float)M_PI_4, (vec3){0, 1, 0});
        glm_quatv(tilt, (float)(sign * M_PI_2), (vec3){1, 0, 0});
        glm_quat_mul(turn, tilt, q);
        camera = (prom_camera){0};
        memcpy(camera.orientation, q, sizeof q);
        prom_walk_init(&motion, &camera, SIZE);
        NEAR(motion.yaw, M_PI_4, 1e-3);
        NEAR(motion.pitch, sign * PROM_WALK_PITCH_MAX, 1e-9);
    }
}

static void the_mouse_turns_and_returns(void **state)
{
    (void)state;
    start_plain();
    prom_walk_step(&motion, &(prom_walk_input){.look_px = {100, 40}}, 0.01);
    prom_walk_camera(&motion, &camera);
    vec3 forward;
    forward_vector(&camera, forward);
    assert_true(forward[0] > 0.1f && forward[1] < -0.05f); // right and down
    // Back in many small steps, whatever the time between them: no drift.
    for (int i = 0; i < 100000; i++)
        prom_walk_step(&motion, &(prom_walk_input){.look_px = {-0.001, -0.0004}},
                       0.001 * (i % 50));
    NEAR(motion.yaw, 0, 1e-6);
    NEAR(motion.pitch, 0, 1e-6);
    NEAR(way_from(1, 2, 3), 0, 0);
}

static void nothing_asked_is_nothing_done(void **state)
{
    (void)state;
    start_at((double[]){1e6, 2, -3e6}, (double[]){1e6 + 3, 1, -3e6});
    prom_walk_motion before = motion;
    for (int i = 0; i < 1000; i++) prom_walk_step(&motion, &(prom_walk_input){0}, 0.05);
    assert_memory_equal(&motion, &before, sizeof motion);
    assert_false(prom_walk_input_moves(&(prom_walk_input){.fast = true}));
    assert_true(prom_walk_input_moves(&(prom_walk_input){.turn = -1}));
}

static void the_pitch_ends_short_of_the_zenith(void **state)
{
    (void)state;
    start_plain();
    for (int i = 0; i < 50; i++)
        prom_walk_step(&motion, &(prom_walk_input){.look_px = {0, -500}}, 0.02);
    NEAR(motion.pitch, PROM_WALK_PITCH_MAX, 0);
    prom_walk_step(&motion, &(prom_walk_input){.look_px = {0, 1e9}}, 0.02);
    NEAR(motion.pitch, -PROM_WALK_PITCH_MAX, 0);
    assert_true(PROM_WALK_PITCH_MAX < M_PI_2);
    // And the heading is still there.
    prom_walk_step(&motion, &(prom_walk_input){.forward = 1}, 0.1);
    NEAR(motion.eye[2], 3 - 0.1, 1e-9);
}

static void keys_turn_too(void **state)
{
    (void)state;
    start_plain();
    walk_for(&(prom_walk_input){.turn = 1, .tilt = 1}, 0.5, 0.01);
    NEAR(motion.yaw, -0.5 * TURN_PER_S, 1e-9);
    NEAR(motion.pitch, 0.5 * TURN_PER_S, 1e-9);
    walk_for(&(prom_walk_input){.turn = 1}, 60, 0.05);
    assert_true(fabs(motion.yaw) <= M_PI);
}

static void a_stall_is_no_leap(void **state)
{
    (void)state;
    const double stalls[] = {0.5, 60, 1e300, INFINITY};
    for (int i = 0; i < 4; i++) {
        start_plain();
        prom_walk_step(&motion, &(prom_walk_input){.forward = 1}, stalls[i]);
        NEAR(way_from(1, 2, 3), PROM_WALK_STEP_MAX_S, 1e-12);
    }
    const double nothing[] = {0, -1, NAN, -INFINITY};
    for (int i = 0; i < 4; i++) {
        start_plain();
        prom_walk_step(&motion, &(prom_walk_input){.forward = 1, .turn = 1}, nothing[i]);
        NEAR(way_from(1, 2, 3), 0, 0);
        NEAR(motion.yaw, 0, 1e-12);
    }
}

static void the_wheel_changes_the_speed_within_bounds(void **state)
{
    (void)state;
    start_plain();
    NEAR(motion.speed, 1, 1e-12);
    prom_walk_step(&motion, &(prom_walk_input){.scroll = 2}, 0.01);
    NEAR(motion.speed, SPEED_PER_NOTCH * SPEED_PER_NOTCH, 1e-12);
    prom_walk_step(&motion, &(prom_walk_input){.scroll = -2}, 0.01);
    NEAR(motion.speed, 1, 1e-12);
    for (int i = 0; i < 100; i++)
        prom_walk_step(&motion, &(prom_walk_input){.scroll = 1e6}, 0.01);
    NEAR(motion.speed, SPEED_RANGE, 1e-9);
    for (int i = 0; i < 100; i++)
        prom_walk_step(&motion, &(prom_walk_input){.scroll = -1e6}, 0.01);
    NEAR(motion.speed, 1 / SPEED_RANGE, 1e-9);
}

static void home_is_where_the_walk_began(void **state)
{
    (void)state;
    start_at((double[]){7, 8, 9}, (double[]){1, 5, 2});
    prom_walk_motion begun = motion;
    walk_for(&(prom_walk_input){.forward = 1, .up = 1, .turn = -1, .scroll = 1}, 3, 0.05);
    assert_true(way_from(7, 8, 9) > 1);
    prom_walk_step(&motion, &(prom_walk_input){.home = true}, 0.05);
    assert_memory_equal(&motion, &begun, sizeof motion);
}

// ---- the model's size

static double size_of_row(uint32_t leaves, double spacing, double far_away)
{
    // A root, then a row of leaves; the last stands far away.
    double center[64][3] = {{0}};
    uint32_t first_child[64];
    float radius[64] = {1};
    first_child[0] = leaves ? 1 : PROM_NONE;
    for (uint32_t i = 1; i <= leaves; i++) {
        first_child[i] = PROM_NONE;
        center[i][0] = 1e5 + spacing * i;
    }
    if (leaves) center[leaves][0] += far_away;
    prom_model model = {.tree_count = leaves + 1, .node_count = leaves + 1};
    model.first_child = first_child;
    model.center = center;
    model.radius = radius;
    return prom_walk_size(&model);
}

static void the_size_is_that_of_where_things_stand(void **state)
{
    (void)state;
    double near = size_of_row(40, 1, 0);
    assert_true(near > 20 && near < 60);
    NEAR(size_of_row(40, 1, 1e7), near, 1e-9); // a far mountain changes nothing
    NEAR(size_of_row(40, 100, 0), 100 * near, 1e-6);
    NEAR(size_of_row(0, 1, 0), 2, 0); // a single object: its sphere
    NEAR(size_of_row(40, 0, 0), 2, 0);
}

// ---- paths

static void a_path_is_walked_between_its_keys(void **state)
{
    (void)state;
    prom_path path = {0};
    for (int i = 0; i < 5; i++)
        prom_path_add(&path, (double[]){i, 0, 2 * i},
                      (double[]){sin(0.1 * i), 0, cos(0.1 * i)});
    for (size_t i = 1; i < 5; i += 2) // the same direction, written the other way
        for (int k = 0; k < 4; k++) path.keys.data[i].orientation[k] *= -1;
    prom_camera at = {0};
    for (double t = 0; t < 4; t += 0.125) {
        prom_walk_path_pose(&path, t, &at);
        NEAR(at.eye[0], t, 1e-12);
        NEAR(at.eye[2], 2 * t, 1e-12);
        vec3 forward;
        forward_vector(&at, forward);
        NEAR(forward[0], sin(0.1 * t), 1e-4);
        NEAR(glm_vec4_norm(at.orientation), 1, 1e-6);
    }
    // To and fro past the end, as frames are.
    prom_walk_path_pose(&path, 4.5, &at);
    NEAR(at.eye[0], 3.5, 1e-12);
    prom_walk_path_pose(&path, 8 + 2.25, &at);
    NEAR(at.eye[0], 2.25, 1e-12);
    NEAR(prom_walk_path_keys(&path, 2), 2 * PROM_PATH_RATE, 1e-9);
    prom_path_finish(&path);
}

static void a_path_of_one_place_is_a_place(void **state)
{
    (void)state;
    prom_path path = {0};
    prom_path_add(&path, (double[]){1, 2, 3}, (double[]){1, 0, 0});
    prom_camera at = {0};
    const double times[] = {0, 0.3, 1, 1e6 + 0.5};
    for (int i = 0; i < 4; i++) {
        prom_walk_path_pose(&path, times[i], &at);
        NEAR(at.eye[2], 3, 0);
        NEAR(glm_vec4_norm(at.orientation), 1, 1e-6);
    }
    assert_true(isfinite(prom_walk_path_keys(&path, 1)));
    prom_path_finish(&path);
}

// ---- the title

static void the_title_tells_the_last_quarter_of_a_second(void **state)
{
    (void)state;
    prom_walk_title title = {0};
    prom_walk_title_facts facts = {.name = "a.prom", .selector = "greedy", .budget_ms = 33};
    char text[PROM_WALK_TITLE_BYTES] = "";
    assert_false(prom_walk_title_due(&title, &facts, 1000, text));
    prom_walk_title_add(&title, 40, 20000, true);
    prom_walk_title_add(&title, 20, 12345678, false);
    assert_true(prom_walk_title_due(&title, &facts, 1000, text));
    assert_string_equal(text,
                        "a.prom | 30.0 of 33 ms | misses 1 of 2 (50.0 %) | greedy | 12.3 M "
                        "triangles | click to look around");
    prom_walk_title_add(&title, 10, 999, false);
    assert_false(prom_walk_title_due(&title, &facts, 1100, text));
    facts.captured = true;
    assert_true(prom_walk_title_due(&title, &facts, 1300, text));
    assert_string_equal(
        text, "a.prom | 10.0 of 33 ms | misses 1 of 3 (33.3 %) | greedy | 999 triangles");
    // At rest no frame comes, and that is said once.
    facts.at_rest = true;
    assert_true(prom_walk_title_due(&title, &facts, 1600, text));
    assert_non_null(strstr(text, "10.0 of 33 ms, at rest"));
    assert_false(prom_walk_title_due(&title, &facts, 9000, text));
}

static void a_long_name_is_cut(void **state)
{
    (void)state;
    char name[1000], text[PROM_WALK_TITLE_BYTES];
    memset(name, 'x', sizeof name);
    name[sizeof name - 1] = 0;
    prom_walk_title title = {0};
    prom_walk_title_facts facts = {.name = name, .selector = "greedy", .budget_ms = 33};
    prom_walk_title_add(&title, 1, 1, false);
    assert_true(prom_walk_title_due(&title, &facts, 1000, text));
    assert_non_null(strstr(text, "33 ms"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(keys_lead_where_they_say),
        cmocka_unit_test(the_speed_is_the_same_at_any_frame_rate),
        cmocka_unit_test(a_diagonal_is_no_faster),
        cmocka_unit_test(walking_keeps_the_height_and_follows_the_heading),
        cmocka_unit_test(the_pose_taken_is_the_pose_given),
        cmocka_unit_test(straight_down_the_heading_is_the_top_of_the_picture),
        cmocka_unit_test(the_mouse_turns_and_returns),
        cmocka_unit_test(nothing_asked_is_nothing_done),
        cmocka_unit_test(the_pitch_ends_short_of_the_zenith),
        cmocka_unit_test(keys_turn_too),
        cmocka_unit_test(a_stall_is_no_leap),
        cmocka_unit_test(the_wheel_changes_the_speed_within_bounds),
        cmocka_unit_test(home_is_where_the_walk_began),
        cmocka_unit_test(the_size_is_that_of_where_things_stand),
        cmocka_unit_test(a_path_is_walked_between_its_keys),
        cmocka_unit_test(a_path_of_one_place_is_a_place),
        cmocka_unit_test(the_title_tells_the_last_quarter_of_a_second),
        cmocka_unit_test(a_long_name_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
