// Keeps frames within the budget: corrects the prediction by the measured ratio and keeps a
// fixed margin for noise. (The conformal guarantee takes this place later.)
#ifndef PROM_TRAVERSE_GOVERNOR_H
#define PROM_TRAVERSE_GOVERNOR_H

#define PROM_GOVERNOR_FRAMES 5

typedef struct prom_governor {
    double ratio; // median of the last frames' actual / predicted, within [1/4, 4]
    double scores[PROM_GOVERNOR_FRAMES]; // actual / predicted, a ring
    unsigned frames;                     // fed so far
    double margin;                       // part of the budget kept back
    double select_ms;                    // smoothed selection time, charged to the budget
} prom_governor;

void prom_governor_init(prom_governor *governor, double margin);
// What a selector may predict for a frame of budget_ms.
double prom_governor_budget(const prom_governor *governor, double budget_ms);
// After a frame: predicted (uncorrected), actual draw time, selection time, all in ms.
void prom_governor_feed(prom_governor *governor, double predicted_ms, double draw_ms,
                        double select_ms);

#endif
