#include "app/swap_test.h"

#include "app/cut_change.h"
#include "app/judge.h"
#include "app/statistics.h"
#include "metaobj/base/log.h"
#include "scenes/random.h"

#define SEED 5 // by taste

typedef struct swap_test {
    prom_still still;
    prom_judge judge;
    prom_random random;
    prom_cut swapped;
    uint32_t *candidates; // entries of the cut
    prom_swap_result *result;
} swap_test;

const char *prom_swap_kind_name(uint32_t kind)
{
    return kind == PROM_SWAP_OPEN ? "open" : prom_rep_kind_name(kind);
}

// What the entries of a cut are expected to show wrong, in pixels.
typedef struct losses {
    double shown, believed; // by the pixels in full detail; by those of the evaluation
} losses;

static losses losses_of(const swap_test *t, const prom_cut *cut)
{
    losses sum = {0};
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        double wrong = 1.0 - (double)e->accuracy;
        sum.shown += t->judge.px[e->node] * wrong;
        sum.believed += (double)t->still.eval.nodes[e->node].px * wrong;
    }
    return sum;
}

static uint32_t other_options(const prom_eval *eval, const prom_cut_entry *entry)
{
    const prom_eval_node *n = &eval->nodes[entry->node];
    uint32_t others = 0;
    for (uint32_t o = n->first_option; o < n->first_option + n->option_count; o++)
        others += eval->options[o].rep != entry->rep;
    return others;
}

static uint32_t find_candidates(swap_test *t)
{
    const prom_eval *eval = &t->still.eval;
    const prom_cut *cut = &t->still.cut;
    uint32_t count = 0;
    for (size_t i = 0; i < cut->entries.count; i++) {
        const prom_cut_entry *e = &cut->entries.data[i];
        if (eval->nodes[e->node].culled || t->judge.px[e->node] < PROM_SWAP_LEAST_PX) continue;
        if (other_options(eval, e) || eval->model->child_count[e->node])
            t->candidates[count++] = (uint32_t)i;
    }
    return count;
}

// The i-th option of an entry's node without its present one.
static uint32_t other_option(const prom_eval *eval, const prom_cut_entry *entry, uint32_t i)
{
    uint32_t o = eval->nodes[entry->node].first_option;
    for (;; o++) {
        if (eval->options[o].rep == entry->rep) continue;
        if (i-- == 0) return o;
    }
}

// Changes one entry of t->swapped. Every second cluster is opened.
static void change(swap_test *t, uint32_t index, prom_swap *swap)
{
    const prom_eval *eval = &t->still.eval;
    const prom_cut_entry entry = t->swapped.entries.data[index];
    uint32_t others = other_options(eval, &entry);
    if (swap->cluster && (!others || prom_random_below(&t->random, 2))) {
        swap->kind_to = PROM_SWAP_OPEN;
        prom_cut_open(eval, &t->swapped, index, prom_cut_best_option);
        return;
    }
    uint32_t option = other_option(eval, &entry, prom_random_below(&t->random, others));
    const prom_representation *rep = &eval->model->reps[eval->options[option].rep];
    swap->kind_to = rep->kind;
    swap->level_to = rep->level;
    prom_cut_take_option(eval, &t->swapped, index, option);
}

static void swap_entry(swap_test *t, uint32_t index, double error_before)
{
    const prom_model *m = t->still.eval.model;
    const prom_cut_entry *e = &t->still.cut.entries.data[index];
    const prom_representation *rep = &m->reps[e->rep];
    prom_swap swap = {
        .frame = t->still.frame,
        .node = e->node,
        .cluster = m->child_count[e->node] > 0,
        .kind_from = rep->kind,
        .level_from = rep->level,
        .size_px = t->still.eval.nodes[e->node].size_px,
        .px = t->judge.px[e->node],
    };
    prom_cut_copy(&t->still.cut, &t->swapped);
    change(t, index, &swap);
    losses before = losses_of(t, &t->still.cut), after = losses_of(t, &t->swapped);
    swap.predicted = after.shown - before.shown;
    swap.predicted_selector = after.believed - before.believed;
    swap.measured = prom_judge_run(&t->judge, &t->swapped) - error_before;
    prom_array_push(&t->result->swaps, swap);
}

static void swap_some(swap_test *t, uint32_t wanted)
{
    uint32_t count = find_candidates(t);
    double error = prom_judge_run(&t->judge, &t->still.cut);
    for (uint32_t i = 0; i < count && i < wanted; i++) {
        uint32_t k = i + prom_random_below(&t->random, count - i);
        uint32_t chosen = t->candidates[k];
        t->candidates[k] = t->candidates[i];
        swap_entry(t, chosen, error);
    }
}

static void run(swap_test *t, uint32_t per_view)
{
    prom_progress progress;
    prom_progress_begin(&progress, "swap test", t->still.count);
    for (uint32_t i = 0; i < t->still.count; i++) {
        prom_still_look(&t->still, i);
        prom_judge_look(&t->judge, &t->still.camera);
        t->random = prom_random_stream(SEED, 0, t->still.frame);
        swap_some(t, per_view);
        prom_progress_step(&progress, 1);
    }
    prom_progress_end(&progress);
    t->result->frames = t->still.count;
}

prom_status prom_swap_test_run(prom_session *session, const prom_still_options *options,
                               uint32_t per_view, prom_swap_result *result, prom_error *error)
{
    swap_test t = {.result = result};
    prom_status status = prom_still_init(&t.still, session, options, error);
    if (status) return status;
    t.candidates = prom_alloc(session->model.tree_count, sizeof *t.candidates);
    status = prom_judge_init(&t.judge, session, error);
    if (!status) run(&t, per_view);
    prom_judge_finish(&t.judge);
    prom_still_finish(&t.still);
    prom_cut_finish(&t.swapped);
    prom_free(t.candidates);
    return status;
}

void prom_swap_result_finish(prom_swap_result *result)
{
    prom_array_finish(&result->swaps);
}

prom_swap_agreement prom_swap_agreement_of(const prom_swap_result *result,
                                           bool (*wanted)(const prom_swap *, uint32_t),
                                           uint32_t user)
{
    size_t count = 0, all = result->swaps.count;
    double *predicted = prom_alloc(3 * all, sizeof *predicted);
    double *believed = predicted + all, *measured = believed + all;
    for (size_t i = 0; i < all; i++) {
        const prom_swap *s = &result->swaps.data[i];
        if (wanted && !wanted(s, user)) continue;
        predicted[count] = s->predicted;
        believed[count] = s->predicted_selector;
        measured[count++] = s->measured;
    }
    prom_swap_agreement agreement = {
        .swaps = count,
        .spearman = prom_spearman(predicted, measured, count),
        .spearman_selector = prom_spearman(believed, measured, count),
        .slope = prom_slope(predicted, measured, count),
    };
    prom_free(predicted);
    return agreement;
}
