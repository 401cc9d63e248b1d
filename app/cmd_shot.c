// promenade shot: one picture of a model.
#include "app/command.h"
#include "app/output.h"
#include "app/resolution.h"
#include "app/sight.h"

#include "metaobj/base/log.h"

#include <math.h>
#include <stdio.h>

#define AUTO_FRAMES 300
#define SETTLE_FRAMES 8 // until what frames show of each other has settled

typedef struct shot_options {
    prom_view_options view;
    const char *model, *output;
    uint64_t frame;
    double eye[3], look_at[3];
    bool has_eye, has_look_at;
    prom_frame_options draw;
} shot_options;

enum { KEY_FRAME = 0x1000, KEY_EYE, KEY_LOOK_AT, KEY_FALSE_COLOURS, KEY_WIREFRAME };

static const struct argp_option options[] = {
    {"output", 'o', "FILE", 0, "The picture to write (PNG)", 0},
    {"frame", KEY_FRAME, "N", 0, "Frame of the path, from 0 (0)", 0},
    {"eye", KEY_EYE, "X,Y,Z", 0, "Instead of a path: the camera's place", 0},
    {"look-at", KEY_LOOK_AT, "X,Y,Z", 0, "With --eye: a point to look at", 0},
    {"false-colours", KEY_FALSE_COLOURS, NULL, 0,
     "Colour by kind of representation: meshes green (fine to coarse: dark to light), clusters "
     "blue, average-colour boxes red, textured boxes orange",
     1},
    {"wireframe", KEY_WIREFRAME, NULL, 0, "Draw edges only", 1},
    {0},
};

static void check_camera(const shot_options *o, const struct argp_state *state)
{
    if (o->has_eye != o->has_look_at) argp_error(state, "--eye and --look-at belong together");
    if (o->has_eye && o->view.path) argp_error(state, "--path and --eye exclude each other");
    double distance = 0;
    for (int i = 0; i < 3; i++) distance += fabs(o->eye[i] - o->look_at[i]);
    if (o->has_eye && !(distance > 0)) argp_error(state, "--look-at: is the eye's own place");
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    shot_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[1] = &o->view;
        break;
    case 'o':
        o->output = text;
        break;
    case KEY_FRAME:
        o->frame = prom_option_whole(state, "--frame", text, 0, UINT32_MAX);
        break;
    case KEY_EYE:
        prom_option_numbers(state, "--eye", text, ',', -1e9, 1e9, 3, o->eye);
        o->has_eye = true;
        break;
    case KEY_LOOK_AT:
        prom_option_numbers(state, "--look-at", text, ',', -1e9, 1e9, 3, o->look_at);
        o->has_look_at = true;
        break;
    case KEY_FALSE_COLOURS:
        o->draw.output = PROM_OUTPUT_TINT;
        break;
    case KEY_WIREFRAME:
        o->draw.wireframe = true;
        break;
    case ARGP_KEY_END:
        prom_option_model(key, text, state, &o->model);
        prom_option_require(state, "--output", o->output);
        check_camera(o, state);
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
    .doc = "Draw one picture of a model.\v"
           "With --budget-ms the selector is `greedy` unless given, without it `full`.",
    .children = prom_view_children,
};

static prom_status check_frame(const shot_options *o, const prom_path *path, prom_error *error)
{
    if (o->has_eye || o->frame < path->keys.count) return PROM_OK;
    return prom_fail(error, PROM_ERR_USAGE,
                     "--frame %llu: the path has %zu frames, numbered from 0",
                     (unsigned long long)o->frame, path->keys.count);
}

static prom_camera camera_of(const shot_options *o, const prom_session *session)
{
    prom_camera camera = session->camera;
    if (!o->has_eye) {
        prom_path_pose(&session->path, o->frame, &camera);
        return camera;
    }
    for (int i = 0; i < 3; i++) camera.eye[i] = o->eye[i];
    prom_camera_look_at(&camera, o->look_at);
    return camera;
}

typedef struct shot {
    prom_camera camera;
    const prom_selector_class *class;
    prom_selector *selector;
    prom_sight sight;
    prom_resolution resolution;
    double allowed_ms;
    prom_cut cut;
} shot;

static prom_status begin(shot *t, const shot_options *o, prom_session *session,
                         prom_error *error)
{
    const char *name = o->view.selector;
    bool budgeted = o->view.budget_ms > 0;
    *t = (shot){.camera = camera_of(o, session), .class = prom_selector_class_named(name)};
    t->allowed_ms = budgeted ? prom_session_allowed_ms(session, o->view.budget_ms) : INFINITY;
    t->selector = prom_selector_create(name, &session->model, error);
    if (!t->selector) return error->status;
    prom_status status = prom_sight_init(&t->sight, session, error);
    if (status) return status;
    return prom_resolution_init(&t->resolution, session, name, &t->camera, error);
}

static void end(shot *t)
{
    prom_resolution_finish(&t->resolution);
    prom_sight_finish(&t->sight);
    prom_cut_finish(&t->cut);
    prom_selector_destroy(t->selector);
}

// What hides what changes costs, and so only cuts that these matter to. Edges hide nothing: the
// frames before the picture are drawn plain.
static void take(shot *t, const shot_options *o, prom_session *session)
{
    const prom_frame_options plain = {0};
    int frames = t->sight.counter && t->class->uses_cost ? SETTLE_FRAMES : 1;
    prom_view view;
    prom_view_init(&view, &t->camera);
    for (int i = 1; i <= frames; i++) {
        prom_renderer_take_stats(session->renderer);
        prom_sight_begin(&t->sight, &t->camera);
        prom_selection selection = prom_session_selection(session, &view, t->sight.visibility,
                                                          t->allowed_ms, o->view.rule_scale);
        prom_resolution_select_best(&t->resolution, t->selector, &selection, &t->cut);
        prom_resolution_draw(&t->resolution, &t->sight, &t->cut, &t->camera,
                             i < frames ? &plain : &o->draw);
    }
    if (t->class->budgeted && t->cut.cmin_ms > t->allowed_ms)
        prom_log(PROM_LOG_WARNING,
                 "budget %g ms: even the cheapest cut is predicted at %.1f ms of drawing",
                 o->view.budget_ms, t->cut.cmin_ms);
}

static void tell(const shot *t, const shot_options *o, prom_session *session)
{
    prom_draw_stats stats = prom_renderer_take_stats(session->renderer);
    double scale = prom_resolution_scale(&t->resolution);
    printf("%s: %s, %llu triangles in %zu nodes", o->output, o->view.selector,
           (unsigned long long)stats.triangles, t->cut.entries.count);
    if (session->cost.sample_count) printf(", predicted %.1f ms", t->cut.predicted_ms);
    if (scale < 1) printf(", drawn at %.2f of its size", scale);
    putchar('\n');
}

static prom_status draw(const shot_options *o, prom_session *session, prom_error *error)
{
    shot t;
    prom_status status = begin(&t, o, session, error);
    if (!status) {
        take(&t, o, session);
        status = prom_session_write_png(session, o->output, error);
    }
    if (!status) tell(&t, o, session);
    end(&t);
    return status;
}

prom_status prom_command_shot(int argc, char **argv, prom_error *error)
{
    shot_options o = {.view = prom_view_options_default};
    argp_parse(&argp, argc, argv, 0, NULL, &o);
    if (!o.view.selector)
        o.view.selector = o.view.budget_ms > 0 ? PROM_SELECTOR_DEFAULT : "full";
    prom_command_files files = {{o.model, prom_view_path_file(&o.view), o.view.profile},
                                {&o.output}};
    prom_status status = prom_outputs_check(&files, error);
    if (status) return status;
    prom_session session;
    status = prom_session_open(&session, o.model, &o.view, !o.has_eye, AUTO_FRAMES, error);
    if (status) return status;
    status = check_frame(&o, &session.path, error);
    if (!status) status = draw(&o, &session, error);
    prom_session_close(&session);
    return status;
}
