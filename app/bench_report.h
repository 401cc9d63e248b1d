// What a bench found, as JSON, as CSV and as a few lines of text.
#ifndef PROM_APP_BENCH_REPORT_H
#define PROM_APP_BENCH_REPORT_H

#include "app/frame_loop.h"
#include "app/oracle.h"
#include "app/output.h"
#include "app/swap_test.h"

typedef struct prom_run_facts {
    const prom_session *session;
    const prom_loop_options *options;
    const prom_loop_result *result;
    const prom_swap_result *swap; // NULL: not asked for
    const prom_oracle_result *oracle;
    const char *scene, *path; // as given on the command line
} prom_run_facts;

// {"runs": [{...}]}, one object a run:
//   scene, path, frames, warmup_frames, resolution, budget_ms, selector, device, program: what
//     was run and where
//   frame_ms and how the frames kept to the budget: see app/guarantee_report.h
//   weights, order (`--benefit`), hysteresis, max_switches: as the cuts were chosen
//   select_ms: mean, p99
//   triangles, draws, cut_nodes, benefit, loss (pixels times weights): means over the frames
//   switches: mean of the nodes that a frame shows by something else than the frame before; px:
//     of the pixels that these show
//   predict: mape, worst_under; of the drawing time
//   infeasible_frames: where even the cheapest cut was predicted above the budget;
//     least_budget_ms: what would have done, or null
//   holes: frames, mean, max, as a share of the covered pixels; null if not asked for
//   accuracy: frames, mean, min of the pictures; predicted: the mean that the selector expected
//     of the same frames; null if not asked for
//   popping: frames, and means over them: flip, floor, popping (their difference), valid_share,
//     see app/popping.h; null if not asked for
//   swap: see app/swap_report.h; oracle: see app/oracle.h; null if not asked for
//   start_s, calibration_s, memory_mb: start, end
json_t *prom_bench_json(const prom_run_facts *facts);
void prom_bench_print(const prom_run_facts *facts);

#endif
