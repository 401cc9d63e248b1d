// What FLIP's files share: filters and colours (flip_recipe.c), the loops over pixels
// (flip_loops.c), and the way through a picture (flip.c).
#ifndef PROM_BENEFIT_FLIP_PRIVATE_H
#define PROM_BENEFIT_FLIP_PRIVATE_H

#include <stddef.h>
#include <stdint.h>

// The greatest radius of a filter, that of Cz at PROM_PPD_MAX.
#define PROM_FLIP_RADIUS_MAX 136

// One direction of a filter: the tap for each distance from the centre, in pixels. Odd filters
// have the opposite one on the other side, the even ones the same on both.
typedef struct prom_flip_taps {
    int radius; // at least 1
    float at[PROM_FLIP_RADIUS_MAX + 1];
} prom_flip_taps;

typedef enum prom_flip_filter {
    PROM_FLIP_BLUR_Y, // contrast sensitivity of the three channels; that of Cz is a sum of two
    PROM_FLIP_BLUR_CX,
    PROM_FLIP_BLUR_CZ1,
    PROM_FLIP_BLUR_CZ2,
    PROM_FLIP_SMOOTH, // features: along an edge, across an edge (odd), across a line or point
    PROM_FLIP_EDGE,
    PROM_FLIP_POINT,
    PROM_FLIP_FILTERS
} prom_flip_filter;

// XYZ stand over their white; the opponent colours are y, x - y and y - z: YCxCz without its
// factors and its offset, which filters that sum to 1 pass on.
typedef struct prom_flip_recipe {
    float opponent_of_rgb[3][3], rgb_of_opponent[3][3], xyz_of_rgb[3][3]; // of linear RGB
    prom_flip_taps taps[PROM_FLIP_FILTERS];
    uint32_t pad; // the greatest radius
} prom_flip_recipe;

// ppd: from PROM_PPD_MIN to PROM_PPD_MAX.
void prom_flip_recipe_init(prom_flip_recipe *recipe, double ppd);

// The features of a picture: a plane each for the filtered colour in Lab, its chroma less where
// it is dark, and for the strength of edges and of points.
enum { PROM_FLIP_L, PROM_FLIP_A, PROM_FLIP_B, PROM_FLIP_EDGES, PROM_FLIP_POINTS };
enum { PROM_FLIP_PLANES = 5 };

// Loops over `count` values. Where they are vectors there are no odd ones at the end: all but
// the last loop go on to the next multiple of PROM_FLIP_LANES, and have the memory for it.
#define PROM_FLIP_LANES 16

typedef struct prom_flip_loops {
    void (*opponents)(const prom_flip_recipe *recipe, const float *const rgb[3], size_t count,
                      float *const opponent[3]);
    // An even filter; the next value in its direction is `step` floats away.
    void (*even)(const prom_flip_taps *taps, const float *in, ptrdiff_t step, size_t count,
                 float *out);
    // An even and an odd filter of one radius.
    void (*both)(const prom_flip_taps *even, const prom_flip_taps *odd, const float *in,
                 ptrdiff_t step, size_t count, float *out_even, float *out_odd);
    // hypot(a, b); out may be a or b.
    void (*lengths)(const float *a, const float *b, size_t count, float *out);
    // Filtered opponent colours, the last one as two summands; lab may be the first three.
    void (*colours)(const prom_flip_recipe *recipe, const float *const opponent[4],
                    size_t count, float *const lab[3]);
    // Errors from the features of two pictures.
    void (*errors)(const float *const a[PROM_FLIP_PLANES],
                   const float *const b[PROM_FLIP_PLANES], size_t count, float *map);
} prom_flip_loops;

// Those that the processor at hand can run, the fastest first; NULL past the last.
const prom_flip_loops *prom_flip_loops_at(size_t i);

#endif
