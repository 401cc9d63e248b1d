// Chains: for every visited node a few states of its subtree, from the cheapest on, each with
// more benefit for more cost and less benefit per cost than the step before: the upper concave
// hull of what the subtree can show for its cost. Benefits are the values of the options here:
// as they count where things are ordered.
//
// Found bottom-up. What opening a node offers is the sum of its children's chains, their steps
// merged by falling slope; the node's chain is the hull over that and its own options, thinned
// to CHAIN_MAX states. So a step may open a cluster and refine what it holds at once, and a
// poor first split does not hide what lies below it (Mason and Blake 1997 buy one level at a
// time).
#ifndef PROM_TRAVERSE_CHAIN_H
#define PROM_TRAVERSE_CHAIN_H

#include "traverse/evaluate.h"
#include "traverse/heap.h"

// Measured on towns of ten levels: 8 states lose 2.6 % of what could be gained and make a sixth
// of the cut flip from frame to frame, 24 lose 0.06 % in the same time, and 64 no less.
enum { PROM_CHAIN_MAX = 24 };

// A prefix of the children's steps in merged order: all with a slope above `slope`, and of
// those with this very slope the ones of children up to `child`. A child has no two steps of
// one slope.
typedef struct prom_chain_limit {
    double slope;
    uint32_t child;
} prom_chain_limit;

typedef struct prom_chain_state {
    double cost, benefit; // of the subtree
    double slope;         // of the step from the state before
    uint32_t option;      // its own option, or PROM_NONE: opened, the children as `limit` says
    prom_chain_limit limit;
} prom_chain_state;

typedef struct prom_chain {
    uint32_t first;
    uint8_t count;
    uint8_t own_end; // states from here on are opened ones
} prom_chain;

typedef struct prom_chain_point prom_chain_point; // scratch

typedef struct prom_chains {
    const prom_eval *eval;
    prom_chain *nodes;
    prom_chain_state *states;
    uint32_t state_count;
    prom_chain_point *points, *own, *hull;
    prom_heap merge; // of the children of one node
    uint8_t *taken;  // per child of one node: steps merged so far
} prom_chains;

void prom_chains_init(prom_chains *chains, const prom_eval *eval);
void prom_chains_finish(prom_chains *chains);

// After prom_eval_run: chains of all visited nodes.
void prom_chains_build(prom_chains *chains);

// The place in its chain that a child has in an opened state of its parent.
uint8_t prom_chain_child_place(const prom_chains *chains, uint32_t child,
                               const prom_chain_limit *limit);
// The opened state of a node with the fewest steps of its children that has more than
// `benefit`; false if there is none.
bool prom_chain_least_opening(prom_chains *chains, uint32_t node, double benefit,
                              prom_chain_state *state);

#endif
