// Pictures worked on in bands of rows, by one thread or by all cores. What is made of a band
// stays in the cache from one filter to the next.
#ifndef PROM_BENEFIT_BANDS_H
#define PROM_BENEFIT_BANDS_H

#include <stddef.h>
#include <stdint.h>

#define PROM_BAND_ROWS 32

typedef struct prom_bands prom_bands;

// Rows [first, last) of a picture, at most PROM_BAND_ROWS of them. scratch: working memory, of
// no known content.
typedef void prom_band_body(void *user, uint32_t first, uint32_t last, void *scratch);

// threads: 1, or all cores. scratch_bytes: working memory of each. Nothing is allocated later.
prom_bands *prom_bands_create(unsigned threads, size_t scratch_bytes);
void prom_bands_destroy(prom_bands *bands); // NULL is allowed

// Calls the body for bands that make up [0, height), in no given order; returns when all are
// done.
void prom_bands_run(prom_bands *bands, uint32_t height, prom_band_body *body, void *user);

#endif
