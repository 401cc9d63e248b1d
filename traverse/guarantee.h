// The guarantee: keeps the share of frames over the budget at what the user accepts, without
// keeping back more of the budget than that takes.
//
//   prom_guarantee_init; for every frame: select with prom_guarantee_cost and
//   prom_guarantee_allowed, draw, prom_guarantee_feed
//
// Predictions are corrected by a fast global scale (what the machine does just now) and slow
// factors of the terms (what this scene is like on this device), both bounded. What is left is
// the score of a frame, actual - expected as a part of the budget, in which other_ms beyond the
// charge counts as drawing. The margin covers the quantile of the recent scores and, on top, as
// much as the misses beyond the accepted ones ask for: the proportional and the integral part
// of a conformal controller (Gibbs and Candès 2021, Adaptive conformal inference under
// distribution shift; Angelopoulos, Candès and Tibshirani 2023, Conformal PID control for time
// series prediction). Only frames predicted at nearly the budget move it. Plain numbers in and
// out, no clock.
#ifndef PROM_TRAVERSE_GUARANTEE_H
#define PROM_TRAVERSE_GUARANTEE_H

#include "metaobj/cut.h"
#include "traverse/cost.h"
#include "traverse/term_factors.h"

#include <stdbool.h>
#include <stdint.h>

#define PROM_MISS_RATE 0.01 // accepted unless the user says otherwise

typedef struct prom_guarantee_options {
    double budget_ms;
    double miss_rate; // accepted share of frames over the budget, in [0.001, 0.5]
    // Nothing is learnt: the same frames give the same cuts, however long they took. The
    // margin stays that of the cost model.
    bool frozen;
} prom_guarantee_options;

enum { PROM_GUARANTEE_SCORES = 512, PROM_GUARANTEE_FAST = 21 };

typedef struct prom_guarantee {
    prom_guarantee_options options;
    prom_cost_model device, cost; // as calibrated; with the factors of the terms
    prom_term_factors terms;
    double scale;     // fast: actual / predicted of the last frames
    double margin;    // part of the budget kept back for noise
    double charge_ms; // of the budget, for what is not drawn: selection and the like
    double extra_ms;  // what the next frame draws besides its cut
    uint64_t frames;  // fed so far
    // More state belongs to guarantee.c.
    struct {
        double terms_ms[PROM_TERMS]; // as the device's model predicts them
        double draw_ms;
    } fast[PROM_GUARANTEE_FAST]; // the last frames, a ring
    unsigned window;             // of them since the machine last changed its pace
    // +-n: so many frames were slower (+) or quicker than expected in a row; by far.
    int side_run, far_run;
    // Of the frames that move the margin, a ring.
    float scores[PROM_GUARANTEE_SCORES];
    uint64_t scored; // of them so far
    double pending;  // the last score, not among them yet; or NAN
    double quantile; // of the recent ones
    double excess;   // misses beyond the accepted ones, at least 0
} prom_guarantee;

// cost: the device's model, copied.
void prom_guarantee_init(prom_guarantee *guarantee, const prom_cost_model *cost,
                         const prom_guarantee_options *options);
// The cost model to select with: the device's with the factors of the terms.
const prom_cost_model *prom_guarantee_cost(const prom_guarantee *guarantee);
// What a cut may be predicted at by that model.
double prom_guarantee_allowed(const prom_guarantee *guarantee);
// What drawing a cut that the model predicts at predicted_ms is expected to take.
double prom_guarantee_expected(const prom_guarantee *guarantee, double predicted_ms);
// The least budget with which a cut predicted at predicted_ms would be allowed.
double prom_guarantee_least_budget(const prom_guarantee *guarantee, double predicted_ms);
// What the next frames are known to take besides their cuts: it is neither scaled nor learnt
// from.
void prom_guarantee_set_extra(prom_guarantee *guarantee, double extra_ms);
// The budget from now on; what has been learnt stays.
void prom_guarantee_set_budget(prom_guarantee *guarantee, double budget_ms);

typedef struct prom_guarantee_frame {
    double terms_ms[PROM_TERMS]; // of the cut, predicted by prom_guarantee_cost
    double draw_ms;              // measured
    double other_ms;             // selection, uploads, display: measured, charged to the budget
    // Not one of the run: the budget was another (at rest), or something disturbed it that will
    // not come again. The scale learns from it, the margin does not.
    bool aside;
} prom_guarantee_frame;
void prom_guarantee_feed(prom_guarantee *guarantee, const prom_guarantee_frame *frame);

// The interval that holds the true rate of `misses` in `frames` independent frames with a
// confidence of 95 % (Clopper and Pearson 1934).
void prom_miss_interval(uint32_t misses, uint32_t frames, double *low, double *high);

#endif
