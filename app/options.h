// Command-line pieces that several commands share: argp children and value parsers.
//
// A parser ends the program through argp_error (one line, the hint to --help, exit code 1) when
// the value is wrong, so its result can be used unchecked.
#ifndef PROM_APP_OPTIONS_H
#define PROM_APP_OPTIONS_H

#include "app/choice_options.h"

#include <argp.h>
#include <stdbool.h>
#include <stdint.h>

// A number within [min, max]; `name` is the option's, for the message.
double prom_option_number(const struct argp_state *state, const char *name, const char *text,
                          double min, double max);
// The same for whole numbers.
uint64_t prom_option_whole(const struct argp_state *state, const char *name, const char *text,
                           uint64_t min, uint64_t max);
// `count` numbers, separated by `separator`.
void prom_option_numbers(const struct argp_state *state, const char *name, const char *text,
                         char separator, double min, double max, unsigned count,
                         double *values);
// "W,H": a picture's size, each side within [16, 16384].
void prom_option_resolution(const struct argp_state *state, const char *text, uint32_t size[2]);

// Stores a command's only argument; a second one is a usage error.
void prom_option_argument(const struct argp_state *state, const char *text, const char **slot);
// What is left of a command whose only argument is a model: takes it, and requires it at the
// end.
error_t prom_option_model(int key, char *text, const struct argp_state *state,
                          const char **model);
// A usage error unless the argument or option has been given; `what` as in "the model's file".
void prom_option_require(const struct argp_state *state, const char *what, const char *value);

// --quiet and --verbose, which set the log's level. No input.
extern const struct argp prom_argp_log;

// What a selection knows of what hides what; flags.
typedef enum prom_visibility_mode {
    PROM_SEE_NONE = 0,
    PROM_SEE_FRAME = 1, // counts of earlier frames
    PROM_SEE_CELLS = 2, // the model's view cells, where it has some
    PROM_SEE_BOTH = 3,
} prom_visibility_mode;
const char *prom_visibility_mode_name(prom_visibility_mode mode); // as on the command line

// What `shot` and `bench` have in common. Input: prom_view_options.
typedef struct prom_view_options {
    const char *path;     // a file or "auto"; NULL: auto
    const char *selector; // NULL: the command's default
    const char *profile;  // NULL: the device's own
    double budget_ms;     // 0: not given
    double rule_scale;
    double miss_rate;   // accepted share of frames over the budget
    double min_scale;   // the picture may be drawn so small, by its sides; 1: it may not
    double fov_degrees; // vertical
    prom_visibility_mode visibility;
    uint32_t size_px[2];
    double ppd; // pixels per degree; 0: of the picture filling a screen
    prom_choice_options choice;
} prom_view_options;

// Pixels per degree of a picture that fills the screen 0.7 m wide and 0.7 m away that FLIP's
// values are usually given for.
double prom_full_screen_ppd(uint32_t width_px);

// The path's file; NULL for an automatic one.
const char *prom_view_path_file(const prom_view_options *view);

extern const prom_view_options prom_view_options_default;
extern const struct argp prom_argp_view;
// The children of such a command: the log's and the view's options; the view's input is the
// second.
extern const struct argp_child prom_view_children[];

#endif
