// Views at rest, for trying out cuts: the cut that the selector chooses once what frames show
// of each other has settled, within a budget that no feedback changes, so that every run comes
// to the same ones; and the evaluation of the whole tree in that view.
#ifndef PROM_APP_STILL_H
#define PROM_APP_STILL_H

#include "app/sight.h"
#include "traverse/evaluate.h"

typedef struct prom_still_options {
    const char *selector;
    double budget_ms, rule_scale;
    uint32_t path_frames; // that the views are chosen from
    uint32_t views;       // evenly spaced; 0: none
} prom_still_options;

typedef struct prom_still {
    prom_session *session;
    const prom_still_options *options;
    prom_selector *selector;
    prom_sight sight;
    double allowed_ms; // what a cut may be predicted at
    uint32_t count;    // views
    // Of the last view.
    uint32_t frame; // of the path
    prom_camera camera;
    prom_view view;
    prom_selection selection;
    prom_eval eval; // down to the leaves
    prom_cut cut;   // its entries' accuracies are those of the tables, also where nothing shows
} prom_still;

// Session and options must outlive it. On failure there is nothing to finish.
prom_status prom_still_init(prom_still *still, prom_session *session,
                            const prom_still_options *options, prom_error *error);
void prom_still_finish(prom_still *still);
// Goes to view i < still->count, in the middle of the i-th part of the path.
void prom_still_look(prom_still *still, uint32_t i);

#endif
