#include "traverse/nnls.h"

#include <assert.h>
#include <math.h>
#include <string.h>

void nnls_add(nnls *equations, const double *row, double target)
{
    assert(equations->columns <= NNLS_COLUMNS);
    for (int a = 0; a < equations->columns; a++) {
        equations->rhs[a] += row[a] * target;
        for (int b = 0; b < equations->columns; b++) equations->gram[a][b] += row[a] * row[b];
    }
    equations->rows++;
}

bool nnls_has(const nnls *equations, int column)
{
    return equations->gram[column][column] > 0.0;
}

// Scales the columns to unit length; scale[a] is 0 for an empty one.
static nnls scaled(const nnls *equations, double scale[NNLS_COLUMNS])
{
    nnls e = *equations;
    for (int a = 0; a < e.columns; a++)
        scale[a] = nnls_has(equations, a) ? 1.0 / sqrt(e.gram[a][a]) : 0.0;
    for (int a = 0; a < e.columns; a++) {
        e.rhs[a] *= scale[a];
        for (int b = 0; b < e.columns; b++) e.gram[a][b] *= scale[a] * scale[b];
    }
    return e;
}

// Solves the equations of the columns in `active` by Cholesky decomposition. A column that the
// others span (to rounding) gets 0.
static void solve_active(const nnls *e, const bool *active, double *x)
{
    double l[NNLS_COLUMNS][NNLS_COLUMNS] = {0}, y[NNLS_COLUMNS] = {0};
    bool used[NNLS_COLUMNS] = {0};
    for (int i = 0; i < e->columns; i++) {
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
    for (int i = e->columns - 1; i >= 0; i--) {
        x[i] = 0.0;
        if (!used[i]) continue;
        double sum = y[i];
        for (int k = i + 1; k < e->columns; k++) sum -= l[k][i] * x[k];
        x[i] = sum / l[i][i];
    }
}

// The inactive column whose growth lowers the error most, or -1.
static int steepest(const nnls *e, const bool *active, const bool *refused, const double *x)
{
    int best = -1;
    double most = 1e-10;
    for (int i = 0; i < e->columns; i++) {
        if (active[i] || refused[i] || !nnls_has(e, i)) continue;
        double gradient = e->rhs[i];
        for (int j = 0; j < e->columns; j++) gradient -= e->gram[i][j] * x[j];
        if (gradient > most) most = gradient, best = i;
    }
    return best;
}

// Moves x towards `target` until the first active coefficient reaches 0; true when it went all
// the way.
static bool move_towards(int columns, const double *target, bool *active, double *x)
{
    double step = 1.0;
    int blocking = -1;
    for (int i = 0; i < columns; i++) {
        if (!active[i] || target[i] > 0.0) continue;
        double t = x[i] > 0.0 ? x[i] / (x[i] - target[i]) : 0.0;
        if (blocking < 0 || t < step) step = t, blocking = i;
    }
    for (int i = 0; i < columns; i++)
        if (active[i]) x[i] += step * (target[i] - x[i]);
    if (blocking < 0) return true;
    x[blocking] = 0.0;
    active[blocking] = false;
    return false;
}

void nnls_solve(const nnls *equations, double *x)
{
    double scale[NNLS_COLUMNS], target[NNLS_COLUMNS];
    bool active[NNLS_COLUMNS] = {0}, refused[NNLS_COLUMNS] = {0};
    nnls e = scaled(equations, scale);
    for (int a = 0; a < e.columns; a++) x[a] = 0.0;
    // Each column enters a few times at most; the limit only guards against rounding in
    // circles.
    for (int round = 0; round < 10 * NNLS_COLUMNS; round++) {
        int enter = steepest(&e, active, refused, x);
        if (enter < 0) break;
        active[enter] = true;
        do solve_active(&e, active, target);
        while (!move_towards(e.columns, target, active, x));
        // A column that fell out at once would enter again for ever.
        if (!active[enter])
            refused[enter] = true;
        else
            memset(refused, 0, sizeof refused);
    }
    for (int a = 0; a < e.columns; a++) x[a] *= scale[a];
}
