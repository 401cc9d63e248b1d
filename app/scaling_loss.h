// What a picture loses by being drawn smaller and scaled up.
#ifndef PROM_APP_SCALING_LOSS_H
#define PROM_APP_SCALING_LOSS_H

#include "app/session.h"
#include "traverse/resolution.h"

// Sets the losses of the scales: the mean error, by the model's own metric, of the pixels that
// the tree covers, against the same cut drawn in full. targets[i] is as large as scale i asks
// for. The cut is the best that the device draws in about a tenth of a second. camera: where
// from; NULL: two places of the session's path. Takes about a second.
prom_status prom_scaling_loss_measure(prom_session *session,
                                      prom_target *const targets[PROM_SCALES],
                                      prom_scaling *scaling, const prom_camera *camera,
                                      prom_error *error);

#endif
