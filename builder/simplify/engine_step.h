// Private to simplification: what the engine's parts share, and doing one collapse.
#ifndef PROM_SIMPLIFY_ENGINE_STEP_H
#define PROM_SIMPLIFY_ENGINE_STEP_H

#include "builder/simplify/engine.h"
#include "builder/simplify/guard.h"
#include "builder/simplify/pairs.h"
#include "builder/simplify/queue.h"
#include "builder/simplify/slots.h"

enum {
    PROM_POINT_LOCKED = 1,
    PROM_POINT_BORDER = 2,
    PROM_POINT_MULTIPLE = 4, // may have more than one vertex
};

// No sum with another stamp is that of two points that are there.
#define PROM_STAMP_GONE (1u << 30)

typedef struct prom_point_state {
    uint32_t stamp; // how often it was merged, PROM_STAMP_GONE: it has no triangles any more
    uint32_t flags;
} prom_point_state;

struct prom_collapser {
    prom_collapse_mesh *mesh;
    prom_collapse_options options;
    prom_collapse_metric *metric;
    prom_queue queue;
    prom_pairs pairs;
    prom_marks marks;
    prom_slots slots;
    prom_point_state *points; // per point
    size_t room;              // so many candidates are worth a look at which are stale
    PROM_ARRAY(prom_vertex) made;
    PROM_ARRAY(uint32_t) survivors; // per slot
    float greatest_error;           // squared
    bool left_out;                  // candidates were dropped that may be possible later
    prom_collapse_stats stats;
};

// One candidate with all that was found out about it.
typedef struct prom_step {
    prom_collapse collapse;
    prom_collapse_result result;
} prom_step;

// What merging would cost; false: it cannot be done. The step is good until the next call.
bool prom_step_evaluate(prom_collapser *c, uint32_t from, uint32_t to, bool fixed,
                        prom_step *step);
// limit: of the error, squared.
prom_verdict prom_step_judge(prom_collapser *c, const prom_step *step, float limit);
// Does it, without looking for candidates.
void prom_step_apply(prom_collapser *c, const prom_step *step);

#endif
