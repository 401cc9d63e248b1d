// promenade walk: a window to walk through a model within a time per frame.
#include "app/command.h"
#include "app/output.h"
#include "app/walk_loop.h"

#include "metaobj/base/log.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define DEFAULT_BUDGET_MS 33.0
#define AUTO_FRAMES 900
// What is answered within a tenth of a second seems to be answered at once (Miller 1968,
// Response time in man-computer conversational transactions).
#define DEFAULT_REST_MS 100.0
// Measured in a walk through the gallery: 22 to 46 % fewer switches for 0.1 % of the pixels
// lost.
#define HYSTERESIS 0.05

typedef struct walk_options {
    prom_view_options view;
    prom_walk_options walk;
    const char *model, *shot;
    bool full_screen;
    prom_window *window;
} walk_options;

enum { KEY_FRAMES = 0x1000, KEY_FULL_SCREEN, KEY_PLAY, KEY_SHOT, KEY_REST };

static const struct argp_option options[] = {
    {"fullscreen", KEY_FULL_SCREEN, NULL, 0, "Fill the screen, in its own resolution", 0},
    {"play", KEY_PLAY, NULL, 0, "Start by walking the path, as P does", 0},
    {"rest-budget-ms", KEY_REST, "MS", 0,
     "While the camera stands still the picture is refined up to full detail, in steps of this "
     "time at most, after each of which a movement is answered; 0: it is not (100, or the "
     "budget where that is more)",
     0},
    {"frames", KEY_FRAMES, "N", 0,
     "End after N frames, drawn without rests; with --play one for each key of the path, as "
     "`bench` does",
     1},
    {"shot", KEY_SHOT, "FILE", 0, "At the end write the last picture (PNG)", 1},
    {0},
};

static error_t parse(int key, char *text, struct argp_state *state)
{
    walk_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[1] = &o->view;
        break;
    case KEY_FRAMES:
        o->walk.frames = prom_option_whole(state, "--frames", text, 1, 1000000000);
        break;
    case KEY_FULL_SCREEN:
        o->full_screen = true;
        break;
    case KEY_PLAY:
        o->walk.play = true;
        break;
    case KEY_REST:
        o->walk.rest_budget_ms = prom_option_number(state, "--rest-budget-ms", text, 0, 1e6);
        break;
    case KEY_SHOT:
        o->shot = text;
        break;
    default:
        return prom_option_model(key, text, state, &o->model);
    }
    return 0;
}

static const struct argp argp = {
    .options = options,
    .parser = parse,
    .args_doc = "X.prom",
    .doc = "Walk through a model in a window, within a time per frame.\v"
           "Keys:\n"
           "  W A S D       walk; Shift: fast\n"
           "  E or Space    up\n"
           "  Q or C        down\n"
           "  mouse         look around, after a click; Tab frees it\n"
           "  wheel         speed\n"
           "  arrow keys    walk and turn; Page Up, Page Down: look up, down\n"
           "  Home          back to the start\n"
           "  P             walk the path by itself; pause\n"
           "  F12           keep a picture: promenade-0001.png, ...\n"
           "  Esc           end\n\n"
           "The selector is `greedy` and the budget 33 ms unless given. The walk starts at the "
           "path's first place.",
    .children = prom_view_children,
};

static prom_context *open_window(void *user, uint32_t size_px[2], prom_error *error)
{
    walk_options *o = user;
    o->window = prom_window_create(o->walk.name, size_px, o->full_screen, error);
    if (!o->window) return NULL;
    prom_window_size(o->window, size_px);
    return prom_context_create_window(o->window, error);
}

static void report(const walk_options *o, const prom_walk_result *r)
{
    double to[3];
    prom_walk_look_at(&r->camera, to);
    printf("%s: %llu frames of %u x %u, %s: mean %.2f ms, worst %.2f ms, %llu over %g ms; "
           "showing one took %.2f ms of it\n",
           o->model, (unsigned long long)r->frames, r->camera.width, r->camera.height,
           o->walk.selector, r->frame_ms, r->worst_ms, (unsigned long long)r->misses,
           o->walk.budget_ms, r->present_ms);
    printf("ended at --eye %.9g,%.9g,%.9g --look-at %.9g,%.9g,%.9g\n", r->camera.eye[0],
           r->camera.eye[1], r->camera.eye[2], to[0], to[1], to[2]);
}

static prom_status walk(walk_options *o, prom_error *error)
{
    const prom_session_device device = {open_window, o};
    prom_session session;
    prom_status status =
        prom_session_open_on(&session, &device, o->model, &o->view, true, AUTO_FRAMES, error);
    if (!status) {
        prom_walk_result result;
        prom_log(PROM_LOG_INFO, "W A S D, mouse after a click, Shift, P plays the path, Esc "
                                "ends; `promenade walk --help` tells the other keys");
        status = prom_walk_run(&session, o->window, &o->walk, &result, error);
        if (!status && o->shot) status = prom_session_write_png(&session, o->shot, error);
        if (!status) report(o, &result);
        prom_session_close(&session);
    }
    prom_window_destroy(o->window);
    return status;
}

prom_status prom_command_walk(int argc, char **argv, prom_error *error)
{
    walk_options o = {.view = prom_view_options_default, .walk.rest_budget_ms = -1};
    o.view.choice.hysteresis = HYSTERESIS;
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    if (!o.view.selector) o.view.selector = PROM_SELECTOR_DEFAULT;
    if (!(o.view.budget_ms > 0)) o.view.budget_ms = DEFAULT_BUDGET_MS;
    const char *slash = strrchr(o.model, '/');
    o.walk.name = slash ? slash + 1 : o.model;
    o.walk.selector = o.view.selector;
    o.walk.budget_ms = o.view.budget_ms;
    o.walk.rule_scale = o.view.rule_scale;
    if (o.walk.rest_budget_ms < 0)
        o.walk.rest_budget_ms = fmax(DEFAULT_REST_MS, o.walk.budget_ms);
    prom_command_files files = {{o.model, prom_view_path_file(&o.view), o.view.profile},
                                {&o.shot}};
    prom_status status = prom_outputs_check(&files, error);
    return status ? status : walk(&o, error);
}
