// The frames of a bench as CSV.
#ifndef PROM_APP_BENCH_CSV_H
#define PROM_APP_BENCH_CSV_H

#include "app/frame_loop.h"

// One row a frame, units in the header. Empty where something is not known: the gap without a
// bound; holes, accuracy, flip, loss and hidden shares where a frame was not compared.
// start_unix_s: when the frame began, in seconds since 1970.
prom_status prom_bench_write_csv(const char *path, const prom_loop_options *options,
                                 const prom_loop_result *result, prom_error *error);

#endif
