// Fit and use of the linear cost model.
//
// Each sample is divided by its time T, so that least squares weighs relative errors; columns
// are scaled to unit length; coefficients are kept non-negative by the active-set method of
// Lawson and Hanson (Solving Least Squares Problems, 1974, chapter 23) on the normal equations.
#include "traverse/cost.h"

#include <assert.h>
#include <math.h>
#include <string.h>

enum { EDGES = 4, HIDDEN, HIDDEN_EDGES, PIXELS, COLUMNS = PIXELS + PROM_COST_KINDS };
// What a hidden pixel costs against a textured one where no sample has any. Measured on
// llvmpipe with six full layers: 7.0 ms, where one takes 3.0.
#define HIDDEN_SHARE 0.27
#define DEFAULT_MARGIN 0.1

static void columns_of(const prom_cost_features *f, double out[COLUMNS])
{
    out[0] = f->fixed;
    out[1] = f->draws;
    out[2] = f->vertices;
    out[3] = f->triangles;
    out[EDGES] = f->edges;
    out[HIDDEN] = f->hidden;
    out[HIDDEN_EDGES] = f->hidden_edges;
    for (int k = 0; k < PROM_COST_KINDS; k++) out[PIXELS + k] = f->pixels[k];
}

static void set_coefficients(prom_cost_model *model, const double x[COLUMNS])
{
    model->fixed_ms = x[0];
    model->draw_ms = x[1];
    model->vertex_ms = x[2];
    model->triangle_ms = x[3];
    model->edge_ms = x[EDGES];
    model->hidden_pixel_ms = x[HIDDEN];
    model->hidden_edge_ms = x[HIDDEN_EDGES];
    for (int k = 0; k < PROM_COST_KINDS; k++) model->pixel_ms[k] = x[PIXELS + k];
}

// ---- non-negative least squares on gram * x = rhs

typedef struct normal_equations {
    double gram[COLUMNS][COLUMNS], rhs[COLUMNS], scale[COLUMNS];
    bool present[COLUMNS];
} normal_equations;

// Solves the equations of the columns in `active` by Cholesky decomposition. A column that the
// others span (to rounding) gets 0.
static void solve_active(const normal_equations *e, const bool active[COLUMNS],
                         double x[COLUMNS])
{
    double l[COLUMNS][COLUMNS] = {0}, y[COLUMNS] = {0};
    bool used[COLUMNS] = {0};
    for (int i = 0; i < COLUMNS; i++) {
        if (!active[i]) continue;
        double diagonal = e->gram[i][i], value = e->rhs[i];
        for (int j = 0; j < i; j++) {
            if (!used[j]) continue;
            double sum = e->gram[i][j];
            for (int k = 0; k < j; k++) sum -= l[i][k] * l[j][k];
            l[i][j] = sum / l[j][j];
            diagonal -= l[i][j] * l[i][j];
            value -= l[i][j] * y[j];
        }
        used[i] = diagonal > 1e-11;
        if (!used[i]) {
            memset(l[i], 0, sizeof l[i]);
            continue;
        }
        l[i][i] = sqrt(diagonal);
        y[i] = value / l[i][i];
    }
    for (int i = COLUMNS - 1; i >= 0; i--) {
        x[i] = 0.0;
        if (!used[i]) continue;
        double sum = y[i];
        for (int k = i + 1; k < COLUMNS; k++) sum -= l[k][i] * x[k];
        x[i] = sum / l[i][i];
    }
}

// The inactive column whose growth lowers the error most, or -1.
static int steepest(const normal_equations *e, const bool active[COLUMNS],
                    const bool refused[COLUMNS], const double x[COLUMNS])
{
    int best = -1;
    double most = 1e-10;
    for (int i = 0; i < COLUMNS; i++) {
        if (active[i] || refused[i] || !e->present[i]) continue;
        double gradient = e->rhs[i];
        for (int j = 0; j < COLUMNS; j++) gradient -= e->gram[i][j] * x[j];
        if (gradient > most) most = gradient, best = i;
    }
    return best;
}

// Moves x towards `target` until the first active coefficient reaches 0; true when it went all
// the way.
static bool move_towards(const double target[COLUMNS], bool active[COLUMNS], double x[COLUMNS])
{
    double step = 1.0;
    int blocking = -1;
    for (int i = 0; i < COLUMNS; i++) {
        if (!active[i] || target[i] > 0.0) continue;
        double t = x[i] > 0.0 ? x[i] / (x[i] - target[i]) : 0.0;
        if (blocking < 0 || t < step) step = t, blocking = i;
    }
    for (int i = 0; i < COLUMNS; i++)
        if (active[i]) x[i] += step * (target[i] - x[i]);
    if (blocking < 0) return true;
    x[blocking] = 0.0;
    active[blocking] = false;
    return false;
}

static void solve_non_negative(const normal_equations *e, double x[COLUMNS])
{
    bool active[COLUMNS] = {0}, refused[COLUMNS] = {0};
    memset(x, 0, COLUMNS * sizeof *x);
    // Each column enters a few times at most; the limit only guards against rounding in
    // circles.
    for (int round = 0; round < 10 * COLUMNS; round++) {
        int enter = steepest(e, active, refused, x);
        if (enter < 0) return;
        active[enter] = true;
        double target[COLUMNS];
        do solve_active(e, active, target);
        while (!move_towards(target, active, x));
        // A column that fell out at once would enter again for ever.
        if (!active[enter])
            refused[enter] = true;
        else
            memset(refused, 0, sizeof refused);
    }
}

// ---- the fit

// Which half a sample belongs to; scrambled, because calibration series have their own rhythm.
static int half_of(size_t i)
{
    return (int)((uint32_t)i * 2654435761u >> 31);
}

// Uses the samples of one half, or all of them with half < 0. Returns how many there were.
static size_t build_equations(const prom_cost_sample *samples, size_t count, int half,
                              normal_equations *e)
{
    memset(e, 0, sizeof *e);
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (half >= 0 && half_of(i) != half) continue;
        double row[COLUMNS];
        columns_of(&samples[i].features, row);
        for (int a = 0; a < COLUMNS; a++) row[a] /= samples[i].ms;
        for (int a = 0; a < COLUMNS; a++) {
            e->rhs[a] += row[a];
            for (int b = 0; b < COLUMNS; b++) e->gram[a][b] += row[a] * row[b];
        }
        used++;
    }
    for (int a = 0; a < COLUMNS; a++) {
        e->present[a] = e->gram[a][a] > 0.0;
        e->scale[a] = e->present[a] ? 1.0 / sqrt(e->gram[a][a]) : 0.0;
    }
    for (int a = 0; a < COLUMNS; a++) {
        e->rhs[a] *= e->scale[a];
        for (int b = 0; b < COLUMNS; b++) e->gram[a][b] *= e->scale[a] * e->scale[b];
    }
    return used;
}

static size_t present_columns(const normal_equations *e)
{
    size_t n = 0;
    for (int a = 0; a < COLUMNS; a++) n += e->present[a];
    return n;
}

// Shading kinds without samples cost what textured pixels cost, or else the dearest known kind;
// hidden pixels a part of it.
static void fill_missing_kinds(prom_cost_model *model, const normal_equations *e)
{
    double fallback = 0.0;
    for (int k = 0; k < PROM_COST_KINDS; k++) fallback = fmax(fallback, model->pixel_ms[k]);
    if (e->present[PIXELS + PROM_SHADE_TEXTURED])
        fallback = model->pixel_ms[PROM_SHADE_TEXTURED];
    for (int k = 0; k < PROM_COST_KINDS; k++)
        if (!e->present[PIXELS + k]) model->pixel_ms[k] = fallback;
    if (!e->present[HIDDEN]) model->hidden_pixel_ms = HIDDEN_SHARE * fallback;
}

static void solve_into(const normal_equations *e, prom_cost_model *model)
{
    double x[COLUMNS];
    solve_non_negative(e, x);
    for (int a = 0; a < COLUMNS; a++) x[a] *= e->scale[a];
    set_coefficients(model, x);
    fill_missing_kinds(model, e);
}

// Adds up the errors of a model on one half of the samples, or on all.
static size_t add_residuals(const prom_cost_model *fit, const prom_cost_sample *samples,
                            size_t count, int half, double *sum, double *worst_under)
{
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        if (half >= 0 && half_of(i) != half) continue;
        double predicted = prom_cost_predict(fit, &samples[i].features);
        *sum += fabs(predicted / samples[i].ms - 1.0);
        if (predicted > 0.0) *worst_under = fmax(*worst_under, samples[i].ms / predicted - 1.0);
        used++;
    }
    return used;
}

// Errors on samples that the fit has not seen: each half predicted from the other. With too few
// samples for that, those of the fit itself.
static void measure_errors(const prom_cost_sample *samples, size_t count, size_t columns,
                           prom_cost_model *model)
{
    double sum = 0.0, worst = 0.0;
    size_t used = 0;
    for (int half = 0; half < 2; half++) {
        normal_equations e;
        prom_cost_model other = {0};
        if (build_equations(samples, count, 1 - half, &e) < columns ||
            present_columns(&e) < columns) {
            used = 0;
            break;
        }
        solve_into(&e, &other);
        used += add_residuals(&other, samples, count, half, &sum, &worst);
    }
    if (!used) {
        sum = worst = 0.0;
        used = add_residuals(model, samples, count, -1, &sum, &worst);
    }
    model->mean_error = sum / (double)used;
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
    normal_equations e;
    build_equations(samples, count, -1, &e);
    size_t columns = present_columns(&e);
    if (!columns || count < columns)
        return prom_fail(error, PROM_ERR_INPUT,
                         "%zu calibration samples are too few to fit %zu cost coefficients; "
                         "calibrate with more effort",
                         count, columns);
    *model = (prom_cost_model){.margin = DEFAULT_MARGIN};
    model->sample_count = count > UINT32_MAX ? UINT32_MAX : (uint32_t)count;
    solve_into(&e, model);
    measure_errors(samples, count, columns, model);
    return PROM_OK;
}

// ---- use

double prom_cost_predict(const prom_cost_model *model, const prom_cost_features *features)
{
    double ms = model->fixed_ms * features->fixed + model->draw_ms * features->draws +
                model->vertex_ms * features->vertices +
                model->triangle_ms * features->triangles + model->edge_ms * features->edges +
                model->hidden_pixel_ms * features->hidden +
                model->hidden_edge_ms * features->hidden_edges;
    for (int k = 0; k < PROM_COST_KINDS; k++) ms += model->pixel_ms[k] * features->pixels[k];
    return ms;
}

uint32_t prom_cost_kind(const prom_representation *rep)
{
    bool lit = rep->shading == PROM_SHADE_IMPOSTOR && !(rep->flags & PROM_REP_UNLIT);
    return lit ? PROM_COST_IMPOSTOR_LIT : rep->shading;
}

void prom_cost_add_terms(const prom_cost_model *model, const prom_representation *rep,
                         double shaded_px, double hidden_px, double terms[PROM_TERMS])
{
    terms[PROM_TERM_GEOMETRY] +=
        model->draw_ms * rep->draws + model->vertex_ms * rep->vertices +
        model->triangle_ms * rep->triangles +
        model->edge_ms * prom_cost_edges(rep->triangles, shaded_px, hidden_px) +
        model->hidden_edge_ms * prom_cost_edges(rep->triangles, hidden_px, shaded_px);
    terms[PROM_TERM_PIXELS] += model->pixel_ms[prom_cost_kind(rep)] * shaded_px;
    terms[PROM_TERM_HIDDEN] += model->hidden_pixel_ms * hidden_px;
}

prom_cost_model prom_cost_scaled(const prom_cost_model *model, const double factors[PROM_TERMS])
{
    prom_cost_model scaled = *model;
    scaled.fixed_ms *= factors[PROM_TERM_FIXED];
    scaled.draw_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.vertex_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.triangle_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.edge_ms *= factors[PROM_TERM_GEOMETRY];
    scaled.hidden_edge_ms *= factors[PROM_TERM_GEOMETRY];
    for (int k = 0; k < PROM_COST_KINDS; k++) scaled.pixel_ms[k] *= factors[PROM_TERM_PIXELS];
    scaled.hidden_pixel_ms *= factors[PROM_TERM_HIDDEN];
    return scaled;
}

double prom_cost_of_rep(const prom_cost_model *model, const prom_representation *rep,
                        double shaded_px, double hidden_px)
{
    assert(rep->shading < PROM_SHADE_COUNT);
    return model->draw_ms * rep->draws + model->vertex_ms * rep->vertices +
           model->triangle_ms * rep->triangles +
           model->pixel_ms[prom_cost_kind(rep)] * shaded_px +
           model->hidden_pixel_ms * hidden_px +
           model->edge_ms * prom_cost_edges(rep->triangles, shaded_px, hidden_px) +
           model->hidden_edge_ms * prom_cost_edges(rep->triangles, hidden_px, shaded_px);
}
