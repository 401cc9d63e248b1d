// One view's evaluation of the tree: which nodes are in the frustum, how many pixels each
// shows, by which representations it may be drawn, at what cost and benefit, and the cheapest
// way to cover it (cmin). All selectors work on it.
//
// Memory is allocated once per model; a run touches only what it visits. Per-node data are
// valid for the root and the children of expanded nodes; the rest is left over from earlier
// views.
#ifndef PROM_TRAVERSE_EVALUATE_H
#define PROM_TRAVERSE_EVALUATE_H

#include "metaobj/cut.h"
#include "traverse/selector.h"

// A valid representation of a node in this view.
typedef struct prom_option {
    double cost;
    float accuracy;
    float benefit; // weighted pixels shown right
    float value;   // the same, as it counts where things are ordered
    uint32_t rep;
} prom_option;

typedef struct prom_eval_node {
    double cmin, cmin_benefit; // of the cheapest cut of its subtree; ties by higher benefit
    uint32_t cmin_option;      // its own option in that cut, or PROM_NONE: opened
    uint32_t first_option, option_count;
    float px;           // visible pixels
    float value_px;     // as they count where things are ordered
    float weight;       // mean of their weights
    float own_px;       // that it would have by itself, by where it is: prom_own_px
    float footprint_px; // pixels, if nothing outside its ancestor hid it
    float distance, nearest, size_px;
    float uv[2]; // direction to the eye, see prom_appearance
    uint8_t dir;
    bool culled; // nothing below it is in the frustum
    bool inside; // wholly in the frustum: what is below needs no test
    bool near_case;
    bool in_flow;  // its pixels are those of the whole subtree and flow on to the children
    bool hidden;   // nothing of it is expected to show
    bool expanded; // its children are evaluated
} prom_eval_node;

// Whether to go below a cluster that could be drawn by one of its own options, which stand in
// the node with their benefits; costs come later. Clusters without options are always expanded.
typedef bool prom_eval_open(void *user, uint32_t node);

typedef struct prom_eval {
    const prom_model *model;
    const prom_selection *selection;
    prom_eval_node *nodes;
    uint32_t *visited; // in the frustum, parents first, in rising order
    uint32_t visited_count;
    prom_option *options;
    uint32_t option_count;
    double fixed_ms;      // fixed part of the frame and the background layer
    double shaded_share;  // part of the visible pixels that are shaded, see evaluate_cost.c
    const bool *any_size; // per representation: valid whatever its max_size_px says, the
                          // selector knows better; NULL: none. The selector's own
    bool any_mesh_hides;  // what is hidden may be drawn by any mesh, whatever its gaps
    bool heeds_priors;
    bool weighted;       // in this view
    float tolerance;     // factor on what prom_eval_open_visible takes for invisible
    float *in_view, *px; // of the children of one node
    uint32_t max_children;
} prom_eval;

void prom_eval_init(prom_eval *eval, const prom_model *model);
void prom_eval_finish(prom_eval *eval);

// Evaluates a view. open: NULL goes down to the leaves.
void prom_eval_run(prom_eval *eval, const prom_selection *selection, prom_eval_open *open,
                   void *user);
// The rule of selectors whose work shall grow with the cut: stop at nodes of a pixel or two,
// and where the picture cannot become visibly better. `user` is the evaluation.
bool prom_eval_open_visible(void *user, uint32_t node);

// What a running sum of costs, fixed_ms included, may reach: a hair less than the budget, over
// which rounding must not lift the finished cut.
double prom_eval_budget(const prom_eval *eval);
// Starts a cut and appends a node drawn by one of its options (its index in eval->options).
void prom_eval_begin_cut(const prom_eval *eval, prom_cut *cut);
void prom_eval_emit(const prom_eval *eval, uint32_t node, uint32_t option, prom_cut *cut);
// Appends the cheapest cut.
void prom_eval_emit_cmin(prom_eval *eval, prom_cut *cut);
// Sets what follows from the whole cut.
void prom_eval_end_cut(const prom_eval *eval, prom_cut *cut);

#endif
