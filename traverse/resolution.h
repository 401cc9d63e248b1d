// Resolution as one more choice: a picture may be drawn smaller and scaled up, where the time
// that its pixels leave buys more than scaling costs.
//
//   prom_scaling_init; for every frame: select with prom_cost_at_scale of scales[at]; if
//   prom_scaling_try names another scale, select with that too; prom_scaling_decide
//
// All is thought in pixels of the full picture: view, tables and visibility stay what they are;
// a smaller scale makes pixels cost less, and every visible pixel loses a little by the
// scaling. Plain numbers in and out.
#ifndef PROM_TRAVERSE_RESOLUTION_H
#define PROM_TRAVERSE_RESOLUTION_H

#include "metaobj/cut.h"
#include "traverse/cost.h"

enum { PROM_SCALES = 5 };

typedef struct prom_scale {
    double factor; // on the picture's sides
    double loss;   // of each visible pixel, by scaling alone: in [0,1]
} prom_scale;

typedef struct prom_scaling {
    prom_scale
        scales[PROM_SCALES]; // from 1 down, each with half the pixels of the last but one
    unsigned count;
    unsigned at; // the one in use
    // Frames since another one was tried, and since the last change.
    unsigned untried, unchanged;
    bool up; // which way was tried last
} prom_scaling;

// The scales from 1 to min_scale, in (0,1]. The losses are 0 until the caller sets them; they
// must not fall from a scale to the next smaller one.
void prom_scaling_init(prom_scaling *scaling, double min_scale);
// The size of a picture at a scale: in whole pixels, one at least.
void prom_scaled_size(const uint32_t size_px[2], double scale, uint32_t scaled_px[2]);
// What frames cost that are drawn at a scale: pixels with its square, edges of triangles with
// it. Below 1, scaling up is in the fixed part: `screen_px` textured pixels.
prom_cost_model prom_cost_at_scale(const prom_cost_model *model, double scale,
                                   double screen_px);

// What a cut that was selected for scale i loses: a share of all that is visible, at most 1; of
// a cut over its budget more than that, and the more the farther over it is.
double prom_scaling_loss(const prom_scaling *scaling, unsigned i, const prom_cut *cut);
// The scale to try in this frame after `cut` was selected for the one in use, or that itself:
// nothing to try. A neighbour, every few frames, and only if it may win; at once when the cut
// is over its budget.
unsigned prom_scaling_try(prom_scaling *scaling, const prom_cut *cut);
// Whether the scale that was tried takes the place of the one in use (it is then `at`).
bool prom_scaling_decide(prom_scaling *scaling, unsigned tried, const prom_cut *cut,
                         const prom_cut *tried_cut);

#endif
