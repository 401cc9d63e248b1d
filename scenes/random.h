// Deterministic random numbers of the city: SplitMix64 (Steele, Lea and Flood 2014).
#ifndef PROM_SCENES_RANDOM_H
#define PROM_SCENES_RANDOM_H

#include <stdint.h>

typedef struct prom_random {
    uint64_t state;
} prom_random;

static inline uint64_t prom_random_mix(uint64_t x)
{
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9u;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebu;
    return x ^ x >> 31;
}

static inline uint64_t prom_random_next(prom_random *r)
{
    return prom_random_mix(r->state += 0x9e3779b97f4a7c15u);
}

// A stream of its own for the thing number `index` of a `kind`.
static inline prom_random prom_random_stream(uint64_t seed, uint64_t kind, uint64_t index)
{
    prom_random r = {prom_random_mix(seed + 1) ^
                     prom_random_mix(kind * 0x9e3779b97f4a7c15u + 2)};
    r.state = prom_random_mix(r.state + index * 0xd1b54a32d192ed03u);
    return r;
}

// In [0, 1).
static inline float prom_random_unit(prom_random *r)
{
    return (float)(prom_random_next(r) >> 40) * 0x1p-24f;
}

static inline float prom_random_between(prom_random *r, float low, float high)
{
    return low + (high - low) * prom_random_unit(r);
}

// In [0, count); count above 0.
static inline uint32_t prom_random_below(prom_random *r, uint32_t count)
{
    return (uint32_t)(((prom_random_next(r) >> 32) * count) >> 32);
}

#endif
