#include "traverse/term_factors.h"

#include <math.h>

// How far off a term is thought to be before anything is known (standard deviation of the
// logarithm), and what part of that doubt comes back with each frame, because scenes differ
// from place to place. By simulation (tests/bench/bench_guarantee.c).
#define PRIOR_DOUBT 0.3
#define RETURN_OF_DOUBT 1e-3

static double prior(int i, int j)
{
    return i == j ? PRIOR_DOUBT * PRIOR_DOUBT : 0.0;
}

void prom_term_factors_init(prom_term_factors *f)
{
    for (int i = 0; i < PROM_TERMS; i++) {
        f->factors[i] = 1.0;
        for (int j = 0; j < PROM_TERMS; j++) f->doubt[i][j] = prior(i, j);
    }
}

// A mean with the prior stays a covariance, and below the prior.
static void doubt_again(prom_term_factors *f)
{
    for (int i = 0; i < PROM_TERMS; i++)
        for (int j = 0; j < PROM_TERMS; j++)
            f->doubt[i][j] += RETURN_OF_DOUBT * (prior(i, j) - f->doubt[i][j]);
}

void prom_term_factors_learn(prom_term_factors *f, const double more[PROM_TERMS], double error,
                             double noise)
{
    double spread[PROM_TERMS] = {0}, variance = noise * noise;
    for (int i = 0; i < PROM_TERMS; i++) {
        for (int j = 0; j < PROM_TERMS; j++) spread[i] += f->doubt[i][j] * more[j];
        variance += more[i] * spread[i];
    }
    for (int i = 0; i < PROM_TERMS; i++) {
        double factor = f->factors[i] * exp(spread[i] / variance * error);
        f->factors[i] = fmin(fmax(factor, PROM_FACTOR_MIN), PROM_FACTOR_MAX);
        for (int j = 0; j < PROM_TERMS; j++) f->doubt[i][j] -= spread[i] * spread[j] / variance;
    }
    doubt_again(f);
}
