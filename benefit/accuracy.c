#include "benefit/accuracy.h"

#include <assert.h>
#include <math.h>

void prom_accuracy_place_init(prom_accuracy_place *place, const float uv[2], float size_px)
{
    place->uv[0] = uv[0];
    place->uv[1] = uv[1];
    place->size_px = size_px;
    prom_directions_around(uv, &place->around);
    float bin = prom_bin_of_size(size_px);
    place->size = bin < PROM_SIZES - 1 ? (uint32_t)bin : PROM_SIZES - 2;
    place->t = fminf(bin - (float)place->size, 1.0f);
    if (size_px > PROM_SIZE_MAX_PX) prom_axes_around(uv, &place->axes);
}

static float between(float low, float high, float t)
{
    return low + t * (high - low);
}

// The mean of values with weights that sum to 1; exact where they are equal.
static float mean(const float *values, const float *weights, int count)
{
    float sum = values[0];
    for (int k = 1; k < count; k++) sum += weights[k] * (values[k] - values[0]);
    return sum;
}

uint8_t prom_byte_of_accuracy(double accuracy)
{
    const double exact = 1e-3; // of a step: what a byte stands for becomes that byte
    double root = sqrt(fmin(fmax(1.0 - accuracy, 0.0) / (double)PROM_ERROR_MAX, 1.0));
    return (uint8_t)(255.0 * (1.0 - root) + exact);
}

// Up to the largest size of all directions.
static float far_accuracy(const prom_accuracy_row *row, const prom_accuracy_place *place)
{
    float values[4];
    for (int k = 0; k < 4; k++) {
        const uint8_t *a = &row->bins[place->around.dir[k]][place->size];
        values[k] = between(prom_accuracy_of_byte(a[0]), prom_accuracy_of_byte(a[1]), place->t);
    }
    return mean(values, place->around.weight, 4);
}

// How much lower the accuracy is along the axes than it is there at PROM_SIZE_MAX_PX.
static float large_loss(const prom_accuracy_row *row, const prom_accuracy_place *place)
{
    float means[1 + PROM_SIZES_LARGE], values[3];
    for (int s = 0; s <= PROM_SIZES_LARGE; s++) {
        for (int k = 0; k < 3; k++) {
            uint32_t dir = place->axes.dir[k];
            values[k] = prom_accuracy_of_byte(s ? row->large[dir][s - 1]
                                                : row->bins[dir][PROM_SIZES - 1]);
        }
        means[s] = mean(values, place->axes.weight, 3);
    }
    float bin = fminf(prom_bin_of_size(place->size_px) - (PROM_SIZES - 1), PROM_SIZES_LARGE);
    int s = bin < PROM_SIZES_LARGE - 1 ? (int)bin : PROM_SIZES_LARGE - 1;
    return fmaxf(means[0] - between(means[s], means[s + 1], bin - (float)s), 0.0f);
}

static float near_ratio(const prom_representation *rep, float size_px, float radius)
{
    if (!(radius > 0.0f)) return 1.0f;
    float per_px = rep->near_k * rep->error / (2.0f * radius);
    return (1.0f + per_px * PROM_SIZE_MAX_LARGE_PX) / (1.0f + per_px * size_px);
}

float prom_accuracy(const prom_model *model, uint32_t rep, const prom_accuracy_place *place,
                    float radius)
{
    assert(rep < model->rep_count);
    const prom_accuracy_row *row = &model->accuracy[rep];
    float accuracy = far_accuracy(row, place);
    if (place->size_px <= PROM_SIZE_MAX_PX) return accuracy;
    const prom_representation *r = &model->reps[rep];
    const float least = 1.0f - PROM_ERROR_MAX;
    if (r->kind != PROM_REP_MESH)
        return fmaxf(1.0f - (1.0f - accuracy) * place->size_px / PROM_SIZE_MAX_PX, least);
    accuracy = fmaxf(accuracy - large_loss(row, place), least);
    if (place->size_px <= PROM_SIZE_MAX_LARGE_PX || accuracy < 0.0f) return accuracy;
    return accuracy * near_ratio(r, place->size_px, radius);
}

float prom_footprint_px(const prom_model *model, uint32_t prototype, uint32_t dir,
                        float size_px)
{
    assert(prototype < model->prototype_count && dir < PROM_DIRS);
    const float quarter_pi = 0.78539816f;
    return (float)model->coverage[prototype][dir] / 65535.0f * quarter_pi * size_px * size_px;
}

void prom_split_pixels(const prom_model *model, uint32_t prototype, uint32_t dir, float pixels,
                       const float *in_view, float *px)
{
    assert(prototype < model->prototype_count && dir < PROM_DIRS);
    const prom_prototype *p = &model->prototypes[prototype];
    const uint16_t(*shares)[PROM_DIRS] =
        p->first_share == PROM_NONE ? NULL : model->shares + p->first_share;
    double total = 0.0;
    if (shares) {
        for (uint32_t c = 0; c < p->child_count; c++) {
            px[c] = (float)shares[c][dir] * in_view[c];
            total += px[c];
        }
    }
    if (!(total > 0.0)) {
        for (uint32_t c = 0; c < p->child_count; c++) {
            px[c] = in_view[c] > 0.0f ? 1.0f : 0.0f;
            total += px[c];
        }
    }
    float factor = total > 0.0 ? (float)(pixels / total) : 0.0f;
    for (uint32_t c = 0; c < p->child_count; c++) px[c] *= factor;
}

// ---- the near-field fit

typedef struct near_rows {
    const float *e_px, *accuracy;
    size_t count;
} near_rows;

static bool usable(const near_rows *rows, size_t i)
{
    return isfinite(rows->e_px[i]) && rows->e_px[i] >= 0.0f && isfinite(rows->accuracy[i]);
}

// Of the best multiple in [0,1] of near(e_px).
static double squared_error(const near_rows *rows, double near_k)
{
    double aa = 0.0, an = 0.0, nn = 0.0;
    for (size_t i = 0; i < rows->count; i++) {
        if (!usable(rows, i)) continue;
        double a = rows->accuracy[i], near = 1.0 / (1.0 + near_k * rows->e_px[i]);
        aa += a * a;
        an += a * near;
        nn += near * near;
    }
    double s = nn > 0.0 ? fmin(fmax(an / nn, 0.0), 1.0) : 0.0;
    return fmax(aa - 2.0 * s * an + s * s * nn, 0.0);
}

// Golden-section search for the least squared error over log(near_k) in [low, high].
static double refine(const near_rows *rows, double low, double high)
{
    const double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double fa = squared_error(rows, exp(a)), fb = squared_error(rows, exp(b));
    for (int i = 0; i < 40; i++) {
        if (fa <= fb) {
            high = b, b = a, fb = fa;
            a = high - golden * (high - low);
            fa = squared_error(rows, exp(a));
        } else {
            low = a, a = b, fa = fb;
            b = low + golden * (high - low);
            fb = squared_error(rows, exp(b));
        }
    }
    return exp(0.5 * (low + high));
}

float prom_accuracy_fit_near(const float *e_px, const float *accuracy, size_t count)
{
    const near_rows rows = {e_px, accuracy, count};
    double e_max = 0.0;
    for (size_t i = 0; i < count; i++)
        if (usable(&rows, i) && e_px[i] > e_max) e_max = e_px[i];
    if (!(e_max > 0.0)) return 0.0f;

    // A scan first, since the error has several valleys in near_k where rows contradict each
    // other. The range covers accuracies of 0.9999 to 0.0001 at the largest e_px.
    enum { STEPS = 72 };
    const double low = log(1e-4 / e_max), step = (log(1e4 / e_max) - low) / STEPS;
    int best = 0;
    double least = INFINITY;
    for (int i = 0; i <= STEPS; i++) {
        double error = squared_error(&rows, exp(low + i * step));
        if (error < least) least = error, best = i;
    }
    double k = refine(&rows, low + (best - 1) * step, low + (best + 1) * step);
    // Rounding must not make a law of rows that are level.
    return squared_error(&rows, k) < squared_error(&rows, 0.0) - 1e-9 ? (float)k : 0.0f;
}
