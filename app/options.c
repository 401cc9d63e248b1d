#include "app/options.h"

#include "benefit/flip.h"
#include "metaobj/base/log.h"
#include "traverse/guarantee.h"
#include "traverse/selector.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

// Parses one number at *text and moves past it.
static bool take_number(const char **text, double min, double max, double *value)
{
    char *end = NULL;
    errno = 0;
    *value = strtod(*text, &end);
    if (end == *text || errno == ERANGE || !isfinite(*value)) return false;
    *text = end;
    return *value >= min && *value <= max;
}

double prom_option_number(const struct argp_state *state, const char *name, const char *text,
                          double min, double max)
{
    double value = min;
    const char *at = text;
    if (!take_number(&at, min, max, &value) || *at)
        argp_error(state, "%s: `%s` is not a number from %g to %g", name, text, min, max);
    return value;
}

uint64_t prom_option_whole(const struct argp_state *state, const char *name, const char *text,
                           uint64_t min, uint64_t max)
{
    char *end = NULL;
    errno = 0;
    unsigned long long value = strtoull(text, &end, 10);
    // strtoull takes a minus sign and wraps.
    bool good = end != text && !*end && !errno && !strchr(text, '-');
    if (!good || value < min || value > max)
        argp_error(state, "%s: `%s` is not a whole number from %llu to %llu", name, text,
                   (unsigned long long)min, (unsigned long long)max);
    return value;
}

void prom_option_numbers(const struct argp_state *state, const char *name, const char *text,
                         char separator, double min, double max, unsigned count, double *values)
{
    const char *at = text;
    bool good = true;
    for (unsigned i = 0; i < count && good; i++) {
        if (i) good = *at++ == separator;
        good = good && take_number(&at, min, max, &values[i]);
    }
    if (!good || *at)
        argp_error(state, "%s: `%s` is not %u numbers from %g to %g with `%c` between", name,
                   text, count, min, max, separator);
}

void prom_option_resolution(const struct argp_state *state, const char *text, uint32_t size[2])
{
    double values[2] = {0, 0};
    prom_option_numbers(state, "--resolution", text, ',', 16, 16384, 2, values);
    if (values[0] != floor(values[0]) || values[1] != floor(values[1]))
        argp_error(state, "--resolution: `%s` is not in whole pixels", text);
    size[0] = (uint32_t)values[0];
    size[1] = (uint32_t)values[1];
}

void prom_option_argument(const struct argp_state *state, const char *text, const char **slot)
{
    if (*slot) argp_error(state, "`%s` is one argument too many", text);
    *slot = text;
}

error_t prom_option_model(int key, char *text, const struct argp_state *state,
                          const char **model)
{
    if (key == ARGP_KEY_ARG)
        prom_option_argument(state, text, model);
    else if (key == ARGP_KEY_END)
        prom_option_require(state, "the model (a .prom file)", *model);
    else
        return ARGP_ERR_UNKNOWN;
    return 0;
}

void prom_option_require(const struct argp_state *state, const char *what, const char *value)
{
    if (!value || !*value) argp_error(state, "%s is missing", what);
}

// ---- --quiet, --verbose

static error_t parse_log(int key, char *text, struct argp_state *state)
{
    (void)text;
    (void)state;
    if (key == 'q')
        prom_log_set_level(PROM_LOG_WARNING);
    else if (key == 'v')
        prom_log_set_level(PROM_LOG_DEBUG);
    else
        return ARGP_ERR_UNKNOWN;
    return 0;
}

static const struct argp_option log_options[] = {
    {"quiet", 'q', NULL, 0, "Warnings and errors only on stderr", 0},
    {"verbose", 'v', NULL, 0, "More on stderr", 0},
    {0},
};

const struct argp prom_argp_log = {.options = log_options, .parser = parse_log};

// ---- what shot and bench share

const prom_view_options prom_view_options_default = {
    .rule_scale = 1,
    .miss_rate = PROM_MISS_RATE,
    .min_scale = 1,
    .fov_degrees = 60,
    .visibility = PROM_SEE_BOTH,
    .size_px = {1280, 720},
    .choice = {.weights = PROM_WEIGHT_SEMANTICS},
};

double prom_full_screen_ppd(uint32_t width_px)
{
    return fmax(PROM_FLIP_PPD * width_px / PROM_FLIP_SCREEN_PX, PROM_PPD_MIN);
}

const char *prom_view_path_file(const prom_view_options *view)
{
    return view->path && strcmp(view->path, "auto") != 0 ? view->path : NULL;
}

enum {
    KEY_PATH = 0x2000,
    KEY_BUDGET,
    KEY_MISS_RATE,
    KEY_MIN_SCALE,
    KEY_SELECTOR,
    KEY_RESOLUTION,
    KEY_PROFILE,
    KEY_RULE_SCALE,
    KEY_FOV,
    KEY_VISIBILITY,
    KEY_PPD,
};

static const struct argp_option view_options[] = {
    {"path", KEY_PATH, "FILE|auto", 0,
     "Camera path; `auto` (the default) derives a walk from the model", 0},
    {"budget-ms", KEY_BUDGET, "MS", 0, "Time that a frame may take", 0},
    {"miss-rate", KEY_MISS_RATE, "SHARE", 0,
     "Share of frames that may take longer, from 0.001 to 0.5 (0.01)", 0},
    {"selector", KEY_SELECTOR, "NAME", 0,
     "What chooses the representations: meta, greedy, distance, full or coarsest", 0},
    {"resolution", KEY_RESOLUTION, "W,H", 0, "Size of the picture in pixels (1280,720)", 0},
    {"min-scale", KEY_MIN_SCALE, "FACTOR", 0,
     "With a budget: the picture may be drawn smaller and scaled up, by this factor on its "
     "sides "
     "at most, where that loses less than it buys; 0.5 allows all steps there are, 1 none (1)",
     0},
    {"fov-deg", KEY_FOV, "DEGREES", 0, "Vertical field of view (60)", 0},
    {"rule-scale", KEY_RULE_SCALE, "FACTOR", 0,
     "For selectors that follow a rule of their own (`distance`, its ranges): factor on it, "
     "finer with more (1)",
     0},
    {"distance-scale", KEY_RULE_SCALE, NULL, OPTION_ALIAS, NULL, 0},
    {"visibility", KEY_VISIBILITY, "none|frame|cells|both", 0,
     "From what the selector knows what is hidden: the pixels counted in earlier frames, the "
     "model's view cells, or both (both)",
     0},
    {"ppd", KEY_PPD, "X", 0,
     "Pixels per degree of the viewer's angle, on which it depends how much of an error shows "
     "(those of the picture filling a screen 0.7 m wide, 0.7 m away: 22.34 for 1280 pixels)",
     0},
    {"profile", KEY_PROFILE, "FILE", 0,
     "Cost profile from `calibrate`; with it nothing that is measured changes what is drawn: "
     "the same path has the same cuts in every run. The default is the device's own, made when "
     "missing, and corrected by what frames take",
     0},
    {0},
};

static const char *known_selector(const struct argp_state *state, const char *name)
{
    if (prom_selector_class_named(name)) return name;
    char names[256] = "";
    for (size_t i = 0; i < prom_selector_count(); i++) {
        if (i) strncat(names, ", ", sizeof names - strlen(names) - 1);
        strncat(names, prom_selector_at(i)->name, sizeof names - strlen(names) - 1);
    }
    argp_error(state, "--selector: there is no `%s`; there are %s", name, names);
    return name;
}

static const char *const visibility_modes[] = {"none", "frame", "cells", "both"};

const char *prom_visibility_mode_name(prom_visibility_mode mode)
{
    return visibility_modes[mode];
}

static prom_visibility_mode known_visibility(const struct argp_state *state, const char *name)
{
    for (int i = PROM_SEE_NONE; i <= PROM_SEE_BOTH; i++)
        if (!strcmp(name, visibility_modes[i])) return (prom_visibility_mode)i;
    argp_error(state, "--visibility: there is no `%s`; give none, frame, cells or both", name);
    return PROM_SEE_NONE;
}

static error_t parse_view(int key, char *text, struct argp_state *state)
{
    prom_view_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->choice;
        break;
    case KEY_PATH:
        o->path = text;
        break;
    case KEY_BUDGET:
        o->budget_ms = prom_option_number(state, "--budget-ms", text, 0.01, 1e6);
        break;
    case KEY_MISS_RATE:
        o->miss_rate = prom_option_number(state, "--miss-rate", text, 1e-3, 0.5);
        break;
    case KEY_MIN_SCALE:
        o->min_scale = prom_option_number(state, "--min-scale", text, 1e-3, 1);
        break;
    case KEY_SELECTOR:
        o->selector = known_selector(state, text);
        break;
    case KEY_RESOLUTION:
        prom_option_resolution(state, text, o->size_px);
        break;
    case KEY_PROFILE:
        o->profile = text;
        break;
    case KEY_RULE_SCALE:
        o->rule_scale = prom_option_number(state, "--rule-scale", text, 1e-3, 1e3);
        break;
    case KEY_VISIBILITY:
        o->visibility = known_visibility(state, text);
        break;
    case KEY_PPD:
        o->ppd = prom_option_number(state, "--ppd", text, PROM_PPD_MIN, PROM_PPD_MAX);
        break;
    case KEY_FOV:
        o->fov_degrees = prom_option_number(state, "--fov-deg", text, 1, 170);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

static const struct argp_child choice_child[] = {{&prom_argp_choice, 0, "Choice:", 3}, {0}};

const struct argp prom_argp_view = {
    .options = view_options, .parser = parse_view, .children = choice_child};

const struct argp_child prom_view_children[] = {
    {&prom_argp_log, 0, NULL, -1},
    {&prom_argp_view, 0, "View:", 2},
    {0},
};
