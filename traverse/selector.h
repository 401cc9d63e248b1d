// Selectors: algorithms that return a cut within a budget, on one interface.
#ifndef PROM_TRAVERSE_SELECTOR_H
#define PROM_TRAVERSE_SELECTOR_H

#include "metaobj/cut.h"
#include "metaobj/model.h"
#include "traverse/choice.h"
#include "traverse/cost.h"
#include "traverse/last_cut.h"
#include "traverse/view.h"
#include "traverse/visibility.h"
#include "traverse/weighting.h"

#include <stdbool.h>

typedef struct prom_selection {
    const prom_view *view;
    const prom_cost_model *cost;
    double budget_ms; // for prediction (fixed part included): what the cut may be predicted at
    // For selectors that follow a rule of their own (`has_scale`): factor on its measure, more
    // of it is finer; 0 means 1.
    float rule_scale;
    // For `feedback`: what the last frame took; 0: not known. It is held against budget_ms,
    // which for this selector is the user's budget, without a margin.
    double measured_ms;
    bool certify; // a bound is wanted: prom_cut.bound
    uint32_t
        max_switches; // of what is shown, from one cut to the next (see last); 0: any number
    // Pixels of the accuracy tables for each of this view: the ratio of their pixels per
    // degree. 0 means 1.
    float table_px;
    const prom_visibility *visibility; // begun for this view; NULL: nothing hides anything
    prom_weighting weighting;
    prom_order order;
    unsigned priors; // prom_prior flags
    // For `meta`, `greedy`, `lagrange` and `incremental`: what a node was drawn by in the last
    // cut counts this part of the node's pixels more when things are ordered; NULL or 0: it
    // does not.
    const prom_last_cut *last;
    float hysteresis;
} prom_selection;

typedef struct prom_selector prom_selector;

typedef struct prom_selector_class {
    const char *name;    // as on the command line
    const char *summary; // one line
    bool budgeted;       // heeds budget_ms
    bool uses_cost;      // its cut depends on the cost model; else only predicted_ms does
    bool has_scale;      // it heeds rule_scale
    void *(*create)(const prom_model *model);
    void (*destroy)(void *state);
    void (*select)(void *state, const prom_selection *selection, prom_cut *cut);
} prom_selector_class;

#define PROM_SELECTOR_DEFAULT "greedy"

// All selectors, in the order of the help text.
size_t prom_selector_count(void);
const prom_selector_class *prom_selector_at(size_t i);
const prom_selector_class *prom_selector_class_named(const char *name); // NULL: unknown

// NULL with PROM_ERR_USAGE and the list of names when `name` is unknown. The model must outlive
// the selector.
prom_selector *prom_selector_create(const char *name, const prom_model *model,
                                    prom_error *error);
void prom_selector_destroy(prom_selector *selector);
// Fills *cut (its memory is reused; start with {0}, end with prom_cut_finish). Never allocates
// once the cut has grown to its size. The fixed part of predicted_ms holds the background
// layer. cut->cmin_ms is the cost of the cheapest cut of the nodes that the selector went over;
// `meta` starts from another one, and may be over a budget that this would keep.
void prom_selector_run(prom_selector *selector, const prom_selection *selection, prom_cut *cut);

// NULL if the cut holds exactly one entry on every root-to-leaf path whose leaf is in the
// frustum, and each representation belongs to its node's prototype; else a literal.
const char *prom_cut_check(const prom_model *model, const prom_view *view, const prom_cut *cut);

#endif
