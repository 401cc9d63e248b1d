// Statistics of the frames of a run.
#ifndef PROM_APP_STATISTICS_H
#define PROM_APP_STATISTICS_H

#include "app/frame_loop.h"

typedef struct prom_spread {
    double mean, p50, p95, p99, p999, max; // percentiles by nearest rank
    double std;                            // of the population
} prom_spread;

typedef struct prom_run_statistics {
    prom_spread select_ms, predicted_ms;
    double resolution; // mean scale that the pictures were drawn at
    double triangles, draws, cut_nodes, benefit_px, loss_px; // means
    double switches, switched_px;                            // means, see prom_switches
    double mape, worst_under; // of predicted_ms: mean |p/a - 1|, greatest a/p - 1
    // Of the frames compared with full detail; 0 where there is none.
    uint32_t hole_frames, accuracy_frames, quality_frames;
    double holes_mean, holes_max;
    double accuracy_mean, accuracy_min;
    double predicted_accuracy; // mean of the same frames: benefit / (benefit + loss)
    prom_spread flip;          // of the frames' means
    double loss_share, hidden_cost, hidden_nodes; // means, see prom_difference
    uint32_t popping_frames;                      // 0: not looked for
    prom_popped popped;                           // means
} prom_run_statistics;

// values: count >= 1 of them; sorted on return.
prom_spread prom_spread_of(double *values, size_t count);
// Spearman's rank correlation of x and y, ties by mid-ranks, in [-1,1]; NAN with less than two
// values, or where all of x or all of y are equal.
double prom_spearman(const double *x, const double *y, size_t count);
// The s of y = s * x by least squares; NAN where all of x are 0.
double prom_slope(const double *x, const double *y, size_t count);
// The accuracy that the selector expected of a frame: benefit / (benefit + loss), 1 where
// nothing is in view.
double prom_predicted_accuracy(const prom_frame_record *record);
// records: count >= 1.
prom_run_statistics prom_run_statistics_of(const prom_frame_record *records, size_t count);

#endif
