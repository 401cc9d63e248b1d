// FLIP, LDR: how different two pictures look to a person who flips between them; the metric
// `flip` of metric.h. Andersson, Nilsson, Akenine-Moeller, Oskarsson, Astroem, Fairchild: FLIP:
// A Difference Evaluator for Alternating Images, HPG 2020.
//
// A value says nothing without its pixels per degree: keep them with it. On a screen of
// `screen_px` across `screen_m`, seen from `distance_m` away, these are
// distance_m * screen_px / screen_m * pi / 180.
#ifndef PROM_BENEFIT_FLIP_H
#define PROM_BENEFIT_FLIP_H

// Pixels per degree of a screen 0.7 m wide with PROM_FLIP_SCREEN_PX pixels, 0.7 m away: the
// authors' default. A picture shown over the whole width of that screen has its part of them.
#define PROM_FLIP_PPD 67.0206
#define PROM_FLIP_SCREEN_PX 3840

#endif
