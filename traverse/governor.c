#include "traverse/governor.h"

#include <math.h>
#include <string.h>

// The ratio is a median and no running mean: a single stalled frame (the scheduler gives the
// core away for some milliseconds, about every fifteenth frame on a shared machine) must not
// make the next ones poor, while a lasting change is followed after three.
#define RATIO_MIN 0.25
#define RATIO_MAX 4.0

// Selection time: a slow one counts for more than a quick one.
#define SELECT_UP 0.6
#define SELECT_DOWN 0.3

static double smoothed(double old, double now)
{
    return old + (now > old ? SELECT_UP : SELECT_DOWN) * (now - old);
}

static double median(const double *values, unsigned count)
{
    double sorted[PROM_GOVERNOR_FRAMES];
    memcpy(sorted, values, count * sizeof *sorted);
    for (unsigned i = 1; i < count; i++)
        for (unsigned k = i; k > 0 && sorted[k] < sorted[k - 1]; k--) {
            double swapped = sorted[k];
            sorted[k] = sorted[k - 1];
            sorted[k - 1] = swapped;
        }
    return sorted[count / 2];
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
    double now = fmin(fmax(draw_ms / predicted_ms, RATIO_MIN), RATIO_MAX);
    governor->scores[governor->frames++ % PROM_GOVERNOR_FRAMES] = now;
    unsigned known =
        governor->frames < PROM_GOVERNOR_FRAMES ? governor->frames : PROM_GOVERNOR_FRAMES;
    governor->ratio = median(governor->scores, known);
}
