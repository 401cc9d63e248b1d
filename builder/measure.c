#include "builder/measure_private.h"

#include "benefit/accuracy.h"
#include "metaobj/base/alloc.h"
#include "metaobj/base/hash.h"
#include "metaobj/base/math.h"
#include "metaobj/base/threads.h"

#include <stdio.h>
#include <string.h>

#define CONSTANT_ACCURACY 0.5 // of everything, with `constant`
#define GAP_STEP (PROM_VIEW_PX / PROM_GAP_PX)

// If more than a hundredth of a footprint lies well within parts as wrong as this, a piece of
// the object is missing or something else is there (by taste; seen on the scenes).
#define VETO_PERCENTILE 0.99f
#define VETO_ERROR 0.8f

// Coarse directions disagree about one between them if their errors differ at any size by more
// than this and this part of the worst, or their coverages by this part of the larger one.
#define DISAGREE_ERROR 0.03f
#define DISAGREE_SHARE 0.1f
#define DISAGREE_COVERAGE 0.25

prom_measure *prom_measure_create(const prom_measure_options *options, float mean_luminance)
{
    prom_measure *m = prom_calloc(1, sizeof *m);
    const char *name = options->metric ? options->metric : PROM_MEASURE_METRIC;
    m->how = (prom_measured){
        .ppd = options->ppd > 0.0f ? options->ppd : PROM_MEASURE_PPD,
        .background = {mean_luminance,
                       prom_linear_to_srgb(mean_luminance) > 0.5f ? 0.02f : 0.8f},
        .veto_percentile = VETO_PERCENTILE,
        .veto_error = options->veto ? VETO_ERROR : 1.0f};
    snprintf(m->how.metric, sizeof m->how.metric, "%s", name);
    m->metric = prom_metric_named(name);
    m->everywhere = options->everywhere;
    pthread_mutex_init(&m->lock, NULL);
    pthread_cond_init(&m->coarse_done, NULL);
    if (!m->metric) return m;
    m->pad = prom_metric_radius_of(name, m->how.ppd);
    prom_encoder_init(&m->encoder);
    m->threads = prom_thread_count();
    m->scratches = prom_calloc(m->threads, sizeof *m->scratches);
    for (unsigned t = 0; t < m->threads; t++) m->scratches[t] = measure_scratch_create(m);
    return m;
}

void prom_measure_destroy(prom_measure *m)
{
    if (!m) return;
    for (unsigned t = 0; t < m->threads; t++) measure_scratch_destroy(m->scratches[t]);
    prom_free(m->scratches);
    pthread_cond_destroy(&m->coarse_done);
    pthread_mutex_destroy(&m->lock);
    prom_free(m);
}

void prom_measure_tell(const prom_measure *m, prom_measured *measured)
{
    *measured = m->how;
}

uint64_t prom_measure_key(const prom_measure *m)
{
    prom_measured how = m->how;
    if (!m->metric || !m->metric->uses_ppd) how.ppd = 0.0f;
    return prom_hash(&how, sizeof how, m->everywhere);
}
_Static_assert(sizeof(prom_measured) == PROM_METRIC_NAME_BYTES + 5 * sizeof(float),
               "hashed without padding");

// ---- gaps

static bool is_covered(const prom_views *views, uint32_t dir, uint32_t x, uint32_t y)
{
    const prom_part *part = &views->at[dir].part;
    if (x < part->x || y < part->y || x - part->x >= part->width || y - part->y >= part->height)
        return false;
    size_t i = (size_t)(y - part->y) * part->width + x - part->x;
    return views->pixels.data[views->at[dir].first + i][3] >= PROM_COVERED;
}

// Pixels of a view that are covered, of those of the gap pixel at a place.
static uint32_t covered_at(const prom_views *views, uint32_t dir, uint32_t x, uint32_t y)
{
    uint32_t covered = 0;
    for (uint32_t dy = 0; dy < GAP_STEP; dy++)
        for (uint32_t dx = 0; dx < GAP_STEP; dx++)
            covered += is_covered(views, dir, x + dx, y + dy);
    return covered;
}

static uint32_t count_gaps(const prom_views *truth, const prom_views *other, uint32_t dir)
{
    const prom_part *part = &truth->at[dir].part;
    const uint32_t left = part->x / GAP_STEP * GAP_STEP, top = part->y / GAP_STEP * GAP_STEP;
    uint32_t gaps = 0;
    for (uint32_t y = top; y < part->y + part->height; y += GAP_STEP)
        for (uint32_t x = left; x < part->x + part->width; x += GAP_STEP)
            gaps += !covered_at(other, dir, x, y) &&
                    covered_at(truth, dir, x, y) == GAP_STEP * GAP_STEP;
    return gaps;
}

// ---- views

// Whether a representation is to be compared in a view.
static bool is_wanted(const prom_comparison *other, uint32_t view)
{
    return view < PROM_DIRS ? other->compared[view] : view < other->views->count;
}

static uint8_t *accuracies_in(prom_comparison *other, uint32_t view)
{
    return view < PROM_DIRS ? other->accuracy.bins[view]
                            : other->accuracy.large[view - PROM_DIRS];
}

// The part of a view in which something is to be seen: all else is background in every picture
// and cannot err. Width 0: nothing is wanted.
static prom_part part_of_all(const prom_measuring *measuring, uint32_t view)
{
    prom_part part = {0};
    bool wanted = false;
    for (size_t i = 0; i < measuring->count; i++) {
        const prom_comparison *other = measuring->others[i];
        if (!is_wanted(other, view)) continue;
        part = prom_part_around(part, other->views->at[view].part);
        wanted = true;
    }
    if (!wanted) return part;
    part = prom_part_around(part, measuring->truth->at[view].part);
    return part.width ? part : (prom_part){0, 0, 1, 1};
}

static void compare_in_view(const prom_measure *m, unsigned thread,
                            const prom_measuring *measuring, uint32_t view)
{
    const prom_part part = part_of_all(measuring, view);
    if (!part.width) return;
    if (!m->metric) { // constant
        for (size_t i = 0; i < measuring->count; i++)
            if (is_wanted(measuring->others[i], view))
                memset(accuracies_in(measuring->others[i], view),
                       prom_byte_of_accuracy(CONSTANT_ACCURACY), sizes_of_view(view).count);
        return;
    }
    measure_scratch *s = m->scratches[thread];
    measure_take_truth(m, s, measuring->truth, view, part);
    for (size_t i = 0; i < measuring->count; i++) {
        prom_comparison *other = measuring->others[i];
        if (is_wanted(other, view))
            measure_compare(m, s, other->views, view, part, accuracies_in(other, view));
    }
}

// ---- from coarse to fine

static bool coverages_disagree(const prom_views *truth, uint32_t dir, const uint32_t *around,
                               uint32_t count)
{
    uint32_t least = truth->at[dir].covered, most = least;
    for (uint32_t k = 0; k < count; k++) {
        uint32_t covered = truth->at[around[k]].covered;
        if (covered < least) least = covered;
        if (covered > most) most = covered;
    }
    return most - least > DISAGREE_COVERAGE * most;
}

static bool accuracies_disagree(const prom_accuracy_row *row, const uint32_t *around,
                                uint32_t count)
{
    for (uint32_t s = 0; s < PROM_SIZES; s++) {
        uint8_t least = 255, most = 0;
        for (uint32_t k = 0; k < count; k++) {
            uint8_t byte = row->bins[around[k]][s];
            if (byte < least) least = byte;
            if (byte > most) most = byte;
        }
        float worst = 1.0f - prom_accuracy_of_byte(least);
        float best = 1.0f - prom_accuracy_of_byte(most);
        if (worst - best > DISAGREE_ERROR + DISAGREE_SHARE * worst) return true;
    }
    return false;
}

static void interpolate(prom_accuracy_row *row, uint32_t dir, const uint32_t *around,
                        uint32_t count)
{
    for (uint32_t s = 0; s < PROM_SIZES; s++) {
        double sum = 0.0;
        for (uint32_t k = 0; k < count; k++)
            sum += (double)prom_accuracy_of_byte(row->bins[around[k]][s]);
        row->bins[dir][s] = prom_byte_of_accuracy(sum / count);
    }
}

// Marks what is to be compared in a fine direction, and interpolates the rest.
static void choose_fine(const prom_measure *m, const prom_measuring *measuring, uint32_t dir)
{
    uint32_t around[4];
    uint32_t count = prom_coarse_directions_around(dir, around);
    bool all = m->everywhere || coverages_disagree(measuring->truth, dir, around, count);
    for (size_t i = 0; i < measuring->count; i++) {
        prom_comparison *other = measuring->others[i];
        other->compared[dir] = all || accuracies_disagree(&other->accuracy, around, count);
        if (!other->compared[dir]) interpolate(&other->accuracy, dir, around, count);
    }
}

static void note_coarse_done(prom_measure *m, prom_measuring *measuring)
{
    pthread_mutex_lock(&m->lock);
    if (--measuring->coarse_left == 0) pthread_cond_broadcast(&m->coarse_done);
    pthread_mutex_unlock(&m->lock);
}

static void wait_for_coarse(prom_measure *m, const prom_measuring *measuring)
{
    pthread_mutex_lock(&m->lock);
    while (measuring->coarse_left) pthread_cond_wait(&m->coarse_done, &m->lock);
    pthread_mutex_unlock(&m->lock);
}

static void measure_direction(prom_measure *m, unsigned thread, prom_measuring *measuring,
                              uint32_t dir)
{
    const bool coarse = dir < PROM_DIRS_COARSE;
    for (size_t i = 0; i < measuring->count; i++) {
        prom_comparison *other = measuring->others[i];
        other->gaps[dir] = count_gaps(measuring->truth, other->views, dir);
        if (coarse) other->compared[dir] = true;
    }
    if (!coarse) {
        wait_for_coarse(m, measuring);
        choose_fine(m, measuring, dir);
    }
    compare_in_view(m, thread, measuring, dir);
    if (coarse) note_coarse_done(m, measuring);
}

void prom_measuring_init(prom_measuring *measuring, const prom_views *truth,
                         prom_comparison *const *others, size_t count)
{
    *measuring = (prom_measuring){truth, others, count, PROM_DIRS_COARSE};
    for (size_t i = 0; i < count; i++)
        memset(&others[i]->accuracy, 0, sizeof others[i]->accuracy);
}

// The large views first: they take longest.
void prom_measure_step(prom_measure *m, unsigned thread, prom_measuring *measuring, size_t step)
{
    if (step < PROM_DIRS_LARGE)
        compare_in_view(m, thread, measuring, PROM_DIRS + (uint32_t)step);
    else
        measure_direction(m, thread, measuring, (uint32_t)step - PROM_DIRS_LARGE);
}

// ---- along an axis from which nothing is seen

// They lose at the large sizes what the axes that see the object lose, in the mean, of what
// they have at the largest of the others.
static void fill_unseen_axes(const prom_views *truth, prom_accuracy_row *row)
{
    double lost[PROM_SIZES_LARGE] = {0};
    uint32_t seen = 0;
    for (uint32_t axis = 0; axis < PROM_DIRS_LARGE; axis++) {
        if (!truth->at[PROM_DIRS + axis].covered) continue;
        seen++;
        for (uint32_t s = 0; s < PROM_SIZES_LARGE; s++)
            lost[s] += (double)(prom_accuracy_of_byte(row->bins[axis][PROM_SIZES - 1]) -
                                prom_accuracy_of_byte(row->large[axis][s]));
    }
    for (uint32_t axis = 0; axis < PROM_DIRS_LARGE; axis++) {
        if (truth->at[PROM_DIRS + axis].covered) continue;
        const double own = (double)prom_accuracy_of_byte(row->bins[axis][PROM_SIZES - 1]);
        for (uint32_t s = 0; s < PROM_SIZES_LARGE; s++)
            row->large[axis][s] =
                prom_byte_of_accuracy(seen ? own - fmax(lost[s] / seen, 0.0) : own);
    }
}

void prom_measure_end(prom_measuring *measuring)
{
    for (size_t i = 0; i < measuring->count; i++)
        if (measuring->others[i]->views->count == PROM_VIEWS)
            fill_unseen_axes(measuring->truth, &measuring->others[i]->accuracy);
}
