// Fit of the cost model.
//
// Each sample is divided by its time T, so that least squares weighs relative errors. The max
// form is fitted by turns: with it known for each sample which side of the maximum is the
// greater, its coefficients follow from least squares, in which the sample says nothing of the
// other side, and from these the sides again (Magnani and Boyd 2009, Convex piecewise-linear
// fitting, section 3).
#include "traverse/cost.h"
#include "traverse/nnls.h"

#include "metaobj/base/alloc.h"

#include <math.h>
#include <string.h>

enum {
    FIXED,
    BINDS,
    UPLOADS,
    UPLOAD_BYTES,
    DRAWS,
    VERTICES,
    TRIANGLES,
    EDGES,
    HIDDEN_EDGES,
    HIDDEN,
    PIXELS,
    COLUMNS = PIXELS + PROM_COST_KINDS,
    GEOMETRY = DRAWS // this column and up to HIDDEN are geometry; from there on pixels
};
// What a hidden pixel costs against a textured one where no sample has any. Measured on
// llvmpipe with six full layers: 7.0 ms, where one takes 3.0.
#define HIDDEN_SHARE 0.27
#define DEFAULT_MARGIN 0.1
// The max form must be better by this: noise alone must not choose it (by taste).
#define MAX_FORM_SHARE 0.9
#define TURNS 30

static void columns_of(const prom_cost_features *f, double out[COLUMNS])
{
    out[FIXED] = f->fixed;
    out[BINDS] = f->binds;
    out[UPLOADS] = f->uploads;
    out[UPLOAD_BYTES] = f->upload_bytes;
    out[DRAWS] = f->draws;
    out[VERTICES] = f->vertices;
    out[TRIANGLES] = f->triangles;
    out[EDGES] = f->edges;
    out[HIDDEN_EDGES] = f->hidden_edges;
    out[HIDDEN] = f->hidden;
    for (int k = 0; k < PROM_COST_KINDS; k++) out[PIXELS + k] = f->pixels[k];
}

static void set_coefficients(prom_cost_model *model, const double x[COLUMNS])
{
    model->fixed_ms = x[FIXED];
    model->bind_ms = x[BINDS];
    model->uploading_ms = x[UPLOADS];
    model->upload_ms = x[UPLOAD_BYTES];
    model->draw_ms = x[DRAWS];
    model->vertex_ms = x[VERTICES];
    model->triangle_ms = x[TRIANGLES];
    model->edge_ms = x[EDGES];
    model->hidden_edge_ms = x[HIDDEN_EDGES];
    model->hidden_pixel_ms = x[HIDDEN];
    for (int k = 0; k < PROM_COST_KINDS; k++) model->pixel_ms[k] = x[PIXELS + k];
}

// Samples that a model is fitted to: those of one half, or with half < 0 all.
typedef struct sample_set {
    const prom_cost_sample *samples;
    size_t count;
    int half;
} sample_set;

// Halves are scrambled, because calibration series have their own rhythm.
static bool is_in(const sample_set *set, size_t i)
{
    return set->half < 0 || (int)((uint32_t)i * 2654435761u >> 31) == set->half;
}

// What of the columns makes the time of each sample.
typedef enum side { SIDE_BOTH, SIDE_GEOMETRY, SIDE_PIXELS } side;

static void drop_other_side(double row[COLUMNS], side greater)
{
    if (greater == SIDE_PIXELS) memset(row + GEOMETRY, 0, (HIDDEN - GEOMETRY) * sizeof *row);
    if (greater == SIDE_GEOMETRY) memset(row + HIDDEN, 0, (COLUMNS - HIDDEN) * sizeof *row);
}

// sides: one per sample, or NULL: both.
static nnls equations_of(const sample_set *set, const side *sides)
{
    nnls e = {.columns = COLUMNS};
    for (size_t i = 0; i < set->count; i++) {
        if (!is_in(set, i)) continue;
        double row[COLUMNS];
        columns_of(&set->samples[i].features, row);
        if (sides) drop_other_side(row, sides[i]);
        for (int a = 0; a < COLUMNS; a++) row[a] /= set->samples[i].ms;
        nnls_add(&e, row, 1.0);
    }
    return e;
}

static size_t columns_present(const nnls *e)
{
    size_t n = 0;
    for (int a = 0; a < COLUMNS; a++) n += nnls_has(e, a);
    return n;
}

// Shading kinds without samples cost what textured pixels cost, or else the dearest known kind;
// hidden pixels a part of it.
static void fill_missing_kinds(prom_cost_model *model, const nnls *e)
{
    double fallback = 0.0;
    for (int k = 0; k < PROM_COST_KINDS; k++) fallback = fmax(fallback, model->pixel_ms[k]);
    if (nnls_has(e, PIXELS + PROM_SHADE_TEXTURED))
        fallback = model->pixel_ms[PROM_SHADE_TEXTURED];
    for (int k = 0; k < PROM_COST_KINDS; k++)
        if (!nnls_has(e, PIXELS + k)) model->pixel_ms[k] = fallback;
    if (!nnls_has(e, HIDDEN)) model->hidden_pixel_ms = HIDDEN_SHARE * fallback;
}

static void solve_into(const nnls *e, prom_cost_model *model)
{
    double x[COLUMNS];
    nnls_solve(e, x);
    set_coefficients(model, x);
    fill_missing_kinds(model, e);
}

// ---- the max form

// Which side is the greater, with geometry weighed by `bias`; false when nothing changed.
static bool find_sides(const sample_set *set, const prom_cost_model *model, double bias,
                       side *sides)
{
    bool changed = false;
    for (size_t i = 0; i < set->count; i++) {
        double terms[PROM_TERMS];
        prom_cost_terms(model, &set->samples[i].features, terms);
        bool geometry = bias * terms[PROM_TERM_GEOMETRY] >
                        terms[PROM_TERM_PIXELS] + terms[PROM_TERM_HIDDEN];
        side now = geometry ? SIDE_GEOMETRY : SIDE_PIXELS;
        changed |= now != sides[i];
        sides[i] = now;
    }
    return changed;
}

static double sum_of_squares(const sample_set *set, const prom_cost_model *model)
{
    double sum = 0.0;
    for (size_t i = 0; i < set->count; i++) {
        if (!is_in(set, i)) continue;
        const prom_cost_sample *s = &set->samples[i];
        double error = prom_cost_predict(model, &s->features) / s->ms - 1.0;
        sum += error * error;
    }
    return sum;
}

// From one start; model holds the sum form's coefficients and gets the best of the way.
static double fit_max_from(const sample_set *set, double bias, side *sides,
                           prom_cost_model *model)
{
    prom_cost_model current = *model;
    double least = INFINITY;
    find_sides(set, &current, bias, sides);
    for (int turn = 0; turn < TURNS; turn++) {
        nnls e = equations_of(set, sides);
        solve_into(&e, &current);
        double error = sum_of_squares(set, &current);
        if (error < least) {
            least = error;
            *model = current;
        }
        if (!find_sides(set, &current, 1.0, sides)) break;
    }
    return least;
}

// The turns end in the nearest minimum, so they start in several places.
static void fit_max(const sample_set *set, prom_cost_model *model)
{
    static const double biases[] = {0.25, 0.5, 1.0, 2.0, 4.0};
    side *sides = prom_calloc(set->count, sizeof *sides);
    prom_cost_model start = *model;
    double least = INFINITY;
    start.form = PROM_COST_MAX;
    for (size_t i = 0; i < sizeof biases / sizeof *biases; i++) {
        prom_cost_model found = start;
        double error = fit_max_from(set, biases[i], sides, &found);
        if (error >= least) continue;
        least = error;
        *model = found;
    }
    prom_free(sides);
}

// ---- the fit

// Sets the coefficients and the form.
static void fit_set(const sample_set *set, prom_cost_form form, prom_cost_model *model)
{
    nnls e = equations_of(set, NULL);
    solve_into(&e, model);
    model->form = PROM_COST_SUM;
    if (form == PROM_COST_MAX) fit_max(set, model);
}

// Whether both halves alone have all columns, and samples enough for them.
static bool halves_suffice(const prom_cost_sample *samples, size_t count)
{
    nnls all = equations_of(&(sample_set){samples, count, -1}, NULL);
    size_t columns = columns_present(&all);
    for (int half = 0; half < 2; half++) {
        nnls e = equations_of(&(sample_set){samples, count, half}, NULL);
        if (e.rows < columns || columns_present(&e) < columns) return false;
    }
    return true;
}

bool prom_cost_held_out(const prom_cost_sample *samples, size_t count, prom_cost_form form,
                        double *predicted_ms)
{
    bool halves = halves_suffice(samples, count);
    for (int half = 0; half < (halves ? 2 : 1); half++) {
        const sample_set seen = {samples, count, halves ? 1 - half : -1};
        prom_cost_model model = {0};
        fit_set(&seen, form, &model);
        for (size_t i = 0; i < count; i++)
            if (!halves || !is_in(&seen, i))
                predicted_ms[i] = prom_cost_predict(&model, &samples[i].features);
    }
    return halves;
}

static void measure_errors(const prom_cost_sample *samples, size_t count,
                           prom_cost_model *model)
{
    double *predicted = prom_alloc(count, sizeof *predicted), sum = 0.0, worst = 0.0;
    prom_cost_held_out(samples, count, model->form, predicted);
    for (size_t i = 0; i < count; i++) {
        sum += fabs(predicted[i] / samples[i].ms - 1.0);
        if (predicted[i] > 0.0) worst = fmax(worst, samples[i].ms / predicted[i] - 1.0);
    }
    prom_free(predicted);
    model->mean_error = sum / (double)count;
    model->worst_under = worst;
}

static const char *sample_fault(const prom_cost_sample *sample)
{
    double row[COLUMNS];
    columns_of(&sample->features, row);
    for (int a = 0; a < COLUMNS; a++)
        if (!isfinite(row[a]) || row[a] < 0.0) return "a feature is negative or not finite";
    if (!isfinite(sample->ms) || !(sample->ms > 0.0)) return "its time is not above 0 ms";
    return NULL;
}

prom_status prom_cost_fit(const prom_cost_sample *samples, size_t count, prom_cost_model *model,
                          prom_error *error)
{
    for (size_t i = 0; i < count; i++) {
        const char *fault = sample_fault(&samples[i]);
        if (fault)
            return prom_fail(error, PROM_ERR_INPUT,
                             "calibration sample %zu of %zu is unusable: %s; calibrate again",
                             i + 1, count, fault);
    }
    const sample_set all = {samples, count, -1};
    nnls e = equations_of(&all, NULL);
    size_t columns = columns_present(&e);
    if (!columns || count < columns)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%zu calibration samples are too few to fit %zu cost coefficients; "
                         "calibrate with more effort",
                         count, columns);
    prom_cost_model fits[PROM_COST_FORMS];
    for (int form = 0; form < PROM_COST_FORMS; form++) {
        fits[form] = (prom_cost_model){.margin = DEFAULT_MARGIN};
        fits[form].sample_count = count > UINT32_MAX ? UINT32_MAX : (uint32_t)count;
        fit_set(&all, (prom_cost_form)form, &fits[form]);
        measure_errors(samples, count, &fits[form]);
    }
    bool max = fits[PROM_COST_MAX].mean_error < MAX_FORM_SHARE * fits[PROM_COST_SUM].mean_error;
    *model = fits[max ? PROM_COST_MAX : PROM_COST_SUM];
    return PROM_OK;
}
