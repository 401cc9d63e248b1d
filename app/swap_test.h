// The swap test: is the benefit that selectors count in what the picture gains? In views along
// a path one entry of the cut at a time is drawn in another way, and the change of the
// picture's error against full detail is held against the change that was predicted: the
// pixels that it shows times the change of their accuracy.
#ifndef PROM_APP_SWAP_TEST_H
#define PROM_APP_SWAP_TEST_H

#include "app/still.h"

// Entries that show less in full detail are not swapped: rounding would outweigh them.
#define PROM_SWAP_LEAST_PX 16
// Instead of a representation's kind: the cluster was opened, and each child drawn by its best.
#define PROM_SWAP_OPEN PROM_REP_KIND_COUNT
#define PROM_SWAP_KINDS (PROM_REP_KIND_COUNT + 1)
const char *prom_swap_kind_name(uint32_t kind);

typedef struct prom_swap {
    uint32_t frame, node;
    bool cluster;
    uint32_t kind_from, kind_to, level_from, level_to; // level_to: 0 if opened
    float size_px;                                     // diameter
    uint32_t px;                                       // that the node shows in full detail
    // Change of the frame's sum of errors, pixels; above 0: it became worse.
    double predicted;          // from the pixels that really show
    double predicted_selector; // from those that the selector believed in
    double measured;
} prom_swap;

typedef struct prom_swap_result {
    PROM_ARRAY(prom_swap) swaps;
    uint32_t frames;
} prom_swap_result;

// Agreement of some swaps.
typedef struct prom_swap_agreement {
    size_t swaps;
    double spearman, spearman_selector; // NAN: too few, or all alike
    double slope; // of measured over predicted: least squares through the origin; NAN likewise
} prom_swap_agreement;

// per_view: swaps in each, as far as there are entries to swap. The choice depends on nothing
// but the frames' numbers and what is in the cuts.
prom_status prom_swap_test_run(prom_session *session, const prom_still_options *options,
                               uint32_t per_view, prom_swap_result *result, prom_error *error);
void prom_swap_result_finish(prom_swap_result *result);
// Of all swaps that `wanted` agrees to; NULL: of all.
prom_swap_agreement prom_swap_agreement_of(const prom_swap_result *result,
                                           bool (*wanted)(const prom_swap *swap, uint32_t user),
                                           uint32_t user);

#endif
