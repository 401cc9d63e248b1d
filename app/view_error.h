// How a look at an object differs from its true look, as a builder measures it: at a size, over
// two backgrounds.
#ifndef PROM_APP_VIEW_ERROR_H
#define PROM_APP_VIEW_ERROR_H

#include "builder/views.h"
#include "metaobj/model.h"

#include <stdbool.h>

typedef struct prom_view_error prom_view_error;

// size_px: PROM_VIEW_LARGE_PX at most; from PROM_VIEW_PX on, only of the directions, and of
// views, that have large ones. Smaller pictures are area averages of the views.
prom_view_error *prom_view_error_create(const prom_measured *measured, float size_px);
void prom_view_error_destroy(prom_view_error *error); // NULL is allowed
// Pixels along a side of the pictures.
uint32_t prom_view_error_side(const prom_view_error *error);
// The metric: the model's, or `flip` where this program does not know that (`constant`).
const char *prom_view_error_metric(const prom_view_error *error);

// Sets the true look, from direction bin `dir`. rgb: side * side pixels of its picture over the
// first background; NULL: not wanted.
void prom_view_error_set_truth(prom_view_error *error, const prom_views *views, uint32_t dir,
                               uint8_t (*rgb)[3]);
// Compares another look from the same direction: its picture, the error of each of its pixels,
// and returned, the accuracy (benefit/accuracy.h), the mean of both backgrounds.
// *vetoed: whether a part of it is so wrong that the accuracy counts as 0 of 255.
double prom_view_error_run(prom_view_error *error, const prom_views *views, uint32_t dir,
                           uint8_t (*rgb)[3], float *map, bool *vetoed);

#endif
