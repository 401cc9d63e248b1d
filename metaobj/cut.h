// The cut: what is drawn in a frame.
#ifndef PROM_METAOBJ_CUT_H
#define PROM_METAOBJ_CUT_H

#include "metaobj/base/alloc.h"
#include "metaobj/cost_features.h"

#include <stdbool.h>
#include <stdint.h>

typedef struct prom_cut_entry {
    uint32_t node;
    uint32_t rep;       // index into the model's representations
    float level;        // continuous level, 0 for discrete kinds
    uint32_t fade_from; // representation that it replaces, or PROM_NONE
    float fade;         // 1 when the change is complete
    float depth;        // distance from the eye to the node's nearest point, for the draw order
    // As predicted when the entry was chosen:
    float footprint_px; // pixels of the viewport that the node would cover by itself
    float visible_px;   // pixels of it that are not hidden; what was counted may be more
    float weight;       // what one of these is worth (benefit/weights.h)
    float accuracy;     // of the representation: benefit = visible_px * weight * accuracy
    float cost_ms;
    bool whole; // the node is wholly in view
} prom_cut_entry;

// Exactly one entry on every root-to-leaf path whose leaf is in the frustum.
typedef struct prom_cut {
    PROM_ARRAY(prom_cut_entry) entries; // the array keeps its memory from frame to frame
    double predicted_ms;         // fixed part + all entries, before the correction factor
    double terms_ms[PROM_TERMS]; // predicted_ms in its parts
    double cmin_ms;              // predicted_ms of the cheapest cut
    double cmin_benefit;         // and its benefit
    double benefit, loss;        // weighted pixels shown right, and wrong (DESIGN: benefit)
    double bound;           // the certificate: no cut within the budget has more benefit, see
                            // traverse/bound.h; INFINITY: not asked for, or none is known
    bool feasible;          // predicted_ms is within the budget that the selector was given
    bool limited;           // more time would have bought a better picture
    uint32_t nodes_visited; // in the frustum, the work of the selection: for benchmarks
} prom_cut;

void prom_cut_finish(prom_cut *cut);

#endif
