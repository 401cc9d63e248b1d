#include "app/choice_options.h"

#include "app/options.h"

#include <string.h>

enum {
    KEY_WEIGHTS = 0x3000,
    KEY_WEIGHT,
    KEY_BENEFIT,
    KEY_PRIOR,
    KEY_HYSTERESIS,
    KEY_MAX_SWITCHES
};

static const struct argp_option options[] = {
    {"weights", KEY_WEIGHTS, "none|LIST", 0,
     "What makes a visible pixel of an object worth more than another's: a list of focus (near "
     "the line of sight), motion (slow across the picture; nothing moves in a `shot`) and "
     "semantics (--weight, here or of `build`) with commas between (semantics)",
     0},
    {"weight", KEY_WEIGHT, "PATTERN=X", 0,
     "Objects of these names are worth X for this run, 'statue*=4' for one; may be given more "
     "than once, the last that matches a name counts",
     0},
    {"benefit", KEY_BENEFIT, "pixels|sum", 0,
     "For `meta` and `greedy`: a cluster takes its place by the visible pixels that it shares "
     "out among its children, or, the classic, by the sum of what each of its objects would "
     "show by itself (pixels)",
     0},
    {"prior", KEY_PRIOR, "LIST", 0,
     "For `meta` and `greedy`, classic rules of thumb: few-pixels (what is smaller than 8 "
     "pixels is drawn by its box of average colours) and full-detail (an object that covers a "
     "quarter of the picture is drawn by its full geometry)",
     0},
    {"hysteresis", KEY_HYSTERESIS, "X", 0,
     "For `meta` and `greedy`: what an object was drawn by in the last frame counts this part "
     "of its pixels more, so that less changes while the camera moves (0; `walk`: 0.05)",
     0},
    {"max-switches", KEY_MAX_SWITCHES, "N", 0,
     "At most N objects in view are drawn in another way than in the last frame, as far as the "
     "budget allows (0: any number)",
     0},
    {0},
};

typedef struct flag_name {
    const char *name;
    unsigned flag;
} flag_name;

static const flag_name weight_names[] = {{"focus", PROM_WEIGHT_FOCUS},
                                         {"motion", PROM_WEIGHT_MOTION},
                                         {"semantics", PROM_WEIGHT_SEMANTICS},
                                         {0}};
static const flag_name prior_names[] = {
    {"few-pixels", PROM_PRIOR_FEW_PIXELS}, {"full-detail", PROM_PRIOR_FULL_DETAIL}, {0}};

// The flag of the name that stands before the next comma; 0: there is none such.
static unsigned flag_at(const flag_name *names, const char *text, size_t length)
{
    for (; names->name; names++)
        if (strlen(names->name) == length && !strncmp(names->name, text, length))
            return names->flag;
    return 0;
}

static unsigned take_flags(const struct argp_state *state, const char *option, const char *text,
                           const flag_name *names, const char *known)
{
    unsigned flags = 0;
    for (const char *at = text;; at++) {
        size_t length = strcspn(at, ",");
        unsigned flag = flag_at(names, at, length);
        if (!flag)
            argp_error(state, "%s: there is no `%.*s`; give %s", option, (int)length, at,
                       known);
        flags |= flag;
        at += length;
        if (!*at) return flags;
    }
}

static unsigned take_weights(const struct argp_state *state, const char *text)
{
    if (!strcmp(text, "none")) return 0;
    return take_flags(state, "--weights", text, weight_names,
                      "none, or some of focus, motion and semantics with commas between");
}

static const char *const order_names[] = {"pixels", "sum"};

const char *prom_order_name(prom_order order)
{
    return order_names[order];
}

static prom_order known_order(const struct argp_state *state, const char *name)
{
    if (!strcmp(name, order_names[PROM_ORDER_SUM])) return PROM_ORDER_SUM;
    if (strcmp(name, order_names[PROM_ORDER_PIXELS]))
        argp_error(state, "--benefit: there is no `%s`; give pixels or sum", name);
    return PROM_ORDER_PIXELS;
}

void prom_option_weight(const struct argp_state *state, char *text, prom_weight_rules *rules)
{
    char *equals = strrchr(text, '=');
    if (!equals || equals == text)
        argp_error(state, "--weight: `%s` is not a pattern of names, `=` and a number", text);
    if (rules->count == PROM_WEIGHT_RULES)
        argp_error(state, "--weight: `%s` is one more than %d of them", text,
                   PROM_WEIGHT_RULES);
    double weight =
        prom_option_number(state, "--weight", equals + 1, 0, (double)PROM_WEIGHT_MAX);
    *equals = '\0';
    rules->list[rules->count++] = (prom_weight_rule){text, (float)weight, false};
}

const char *prom_weight_names(unsigned weights, char text[PROM_WEIGHT_NAMES_BYTES])
{
    text[0] = '\0';
    for (const flag_name *n = weight_names; n->name; n++) {
        if (!(weights & n->flag)) continue;
        if (text[0]) strcat(text, ",");
        strcat(text, n->name);
    }
    return text[0] ? text : "none";
}

static error_t parse(int key, char *text, struct argp_state *state)
{
    prom_choice_options *o = state->input;
    switch (key) {
    case KEY_WEIGHTS:
        o->weights = take_weights(state, text);
        break;
    case KEY_WEIGHT:
        prom_option_weight(state, text, &o->rules);
        break;
    case KEY_BENEFIT:
        o->order = known_order(state, text);
        break;
    case KEY_PRIOR:
        o->priors = take_flags(state, "--prior", text, prior_names,
                               "few-pixels, full-detail, or both with a comma between");
        break;
    case KEY_HYSTERESIS:
        o->hysteresis = prom_option_number(state, "--hysteresis", text, 0, 1);
        break;
    case KEY_MAX_SWITCHES:
        o->max_switches =
            (uint32_t)prom_option_whole(state, "--max-switches", text, 0, 1000000);
        break;
    default:
        return ARGP_ERR_UNKNOWN;
    }
    return 0;
}

const struct argp prom_argp_choice = {.options = options, .parser = parse};
