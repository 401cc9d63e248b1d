#include "traverse/governor.h"

#include <math.h>

// Smoothing: a frame that took longer than predicted counts for more than one that took less,
// so that overload ends within 2 to 3 frames and one quick frame does not invite the next miss.
#define RATIO_UP 0.6
#define RATIO_DOWN 0.3
#define RATIO_MIN 0.25
#define RATIO_MAX 4.0

static double smoothed(double old, double now)
{
    return old + (now > old ? RATIO_UP : RATIO_DOWN) * (now - old);
}

void prom_governor_init(prom_governor *governor, double margin)
{
    double valid = margin >= 0.0 ? fmin(margin, 0.9) : 0.0;
    *governor = (prom_governor){.ratio = 1.0, .margin = valid};
}

double prom_governor_budget(const prom_governor *governor, double budget_ms)
{
    double left =
        (budget_ms - governor->select_ms) / governor->ratio * (1.0 - governor->margin);
    return left > 0.0 ? left : 0.0;
}

void prom_governor_feed(prom_governor *governor, double predicted_ms, double draw_ms,
                        double select_ms)
{
    if (isfinite(select_ms) && select_ms >= 0.0)
        governor->select_ms = smoothed(governor->select_ms, select_ms);
    if (!(predicted_ms > 0.0) || !isfinite(predicted_ms)) return;
    if (!(draw_ms > 0.0) || !isfinite(draw_ms)) return;
    // A single stalled frame is worth no more than the clamp.
    double now = fmin(fmax(draw_ms / predicted_ms, RATIO_MIN), RATIO_MAX);
    governor->ratio = smoothed(governor->ratio, now);
}
