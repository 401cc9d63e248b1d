// What the metrics on greys have in common.
#ifndef PROM_BENEFIT_GREY_H
#define PROM_BENEFIT_GREY_H

#include "benefit/metric.h"

// Luma of a row: 0.2126 R + 0.7152 G + 0.0722 B (Rec. 709) of the values as they are stored:
// bytes / 255, floats as they are. `width` floats.
void prom_grey_row(const prom_picture *picture, uint32_t y, float *row);

#endif
