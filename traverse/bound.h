// The certificate: how good a cut can be at most.
//
// For every price p >= 0, f(n) = max(max over the options r of n of B_r - p C_r, sum of f over
// the children); then f(root) + p * budget is at least the benefit of every cut within the
// budget (Lagrangian relaxation of the multiple-choice knapsack over a tree; it is convex in
// p).
#ifndef PROM_TRAVERSE_BOUND_H
#define PROM_TRAVERSE_BOUND_H

#include "traverse/evaluate.h"

typedef struct prom_bound prom_bound; // scratch memory of a model
prom_bound *prom_bound_create(const prom_model *model);
void prom_bound_destroy(prom_bound *bound); // NULL is allowed

// Upper bound on the benefit of cuts of the evaluated view within its budget: the least over
// `looks` prices from `price` (benefit per ms; 0: not known) on. Below a node that the
// evaluation did not open, everything may be right for what the node's cheapest option costs.
// (As builds make them, no cluster's cheapest picture costs more than what is below it.)
// At most what the visible pixels are worth; cmin's benefit where cmin is over the budget.
double prom_bound_find(prom_bound *bound, const prom_eval *eval, double price, unsigned looks);

// Fills cut->bound of a finished cut, where the selection asks for it. Where the gap is above
// 3 % and a price is known, the bound is tightened by branching (bound.c).
void prom_bound_certify(prom_bound *bound, const prom_eval *eval, double price, prom_cut *cut);

// Normalised gap of a cut with a bound (DESIGN 7): (bound - B) / (bound - B(cheapest cut)), in
// [0,1]; 0 where the bound equals the cheapest cut's benefit, and NAN without a bound.
double prom_cut_gap(const prom_cut *cut);

#endif
