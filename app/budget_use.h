// How frames kept to their budget: misses, what they used of it, and how even they were; over
// all frames of a run, its quarters, and where the choice of the cut was what mattered.
#ifndef PROM_APP_BUDGET_USE_H
#define PROM_APP_BUDGET_USE_H

#include "app/frame_loop.h"
#include "app/statistics.h"

typedef struct prom_budget_use {
    uint32_t frames;                       // 0: all below is 0
    uint32_t misses, longest_run;          // frames above the budget; the longest run of them
    double miss_rate, rate_low, rate_high; // with the interval of prom_miss_interval
    prom_spread frame_ms;
    double use;                    // mean frame time / budget
    double overshoot;              // mean over the misses of frame time / budget - 1
    double change_std, change_p99; // of the ms from one frame to the next, either way
} prom_budget_use;

typedef bool prom_frame_wanted(const prom_frame_record *record);
// The choice mattered: full detail was predicted at more than could be spent, and the cheapest
// cut was expected to fit into the budget less the noise that the device was calibrated at. Not
// the guarantee's margin: a wide one must not take the frames away that it is to be judged by.
prom_frame_wanted prom_is_contested;

// Over the wanted ones of `count` frames in a row; wanted: NULL takes all. A run, and a change,
// is of neighbours that are both wanted.
prom_budget_use prom_budget_use_of(const prom_frame_record *records, size_t count,
                                   double budget_ms, prom_frame_wanted *wanted);

// Of the normalised gap (traverse/bound.h).
typedef struct prom_gap_report {
    uint32_t frames; // where it was known
    prom_spread share;
} prom_gap_report;

enum { PROM_QUARTERS = 4, PROM_TURN_FRAMES = 100 };

typedef struct prom_budget_report {
    prom_budget_use all, contested, cold;
    uint32_t quarter_misses[PROM_QUARTERS], quarter_frames[PROM_QUARTERS];
    uint32_t limited_frames;
    uint32_t turns, most_after_turn;    // misses in the PROM_TURN_FRAMES frames from a turn on
    double scale, margin;               // means
    prom_gap_report gap, contested_gap; // 0 by definition where the cheapest cut is too dear
    uint32_t floor_draws;               // 0: not asked for
    prom_spread floor_ms;
    double use_of_floor, std_of_floor; // contested use / the floor's mean/p99; ratio of the
                                       // stds. NAN without the one or the other
    uint64_t cuts_hash;                // of the frames' hashes
} prom_budget_report;

// The run must have a frame.
prom_budget_report prom_budget_report_of(const prom_loop_result *result, double budget_ms);

#endif
