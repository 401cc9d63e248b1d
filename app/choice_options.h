// The options of how representations are chosen, beside the selector's name: weights, rules of
// thumb and staying with what is shown. Shared by `bench`, `walk` and `shot`; the patterns of
// weights by `build` too.
#ifndef PROM_APP_CHOICE_OPTIONS_H
#define PROM_APP_CHOICE_OPTIONS_H

#include "benefit/weights.h"
#include "traverse/choice.h"

#include <argp.h>

typedef struct prom_choice_options {
    unsigned weights; // prom_weight_kind flags
    prom_weight_rules rules;
    prom_order order;
    unsigned priors; // prom_prior flags
    double hysteresis;
    uint32_t max_switches; // from one cut to the next; 0: any number
} prom_choice_options;

// Input: prom_choice_options; part of the view's options.
extern const struct argp prom_argp_choice;

// Takes PATTERN=WEIGHT; a wrong one is a usage error. `text` is cut in two and kept.
void prom_option_weight(const struct argp_state *state, char *text, prom_weight_rules *rules);

// The weights in use as on the command line: "none", or names with commas between.
#define PROM_WEIGHT_NAMES_BYTES 32
const char *prom_weight_names(unsigned weights, char text[PROM_WEIGHT_NAMES_BYTES]);
const char *prom_order_name(prom_order order);

#endif
