// Random changes of a cut within a predicted cost: something is shown better, and something
// else worse where that is needed to pay for it.
#ifndef PROM_APP_ORACLE_MOVES_H
#define PROM_APP_ORACLE_MOVES_H

#include "scenes/random.h"
#include "traverse/evaluate.h"

// Changes a cut in one to four places. error: per node of the tree, of what its entry shows;
// what is more wrong is more often changed. False if the cut is what it was, or if no way was
// found to pay for it: it is of no use then.
bool prom_oracle_move(const prom_eval *eval, prom_random *random, const double *error,
                      double limit_ms, prom_cut *cut);

#endif
