#include "app/oracle.h"

#include "app/cut_change.h"
#include "app/judge.h"
#include "app/oracle_moves.h"
#include "metaobj/base/log.h"

#include <math.h>
#include <stdio.h>

#define SEED 7        // by taste
#define VAIN_MOVES 20 // for each try, that cannot be paid; then a view has no more tries

typedef struct oracle {
    prom_still still;
    prom_judge judge;
    prom_random random;
    prom_cut best, tried;
    double *error; // per node, of the best cut
    uint32_t tries;
    prom_progress progress;
} oracle;

// A changed cut that may be drawn, in o->tried.
static bool find_try(oracle *o, double limit_ms)
{
    for (int i = 0; i < VAIN_MOVES; i++) {
        prom_cut_copy(&o->best, &o->tried);
        if (prom_oracle_move(&o->still.eval, &o->random, o->error, limit_ms, &o->tried))
            return true;
    }
    return false;
}

static void keep(oracle *o)
{
    prom_cut best = o->tried;
    o->tried = o->best;
    o->best = best;
}

// The sum of errors of the best cut that was found; o->best becomes it.
static double climb(oracle *o, double limit_ms)
{
    prom_cut_copy(&o->still.cut, &o->best);
    double least = prom_judge_nodes(&o->judge, &o->best, o->error);
    for (uint32_t i = 0; i < o->tries; i++) {
        prom_progress_step(&o->progress, 1);
        if (!(least > 0) || !find_try(o, limit_ms)) continue;
        if (!(prom_judge_run(&o->judge, &o->tried) < least)) continue;
        keep(o);
        least = prom_judge_nodes(&o->judge, &o->best, o->error);
    }
    return least;
}

static prom_oracle_frame look(oracle *o, uint32_t view)
{
    prom_still_look(&o->still, view);
    prom_judge_look(&o->judge, &o->still.camera);
    o->random = prom_random_stream(SEED, 0, o->still.frame);
    const prom_cut *cut = &o->still.cut;
    double pixels = (double)o->judge.pixels, sum = prom_judge_run(&o->judge, cut);
    // A cut that no budget allows any cheaper may cost what it does.
    double best = climb(o, fmax(o->still.allowed_ms, cut->predicted_ms));
    return (prom_oracle_frame){.frame = o->still.frame,
                               .flip = sum / pixels,
                               .best_flip = best / pixels,
                               .predicted_ms = cut->predicted_ms,
                               .best_ms = o->best.predicted_ms};
}

static void run(oracle *o, prom_oracle_result *result)
{
    prom_progress_begin(&o->progress, "oracle", (uint64_t)o->tries * o->still.count);
    for (uint32_t i = 0; i < o->still.count; i++) prom_array_push(&result->frames, look(o, i));
    prom_progress_end(&o->progress);
    result->tries = o->tries;
}

prom_status prom_oracle_run(prom_session *session, const prom_still_options *options,
                            uint32_t tries, prom_oracle_result *result, prom_error *error)
{
    oracle o = {.tries = tries};
    prom_status status = prom_still_init(&o.still, session, options, error);
    if (status) return status;
    o.error = prom_alloc(session->model.tree_count, sizeof *o.error);
    status = prom_judge_init(&o.judge, session, error);
    if (!status) run(&o, result);
    prom_judge_finish(&o.judge);
    prom_still_finish(&o.still);
    prom_cut_finish(&o.best);
    prom_cut_finish(&o.tried);
    prom_free(o.error);
    return status;
}

void prom_oracle_result_finish(prom_oracle_result *result)
{
    prom_array_finish(&result->frames);
}

// ---- reports

static prom_oracle_frame mean_of(const prom_oracle_result *result)
{
    prom_oracle_frame mean = {0};
    double count = (double)result->frames.count;
    for (size_t i = 0; i < result->frames.count; i++) {
        mean.flip += result->frames.data[i].flip / count;
        mean.best_flip += result->frames.data[i].best_flip / count;
    }
    return mean;
}

static double ratio_of(const prom_oracle_frame *frame)
{
    return frame->flip > 0 ? frame->best_flip / frame->flip : 1;
}

static json_t *frame_json(const prom_oracle_frame *f)
{
    return json_pack("{s:I, s:o, s:o, s:o, s:o}", "frame", (json_int_t)f->frame, "flip",
                     prom_json_number(f->flip), "best_flip", prom_json_number(f->best_flip),
                     "predicted_ms", prom_json_number(f->predicted_ms), "best_ms",
                     prom_json_number(f->best_ms));
}

json_t *prom_oracle_json(const prom_oracle_result *result)
{
    prom_oracle_frame mean = mean_of(result);
    json_t *frames = json_array();
    for (size_t i = 0; i < result->frames.count; i++)
        json_array_append_new(frames, frame_json(&result->frames.data[i]));
    return json_pack("{s:I, s:I, s:o, s:o, s:o, s:o}", "frames",
                     (json_int_t)result->frames.count, "tries", (json_int_t)result->tries,
                     "flip", prom_json_number(mean.flip), "best_flip",
                     prom_json_number(mean.best_flip), "ratio",
                     prom_json_number(ratio_of(&mean)), "per_frame", frames);
}

void prom_oracle_print(const prom_oracle_result *result)
{
    prom_oracle_frame mean = mean_of(result);
    printf("oracle     FLIP %.5f of the cuts, %.5f of the best of %u tries (%.0f %%), mean of "
           "%zu frames\n",
           mean.flip, mean.best_flip, result->tries, 100 * ratio_of(&mean),
           result->frames.count);
    for (size_t i = 0; i < result->frames.count; i++) {
        const prom_oracle_frame *f = &result->frames.data[i];
        printf("  frame %-6u %.5f, best %.5f (%.0f %%), predicted %.1f ms, best %.1f\n",
               f->frame, f->flip, f->best_flip, 100 * ratio_of(f), f->predicted_ms, f->best_ms);
    }
}
