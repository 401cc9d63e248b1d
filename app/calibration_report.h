// What a calibration came to: the fit, and its residuals by sample, as text, table, plot and
// JSON.
#ifndef PROM_APP_CALIBRATION_REPORT_H
#define PROM_APP_CALIBRATION_REPORT_H

#include "metaobj/base/status.h"
#include "metaobj/cost_features.h"
#include "traverse/cost.h"

#include <jansson.h>
#include <stdbool.h>

typedef struct prom_calibration_report {
    const prom_cost_model *model;
    const prom_cost_samples *samples; // that it was fitted to
    bool queries;                     // the clock was the device's timer
    double seconds;
    // What the model's form predicts of each sample when fitted to others only.
    double *held_out_ms;
    double form_errors[PROM_COST_FORMS]; // mean |predicted/measured - 1| so, of either form
} prom_calibration_report;

// model and samples must outlive the report.
void prom_calibration_report_init(prom_calibration_report *report, const prom_cost_model *model,
                                  const prom_cost_samples *samples);
void prom_calibration_report_finish(prom_calibration_report *report);

// Coefficients with their units, errors in all and by what the samples draw.
void prom_calibration_print(const prom_calibration_report *report);
json_t *prom_calibration_json(const prom_calibration_report *report);
// A row for each sample: its features, measured and predicted time.
prom_status prom_calibration_write_residuals(const prom_calibration_report *report,
                                             const char *path, prom_error *error);
// SVG, predicted against measured.
prom_status prom_calibration_write_plot(const prom_calibration_report *report, const char *path,
                                        prom_error *error);

#endif
