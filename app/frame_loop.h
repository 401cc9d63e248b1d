// The frame loop: walks a path, selects and draws every frame within a budget, and keeps what
// was measured. A frame's time runs from its start to the finished image; pictures and
// comparisons with full detail are made between frames.
#ifndef PROM_APP_FRAME_LOOP_H
#define PROM_APP_FRAME_LOOP_H

#include "app/frame_step.h"
#include "app/noise_floor.h"

enum { PROM_COLD_FRAMES = 30 };

typedef struct prom_loop_options {
    const char *selector;
    uint32_t frames, warmup; // warm-up frames are drawn before the first and not recorded
    double budget_ms, rule_scale;
    const char *keep_folder; // PNGs of every keep_every-th frame; NULL: none
    uint32_t keep_every;
    bool keep_colours; // and each of them again in false colours
    // Frames to compare with full detail, evenly spaced; 0: none.
    uint32_t check_holes, check_accuracy, quality_frames;
    uint32_t popping_frames; // evenly spaced, compared with the frame before; 0: none
    uint32_t noise_floor;    // repeats of a fixed cut, evenly between the frames; 0: none
} prom_loop_options;

typedef struct prom_loop_result {
    PROM_ARRAY(prom_frame_record) frames;
    // The first ones that were drawn, the warm-up's included, while little was learnt yet.
    PROM_ARRAY(prom_frame_record) cold;
    prom_noise_floor floor; // without repeats: not asked for
    double start_unix_s;    // when the clock of start_ms stood at 0
    uint32_t infeasible_frames;
    double least_budget_ms; // with which no frame would have been infeasible
    double memory_start_mb, memory_end_mb;
} prom_loop_result;

prom_status prom_frame_loop_run(prom_session *session, const prom_loop_options *options,
                                prom_loop_result *result, prom_error *error);
void prom_loop_result_finish(prom_loop_result *result);

#endif
