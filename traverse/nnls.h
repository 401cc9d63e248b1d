// Non-negative least squares with few columns: the x >= 0 that minimises the sum over the rows
// of (row . x - target)^2. Active-set method of Lawson and Hanson (Solving Least Squares
// Problems, 1974, chapter 23) on the normal equations, columns scaled to unit length.
#ifndef PROM_TRAVERSE_NNLS_H
#define PROM_TRAVERSE_NNLS_H

#include <stdbool.h>
#include <stddef.h>

enum { NNLS_COLUMNS = 16 }; // at most

typedef struct nnls {
    int columns;
    size_t rows; // added so far
    double gram[NNLS_COLUMNS][NNLS_COLUMNS], rhs[NNLS_COLUMNS];
} nnls; // {.columns = n} has no rows

void nnls_add(nnls *equations, const double *row, double target);
// Whether any row has something in a column.
bool nnls_has(const nnls *equations, int column);
// x: one per column; 0 where no row has anything, and in columns that the others span.
void nnls_solve(const nnls *equations, double *x);

#endif
