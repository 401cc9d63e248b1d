// The oracle: in some views, the best cut that many tries find by the picture itself, at no
// more predicted cost than the selector may have. No selector can know what it knows; how far a
// selector stays behind it says what better predictions of the benefit could gain.
//
// A hill climb: each try changes the best cut so far in a few places, shows better what is
// wrong in its picture and elsewhere pays for that, is drawn, and kept if its mean FLIP is
// lower. Its result is a bound from one side: there may be better cuts yet.
#ifndef PROM_APP_ORACLE_H
#define PROM_APP_ORACLE_H

#include "app/output.h"
#include "app/still.h"

typedef struct prom_oracle_frame {
    uint32_t frame;
    double flip, best_flip;       // mean errors of the selector's cut, and of the best one
    double predicted_ms, best_ms; // what they are predicted at
} prom_oracle_frame;

typedef struct prom_oracle_result {
    PROM_ARRAY(prom_oracle_frame) frames;
    uint32_t tries;
} prom_oracle_result;

prom_status prom_oracle_run(prom_session *session, const prom_still_options *options,
                            uint32_t tries, prom_oracle_result *result, prom_error *error);
void prom_oracle_result_finish(prom_oracle_result *result);

// frames, tries (a frame); means over the frames: flip, best_flip, and ratio of the second to
// the first (1 where both are 0); per_frame: an array of frame, flip, best_flip, predicted_ms,
// best_ms.
json_t *prom_oracle_json(const prom_oracle_result *result);
void prom_oracle_print(const prom_oracle_result *result);

#endif
