#include "traverse/resolution.h"

#include <math.h>

// A trial takes as long as a selection: every so many frames it is a small part of them.
#define TRY_EVERY 8
// After a change the picture stays as sharp for half a second at 60 frames a second.
#define STAY 30
// Another scale must lose this part less, and this much. Both by taste: the sharpness of a
// whole picture shows when it changes.
#define BETTER_PART 0.9
#define BETTER_BY 0.002

void prom_scaling_init(prom_scaling *scaling, double min_scale)
{
    *scaling = (prom_scaling){.unchanged = STAY};
    for (unsigned i = 0; i < PROM_SCALES; i++) {
        double factor = exp2(-0.25 * i);
        if (factor < min_scale * (1 - 1e-6)) break;
        scaling->scales[scaling->count++].factor = factor;
    }
    if (!scaling->count) scaling->scales[scaling->count++].factor = 1;
}

void prom_scaled_size(const uint32_t size_px[2], double scale, uint32_t scaled_px[2])
{
    for (int i = 0; i < 2; i++) scaled_px[i] = (uint32_t)fmax(round(size_px[i] * scale), 1);
}

prom_cost_model prom_cost_at_scale(const prom_cost_model *model, double scale, double screen_px)
{
    prom_cost_model scaled = *model;
    if (scale >= 1) return scaled;
    for (int i = 0; i < PROM_COST_KINDS; i++) scaled.pixel_ms[i] *= scale * scale;
    scaled.hidden_pixel_ms *= scale * scale;
    scaled.edge_ms *= scale;
    scaled.hidden_edge_ms *= scale;
    scaled.fixed_ms += screen_px * model->pixel_ms[PROM_SHADE_TEXTURED];
    return scaled;
}

double prom_scaling_loss(const prom_scaling *scaling, unsigned i, const prom_cut *cut)
{
    if (!cut->feasible) return 1 + cut->predicted_ms;
    double all = cut->benefit + cut->loss;
    double share = all > 0 ? cut->loss / all : 0;
    return fmin(share + scaling->scales[i].loss, 1);
}

// A smaller scale saves at most what the cut loses, and costs the difference of the losses.
static bool may_win(const prom_scaling *s, unsigned i, const prom_cut *cut)
{
    if (i < s->at) return true;
    double own = prom_scaling_loss(s, s->at, cut);
    return s->scales[i].loss < own * BETTER_PART - BETTER_BY;
}

unsigned prom_scaling_try(prom_scaling *scaling, const prom_cut *cut)
{
    prom_scaling *s = scaling;
    bool smaller = s->at + 1 < s->count, larger = s->at > 0;
    s->untried++;
    s->unchanged++;
    if (!cut->feasible) return smaller ? s->at + 1 : s->at;
    if (s->untried < TRY_EVERY || s->unchanged < STAY) return s->at;
    s->untried = 0;
    s->up = smaller && larger ? !s->up : larger;
    if (s->up ? !larger : !smaller) return s->at;
    unsigned i = s->up ? s->at - 1 : s->at + 1;
    return may_win(s, i, cut) ? i : s->at;
}

bool prom_scaling_decide(prom_scaling *scaling, unsigned tried, const prom_cut *cut,
                         const prom_cut *tried_cut)
{
    double own = prom_scaling_loss(scaling, scaling->at, cut);
    double other = prom_scaling_loss(scaling, tried, tried_cut);
    bool better = cut->feasible ? other < own * BETTER_PART - BETTER_BY : other < own;
    if (!better) return false;
    scaling->at = tried;
    scaling->unchanged = 0;
    return true;
}
