// LINK: prom_app prom_render prom_traverse prom_benefit prom_metaobj
// NEEDS: promenade
//
// Popping, on a field of striped balls: a camera at rest or in motion makes none, a ball that
// is drawn in another way makes some, where it stands. Warping, on depths made by hand.
#include "app/popping.c"
#include "app/warp.c"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>

#include <cmocka.h>

#include "tests/run_program.h"

#define WIDTH 240
#define HEIGHT 136
#define PIXELS (WIDTH * HEIGHT)

// ---- warping alone

// A plane that a camera at (x, 0, 0), turned about +y, looks at: z = -4 + slope * x.
static void draw_plane(const prom_camera *camera, double slope, float *depth)
{
    pinhole p;
    pinhole_init(&p, camera);
    for (uint32_t y = 0, i = 0; y < camera->height; y++)
        for (uint32_t x = 0; x < camera->width; x++, i++) {
            double d[3];
            direction_of(&p, x, y, d);
            double inverse = (slope * d[0] - d[2]) / (4 - slope * camera->eye[0]);
            depth[i] = (float)fmax(inverse * p.near, 0);
        }
}

static prom_camera camera_at(double x, double turn)
{
    return (prom_camera){.eye = {x, 0, 0},
                         .orientation = {0, (float)sin(turn / 2), 0, (float)cos(turn / 2)},
                         .fov_y = 1,
                         .z_near = 0.1f,
                         .width = WIDTH,
                         .height = HEIGHT};
}

typedef struct planes {
    float before[PIXELS], now[PIXELS], from[PIXELS][2];
    size_t found;
} planes;

static planes *warp_planes(const prom_camera *before, const prom_camera *now, double slope)
{
    static planes p;
    draw_plane(before, slope, p.before);
    draw_plane(now, slope, p.now);
    p.found = prom_warp_find(&(prom_warp_view){*before, p.before},
                             &(prom_warp_view){*now, p.now}, p.from);
    return &p;
}

static void nothing_moves_at_rest(void **state)
{
    (void)state;
    prom_camera camera = camera_at(0.3, 0.2);
    planes *p = warp_planes(&camera, &camera, 0.5);
    assert_int_equal(p->found, PIXELS);
    for (size_t i = 0; i < PIXELS; i++) {
        assert_true(fabs((double)p->from[i][0] - (double)(i % WIDTH)) < 1e-4);
        assert_true(fabs((double)p->from[i][1] - (double)(i / WIDTH)) < 1e-4);
    }
}

// A step to the right moves a wall at a distance of 4 to the left by focal * step / 4; what
// comes in at the border has no place.
static void a_step_moves_by_its_parallax(void **state)
{
    (void)state;
    prom_camera before = camera_at(0, 0), now = camera_at(0.25, 0);
    double moved = 0.5 * HEIGHT / tan(0.5) * 0.25 / 4;
    planes *p = warp_planes(&before, &now, 0);
    assert_int_equal(p->found, HEIGHT * (WIDTH - (size_t)ceil(moved)));
    for (size_t i = 0; i < PIXELS; i++) {
        double x = (double)(i % WIDTH) + moved;
        if (x > WIDTH - 1) {
            assert_true(isnan(p->from[i][0]));
            continue;
        }
        assert_true(fabs((double)p->from[i][0] - x) < 1e-3);
        assert_true(fabs((double)p->from[i][1] - (double)(i / WIDTH)) < 1e-3);
    }
}

// Where the ray of a pixel, which may be between pixels, meets the plane; x only.
static double meet_plane(const prom_camera *camera, double x, double y, double slope)
{
    pinhole p;
    double d[3];
    pinhole_init(&p, camera);
    direction_of(&p, x, y, d);
    return camera->eye[0] + d[0] * (4 - slope * camera->eye[0]) / (slope * d[0] - d[2]);
}

// Depths between pixels are exact on a slanted plane, so that all that stays in view is found,
// and is the same point.
static void a_slanted_plane_is_found_whole(void **state)
{
    (void)state;
    prom_camera before = camera_at(-0.4, 0.05), now = camera_at(0.4, -0.05);
    const double slope = 0.6;
    planes *p = warp_planes(&before, &now, slope);
    size_t found = 0;
    for (size_t i = 0; i < PIXELS; i++) {
        double x = meet_plane(&now, (double)(i % WIDTH), (double)(i / WIDTH), slope);
        if (isnan(p->from[i][0])) continue;
        found++;
        double u = (double)p->from[i][0], v = (double)p->from[i][1];
        assert_true(fabs(meet_plane(&before, u, v, slope) - x) < 1e-4);
    }
    assert_true(found == p->found && found > PIXELS / 2);
    // Full rows: nothing is missing between the first and the last that is found.
    for (size_t y = HEIGHT / 2, x = 1; x + 1 < WIDTH; x++)
        assert_false(isnan(p->from[y * WIDTH + x][0]) &&
                     !isnan(p->from[y * WIDTH + x - 1][0]) &&
                     !isnan(p->from[y * WIDTH + x + 1][0]));
}

// A post before a wall: what it hid has no place, and what it hides now is not looked for.
static void what_was_hidden_has_no_place(void **state)
{
    (void)state;
    prom_camera before = camera_at(0, 0), now = camera_at(0.25, 0);
    planes *p = warp_planes(&before, &now, 0);
    const float near = 0.1f / 1; // the post stands at a distance of 1
    int post[2] = {100, 120}, moved = (int)(0.5 * HEIGHT / tan(0.5) * 0.25);
    for (size_t i = 0; i < PIXELS; i++) {
        int x = (int)(i % WIDTH);
        if (x >= post[0] && x < post[1]) p->before[i] = near;
        if (x >= post[0] - moved && x < post[1] - moved) p->now[i] = near;
    }
    prom_warp_find(&(prom_warp_view){before, p->before}, &(prom_warp_view){now, p->now},
                   p->from);
    int wall = moved / 4; // how far the wall moves
    for (size_t i = 0; i < PIXELS; i++) {
        int x = (int)(i % WIDTH);
        if (x > post[0] - wall && x < post[1] - wall - 1) // was behind the post
            assert_true(isnan(p->from[i][0]));
        if (x > post[0] - moved && x < post[1] - moved - 2) // the post itself
            assert_true(fabs((double)p->from[i][0] - x - moved) < 1);
    }
}

static void places_without_one_show_the_picture_now(void **state)
{
    (void)state;
    static const uint8_t before[] = {0, 0, 0, 255, 255, 255, 255, 255},
                         now[] = {10, 20, 30, 255, 40, 50, 60, 255};
    const float from[2][2] = {{0.5f, 0}, {NAN, NAN}};
    float warped[2][3];
    prom_warp_apply(from, 2, 1, before, now, warped);
    for (int c = 0; c < 3; c++) {
        assert_true(fabsf(warped[0][c] - 0.5f) < 1e-6f); // of the light, not of the bytes
        assert_true(warped[1][c] == prom_srgb8_to_linear(now[4 + c]));
    }
}

// ---- a model

typedef struct scene {
    prom_session session;
    prom_popping popping;
    prom_cut full; // of `now`
    prom_camera before, now;
} scene;

static scene *field; // NULL: no device

// Balls of 24 x 12 quads, with stripes in their vertices' colours, in rows on the ground.
static void write_balls(const char *path)
{
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    for (int ball = 0, base = 1; ball < 16; ball++, base += 25 * 13) {
        fprintf(f, "o ball_%d\n", ball);
        for (int i = 0; i < 25 * 13; i++) {
            double a = i % 25 * M_PI / 12, b = i / 25 * M_PI / 12;
            double light = (i / 25 + i % 25) % 3 ? 0.9 : 0.2 + 0.04 * ball;
            fprintf(f, "v %g %g %g %g %g %g\n", ball % 4 * 4.0 + cos(a) * sin(b), 1 + cos(b),
                    -(ball / 4) * 4.0 - sin(a) * sin(b), light, 0.5, 1 - light);
        }
        for (int i = 0; i < 24 * 12; i++) {
            int v = base + i / 24 * 25 + i % 24;
            fprintf(f, "f %d %d %d %d\n", v, v + 25, v + 26, v + 1);
        }
    }
    fclose(f);
}

static prom_camera camera_over_field(double x)
{
    prom_camera camera = {
        .eye = {x, 4, 7}, .fov_y = 1, .z_near = 0.05f, .width = WIDTH, .height = HEIGHT};
    prom_camera_look_at(&camera, (double[3]){6, 1, -5});
    return camera;
}

static prom_status open_session(prom_session *s, prom_error *error)
{
    s->context = prom_context_create_headless(error);
    if (!s->context) return error->status;
    s->container = prom_container_open("balls.prom", error);
    if (!s->container) return error->status;
    prom_status status = prom_container_load_model(s->container, &s->model, error);
    if (!status) s->renderer = prom_renderer_create(s->context, error);
    if (!s->renderer) return error->status;
    s->list = prom_draw_list_create(s->renderer);
    s->camera = camera_over_field(6);
    return prom_renderer_load(s->renderer, s->container, &s->model, error);
}

static void close_session(prom_session *s)
{
    if (s->list) prom_draw_list_destroy(s->list);
    if (s->renderer) prom_renderer_destroy(s->renderer);
    prom_context_destroy(s->context);
    prom_model_finish(&s->model);
    prom_container_close(s->container);
}

static void select_by(const char *name, prom_session *s, const prom_camera *camera,
                      prom_cut *cut)
{
    prom_view view;
    prom_view_init(&view, camera);
    prom_selector *selector = prom_selector_create(name, &s->model, NULL);
    const prom_selection selection = {.view = &view, .cost = &s->cost, .budget_ms = INFINITY};
    prom_selector_run(selector, &selection, cut);
    prom_selector_destroy(selector);
}

static int teardown(void **state)
{
    (void)state;
    if (!field) return 0;
    prom_popping_finish(&field->popping);
    prom_cut_finish(&field->full);
    close_session(&field->session);
    free(field);
    field = NULL;
    return 0;
}

static int setup(void **state)
{
    program_run run;
    prom_error error = {0};
    write_balls("balls.obj");
    run_program(&run, "build balls.obj -o balls.prom --force --quiet --metric rmse");
    if (run.code == 3) { // no device
        print_message("%s\n", run.err);
        return 0;
    }
    if (run.code) fail_msg("%s", run.err);
    field = calloc(1, sizeof *field);
    if (open_session(&field->session, &error) ||
        prom_popping_init(&field->popping, &field->session, 67, &error)) {
        print_error("%s\n", error.text);
        teardown(state);
        return 1;
    }
    field->before = camera_over_field(6);
    field->now = camera_over_field(6.12);
    select_by("full", &field->session, &field->now, &field->full);
    assert_true(field->full.entries.count > 8);
    return 0;
}

#define NEED_FIELD()                                                                           \
    (void)state;                                                                               \
    if (!field) skip()

static prom_popped look_at(const prom_cut *before, const prom_camera *camera_before,
                           const prom_cut *cut, const prom_camera *camera)
{
    return prom_popping_look(&field->popping, &field->session, before, camera_before, cut,
                             camera);
}

static void the_same_picture_pops_not(void **state)
{
    NEED_FIELD();
    prom_cut coarse = {0};
    select_by("coarsest", &field->session, &field->now, &coarse);
    prom_popped full = look_at(&field->full, &field->now, &field->full, &field->now);
    prom_popped cut = look_at(&coarse, &field->now, &coarse, &field->now);
    assert_true(full.valid_share == 1 && cut.valid_share == 1);
    assert_true(full.flip < 1e-4 && full.floor < 1e-4);
    assert_true(cut.flip < 1e-4 && cut.floor < 1e-4);
    prom_cut_finish(&coarse);
}

// Full detail pops as much as full detail; warping is worth its while, and its floor small.
static void motion_alone_is_the_floor(void **state)
{
    NEED_FIELD();
    prom_popped moved = look_at(&field->full, &field->before, &field->full, &field->now);
    assert_true(moved.flip == moved.floor);
    assert_true(moved.floor > 0);
    assert_true(moved.valid_share > 0.8 && moved.valid_share < 1);

    // Without the warping, the same two pictures differ by several times as much.
    prom_popping *p = &field->popping;
    for (size_t i = 0; i < PIXELS; i++)
        p->from[i][0] = (float)(i % WIDTH), p->from[i][1] = (float)(i / WIDTH);
    double still = error_of(p, &field->now, p->before.full, p->now.full, PIXELS);
    assert_true(still > 3 * moved.floor);
}

// The roughest representation of a node.
static uint32_t roughest_of(const prom_model *m, uint32_t node)
{
    const prom_prototype *p = &m->prototypes[m->prototype[node]];
    uint32_t roughest = p->first_rep;
    for (uint32_t rep = p->first_rep; rep < p->first_rep + p->rep_count; rep++)
        if (m->reps[rep].error > m->reps[roughest].error) roughest = rep;
    return roughest;
}

// Centre and radius of a node in the picture.
static void circle_of(const prom_camera *camera, const prom_model *m, uint32_t node,
                      double circle[3])
{
    pinhole p;
    pinhole_init(&p, camera);
    double d[3], inverse = 0;
    for (int i = 0; i < 3; i++) d[i] = m->center[node][i] - camera->eye[i];
    assert_true(project(&p, d, 1, circle, &inverse));
    circle[2] = p.focal * (double)m->radius[node] * inverse;
}

static void a_switch_pops_where_it_is(void **state)
{
    NEED_FIELD();
    static float calm[PIXELS];
    prom_popped moved = look_at(&field->full, &field->before, &field->full, &field->now);
    memcpy(calm, field->popping.errors, sizeof calm);

    prom_cut switched = {0};
    select_by("full", &field->session, &field->now, &switched);
    prom_cut_entry *entry = &switched.entries.data[switched.entries.count / 2];
    uint32_t rep = roughest_of(&field->session.model, entry->node);
    assert_int_not_equal(entry->rep, rep);
    entry->rep = rep;
    prom_popped popped = look_at(&field->full, &field->before, &switched, &field->now);
    assert_true(popped.floor == moved.floor && popped.valid_share == moved.valid_share);
    assert_true(popped.flip > 1.1 * popped.floor);

    double circle[3] = {0}, inside = 0, all = 0;
    circle_of(&field->now, &field->session.model, entry->node, circle);
    double reach = circle[2] + prom_metric_radius(field->popping.metric);
    for (size_t i = 0; i < PIXELS; i++) {
        double more = fabs((double)field->popping.errors[i] - (double)calm[i]);
        double x = (double)(i % WIDTH) - circle[0], y = (double)(i / WIDTH) - circle[1];
        all += more;
        if (hypot(x, y) <= reach) inside += more;
    }
    assert_true(all > 0 && inside > 0.99 * all);
    prom_cut_finish(&switched);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nothing_moves_at_rest),
        cmocka_unit_test(a_step_moves_by_its_parallax),
        cmocka_unit_test(a_slanted_plane_is_found_whole),
        cmocka_unit_test(what_was_hidden_has_no_place),
        cmocka_unit_test(places_without_one_show_the_picture_now),
        cmocka_unit_test(the_same_picture_pops_not),
        cmocka_unit_test(motion_alone_is_the_floor),
        cmocka_unit_test(a_switch_pops_where_it_is),
    };
    enter_scratch();
    int failed = cmocka_run_group_tests(tests, setup, teardown);
    leave_scratch();
    return failed;
}
