#include "traverse/guarantee.h"

#include <assert.h>
#include <math.h>

#define TAIL 0.025 // of the confidence of 95 % on each side

// The probability of at most k of n at a rate of p in (k / n, 1): the terms fall from k on.
static double at_most(double k, double n, double p)
{
    double odds = (1 - p) / p;
    double term = exp(lgamma(n + 1) - lgamma(k + 1) - lgamma(n - k + 1) + k * log(p) +
                      (n - k) * log1p(-p));
    double sum = term;
    for (double i = k; i > 0; i--) {
        double next = term * odds * i / (n - i + 1);
        if (next < 1e-16 * sum) break;
        sum += term = next;
    }
    return sum;
}

// The rate at which at most k of n are as improbable as TAIL.
static double upper(double k, double n)
{
    if (k >= n) return 1.0;
    double low = k / n, high = 1.0;
    for (int i = 0; i < 60; i++) {
        double middle = (low + high) / 2;
        *(at_most(k, n, middle) > TAIL ? &low : &high) = middle;
    }
    return (low + high) / 2;
}

void prom_miss_interval(uint32_t misses, uint32_t frames, double *low, double *high)
{
    assert(misses <= frames);
    *high = upper(misses, frames);
    *low = 1.0 - upper((double)frames - misses, frames);
}
