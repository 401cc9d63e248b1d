// Slow factors on the terms of a frame's cost: what this scene is like on this device, where
// the calibration did not know it.
//
// A Kalman filter on the logarithms of the factors. What a frame took beyond the fast scale is
// laid at the terms that it has more of than the frames around it: what all frames share is the
// scale's to learn, so that the two never fight, and a frame with the usual mix teaches
// nothing.
#ifndef PROM_TRAVERSE_TERM_FACTORS_H
#define PROM_TRAVERSE_TERM_FACTORS_H

#include "metaobj/cost_features.h"

#define PROM_FACTOR_MIN 0.5
#define PROM_FACTOR_MAX 2.0

typedef struct prom_term_factors {
    double factors[PROM_TERMS];           // in [PROM_FACTOR_MIN, PROM_FACTOR_MAX]
    double doubt[PROM_TERMS][PROM_TERMS]; // covariance of their logarithms
} prom_term_factors;

void prom_term_factors_init(prom_term_factors *factors);
// more: what part of the frame each term is, less the same of the frames around it (sums to 0).
// error: ln(actual / expected) of the frame; noise: its usual standard deviation, above 0.
void prom_term_factors_learn(prom_term_factors *factors, const double more[PROM_TERMS],
                             double error, double noise);

#endif
