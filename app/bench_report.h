// What a bench found, as JSON, as CSV and as a few lines of text.
#ifndef PROM_APP_BENCH_REPORT_H
#define PROM_APP_BENCH_REPORT_H

#include "app/frame_loop.h"
#include "app/output.h"

typedef struct prom_run_facts {
    const prom_session *session;
    const prom_loop_options *options;
    const prom_loop_result *result;
    const char *scene, *path; // as given on the command line
} prom_run_facts;

// {"runs": [{...}]}; docs/FORMAT.md and `promenade bench --help` name the keys.
json_t *prom_bench_json(const prom_run_facts *facts);
// One row a frame, units in the header.
prom_status prom_bench_write_csv(const char *path, const prom_loop_options *options,
                                 const prom_loop_result *result, prom_error *error);
void prom_bench_print(const prom_run_facts *facts);

#endif
