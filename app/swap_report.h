// What the swap test found, as JSON, CSV, a plot and a few lines of text.
#ifndef PROM_APP_SWAP_REPORT_H
#define PROM_APP_SWAP_REPORT_H

#include "app/output.h"
#include "app/swap_test.h"

// frames, swaps, least_px; spearman (predicted against measured, ties by mid-ranks), slope
// (measured over predicted, least squares through the origin), spearman_selector (the same with
// the pixels that the selector believed in); kinds, by what was swapped in: mesh, average-box,
// textured-box, open, and nodes: leaf, cluster, each with swaps, spearman, slope and
// spearman_selector. null where there are too few.
json_t *prom_swap_json(const prom_swap_result *result);
// A row a swap: frame, node, its name, kinds and levels, and its pixels.
prom_status prom_swap_write_csv(const char *path, const prom_model *model,
                                const prom_swap_result *result, prom_error *error);
// Predicted against measured, as SVG. scene: for the title.
prom_status prom_swap_write_plot(const char *path, const char *scene,
                                 const prom_swap_result *result, prom_error *error);
void prom_swap_print(const prom_swap_result *result);

#endif
