#include "traverse/guarantee.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#define SCALE_MIN 0.1
#define SCALE_MAX 10.0
#define MARGIN_MAX 0.75

// Frames predicted at less of what is allowed say nothing about the margin (DESIGN 6).
#define NEAR_BUDGET 0.9
// Before so many frames the scale is not known, and what it misses is no noise.
#define COLD_FRAMES 3
// A frame further from the expected time than the margin, and than this, is an outlier.
#define OUTLIER 0.1
// So many frames on one side of what is expected happen by chance once in 60 or so; then the
// scale follows them alone. By simulation, like the length of its window: shorter ones
// stray more, longer ones lag behind.
#define SIDE_RUN 6

// A miss more than accepted adds EXCESS_STEP of the quantile (or of QUANTILE_LEAST) to it, two
// 3, three 7 times that, and no more are counted, so that the margin comes back once the cause
// is gone. By simulation (tests/bench/bench_guarantee.c).
#define EXCESS_STEP 0.15
#define EXCESS_MAX 3.0
#define QUANTILE_LEAST 0.1
// A score beyond the margin counts for no more than this times it.
#define OUTLIER_SCORE 1.5
// Of a few scores the second largest, which no single stall sets, falls short of their
// quantile: of 35 normal ones, p99 is 1.45 times as far out.
#define FEW_SCORES 1.45

// Charges follow a slow frame more than a quick one.
#define CHARGE_UP 0.6
#define CHARGE_DOWN 0.3

static double sum_of(const double terms[PROM_TERMS])
{
    double sum = 0.0;
    for (int k = 0; k < PROM_TERMS; k++) sum += terms[k];
    return sum;
}

static int by_value(const void *a, const void *b)
{
    float x = *(const float *)a, y = *(const float *)b;
    return (x > y) - (x < y);
}

// ---- the scale

// The k-th frame back, 0 being the last.
static size_t fast_at(const prom_guarantee *g, unsigned k)
{
    return (g->frames - 1 - k) % PROM_GUARANTEE_FAST;
}

// What that frame would be predicted at now.
static void predicted_terms(const prom_guarantee *g, unsigned k, double terms[PROM_TERMS])
{
    for (int t = 0; t < PROM_TERMS; t++)
        terms[t] = g->fast[fast_at(g, k)].terms_ms[t] * g->terms.factors[t];
}

// A median and no mean: a single stalled frame (the scheduler gives the core away for some
// milliseconds, about every fifteenth frame on a shared machine) must not make the next ones
// poor. Of two the greater.
static double scale_of_window(const prom_guarantee *g)
{
    float ratios[PROM_GUARANTEE_FAST];
    for (unsigned k = 0; k < g->window; k++) {
        double terms[PROM_TERMS];
        predicted_terms(g, k, terms);
        ratios[k] = (float)(g->fast[fast_at(g, k)].draw_ms / sum_of(terms));
    }
    qsort(ratios, g->window, sizeof *ratios, by_value);
    return fmin(fmax((double)ratios[g->window / 2], SCALE_MIN), SCALE_MAX);
}

// +-n: the last n frames were all on this side of what is usual.
static int lengthened(int run, bool above, bool below)
{
    if (above) return run > 0 ? run + 1 : 1;
    if (below) return run < 0 ? run - 1 : -1;
    return 0;
}

// Two frames in a row that are far too slow, or far too quick, are no noise but another pace of
// the machine: what was before them is forgotten.
static bool changes_pace(prom_guarantee *g, double error)
{
    double limit = fmax(-log1p(-g->margin), OUTLIER);
    g->far_run = lengthened(g->far_run, error > limit, error < -limit);
    g->side_run = lengthened(g->side_run, error > 0, error < 0);
    return abs(g->far_run) >= 2;
}

static void follow(prom_guarantee *g, const prom_guarantee_frame *frame, bool changes)
{
    size_t i = g->frames++ % PROM_GUARANTEE_FAST;
    g->fast[i].draw_ms = frame->draw_ms;
    for (int t = 0; t < PROM_TERMS; t++)
        g->fast[i].terms_ms[t] = frame->terms_ms[t] / g->terms.factors[t];
    unsigned most = changes ? 2 : abs(g->side_run) >= SIDE_RUN ? SIDE_RUN : PROM_GUARANTEE_FAST;
    g->window = g->window < most ? g->window + 1 : most;
}

// ---- the terms

static void learn_terms(prom_guarantee *g, const double terms_ms[PROM_TERMS], double error)
{
    double more[PROM_TERMS], total = sum_of(terms_ms);
    for (int t = 0; t < PROM_TERMS; t++) more[t] = terms_ms[t] / total;
    for (unsigned k = 0; k < g->window; k++) {
        double around[PROM_TERMS];
        predicted_terms(g, k, around);
        for (int t = 0; t < PROM_TERMS; t++) more[t] -= around[t] / sum_of(around) / g->window;
    }
    double noise = fmax(g->quantile, QUANTILE_LEAST) / 2;
    double usual = fmin(fmax(error, -3 * noise), 3 * noise); // a stall is no news of the scene
    prom_term_factors_learn(&g->terms, more, usual, noise);
    g->cost = prom_cost_scaled(&g->device, g->terms.factors);
}

// ---- the margin

// So many recent scores say what the quantile is: three beyond it.
static size_t memory(const prom_guarantee *g)
{
    double wanted = 3.0 / g->options.miss_rate;
    return (size_t)fmin(fmax(wanted, 64.0), PROM_GUARANTEE_SCORES);
}

// The quantile that a further score exceeds with the accepted probability (Vovk et al. 2005;
// Angelopoulos and Bates 2021, section 1), the calibration's until enough scores are known.
static double quantile_of_scores(const prom_guarantee *g)
{
    double prior = g->device.margin, rate = g->options.miss_rate;
    size_t limit = memory(g), count = g->scored < limit ? (size_t)g->scored : limit;
    if (!count) return prior;
    float sorted[PROM_GUARANTEE_SCORES];
    for (size_t i = 0; i < count; i++)
        sorted[i] = g->scores[(g->scored - 1 - i) % PROM_GUARANTEE_SCORES];
    qsort(sorted, count, sizeof *sorted, by_value);
    // Never the largest of all: a single stall is what the accepted misses are for.
    size_t from_top = (size_t)fmax((double)(count + 1) * rate, 2.0);
    double second = (double)sorted[count > 1 ? count - 2 : 0];
    double seen = from_top < count ? (double)sorted[count - from_top] : second;
    double known = fmin(1.0, (double)count / fmin(1 / rate, (double)limit));
    return known * seen + (1 - known) * fmax(prior, FEW_SCORES * second);
}

// The median of n frames strays by sqrt(pi / 2n) of their noise: right after a change of pace
// the margin is wider by that.
static double widening(const prom_guarantee *g)
{
    double now = 1 + M_PI_2 / fmax(g->window, 1), usual = 1 + M_PI_2 / PROM_GUARANTEE_FAST;
    return sqrt(now / usual);
}

static void set_margin(prom_guarantee *g)
{
    g->quantile = fmax(quantile_of_scores(g), 0.0);
    double step = EXCESS_STEP * fmax(g->quantile, QUANTILE_LEAST);
    g->margin = fmin(g->quantile * widening(g) + step * (exp2(g->excess) - 1), MARGIN_MAX);
}

// A score is noise only if the next frame does not show that the pace changed: that is the
// scale's to answer. One far beyond the margin counts as one a bit beyond, lest a single stall
// sets the margin while few scores are known.
static void note_score(prom_guarantee *g, double score, bool noise)
{
    if (!noise) {
        g->pending = NAN;
        return;
    }
    if (!isnan(g->pending)) g->scores[g->scored++ % PROM_GUARANTEE_SCORES] = (float)g->pending;
    g->pending = fmin(score, OUTLIER_SCORE * fmax(g->margin, QUANTILE_LEAST));
}

// Where the pace changes so often that its misses are no longer counted, changes are noise too.
static void take_score(prom_guarantee *g, double score, bool changes)
{
    double miss = score > g->margin ? 1.0 : 0.0;
    double excess = g->excess + miss - g->options.miss_rate;
    g->excess = fmin(fmax(excess, 0.0), EXCESS_MAX);
    note_score(g, score, !changes || excess >= EXCESS_MAX);
}

// ---- the interface

void prom_guarantee_init(prom_guarantee *g, const prom_cost_model *cost,
                         const prom_guarantee_options *options)
{
    assert(options->miss_rate > 0.0 && options->miss_rate < 1.0);
    *g = (prom_guarantee){
        .options = *options, .device = *cost, .cost = *cost, .scale = 1.0, .pending = NAN};
    g->device.margin = cost->margin >= 0.0 ? fmin(cost->margin, MARGIN_MAX) : 0.0;
    prom_term_factors_init(&g->terms);
    if (options->frozen) {
        g->margin = g->device.margin;
        return;
    }
    g->excess = 1.0; // begins as if it had just missed
    set_margin(g);
}

const prom_cost_model *prom_guarantee_cost(const prom_guarantee *g)
{
    return &g->cost;
}

double prom_guarantee_allowed(const prom_guarantee *g)
{
    double left = g->options.budget_ms - g->charge_ms;
    return fmax(left * (1.0 - g->margin) - g->extra_ms, 0.0) / g->scale;
}

double prom_guarantee_expected(const prom_guarantee *g, double predicted_ms)
{
    return g->scale * predicted_ms + g->extra_ms;
}

double prom_guarantee_least_budget(const prom_guarantee *g, double predicted_ms)
{
    return (predicted_ms * g->scale + g->extra_ms) / (1.0 - g->margin) + g->charge_ms;
}

void prom_guarantee_set_extra(prom_guarantee *g, double extra_ms)
{
    g->extra_ms = fmax(extra_ms, 0.0);
}

void prom_guarantee_set_budget(prom_guarantee *g, double budget_ms)
{
    g->options.budget_ms = budget_ms;
}

// frame: without what was known to be besides the cut.
static void learn(prom_guarantee *g, const prom_guarantee_frame *frame, double predicted)
{
    double expected = g->scale * predicted;
    double over = frame->draw_ms + frame->other_ms - g->charge_ms - expected;
    // A frame that had to take more than there is tells what would do for it.
    double left = fmax(g->options.budget_ms - g->charge_ms, expected);
    bool near_budget = predicted >= NEAR_BUDGET * prom_guarantee_allowed(g);
    bool known = g->frames >= COLD_FRAMES;
    double error = log(frame->draw_ms / expected);
    bool changes = changes_pace(g, error);
    if (known && !changes) learn_terms(g, frame->terms_ms, error);
    follow(g, frame, changes);
    if (known && near_budget && !frame->aside) take_score(g, over / left, changes);
    g->scale = scale_of_window(g);
    set_margin(g);
}

void prom_guarantee_feed(prom_guarantee *g, const prom_guarantee_frame *frame)
{
    if (g->options.frozen) return;
    double predicted = sum_of(frame->terms_ms), other = frame->other_ms;
    bool sound = predicted > 0.0 && isfinite(predicted) && frame->draw_ms > 0.0 &&
                 isfinite(frame->draw_ms) && isfinite(other) && other >= 0.0;
    if (!sound) return;
    prom_guarantee_frame cut_only = *frame;
    cut_only.draw_ms = fmax(frame->draw_ms - g->extra_ms, 0.1 * frame->draw_ms);
    learn(g, &cut_only, predicted);
    g->charge_ms += (other > g->charge_ms ? CHARGE_UP : CHARGE_DOWN) * (other - g->charge_ms);
}
