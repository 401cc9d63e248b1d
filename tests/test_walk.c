// LINK: prom_builder prom_scenes prom_traverse prom_metaobj
// NEEDS: promenade
//
// The window of `promenade walk`, on an X server of its own (Xvfb) with keys and mouse from
// xdotool. Skips where these or GL are missing.
#include "tests/scene_files.h"
#include "tests/x_server.h"

#include "builder/image_io.h"
#include "metaobj/base/clock.h"
#include "scenes/path.h"
#include "traverse/cost.h"

#include <cglm/cglm.h>

#include <math.h>
#include <sys/stat.h>
#include <time.h>

#include <cmocka.h>

#define PATIENCE_S 60 // the sanitizers on a busy machine are slow
#define WIDTH 320
#define HEIGHT 180
#define VIEW " --profile p.json --resolution 320,180 --path scene.path --quiet"

static program_run run;
static const char *missing; // why the tests skip
static pid_t walker;        // 0: not running
static prom_path path;

#define NEED_WINDOW()                                                                          \
    if (missing) skip()

// ---- programs

static void nap(unsigned ms)
{
    const struct timespec time = {ms / 1000, (long)(ms % 1000) * 1000000};
    nanosleep(&time, NULL);
}

static void expect(const char *arguments, int code)
{
    run_program(&run, arguments);
    if (run.code != code) fprintf(stderr, "promenade %s: %s\n", arguments, run.err);
    assert_int_equal(run.code, code);
}

// ---- the walker

static void start_walk(const char *arguments)
{
    char text[512], *argv[32];
    int argc = 0;
    snprintf(text, sizeof text, "walk scene.prom" VIEW " %s", arguments);
    argv[argc++] = getenv("PROM_PROGRAM");
    for (char *word = strtok(text, " "); word && argc < 31; word = strtok(NULL, " "))
        argv[argc++] = word;
    argv[argc] = NULL;
    fflush(NULL);
    walker = fork();
    if (walker == 0) {
        redirect(1, "walk.out");
        redirect(2, "walk.err");
        execv(argv[0], argv);
        _exit(127);
    }
}

static bool has_ended(void)
{
    int status = 0;
    if (walker && waitpid(walker, &status, WNOHANG) != walker) return false;
    if (walker) run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    walker = 0;
    return true;
}

static void fail_walk(const char *why)
{
    slurp("walk.err", run.err, sizeof run.err);
    stop(&walker);
    fail_msg("%s: %s", why, run.err);
}

static void wait_for_end(void)
{
    double start = prom_clock_ms();
    while (!has_ended()) {
        if (prom_clock_ms() - start > PATIENCE_S * 1000) fail_walk("walk does not end");
        nap(20);
    }
    slurp("walk.out", run.out, sizeof run.out);
    slurp("walk.err", run.err, sizeof run.err);
    if (run.code != 0) fprintf(stderr, "walk: %s\n", run.err);
    assert_int_equal(run.code, 0);
}

static void end_walk(void)
{
    xdotool("key Escape");
    wait_for_end();
}

static bool title_has(const char *text)
{
    const char *title =
        ask("xdotool search --onlyvisible --name scene.prom getwindowname 2> /dev/null");
    return strstr(title, text) != NULL;
}

static void wait_for_title(const char *text)
{
    double start = prom_clock_ms();
    while (!title_has(text)) {
        if (has_ended()) fail_walk("walk ended early");
        if (prom_clock_ms() - start > PATIENCE_S * 1000) fail_walk(text);
        nap(50);
    }
}

static void wait_for_file(const char *name)
{
    double start = prom_clock_ms();
    struct stat st;
    while (stat(name, &st) != 0) { // written whole under this name
        if (prom_clock_ms() - start > PATIENCE_S * 1000) fail_walk(name);
        nap(20);
    }
}

// What walk says at its end: how many frames it drew, and where it was.
typedef struct ending {
    unsigned frames, width, height;
    double eye[3], look_at[3];
} ending;

static ending read_ending(void)
{
    ending e = {0};
    assert_int_equal(
        sscanf(run.out, "scene.prom: %u frames of %u x %u", &e.frames, &e.width, &e.height), 3);
    const char *pose = strstr(run.out, "ended at");
    assert_non_null(pose);
    assert_int_equal(sscanf(pose, "ended at --eye %lf,%lf,%lf --look-at %lf,%lf,%lf", &e.eye[0],
                            &e.eye[1], &e.eye[2], &e.look_at[0], &e.look_at[1], &e.look_at[2]),
                     6);
    return e;
}

static double heading(const ending *e)
{
    return atan2(e->look_at[0] - e->eye[0], e->look_at[2] - e->eye[2]);
}

// ---- pictures

static picture read_picture(const char *name)
{
    picture p = {0};
    prom_error error = {0};
    if (prom_image_read(name, 4096, &p.width, &p.height, &p.rgba, &error))
        fail_msg("%s", error.text);
    return p;
}

// Mean difference of the colours, of 255.
static double difference(const picture *a, const picture *b)
{
    assert_int_equal(a->width, b->width);
    assert_int_equal(a->height, b->height);
    double sum = 0;
    size_t bytes = (size_t)a->width * a->height * 4;
    for (size_t i = 0; i < bytes; i++)
        if (i % 4 != 3) sum += abs(a->rgba[i] - b->rgba[i]);
    return sum / (double)(bytes / 4 * 3);
}

static double difference_of_files(const char *first, const char *second)
{
    picture a = read_picture(first), b = read_picture(second);
    double d = difference(&a, &b);
    prom_free(a.rgba);
    prom_free(b.rgba);
    return d;
}

// The server may show a picture some time after it was handed over.
static void wait_for_screen(const char *name, double most)
{
    picture wanted = read_picture(name);
    double start = prom_clock_ms(), d;
    do {
        nap(20);
        picture shown = read_screen(wanted.width, wanted.height);
        d = difference(&shown, &wanted);
        prom_free(shown.rgba);
        if (prom_clock_ms() - start > PATIENCE_S * 1000) fail_walk("the screen shows another");
    } while (d >= most);
    prom_free(wanted.rgba);
}

// ---- setup

// Triangles of three colours beside and behind each other: turned around, mirrored or with its
// colours swapped, the picture is another.
static void write_scene(void)
{
    const char *rest =
        ",\"materials\":["
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.1,0.05,1]},\"doubleSided\":true}"
        ","
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.1,0.7,0.1,1]},\"doubleSided\":true},"
        "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.9,0.8,0.1,1]},\"doubleSided\":true}]"
        ","
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":0}]},"
        "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":1}]},"
        "{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"material\":2}]}],"
        "\"nodes\":[{\"mesh\":0,\"translation\":[-3,0,0],\"scale\":[2,3,1]},"
        "{\"mesh\":1,\"translation\":[2,0,-2],\"scale\":[3,1,1]},"
        "{\"mesh\":2,\"translation\":[-1,-1,-4],\"scale\":[1,2,1]}],"
        "\"scenes\":[{\"nodes\":[0,1,2]}],\"scene\":0";
    char *data = scene_base64(&scene_triangle_unit, sizeof scene_triangle_unit);
    char *uri = prom_format("data:application/octet-stream;base64,%s", data);
    char *text = scene_gltf(uri, rest + 1);
    FILE *file = fopen("scene.gltf", "wb");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
    free(text);
    prom_free(uri);
    free(data);
}

// Straight ahead, turning a little to the right.
static void write_path(void)
{
    prom_error error = {0};
    for (int i = 0; i < 60; i++)
        prom_path_add(&path, (double[]){0, 0.5, 8 - 0.1 * i}, (double[]){0.005 * i, 0.02, -1});
    if (prom_path_save("scene.path", &path, NULL, &error)) fail_msg("%s", error.text);
}

// Any costs do: what is drawn in time is not the subject here.
static void write_profile(void)
{
    prom_error error = {0};
    prom_cost_model model = {.fixed_ms = 0.1,
                             .draw_ms = 1e-3,
                             .triangle_ms = 1e-4,
                             .hidden_pixel_ms = 1e-7,
                             .margin = 0.2,
                             .sample_count = 1};
    for (int i = 0; i < PROM_SHADE_COUNT; i++) model.pixel_ms[i] = 1e-5;
    if (prom_cost_save(&model, "p.json", &error)) fail_msg("%s", error.text);
}

static int make_model(void **state)
{
    (void)state;
    enter_scratch();
    write_scene();
    write_path();
    write_profile();
    run_program(&run, "build scene.gltf -o scene.prom --quiet");
    if (run.code == 3) missing = "no GL";
    if (missing) {
        fprintf(stderr, "skipped: %s", run.err);
        return 0;
    }
    if (run.code != 0) fail_msg("build: %s", run.err);
    if (!has_program("Xvfb") || !has_program("xdotool"))
        missing = "Xvfb or xdotool is not installed";
    else if (!start_server())
        missing = "Xvfb does not start";
    if (missing) fprintf(stderr, "skipped: %s\n", missing);
    return 0;
}

static int end_all(void **state)
{
    (void)state;
    stop(&walker);
    stop(&x_server);
    prom_path_finish(&path);
    leave_scratch();
    return 0;
}

static int end_walker(void **state)
{
    (void)state;
    stop(&walker);
    setenv("DISPLAY", x_display, 1);
    return 0;
}

// ---- tests

static void without_a_display_it_says_what_to_do(void **state)
{
    (void)state;
    if (missing && !strcmp(missing, "no GL")) skip(); // there is no model
    const char *const made[] = {"scene.gltf", "scene.path", "scene.prom",   "scene.prom.work",
                                "p.json",     "xvfb.log",   "Xvfb_screen0", NULL};
    unsetenv("DISPLAY");
    expect("walk scene.prom" VIEW, 3);
    assert_int_equal(count_lines(run.err), 1);
    assert_non_null(strstr(run.err, "DISPLAY"));
    assert_non_null(strstr(run.err, "promenade bench"));
    setenv("DISPLAY", ":98765", 1);
    expect("walk scene.prom" VIEW, 3);
    expect("walk nothing.prom" VIEW, 2);
    assert_int_equal(count_others(".", made), 0);
}

static void the_window_shows_what_shot_draws(void **state)
{
    (void)state;
    NEED_WINDOW();
    expect("shot scene.prom" VIEW " --frame 0 -o shot.png", 0);
    // What F12 and --shot keep,
    start_walk("--selector full --frames 60 --shot walk.png");
    wait_for_end();
    ending e = read_ending();
    assert_int_equal(e.frames, 60);
    for (int i = 0; i < 3; i++)
        assert_true(fabs(e.eye[i] - path.keys.data[0].position[i]) < 1e-6);
    assert_true(difference_of_files("walk.png", "shot.png") < 0.5);
    // and what is on the screen.
    start_walk("--selector full");
    wait_for_title("at rest");
    wait_for_screen("shot.png", 0.5);
    end_walk();
}

static void keys_walk_and_home_returns(void **state)
{
    (void)state;
    NEED_WINDOW();
    start_walk("--selector coarsest");
    wait_for_title("at rest");
    xdotool("keydown w");
    nap(500);
    xdotool("keyup w");
    wait_for_title("at rest");
    end_walk();
    ending e = read_ending();
    const double *start = path.keys.data[0].position;
    double dx = e.eye[0] - start[0], dz = e.eye[2] - start[2];
    assert_true(hypot(dx, dz) > 0.05);
    assert_true(fabs(e.eye[1] - start[1]) < 1e-6);
    assert_true(fabs(remainder(atan2(dx, dz) - heading(&e), 2 * M_PI)) < 1e-3); // ahead

    start_walk("--selector coarsest");
    wait_for_title("at rest");
    xdotool("keydown d keydown Shift sleep 0.3 keyup Shift keyup d key e key Right key Home");
    wait_for_title("at rest");
    end_walk();
    ending home = read_ending();
    for (int i = 0; i < 3; i++) assert_true(fabs(home.eye[i] - start[i]) < 1e-6);
    assert_true(fabs(remainder(heading(&home) - heading(&e), 2 * M_PI)) < 1e-6);
}

static void the_picture_follows_the_window(void **state)
{
    (void)state;
    NEED_WINDOW();
    start_walk("--selector full");
    wait_for_title("at rest");
    const char *search = "xdotool search --onlyvisible --name scene.prom";
    unsigned window = (unsigned)strtoul(ask(search), NULL, 10);
    char command[64];
    for (unsigned i = 0; i <= 20; i++) { // a drag
        snprintf(command, sizeof command, "windowsize %u %u %u", window, 320 + 8 * i,
                 180 + 4 * i);
        xdotool(command);
    }
    snprintf(command, sizeof command, "windowsize --sync %u 400 300", window);
    xdotool(command);
    xdotool("key F12"); // after the resizing, as events keep their order
    wait_for_file("promenade-0001.png");
    wait_for_screen("promenade-0001.png", 0.01);
    end_walk();
    ending e = read_ending();
    assert_int_equal(e.width, 400);
    assert_int_equal(e.height, 300);
    expect("shot scene.prom --path scene.path --frame 0 --resolution 400,300 -o large.png", 0);
    assert_true(difference_of_files("promenade-0001.png", "large.png") < 0.5);
}

static void a_click_captures_the_mouse_and_tab_frees_it(void **state)
{
    (void)state;
    NEED_WINDOW();
    start_walk("--selector coarsest");
    wait_for_title("at rest");
    xdotool("mousemove 100 90");
    xdotool("mousemove 200 90"); // free: turns nothing
    wait_for_title("click to look around");
    xdotool("click 1");
    double start = prom_clock_ms();
    while (title_has("click to look")) {
        if (prom_clock_ms() - start > PATIENCE_S * 1000) fail_walk("the mouse stays free");
        nap(50);
    }
    xdotool("mousemove_relative 120 0");
    nap(200);
    xdotool("key Tab");
    wait_for_title("click to look around");
    xdotool("mousemove_relative 0 60"); // free again
    nap(100);
    end_walk();
    ending e = read_ending();
    prom_camera first = {0};
    prom_path_pose(&path, 0, &first);
    vec3 forward;
    versor q;
    memcpy(q, first.orientation, sizeof q);
    glm_quat_rotatev(q, (vec3){0, 0, -1}, forward);
    double turned = remainder(heading(&e) - atan2(forward[0], forward[2]), 2 * M_PI);
    assert_true(turned < -0.05); // to the right
    assert_true(fabs(e.look_at[1] - e.eye[1] - (double)forward[1]) < 1e-3);
}

static void at_rest_nothing_is_drawn(void **state)
{
    (void)state;
    NEED_WINDOW();
    start_walk("");
    wait_for_title("at rest");
    nap(1000);
    end_walk();
    assert_true(read_ending().frames < 20);
}

static void at_rest_it_shows_full_detail(void **state)
{
    (void)state;
    NEED_WINDOW();
    expect("shot scene.prom" VIEW " --frame 0 -o shot.png", 0);
    start_walk("--budget-ms 0.05 --rest-budget-ms 0.2");
    wait_for_title("at rest, full detail");
    wait_for_screen("shot.png", 0.5);
    xdotool("key Right");
    wait_for_title("at rest, full detail");
    end_walk();
    start_walk("--rest-budget-ms 0");
    wait_for_title("at rest");
    nap(500);
    assert_false(title_has("full detail"));
    end_walk();
}

static void the_path_is_played(void **state)
{
    (void)state;
    NEED_WINDOW();
    // A key each, as bench does;
    start_walk("--play --frames 30 --budget-ms 20 --selector meta");
    wait_for_end();
    ending e = read_ending();
    for (int i = 0; i < 3; i++)
        assert_true(fabs(e.eye[i] - path.keys.data[29].position[i]) < 1e-6);
    // by P in real time, until P.
    start_walk("--selector coarsest");
    wait_for_title("at rest");
    xdotool("key p");
    wait_for_title("playing");
    nap(300);
    xdotool("key p");
    wait_for_title("at rest");
    end_walk();
    e = read_ending();
    const double *start = path.keys.data[0].position;
    assert_true(hypot(e.eye[0] - start[0], e.eye[2] - start[2]) > 0.05);
}

static void a_picture_that_cannot_be_written_is_an_error(void **state)
{
    (void)state;
    NEED_WINDOW();
    expect("walk scene.prom" VIEW " --frames 2 --shot nowhere/a.png", 4);
    expect("walk scene.prom" VIEW " --frames 2 --shot scene.prom", 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(without_a_display_it_says_what_to_do, end_walker),
        cmocka_unit_test_teardown(the_window_shows_what_shot_draws, end_walker),
        cmocka_unit_test_teardown(keys_walk_and_home_returns, end_walker),
        cmocka_unit_test_teardown(the_picture_follows_the_window, end_walker),
        cmocka_unit_test_teardown(a_click_captures_the_mouse_and_tab_frees_it, end_walker),
        cmocka_unit_test_teardown(at_rest_nothing_is_drawn, end_walker),
        cmocka_unit_test_teardown(at_rest_it_shows_full_detail, end_walker),
        cmocka_unit_test_teardown(the_path_is_played, end_walker),
        cmocka_unit_test_teardown(a_picture_that_cannot_be_written_is_an_error, end_walker),
    };
    return cmocka_run_group_tests(tests, make_model, end_all);
}
