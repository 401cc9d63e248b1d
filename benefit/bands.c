#include "benefit/bands.h"

#include "metaobj/base/alloc.h"
#include "metaobj/base/threads.h"

struct prom_bands {
    prom_pool *pool; // NULL: one thread
    size_t scratch_bytes;
    uint8_t *scratch;
};

typedef struct run {
    const prom_bands *bands;
    uint32_t height;
    prom_band_body *body;
    void *user;
} run;

prom_bands *prom_bands_create(unsigned threads, size_t scratch_bytes)
{
    const size_t line = 64; // threads do not share cache lines
    prom_bands *bands = prom_alloc(1, sizeof *bands);
    bands->pool = threads == 1 ? NULL : prom_pool_create();
    bands->scratch_bytes = (scratch_bytes / line + 1) * line;
    bands->scratch = prom_alloc(bands->pool ? prom_thread_count() : 1, bands->scratch_bytes);
    return bands;
}

void prom_bands_destroy(prom_bands *bands)
{
    if (!bands) return;
    prom_pool_destroy(bands->pool);
    prom_free(bands->scratch);
    prom_free(bands);
}

static void run_band(void *user, size_t i, unsigned thread)
{
    const run *r = user;
    uint32_t first = (uint32_t)i * PROM_BAND_ROWS, rest = r->height - first;
    uint32_t last = first + (rest < PROM_BAND_ROWS ? rest : PROM_BAND_ROWS);
    r->body(r->user, first, last, r->bands->scratch + thread * r->bands->scratch_bytes);
}

void prom_bands_run(prom_bands *bands, uint32_t height, prom_band_body *body, void *user)
{
    run r = {bands, height, body, user};
    const size_t count = ((size_t)height + PROM_BAND_ROWS - 1) / PROM_BAND_ROWS;
    if (bands->pool && count > 1) {
        prom_loop loop = {.body = run_band, .user = &r, .count = count};
        prom_pool_start(bands->pool, &loop);
        prom_pool_wait(bands->pool, &loop);
    } else {
        for (size_t i = 0; i < count; i++) run_band(&r, i, 0);
    }
}
