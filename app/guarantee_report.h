// How a bench kept to its budget, as JSON and as a few lines of text.
#ifndef PROM_APP_GUARANTEE_REPORT_H
#define PROM_APP_GUARANTEE_REPORT_H

#include "app/bench_report.h"
#include "app/budget_use.h"

// Adds to a run's object:
//   frame_ms: mean, p50, p95, p99, p999, max, std; change_ms: std, p99, of what a frame took
//     more or less than the one before
//   miss_rate: of the frames above the budget; miss_rate_wanted: what was accepted
//   misses: count, longest_run, rate_low and rate_high (95 % interval of the rate), quarters
//     (of the run: count in each), overshoot: mean of frame time / budget - 1
//   use_of_budget: mean frame time / budget
//   contested: of the frames where full detail was predicted to exceed the budget and the
//     cheapest cut to fit, with the calibration's margin: frames, use_of_budget, std_ms, and misses as
//     above but quarters
//   cold_start: the same of the first 30 frames drawn, warm-up included
//   after_turn: turns (the camera turned by more than 30 degrees in a frame, or jumped),
//     most_misses in the 100 frames from one on
//   guarantee: frozen (with a profile), mean scale and margin
//   gap, and contested.gap: frames, mean, p50, p99, see traverse/bound.h; null where no bound
//     was known; 0 by definition where the cheapest cut is too dear
//   limited_frames: where more time would have bought a better picture
//   noise_floor: draws, frame (of the path), target_ms, chosen_ms, mean, p50, p95, p99, std,
//     mean_of_p99; use_of_floor: contested use_of_budget / mean_of_p99; std_of_floor: contested
//     std_ms / std; null if not asked for
//   cuts_hash: of every frame's nodes and representations, 16 hexadecimal digits
void prom_guarantee_add_json(json_t *run, const prom_run_facts *facts,
                             const prom_budget_report *report);
void prom_guarantee_print(const prom_run_facts *facts, const prom_budget_report *report);

#endif
